//! Lens, shutter and sensor of a camera, on finished pictures: point spread, sharpening, exposure, white balance, bloom, motion blur,
//! a rolling shutter, noise. Nothing here knows a town.

mod bloom;
mod motion_blur;
mod noise;
mod optics;
mod point_spread;
mod readout;
mod settings;
mod stereo;

pub use motion_blur::{Exposure, pose_at, target_state_at};
pub use noise::add_noise;
pub use optics::{Glass, exposure, gains};
pub use readout::{READOUT_KEYS, ReadoutStrips, margins_px};
pub use settings::{OpticsConfig, OpticsPreset, of_mean_drone};
pub use stereo::{STEPS as STEREO_STEPS, StereoMatcher};
