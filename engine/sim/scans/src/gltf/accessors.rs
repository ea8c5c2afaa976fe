//! Accessors of a glTF file: numbers in its buffers, plain, packed or sparse. Every index and every range is checked.

use super::document::{Document, Node, Primitive};
use super::materials::TextureUse;
use super::views::{Accessor, Instances, Sparse, View, is_read, scalar, scalar_of_index};
use cosfly_frames::DVec3;
use cosfly_town::MapError;
use glam::{DMat4, DQuat};

/// Most places of one mesh that stands in many.
const MOST_PLACES: usize = 1_000_000;

impl Document {
    /// Numbers of corners and indices that a shape says it has, with all their colours and texture places, no more than there are bytes: what reading it costs, whether it can be read or not.
    pub fn elements_of_shape(&self, shape: &Primitive) -> usize {
        let bytes: usize = self.data.iter().map(Vec::len).sum();
        let count = |accessor: &usize| self.accessors.get(*accessor).map_or(0, |accessor| accessor.count.min(bytes));
        let attributes = shape.attributes.iter().filter(|(name, _)| is_read(name));
        1 + attributes.map(|(_, accessor)| count(accessor)).sum::<usize>() + shape.indices.as_ref().map_or(0, count)
    }

    /// Bytes of a view.
    pub(super) fn viewed(&self, view: &View) -> Option<&[u8]> {
        self.data.get(view.buffer)?.get(view.byte_offset..)?.get(..view.byte_length)
    }

    /// Bytes of each element of an accessor; none where it is sparse or reaches beyond its data.
    fn elements(&self, accessor: &Accessor, bytes: usize) -> Option<impl Iterator<Item = &[u8]>> {
        let view = accessor.buffer_view.filter(|_| accessor.sparse.is_none())?;
        self.elements_of(view, accessor.byte_offset, accessor.count, bytes)
    }

    fn elements_of(
        &self,
        view: usize,
        offset: usize,
        count: usize,
        bytes: usize,
    ) -> Option<impl Iterator<Item = &[u8]>> {
        let view = self.buffer_views.get(view)?;
        let data = self.viewed(view)?.get(offset..)?;
        let stride = view.byte_stride.unwrap_or(bytes).max(bytes);
        let end = count.checked_sub(1)?.checked_mul(stride)?.checked_add(bytes)?;
        (end <= data.len()).then(|| (0..count).map(move |at| &data[at * stride..][..bytes]))
    }

    /// Elements of `N` numbers, plain or sparse.
    fn vectors<const N: usize, T: Clone>(
        &self,
        accessor: usize,
        kind: &str,
        make: impl Fn([f64; N]) -> T,
    ) -> Option<Vec<T>> {
        let accessor = self.accessors.get(accessor).filter(|accessor| accessor.kind == kind)?;
        let scalar = scalar(accessor.component_type)?;
        let most = accessor.greatest();
        let number = |own: &[u8], at: usize| {
            let number = scalar.read(&own[at * scalar.bytes()..], false).unwrap_or(f64::NAN) / most;
            if accessor.normalized { number.max(-1.0) } else { number }
        };
        let vector = |own: &[u8]| make(core::array::from_fn(|at| number(own, at)));
        let bytes = N * scalar.bytes();
        let mut all: Vec<T> = match accessor.buffer_view {
            Some(view) => self.elements_of(view, accessor.byte_offset, accessor.count, bytes)?.map(vector).collect(),
            // Zeros cost a file nothing: it must have as many bytes.
            None if accessor.count <= self.data.iter().map(Vec::len).sum() => vec![make([0.0; N]); accessor.count],
            None => return None,
        };
        if let Some(Sparse { count, indices, values }) = &accessor.sparse {
            let index = scalar_of_index(indices.component_type)?;
            let places = self.elements_of(indices.buffer_view, indices.byte_offset, *count, index.bytes())?;
            let values = self.elements_of(values.buffer_view, values.byte_offset, *count, bytes)?;
            for (place, own) in places.zip(values) {
                *all.get_mut(index.read(place, false)? as usize)? = vector(own);
            }
        }
        Some(all)
    }

