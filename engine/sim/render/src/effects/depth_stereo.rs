//! Depth that a stereo pair measures: a matcher compares the pictures of its two cameras, version 1.
//!
//! Both pictures have blur, a rolling shutter and noise, as finished ones have; none has been compressed.

use cosfly_domain::channels::depth_stereo;
use cosfly_domain::{Camera, FrameImages, StereoEye};
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec3, Pose};
use cosfly_optics::{STEREO_STEPS, StereoMatcher};

/// Nearest depth that is measured, metres, where the matcher's largest disparity does not end before.
const NEAREST_M: f64 = 0.5;

/// One camera of a pair with the other one's picture, and what compares the two.
pub(super) struct PairMatcher {
    eye: StereoEye,
    /// Focal length x base line, pixels x metres.
    scale: f64,
    /// Colours of the other camera's picture.
    pub(super) other_rgb: Vec<u8>,
    matcher: StereoMatcher,
}

impl PairMatcher {
    pub(super) fn new(eye: StereoEye, camera: &Camera) -> Self {
        let scale = camera.focal_px() * eye.base_line_m;
        let largest_px = (scale / NEAREST_M).min(f64::from(camera.width)) as usize;
        Self { eye, scale, other_rgb: vec![], matcher: StereoMatcher::new(camera.width as usize, largest_px) }
    }

    /// Pose of the other camera beside this one.
    pub(super) fn other_pose(&self, pose: &Pose) -> Pose {
        let right_m = if self.eye.is_right { -self.eye.base_line_m } else { self.eye.base_line_m };
        let aside = pose.world_from_body() * DVec3::new(0.0, right_m, 0.0);
        Pose { position_in_world: pose.position_in_world + aside, ..*pose }
    }

    /// Fills the channel from the finished colours of both cameras.
    pub(super) fn draw(&mut self, images: &mut FrameImages) {
        let FrameImages { rgb, on_request, .. } = images;
        let Some(image) = on_request.iter_mut().find(|image| *image.channel == depth_stereo::CHANNEL) else { return };
        let found = self.matcher.matched(Level::best(), [rgb, &self.other_rgb], self.eye.is_right);
        for (pixel, steps) in image.bytes.as_chunks_mut::<4>().0.iter_mut().zip(found) {
            let depth_m = self.scale * f64::from(STEREO_STEPS) / f64::from(*steps);
            let is_measured = *steps > 0 && depth_m >= NEAREST_M;
            *pixel = if is_measured { depth_m as f32 } else { f32::NAN }.to_le_bytes();
        }
    }
}
