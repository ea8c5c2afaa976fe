//! [`Model`]: triangles of a glTF file with colours and textures, in the frame of a thing.

use crate::picture::MOST_PIXELS;
use crate::pictures;
use crate::texture::Texture;
use cosfly_frames::DVec3;
use cosfly_scans::gltf::document::{Document, MAGIC, Primitive};
use cosfly_scans::gltf::materials::{Material, TextureUse};
use cosfly_scans::gltf::{for_each_shape, triangles};
use cosfly_town::MapError;
use std::collections::BTreeMap;

/// Most triangles of a model: more of them do not show in pictures, and each is drawn for every thing of its kind.
const MOST_TRIANGLES: usize = 200_000;

/// A file's triangles in the frame of a thing: x forward, y right, z up, metres.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Triangles.
    pub triangles: Vec<ModelTriangle>,
    /// Pictures that triangles name.
    pub textures: Vec<Texture>,
    /// Lowest corner of all.
    pub low: DVec3,
    /// Highest corner of all.
    pub high: DVec3,
}

/// A triangle with its colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelTriangle {
    /// Corners.
    pub corners: [DVec3; 3],
    /// Places of the corners in the texture.
    pub texture_places: [[f32; 2]; 3],
    /// Number of the texture.
    pub texture: Option<u32>,
    /// Linear red, green, blue; the texture is multiplied by them.
    pub colour: [f32; 3],
}

impl Model {
    /// A file: a car of boxes with a texture of squares, to try things out.
    pub const EXAMPLE: &[u8] = include_bytes!("example.glb");

    /// Reads a file.
    ///
    /// # Errors
    /// No glTF 2.0, data in other files, damaged pictures, no triangle or more than 200,000.
    pub fn read(bytes: &[u8]) -> Result<Self, MapError> {
        if !bytes.starts_with(MAGIC) && bytes.iter().find(|byte| !byte.is_ascii_whitespace()) != Some(&b'{') {
            return Err(MapError::new("the file is no glTF file").hint("export the model as GLB"));
        }
        let document = Document::read(bytes)?;
        let mut reader = Reader::new(&document);
        for_each_shape(&document, &mut |_, matrix, shape| {
            // glTF: y up, z forward, right-handed; things: x forward, y right, z up.
            let in_thing = |point: DVec3| {
                let own = matrix.transform_point3(point);
                DVec3::new(own.z, -own.x, own.y)
            };
            reader.add(shape, &in_thing)
        })?;
        let Reader { triangles, textures, .. } = reader;
        let corners = || triangles.iter().flat_map(|triangle| triangle.corners);
        let low = corners().fold(DVec3::INFINITY, DVec3::min);
        let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
        if triangles.is_empty() {
            let error = MapError::new("the model has no triangle that can be drawn");
            return Err(error.hint("points, lines and meshes without extent show nothing"));
        }
        Ok(Self { triangles, textures, low, high })
    }
}

/// Most corners and indices that are read, triangles or not.
const MOST_ELEMENTS: usize = 20_000_000;

struct Reader<'a> {
    document: &'a Document,
    /// Corners and indices, and pixels, that may still be read.
    left: [usize; 2],
    /// Numbers of textures by those of pictures.
    pictures: BTreeMap<usize, u32>,
    triangles: Vec<ModelTriangle>,
    textures: Vec<Texture>,
}

impl<'a> Reader<'a> {
    fn new(document: &'a Document) -> Self {
        let left = [MOST_ELEMENTS, MOST_PIXELS];
        Self { document, left, pictures: BTreeMap::new(), triangles: vec![], textures: vec![] }
    }

