//! Experts as recipes describe them, and the artifacts of stages as everybody reads and writes them.
//!
//! * [`artifacts`]: kinds of artifacts, each with its type, its format version and its blobs; [`codec`]: their encoding.
//! * [`expert`]: parameters of an expert; [`pictures`]: settings of pictures.
//! * [`map_files`]: towns read from map files; [`area_pictures`]: pictures of areas of people.
//! * [`plugins`]: plugins in recipes.
//! * [`world`]: the town of a task; [`published_towns`]: those of a dataset; [`memo`]: what is computed from one input for all tasks.
//! * [`render_files`]: models, meshes and splats that pictures show.

pub mod area_pictures;
pub mod artifacts;
pub mod codec;
pub mod expert;
pub mod map_files;
pub mod memo;
pub mod pictures;
pub mod plugins;
pub mod published_towns;
pub mod render_files;
pub mod world;

pub use artifacts::Kind;
pub use expert::RecipeExpert;
