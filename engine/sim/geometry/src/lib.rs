//! Boxes, triangles, BVHs, and the interface of all geometric queries: [`SpatialQuery`].

pub mod bounds;
pub mod box_bvh;
pub mod brute_force;
pub mod bvh;
mod lanes;
pub mod query;
pub mod shape;
pub mod shape_bvh;
pub mod triangle;
pub mod turned_box;
mod wide;

pub use bounds::Bounds;
pub use box_bvh::BoxBvh;
pub use brute_force::{BruteForce, ShapeBruteForce, TriangleBruteForce};
pub use query::{Hit, Nearest, SpatialQuery};
pub use shape_bvh::{ShapeBvh, TriangleBvh};
pub use triangle::Triangle;
pub use turned_box::TurnedBox;
