//! A wide BVH (sixteen children) over boxes, in f32 relative to a local origin; one file per query.
//!
//! The tree never determines an answer. For each query it classifies boxes as certainly hit, certainly missed, or in
//! need of exact arithmetic. Its margin, [`tree::WideTree::margin`], covers every rounding.

pub mod build;
pub mod closest;
pub mod near;
pub mod ray;
pub mod shaft;
pub mod tree;
pub mod turned;
pub mod turned_lanes;
