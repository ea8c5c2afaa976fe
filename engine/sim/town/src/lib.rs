//! The [`Town`] model (obstacles, walkable ground, lanes, surfaces, labels), the seam of map formats, and what their readers
//! share: the world frame, text with places, covers of footprints, ground meshes, land around them, planning boxes.

pub mod census;
pub mod cover;
pub mod crown;
pub mod error;
pub mod format;
pub mod ground;
mod lane;
mod lanes;
pub mod mesh;
pub mod open_ground;
pub mod options;
pub mod polygons;
pub mod regions;
pub mod remarks;
pub mod semantics;
pub mod simplify;
pub mod solids;
pub mod terrain;
pub mod text;
pub mod town;
pub mod units;
pub mod world;

pub use error::{MapError, Place};
pub use format::{Format, MapFormat};
pub use ground::{GroundIndex, GroundPoint};
pub use lane::{Lane, LaneKind};
pub use options::FormatOptions;
pub use semantics::SemanticLabel;
pub use town::{
    MapOrigin, Obstacle, ObstacleKind, SimplificationReport, SurfaceMesh, Synthetic, Town, WalkableKind,
    WalkablePolygon,
};
