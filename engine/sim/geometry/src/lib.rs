//! Rays, nearest obstacles and swept spheres against solid boxes and triangles.
//!
//! * [`BoxBvh`] holds boxes rotated around z, [`TriangleBvh`] two-sided triangles; both answer a [`SpatialQuery`].
//! * [`BruteForce`] and [`TriangleBruteForce`] give the same answers without a tree, for tests.
//! * [`ShapeBvh`] holds any [`Shape`]; [`Bvh`] is the bare tree of [`Bounds`], for queries of your own.
//!
//! Points are in the world frame, metres. Answers are the same bits on every processor. No call fails: a primitive with a number that is
//! not finite is never hit, and a segment with one is blocked.
//!
//! ```
//! use cosfly_domain::OrientedBox;
//! use cosfly_frames::DVec3;
//! use cosfly_geometry::{BoxBvh, SpatialQuery};
//!
//! let house = OrientedBox {
//!     center_in_world: DVec3::new(10.0, 0.0, 5.0),
//!     half_extents_m: DVec3::new(2.0, 3.0, 5.0),
//!     yaw_rad: 0.0,
//! };
//! let map = BoxBvh::build(vec![house]);
//! let hit = map.closest_hit(DVec3::new(0.0, 0.0, 2.0), DVec3::X, 50.0).expect("the house is ahead");
//! assert_eq!((hit.primitive, hit.t), (0, 8.0));
//! assert!(map.blocked(DVec3::new(0.0, 0.0, 2.0), DVec3::new(20.0, 0.0, 2.0)));
//! assert_eq!(map.nearest(DVec3::new(7.0, 0.0, 2.0), 5.0).map(|near| near.distance_m), Some(1.0));
//! ```

mod bounds;
mod box_bvh;
mod brute_force;
mod bvh;
mod lanes;
mod query;
mod shape;
mod shape_bvh;
mod triangle;
mod turned_box;
mod wide;

pub use bounds::Bounds;
pub use box_bvh::BoxBvh;
pub use brute_force::{BruteForce, ShapeBruteForce, TriangleBruteForce};
pub use bvh::{Bvh, Visitor};
pub use query::{Hit, Nearest, SpatialQuery};
pub use shape::Shape;
pub use shape_bvh::{ShapeBvh, TriangleBvh};
pub use triangle::Triangle;
pub use turned_box::TurnedBox;
