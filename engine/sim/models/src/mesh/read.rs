//! Files of meshes, told by their content.

use super::config::MeshPlace;
use super::textured::TexturedMesh;
use super::{gltf, obj};
use cosfly_scans::gltf::document::MAGIC;
use cosfly_scans::way_out::or_advice;
use cosfly_town::MapError;

/// The way out of a damaged file.
const WAY_OUT: &str = "the file seems to be damaged: export the mesh again";

/// A file that a mesh may name, by its name; by a path of as many folders as tell it from others of its name.
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
    use cosfly_scans::tiles::{TilesChoice, join};

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

    /// The example as others export it: packed by gltfpack 1.3 (`-c`; `-cc -ce khr -vpf`), with pictures in WebP and in KTX2.
    const PACKED: [&[u8]; 2] = [include_bytes!("packed/ext_webp.glb"), include_bytes!("packed/khr_ktx2.glb")];

    #[test]
    fn packed_files_show_what_the_plain_one_does() {
        let plain = TexturedMesh::read(TexturedMesh::EXAMPLE, &[], &here()).expect("a mesh");
        let seen = |mesh: &TexturedMesh, at: usize| {
            let own = &mesh.triangles[at];
            let middle = |axis: usize| own.corners_in_world.iter().map(|corner| corner[axis]).sum::<f32>() / 3.0;
            // Averaged over the whole picture: a place of it may be at the edge of two bricks.
            let look = mesh.look_at(own, [1.0 / 3.0; 3], [[8.0, 0.0], [0.0, 8.0]]);
            ([0, 1, 2].map(middle), look)
        };
        for packed in PACKED {
            let mesh = TexturedMesh::read(packed, &[], &here()).expect("a mesh");
            assert_eq!((mesh.triangles.len(), mesh.textures.len()), (plain.triangles.len(), 2));
            assert!(mesh.remarks.is_empty(), "{:?}", mesh.remarks);
            for at in 0..plain.triangles.len() {
                let (middle, look) = seen(&plain, at);
                let is_same = |other: usize| {
                    let (own, its) = seen(&mesh, other);
                    (0..3).all(|axis| (own[axis] - middle[axis]).abs() < 0.01)
                        && (0..4).all(|k| (its[k] - look[k]).abs() < 0.06)
                };
                assert!((0..mesh.triangles.len()).any(is_same), "{middle:?} {look:?}");
            }
        }
    }

    #[test]
    fn packed_tiles_that_are_joined_stay_packed_and_are_read() {
        let tileset =
            r#"{"asset":{"version":"1.1"},"root":{"geometricError":0,"contents":[{"uri":"0.glb"},{"uri":"1.glb"}]}}"#;
        let mut open = |path: &str| {
            Ok(match path {
                "0.glb" => PACKED[0],
                "1.glb" => PACKED[1],
                _ => tileset.as_bytes(),
            }
            .to_vec())
        };
        let joined = join("tileset.json", &TilesChoice::default(), &mut open).expect("a file");
        assert!(joined.glb.len() < 2 * (PACKED[0].len() + PACKED[1].len()), "{}", joined.glb.len());
        let mesh = TexturedMesh::read(&joined.glb, &[], &here()).expect("a mesh");
        assert_eq!((mesh.triangles.len(), mesh.textures.len(), mesh.left_out), (104, 4, 0));
    }

    #[test]
    fn damaged_files_are_refused_and_never_panic() {
        PACKED.into_iter().for_each(check_damaged);
        check_damaged(TexturedMesh::EXAMPLE);
    }

    fn check_damaged(example: &[u8]) {
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
