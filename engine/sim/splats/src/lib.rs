//! Gaussian splats: scans made of coloured ellipsoids that are blended, and pictures of them on the processor.
//!
//! * [`read()`]: files of other programs, `.ply`, `.splat` and `.spz`, as a [`SplatCloud`] in the file's own frame.
//! * [`SplatsConfig`] and [`Placement`]: where the file's frame lies in the world.
//! * [`SplatRenderer`]: colour, transmittance and depth of a cloud (Kerbl et al. 2023, 3D Gaussian Splatting), the same bytes for
//!   any number of threads and any vector instructions; opacities of small splats as in Yu et al. 2024, Mip-Splatting.
//! * [`exact`]: the same equations pixel by pixel in double precision, to compare with.

mod band;
mod block;
mod cloud;
mod error;
pub mod exact;
mod exponential;
mod footprint;
mod harmonics;
mod order;
mod placement;
mod project;
mod read;
mod renderer;
mod splat;
mod tile;
mod view;
mod write;

pub use cloud::SplatCloud;
pub use error::SplatError;
pub use placement::{ControlPoint, Placement, SplatsConfig, SplatsProblem};
pub use read::{MOST_SPLATS, SplatFile, read};
pub use renderer::{SplatPicture, SplatRenderer};
pub use splat::{MOST_COEFFICIENTS, Splat};
pub use view::SplatView;
pub use write::to_ply;
