//! Models that people bring along: triangles with textures from glTF files, instead of the boxes of a town's things.
//!
//! [`Model`] is a file in its own frame, [`ModelConfig`] a line of a recipe, [`place`] puts a model where a thing stands.
//! [`mesh`] has whole places: scans with the light that they were taken in.

mod config;
mod ktx2;
pub mod mesh;
mod model;
mod picture;
mod pictures;
mod place;
mod texture;

pub use config::{ModelConfig, ModelFit, ModelKind};
pub use model::{Model, ModelTriangle};
pub use place::{Stand, place, stands};
pub use texture::Texture;
