//! Towns as textured meshes and as Gaussian splats: scans whose truth is known.
//!
//! [`bake`] photographs every face of a town from straight above it, in the light of one weather. [`BakedTown::to_glb`] writes the
//! faces with these pictures as textures, [`BakedTown::splats`] one flat splat for each pixel that can be seen.

mod atlas;
mod bake;
mod glb;
mod painter;
mod patch;
mod splats;
mod words;

pub use bake::{BakeProblem, BakedTown, MOST_TEXELS, bake};
