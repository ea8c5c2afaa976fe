//! Textured meshes: scanned places as triangles with textures and colours of their own, in the world of a town.
//!
//! [`TexturedMesh`] is a file where [`MeshConfig`] puts it, [`MeshSurvey`] its figures. Readers: glTF, and OBJ with its materials.

mod builder;
mod config;
mod gltf;
mod materials;
mod obj;
mod order;
mod read;
mod survey;
mod texture;
mod textured;
mod used_texels;

pub use config::{MeshConfig, MeshLight, MeshPlace, MeshProblem};
pub use materials::{beside, name_of, named_files};
pub use read::NamedFile;
pub use survey::MeshSurvey;
pub use texture::MeshTexture;
pub use textured::{MeshMaterial, MeshTriangle, TexturedMesh};
