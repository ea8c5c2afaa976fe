//! Shapes that Draco packed (`KHR_draco_mesh_compression`), as plain accessors of a further buffer.

use super::document::Document;
use super::views::{Accessor, REAL, View, is_read};
use cosfly_diagnose::contained;
use cosfly_town::MapError;
use draco_core::{DecodeLimits, DecoderBuffer, Mesh, MeshDecoder};

/// Bytes of a triangle's corners, and those that each layer of seams takes for it meanwhile.
const CORNER_BYTES: u64 = 12;
const LAYER_BYTES: u64 = 24;
/// Most layers of seams that a shape can have, and one for the shape itself.
const MOST_LAYERS: u64 = 256;
/// Numbers of 32 bits without a sign.
const INDEX: u32 = 5125;
const HINT: &str = "`gltf-transform cp FILE plain.glb` unpacks shapes, or export the file without compression";

impl Document {
    /// Unpacks all packed shapes, into no more bytes than are left.
    pub(super) fn unpack(&mut self, mut left: u64) -> Result<(), MapError> {
        let mut meshes = std::mem::take(&mut self.meshes);
        for shape in meshes.iter_mut().flat_map(|mesh| &mut mesh.primitives) {
            let Some(packed) = shape.extensions.draco.take() else { continue };
            let view = self.buffer_views.get(packed.buffer_view).and_then(|view| self.viewed(view));
            let bytes = view.ok_or_else(|| damaged("its bytes are not in the file"))?;
            let of_triangle = CORNER_BYTES + LAYER_BYTES * layers(bytes).unwrap_or(MOST_LAYERS);
            let mesh = unpacked(bytes, left, of_triangle)?;
            let of_point = |number| mesh.attribute(number).byte_stride().unsigned_abs();
            let of_points = (0..mesh.num_attributes()).map(of_point).sum::<u64>() * mesh.num_points() as u64;
            left = left.saturating_sub(of_points + of_triangle * mesh.num_faces() as u64);
            let indices: Vec<u8> = mesh.faces().iter().flatten().flat_map(|corner| corner.0.to_le_bytes()).collect();
            shape.indices = Some(self.further(indices, 3 * mesh.num_faces(), INDEX, "SCALAR"));
            shape.mode = Some(4);
            for (name, number) in shape.attributes.iter_mut().filter(|(name, _)| is_read(name)) {
                let (Some(own), Some(accessor)) = (packed.attributes.get(name), self.accessors.get(*number)) else {
                    continue;
                };
                let (kind, most) = (accessor.kind.clone(), accessor.greatest() as f32);
                let width = match kind.as_str() {
                    "VEC2" => 2,
                    "VEC3" => 3,
                    "VEC4" => 4,
                    _ => continue,
                };
                let values = mesh.attribute_by_unique_id(*own).map(|own| own.read_f32s(mesh.num_points(), width));
                let values = values.ok_or_else(|| damaged("an attribute is not in it"))?;
                let values: Vec<u8> = values.into_iter().flat_map(|value| (value / most).to_le_bytes()).collect();
                *number = self.further(values, mesh.num_points(), REAL, &kind);
            }
        }
        self.meshes = meshes;
        Ok(())
    }

    /// The number of a new accessor of these bytes.
    fn further(&mut self, data: Vec<u8>, count: usize, component_type: u32, kind: &str) -> usize {
        let view = View { buffer: self.data.len(), byte_length: data.len(), ..View::default() };
        let buffer_view = Some(self.buffer_views.len());
        self.data.push(data);
        self.buffer_views.push(view);
        self.accessors.push(Accessor {
            buffer_view,
            component_type,
            count,
            kind: kind.to_owned(),
            ..Accessor::default()
        });
        self.accessors.len() - 1
    }
}

/// A shape that takes no more bytes than are left.
fn unpacked(bytes: &[u8], left: u64, of_triangle: u64) -> Result<Mesh, MapError> {
    let most = DecodeLimits::default().with_max_faces(left / of_triangle).with_max_decoded_bytes(left);
    let decoded = contained(|| {
        let mut mesh = Mesh::new();
        MeshDecoder::new().decode(&mut DecoderBuffer::new(bytes).with_limits(most), &mut mesh).map(|()| mesh)
    });
    let mesh =
        decoded.unwrap_or_else(|| Err(draco_core::DracoError::general("it holds what no encoder writes".to_owned())));
    mesh.map_err(|error| damaged(&error.to_string()))
}

/// Layers of seams of a shape and one for itself, by its head: magic, version, kind, method, flags, way, two counts, layers.
/// None where other data (`metadata`, which no exporter of glTF writes) stand before the counts.
fn layers(bytes: &[u8]) -> Option<u64> {
    let (head, mut rest) = bytes.split_at_checked(12)?;
    if head[8] == 0 {
        return Some(1);
    }
    if head[10] & 0x80 != 0 {
        return None;
    }
    for _ in 0..2 {
        let length = 1 + rest.iter().position(|byte| byte & 0x80 == 0)?;
        rest = &rest[length..];
    }
    rest.first().map(|layers| 1 + u64::from(*layers))
}

fn damaged(why: &str) -> MapError {
    MapError::new(format!("a shape that Draco packed cannot be unpacked: {why}")).hint(HINT)
}
