//! [`Builder`]: a mesh as its reader makes it, within bounds.

use super::config::MeshPlace;
use super::texture::MeshTexture;
use super::textured::{MeshMaterial, MeshTriangle, TexturedMesh};
use crate::picture::{MOST_PIXELS as OF_MODEL, Picture};
use crate::pictures;
use cosfly_frames::DVec3;
use cosfly_scans::gltf::materials::TextureWrap;
use cosfly_town::MapError;

/// Most triangles of a mesh.
const MOST_TRIANGLES: usize = 10_000_000;
/// Most corners and indices that are read, in triangles or not.
const MOST_ELEMENTS: usize = 100_000_000;
/// Most pixels of all pictures of a mesh.
const MOST_PIXELS: usize = 4 * OF_MODEL;
/// Farthest coordinate in the world, metres.
const FARTHEST_M: f64 = 20_000.0;

/// Takes triangles and pictures within the bounds of a mesh.
pub(super) struct Builder<'a> {
    pub mesh: TexturedMesh,
    place: &'a MeshPlace,
    elements_left: usize,
    pixels_left: usize,
}

impl<'a> Builder<'a> {
    pub fn new(format: &'static str, place: &'a MeshPlace) -> Self {
        let mesh = TexturedMesh { format, ..TexturedMesh::default() };
        Self { mesh, place, elements_left: MOST_ELEMENTS, pixels_left: MOST_PIXELS }
    }

    /// Refuses more corners and indices than a mesh may have, before they are read.
    pub fn count(&mut self, elements: usize) -> Result<(), MapError> {
        self.elements_left = self.elements_left.checked_sub(elements).ok_or_else(|| {
            let error = MapError::new(format!("the mesh has more than {MOST_ELEMENTS} corners"));
            error.hint("cut the scene into pieces, or simplify it")
        })?;
        Ok(())
    }

    /// Adds a triangle by its corners in the file.
    pub fn push(&mut self, corners: [DVec3; 3], look: MeshTriangle) -> Result<(), MapError> {
        let corners = corners.map(|corner| self.place.in_world(corner));
        let [a, b, c] = corners;
        let has_extent = (b - a).cross(c - a).length_squared() > 1e-16;
        if !has_extent || !corners.iter().all(|corner| corner.abs().cmple(DVec3::splat(FARTHEST_M)).all()) {
            self.mesh.left_out += 1;
            return Ok(());
        }
        if self.mesh.triangles.len() == MOST_TRIANGLES {
            let error = MapError::new(format!("the mesh has more than {MOST_TRIANGLES} triangles"));
            return Err(error.hint("cut the scene into pieces, or simplify it"));
        }
        let corners_in_world = corners.map(|corner| corner.as_vec3().to_array());
        self.mesh.triangles.push(MeshTriangle { corners_in_world, ..look });
        Ok(())
    }

    /// Number of a new material.
    pub fn material(&mut self, material: MeshMaterial) -> u32 {
        self.mesh.materials.push(material);
        (self.mesh.materials.len() - 1) as u32
    }

    /// Number of a new picture.
    pub fn texture(&mut self, bytes: &[u8], shown: &str, wraps: [TextureWrap; 2]) -> Result<u32, MapError> {
        let picture: Picture = pictures::read_named(bytes, shown, &mut self.pixels_left)?;
        self.mesh.textures.push(MeshTexture::new(picture, wraps));
        Ok((self.mesh.textures.len() - 1) as u32)
    }
}
