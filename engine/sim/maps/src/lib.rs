//! The [`Town`] model (obstacles, walkable areas, surfaces, semantics), its readers and its generator.

pub mod config;
pub mod cover;
pub mod crown;
pub mod error;
pub mod fill;
pub mod formats;
pub mod generate;
pub mod ground;
pub mod options;
pub mod polygons;
pub mod read;
pub mod semantics;
pub mod simplify;
pub mod town;

pub use config::MapConfig;
pub use error::{MapError, Place};
pub use formats::{FORMATS, Format, MapFormat};
pub use ground::{GroundIndex, GroundPoint};
pub use options::FormatOptions;
pub use read::{read_town, recognise};
pub use semantics::SemanticLabel;
pub use town::{
    MapOrigin, Obstacle, ObstacleKind, SimplificationReport, SurfaceMesh, Synthetic, Town, WalkableKind,
    WalkablePolygon,
};
