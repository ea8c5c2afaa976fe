//! Disparity of a stereo pair, and the depth that it measures, against the depth of the same picture and the base line.

use super::rows::PlacedFlight;
use cosfly_domain::Channel;
use cosfly_domain::channels::{depth_stereo, disparity};

/// Every so many pixels are compared.
const EVERY: usize = 61;
/// Half the step of the stored depths, and what 32 bits round, metres and a share.
const DEPTH_STEP_M: f64 = 5e-4;
const SHARE: f64 = 1e-6;
/// Least number of compared pixels with a matched depth, and the error of disparity that half of them may have, pixels.
const LEAST_MATCHED: usize = 30;
const MATCHED_WITHIN_PX: f64 = 2.0;

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
        if ![&disparity::CHANNEL, &depth_stereo::CHANNEL].contains(&channel) {
            return None;
        }
        let Some(base_line_m) = flight.base_line_m else {
            return Some("table `trajectories` has no base line of it".into());
        };
        let scale = flight.camera.focal_px() * base_line_m;
        let mut known = self.depths.iter().copied().filter(|_| self.frame == frame);
        let found =
            |pixel: usize| Some(f64::from(f32::from_le_bytes(stored.get(4 * pixel..4 * pixel + 4)?.try_into().ok()?)));
        if *channel == depth_stereo::CHANNEL {
            let matched =
                known.filter_map(|(pixel, depth_m)| Some((found(pixel).filter(|it| it.is_normal())?, depth_m)));
            return matched_finding(
                matched.map(|(found_m, depth_m)| (scale / found_m - scale / depth_m).abs()).collect(),
            );
        }
        known.find_map(|(pixel, depth_m)| {
            let found = found(pixel)?;
            let expected = scale / depth_m;
            let allowed = expected * (SHARE + DEPTH_STEP_M / (depth_m - DEPTH_STEP_M).max(DEPTH_STEP_M));
            ((found - expected).abs() > allowed).then(|| {
                format!("pixel {pixel} has a disparity of {found:.4} px; by depth and base line it is {expected:.4} px")
            })
        })
    }
}

/// What is wrong with matched depths whose disparities have these errors: single ones may be far off, half of them may not.
fn matched_finding(mut errors_px: Vec<f64>) -> Option<String> {
    errors_px.sort_unstable_by(f64::total_cmp);
    let median_px = errors_px.get(errors_px.len() / 2).filter(|_| errors_px.len() >= LEAST_MATCHED)?;
    (*median_px > MATCHED_WITHIN_PX).then(|| {
        format!(
            "half of {} matched depths are more than {median_px:.2} px of disparity off the exact ones",
            errors_px.len()
        )
    })
}
