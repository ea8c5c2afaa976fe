//! Files of meshes, told by their content.

use super::config::MeshPlace;
use super::textured::TexturedMesh;
use super::{gltf, obj};
use cosfly_scans::gltf::document::MAGIC;
use cosfly_scans::way_out::or_advice;
use cosfly_town::MapError;

/// The way out of a damaged file.
const WAY_OUT: &str = "the file seems to be damaged: export the mesh again";

/// A file that a mesh may name, by its name without folders.
pub type NamedFile = (String, Vec<u8>);

impl TexturedMesh {
    /// A file: a house, a tree and their ground, to try things out.
    pub const EXAMPLE: &[u8] = include_bytes!("example.glb");

    /// Reads a glTF, GLB or OBJ file, told by its content. `beside` are the files that it may name: materials and pictures of OBJ.
    /// No other file is opened, and no address is fetched.
    ///
    /// # Errors
    /// Other formats, damaged or cut files, named files that are not there, no triangle or more than 10 million.
    pub fn read(bytes: &[u8], beside: &[NamedFile], place: &MeshPlace) -> Result<Self, MapError> {
        let begin = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
        let is_text = begin.iter().find(|byte| !byte.is_ascii_whitespace()) == Some(&b'{');
        let read = if bytes.starts_with(MAGIC) || is_text {
            gltf::read(bytes, place)
        } else {
            obj::read(bytes, beside, place)
        };
        let mut mesh = or_advice(read, WAY_OUT)?;
        if mesh.triangles.is_empty() {
            let message =
                format!("no triangle of the mesh can be drawn ({} have no extent or lie far away)", mesh.left_out);
            let hint = "points and lines show nothing; check the unit and the place of the mesh";
            return Err(MapError::new(message).hint(hint));
        }
        mesh.add_copies();
        Ok(mesh)
    }
}

#[cfg(test)]
mod tests {
    use super::super::config::MeshConfig;
    use super::*;
    use cosfly_frames::DVec3;

    fn here() -> MeshPlace {
        MeshConfig::new("scan.glb").place(DVec3::ZERO).expect("a place")
    }

    #[test]
    fn a_binary_file_keeps_its_textures_colours_and_holes() {
        let mesh = TexturedMesh::read(TexturedMesh::EXAMPLE, &[], &here()).expect("a mesh");
        assert_eq!((mesh.format, mesh.textures.len()), ("glTF", 2));
        assert!(mesh.materials.iter().any(|it| it.least_alpha.is_some()));
        let [low, high] = mesh.bounds();
        assert!((high - low).abs_diff_eq(DVec3::new(40.0, 40.0, 6.0), 1e-3), "{low} {high}");
        assert!(mesh.triangles.iter().any(|it| it.colours != [[255; 3]; 3]));
    }

    #[test]
    fn damaged_files_are_refused_and_never_panic() {
        let example = TexturedMesh::EXAMPLE;
        for length in (0..example.len()).step_by(11) {
            let error = TexturedMesh::read(&example[..length], &[], &here()).expect_err("cut");
            assert!(!error.hints.is_empty(), "{length}: {error}");
        }
        let mut state = 1_u32;
        for _ in 0..1000 {
            let mut bytes = example.to_vec();
            for _ in 0..3 {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let at = (state >> 8) as usize % bytes.len();
                bytes[at] = (state >> 3) as u8;
            }
            drop(TexturedMesh::read(&bytes, &[], &here()));
        }
    }
}
