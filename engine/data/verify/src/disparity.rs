//! Disparity of a stereo pair against the depth of the same picture and the base line.

use super::rows::PlacedFlight;
use cosfly_domain::Channel;
use cosfly_domain::channels::disparity;

/// Every so many pixels are compared.
const EVERY: usize = 61;
/// Half the step of the stored depths, and what 32 bits round, metres and a share.
const DEPTH_STEP_M: f64 = 5e-4;
const SHARE: f64 = 1e-6;

/// Depths of some pixels of a frame of a stereo pair.
#[derive(Default)]
pub struct KnownDepths {
    frame: usize,
    /// Pixel and depth, metres.
    depths: Vec<(usize, f64)>,
}

impl KnownDepths {
    /// The depths of a frame; none of a single camera.
    pub fn of(flight: &PlacedFlight, frame: usize, depths: &[u8]) -> Self {
        let depths = depths.as_chunks::<4>().0.iter().map(|four| f64::from(f32::from_le_bytes(*four)));
        let known = depths.enumerate().step_by(EVERY).filter(|_| flight.base_line_m.is_some());
        Self { frame, depths: known.collect() }
    }

    /// What is wrong with the disparities of a frame.
    pub fn finding(&self, flight: &PlacedFlight, (frame, channel): (usize, &Channel), stored: &[u8]) -> Option<String> {
        if *channel != disparity::CHANNEL {
            return None;
        }
        let Some(base_line_m) = flight.base_line_m else {
            return Some("table `trajectories` has no base line of it".into());
        };
        let scale = flight.camera.focal_px() * base_line_m;
        let known = self.depths.iter().filter(|_| self.frame == frame);
        known.copied().find_map(|(pixel, depth_m)| {
            let found = f64::from(f32::from_le_bytes(stored.get(4 * pixel..4 * pixel + 4)?.try_into().ok()?));
            let expected = scale / depth_m;
            let allowed = expected * (SHARE + DEPTH_STEP_M / (depth_m - DEPTH_STEP_M).max(DEPTH_STEP_M));
            ((found - expected).abs() > allowed).then(|| {
                format!("pixel {pixel} has a disparity of {found:.4} px; by depth and base line it is {expected:.4} px")
            })
        })
    }
}
