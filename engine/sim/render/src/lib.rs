//! The CPU renderer: RGB, planar depth, semantic and instance ids from one visibility pass.

pub mod camera;
pub mod frame;
pub mod weather;

pub use camera::Camera;
pub use frame::{FrameImages, PixelBox, TargetView};
pub use weather::Weather;
