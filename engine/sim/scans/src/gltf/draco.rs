//! Shapes that Draco packed (`KHR_draco_mesh_compression`), as plain accessors of a further buffer.

use super::document::Document;
use super::views::{Accessor, Packed, REAL, View, is_read};
use cosfly_diagnose::contained;
use cosfly_town::MapError;
use draco_core::{DecodeLimits, DecoderBuffer, Mesh, MeshDecoder};

/// Most triangles of all packed shapes of a file, and most bytes of all that they hold: a few bytes may say that they are millions.
const MOST_TRIANGLES: u64 = 10_000_000;
const MOST_BYTES: u64 = 1 << 30;
/// Numbers of 32 bits without a sign.
const INDEX: u32 = 5125;
const HINT: &str = "`gltf-transform cp FILE plain.glb` unpacks shapes, or export the file without compression";

impl Document {
    /// Unpacks all packed shapes.
    pub(super) fn unpack(&mut self) -> Result<(), MapError> {
        let mut meshes = std::mem::take(&mut self.meshes);
        let mut left = DecodeLimits::default().with_max_faces(MOST_TRIANGLES).with_max_decoded_bytes(MOST_BYTES);
        for shape in meshes.iter_mut().flat_map(|mesh| &mut mesh.primitives) {
            let Some(packed) = shape.extensions.draco.take() else { continue };
            let mesh = self.unpacked(&packed, left)?;
            let indices: Vec<u8> = mesh.faces().iter().flatten().flat_map(|corner| corner.0.to_le_bytes()).collect();
            let mut bytes = indices.len() as u64;
            left = left.with_max_faces(left.max_faces - (mesh.num_faces() as u64).min(left.max_faces));
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
                bytes += values.len() as u64;
                *number = self.further(values, mesh.num_points(), REAL, &kind);
            }
            let rest = left.max_decoded_bytes.checked_sub(bytes);
            left = left.with_max_decoded_bytes(rest.ok_or_else(|| damaged("all of them together are too large"))?);
        }
        self.meshes = meshes;
        Ok(())
    }

    fn unpacked(&self, packed: &Packed, most: DecodeLimits) -> Result<Mesh, MapError> {
        let view = self.buffer_views.get(packed.buffer_view).and_then(|view| self.viewed(view));
        let bytes = view.ok_or_else(|| damaged("its bytes are not in the file"))?;
        let decoded = contained(|| {
            let mut mesh = Mesh::new();
            MeshDecoder::new().decode(&mut DecoderBuffer::new(bytes).with_limits(most), &mut mesh).map(|()| mesh)
        });
        let mesh = decoded
            .unwrap_or_else(|| Err(draco_core::DracoError::general("it holds what no encoder writes".to_owned())));
        mesh.map_err(|error| damaged(&error.to_string()))
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

fn damaged(why: &str) -> MapError {
    MapError::new(format!("a shape that Draco packed cannot be unpacked: {why}")).hint(HINT)
}