    /// Points of an accessor, of real or of packed numbers.
    pub fn positions(&self, accessor: usize) -> Option<Vec<DVec3>> {
        self.vectors(accessor, "VEC3", DVec3::from_array)
    }

    /// From the places of a node's mesh to the node: one, or those of `EXT_mesh_gpu_instancing`.
    ///
    /// # Errors
    /// Places that the file does not hold.
    pub fn places(&self, node: &Node) -> Result<Vec<DMat4>, MapError> {
        let Some(Instances { attributes }) = &node.extensions.instances else { return Ok(vec![DMat4::IDENTITY]) };
        let missing = || MapError::new("the places of a mesh that stands in many are not all in the file");
        let is_many = |at: &usize| self.accessors.get(*at).is_some_and(|accessor| accessor.count > MOST_PLACES);
        if attributes.values().any(is_many) {
            let error = MapError::new(format!("a mesh stands in more than {MOST_PLACES} places"));
            return Err(error.hint("cut the scene into pieces"));
        }
        let shifts =
            attributes.get("TRANSLATION").map(|at| self.vectors(*at, "VEC3", DVec3::from_array).ok_or_else(missing));
        let turns =
            attributes.get("ROTATION").map(|at| self.vectors(*at, "VEC4", DQuat::from_array).ok_or_else(missing));
        let scales = attributes.get("SCALE").map(|at| self.vectors(*at, "VEC3", DVec3::from_array).ok_or_else(missing));
        let (shifts, turns, scales) = (shifts.transpose()?, turns.transpose()?, scales.transpose()?);
        let counts = [shifts.as_ref().map(Vec::len), turns.as_ref().map(Vec::len), scales.as_ref().map(Vec::len)];
        let count = counts.into_iter().flatten().min().unwrap_or(0);
        let place = |at: usize| {
            DMat4::from_scale_rotation_translation(
                scales.as_ref().map_or(DVec3::ONE, |all| all[at]),
                turns.as_ref().map_or(DQuat::IDENTITY, |all| all[at]),
                shifts.as_ref().map_or(DVec3::ZERO, |all| all[at]),
            )
        };
        Ok((0..count).map(place).collect())
    }

    /// Places of a shape's corners in a texture: from the left and from the top, 0 to 1 over the picture. None where the shape has none that can
    /// be read.
    pub fn texture_places(&self, shape: &Primitive, texture: &TextureUse) -> Option<Vec<[f32; 2]>> {
        let mut places = self.texture_coordinates(*shape.attributes.get(&format!("TEXCOORD_{}", texture.set()))?)?;
        places.iter_mut().for_each(|place| *place = texture.placed(*place));
        Some(places)
    }

    /// Texture coordinates of an accessor, of real or of packed numbers.
    fn texture_coordinates(&self, accessor: usize) -> Option<Vec<[f32; 2]>> {
        self.vectors(accessor, "VEC2", |place: [f64; 2]| place.map(|number| number as f32))
    }

    /// Colours of an accessor: linear red, green and blue.
    pub fn colours(&self, accessor: usize) -> Option<Vec<[f32; 3]>> {
        let linear = |[red, green, blue]: [f64; 3]| [red as f32, green as f32, blue as f32];
        let with_alpha = |[red, green, blue, _]: [f64; 4]| linear([red, green, blue]);
        self.vectors(accessor, "VEC3", linear).or_else(|| self.vectors(accessor, "VEC4", with_alpha))
    }

    /// Numbers of corners of an accessor.
    pub fn indices(&self, accessor: usize) -> Option<Vec<u32>> {
        let accessor = self.accessors.get(accessor)?;
        let scalar = scalar_of_index(accessor.component_type)?;
        let numbers = self.elements(accessor, scalar.bytes())?;
        numbers.map(|own| scalar.read(own, false).map(|number| number as u32)).collect()
    }
}
