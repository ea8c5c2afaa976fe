//! Boxes, triangles, BVH, and the one query seam everything else asks: [`SpatialQuery`].

pub mod oriented_box;
pub mod query;

pub use oriented_box::OrientedBox;
pub use query::{Hit, Nearest, SpatialQuery};