    fn add(&mut self, shape: &Primitive, in_thing: &dyn Fn(DVec3) -> DVec3) -> Result<(), MapError> {
        let elements = self.document.elements_of_shape(shape);
        self.left[0] = self.left[0].checked_sub(elements).ok_or_else(|| {
            let error = MapError::new(format!("the model has more than {MOST_ELEMENTS} corners"));
            error.hint("export it with less detail: a few thousand triangles suffice")
        })?;
        let Some((points, corners)) = triangles(self.document, shape) else {
            // Points and lines have nothing to draw; a surface that cannot be read must not be missing unnoticed.
            if !(4..=6).contains(&shape.mode.unwrap_or(4)) {
                return Ok(());
            }
            let error = MapError::new("a mesh of the model cannot be read");
            return Err(error.hint("export it again without sparse data, as one whole file"));
        };
        if self.triangles.len() + corners.len() > MOST_TRIANGLES {
            let error = MapError::new(format!("the model has more than {MOST_TRIANGLES} triangles"));
            return Err(error.hint("export it with less detail: a few thousand triangles suffice"));
        }
        let points: Vec<DVec3> = points.into_iter().map(in_thing).collect();
        let of_file = shape.material.and_then(|number| self.document.material(number));
        let ([red, green, blue, _], of_file) = of_file.map_or(([1.0; 4], None), Material::base);
        let colour = [red, green, blue];
        let (texture, places) = match of_file {
            Some(texture) => self.texture_of(texture, shape)?,
            None => (None, vec![]),
        };
        for three in corners {
            let corner = |k: usize| points.get(three[k] as usize).copied();
            let (Some(a), Some(b), Some(c)) = (corner(0), corner(1), corner(2)) else { continue };
            let corners = [a, b, c];
            let is_flat = (b - a).cross(c - a).length() < 1e-12;
            if is_flat || corners.iter().any(|corner| !corner.is_finite() || corner.abs().max_element() > 1e6) {
                continue;
            }
            let texture_places = three.map(|at| places.get(at as usize).copied().unwrap_or_default());
            self.triangles.push(ModelTriangle { corners, texture_places, texture, colour });
        }
        Ok(())
    }

    /// The number of a texture, and the places of all points in it.
    fn texture_of(
        &mut self,
        texture: &TextureUse,
        shape: &Primitive,
    ) -> Result<(Option<u32>, Vec<[f32; 2]>), MapError> {
        let document = self.document;
        let Ok((picture, _)) = document.picture_of(texture.index) else { return Ok((None, vec![])) };
        let Some(places) = document.texture_places(shape, texture) else { return Ok((None, vec![])) };
        if let Some(known) = self.pictures.get(&picture) {
            return Ok((Some(*known), places));
        }
        let read = pictures::read(&document.picture(picture)?, picture, &mut self.left[1])?;
        let number = self.textures.len() as u32;
        self.textures.push(Texture::new(&read));
        self.pictures.insert(picture, number);
        Ok((Some(number), places))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The example with the first `from` in its text replaced by as many bytes.
    fn changed(from: &str, to: &str) -> Vec<u8> {
        assert_eq!(from.len(), to.len());
        let at = Model::EXAMPLE.windows(from.len()).position(|it| it == from.as_bytes()).expect("part of the text");
        let mut bytes = Model::EXAMPLE.to_vec();
        bytes[at..at + to.len()].copy_from_slice(to.as_bytes());
        bytes
    }

    #[test]
    fn models_look_forward_and_keep_their_sizes() {
        let model = Model::read(Model::EXAMPLE).expect("a model");
        assert_eq!((model.triangles.len(), model.textures.len()), (72, 1));
        let size = model.high - model.low;
        assert!((size - DVec3::new(4.4, 1.8, 1.45)).length() < 1e-6, "{size}");
        // The cabin, the highest part, is nearer to the back.
        let top = model.triangles.iter().flat_map(|it| it.corners).filter(|corner| corner.z > 1.4);
        assert!(top.map(|corner| corner.x).fold(f64::INFINITY, f64::min) < -1.4);
    }

    #[test]
    fn damaged_files_are_refused_or_lose_their_texture_and_never_panic() {
        for length in (0..Model::EXAMPLE.len()).step_by(7) {
            assert!(Model::read(&Model::EXAMPLE[..length]).is_err(), "{length}");
        }
        let refused = |bytes: &[u8]| Model::read(bytes).expect_err("refused").message;
        assert!(refused(b"solid model").contains("no glTF"));
        assert!(refused(&changed("\"bufferView\": 2", "\"bufferView\": 7")).contains("picture 0"));
        assert!(refused(&changed("\"POSITION\"", "\"POSITIOn\"")).contains("a mesh of the model"));
        // A texture that the file does not have leaves the plain colour.
        let plain = Model::read(&changed("\"source\": 0", "\"sourcE\": 0")).expect("a model");
        assert!(plain.textures.is_empty() && plain.triangles.iter().all(|it| it.texture.is_none()));
        let mut state = 1u32;
        for _ in 0..2000 {
            let mut bytes = Model::EXAMPLE.to_vec();
            for _ in 0..3 {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let at = (state >> 8) as usize % bytes.len();
                bytes[at] = (state >> 3) as u8;
            }
            drop(Model::read(&bytes));
        }
    }
}
