//! A tree of sixteen children over boxes, in f32 about a local origin; each query is a file.
//!
//! The tree never answers by itself. For each query it tells which boxes are met beyond doubt, which are missed beyond
//! doubt, and which need exact arithmetic. Its margin, [`tree::WideTree::margin`], covers every rounding.

pub mod build;
pub mod closest;
pub mod near;
pub mod ray;
pub mod shaft;
pub mod tree;
pub mod turned;
pub mod turned_lanes;
