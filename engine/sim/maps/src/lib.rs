//! The [`Town`] model (obstacles, walkable areas, surfaces, semantics), its readers and its generator.

pub mod fill;
pub mod semantics;
pub mod simplify;
pub mod town;

pub use semantics::SemanticLabel;
pub use town::{
    MapOrigin, Obstacle, ObstacleKind, SimplificationReport, SurfaceMesh, Synthetic, Town, WalkableKind,
    WalkablePolygon,
};
