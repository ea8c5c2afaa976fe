//! The [`cosfly_domain::Town`] model (obstacles, walkable ground, lanes, surfaces, labels), the seam of map formats, and what their readers
//! share: the world frame, text with places, covers of footprints, ground meshes, land around them, planning boxes.

pub mod census;
pub mod cover;
pub mod crown;
pub mod error;
pub mod format;
pub mod ground;
pub mod lanes;
pub mod mesh;
pub mod open_ground;
pub mod options;
pub mod polygons;
pub mod regions;
pub mod remarks;
pub mod rules;
pub mod simplify;
pub mod solids;
pub mod terrain;
pub mod text;
pub mod units;
pub mod world;

pub use error::{MapError, TextPlace};
pub use format::{Format, MapFormat};
pub use ground::{GroundIndex, GroundPoint};
pub use options::FormatOptions;
pub use rules::assert_well_formed;
