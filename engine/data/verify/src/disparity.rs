//! Disparity of a stereo pair, and measured depths, against the depth of the same picture and the base line.

use super::rows::PlacedFlight;
use cosfly_domain::Channel;
use cosfly_domain::channels::{depth_sensor, depth_stereo, disparity};

/// Every so many pixels are compared.
const EVERY: usize = 61;
/// Half the step of the stored depths, and what 32 bits round, metres and a share.
const DEPTH_STEP_M: f64 = 5e-4;
const SHARE: f64 = 1e-6;
/// Base line of the model of `depth_sensor`, which its channel states in words, metres.
const MODEL_BASE_LINE_M: f64 = 0.12;
/// Measured disparities are whole steps of a pixel, but for what 32 bits round.
const STEPS: f64 = 16.0;
const OFF_GRID: f64 = 0.02;
/// Least number of compared pixels with a measured depth, and the error of disparity that half of them may have, pixels.
const LEAST_MATCHED: usize = 30;
const MATCHED_WITHIN_PX: f64 = 2.0;

/// A channel of measured depths.
struct Measure {
    channel: &'static Channel,
    /// By how much the line through measured and exact disparities may be steeper or flatter than 1, beside five deviations of it. Matchers of
    /// windows draw far things to near ones.
    steeper: f64,
    /// Least standard deviation of the exact disparities by which a frame is judged, pixels: steps and errors are as large.
    spread_px: f64,
}

const MEASURES: [Measure; 2] = [
    Measure { channel: &depth_sensor::CHANNEL, steeper: 0.1, spread_px: 0.2 },
    Measure { channel: &depth_stereo::CHANNEL, steeper: 0.3, spread_px: 0.6 },
];

/// Depths of some pixels of a frame.
#[derive(Default)]
pub struct KnownDepths {
    /// Pixel and depth, metres.
    depths: Vec<(usize, f64)>,
}

impl KnownDepths {
    /// The depths of a frame.
    pub fn of(flight: &PlacedFlight, depths: &[u8]) -> Self {
        if flight.lens.is_wide(&flight.camera) {
            return Self::default();
        }
        let depths = depths.as_chunks::<4>().0.iter().map(|four| f64::from(f32::from_le_bytes(*four)));
        Self { depths: depths.enumerate().step_by(EVERY).collect() }
    }

    /// Fault of the disparities of a frame, in words.
    pub fn finding(&self, flight: &PlacedFlight, channel: &Channel, stored: &[u8]) -> Option<String> {
        let measure = MEASURES.iter().find(|measure| measure.channel == channel);
        if *channel != disparity::CHANNEL && measure.is_none() {
            return None;
        }
        let base_line_m = if *channel == depth_sensor::CHANNEL { Some(MODEL_BASE_LINE_M) } else { flight.base_line_m };
        let Some(base_line_m) = base_line_m else {
            return Some("table `trajectories` has no base line of it".into());
        };
        let scale = flight.camera.focal_px() * base_line_m;
        let found =
            |pixel: usize| Some(f64::from(f32::from_le_bytes(stored.get(4 * pixel..4 * pixel + 4)?.try_into().ok()?)));
        if let Some(measure) = measure {
            let both = self.depths.iter().filter_map(|(pixel, depth_m)| {
                let found_m = found(*pixel).filter(|it| it.is_normal())?;
                Some((*pixel, scale / depth_m, scale / found_m))
            });
            return measured_finding(&both.collect::<Vec<_>>(), measure);
        }
        self.depths.iter().find_map(|(pixel, depth_m)| {
            let found = found(*pixel)?;
            let expected = scale / depth_m;
            let allowed = expected * (SHARE + DEPTH_STEP_M / (depth_m - DEPTH_STEP_M).max(DEPTH_STEP_M));
            ((found - expected).abs() > allowed).then(|| {
                format!("pixel {pixel} has a disparity of {found:.4} px; by depth and base line it is {expected:.4} px")
            })
        })
    }
}

/// Fault of measured depths of these pixels, with exact and measured disparities: each is a whole number of steps; single ones may
/// be far off, half of them may not; and the larger ones are the larger ones.
fn measured_finding(both: &[(usize, f64, f64)], measure: &Measure) -> Option<String> {
    let off_grid = |px: f64| (STEPS * px - (STEPS * px).round()).abs() > OFF_GRID;
    if let Some((pixel, _, found)) = both.iter().find(|(_, _, found)| off_grid(*found)) {
        return Some(format!(
            "pixel {pixel} measures a disparity of {found:.4} px, which is no whole number of 1/16 px"
        ));
    }
    let mut errors_px: Vec<f64> = both.iter().map(|(_, exact, found)| (found - exact).abs()).collect();
    errors_px.sort_unstable_by(f64::total_cmp);
    let median_px = errors_px.get(errors_px.len() / 2).filter(|_| errors_px.len() >= LEAST_MATCHED)?;
    let count = errors_px.len();
    if *median_px > MATCHED_WITHIN_PX {
        return Some(format!(
            "half of {count} measured depths are more than {median_px:.2} px of disparity off the exact ones"
        ));
    }
    let near = both.iter().filter(|(_, exact, found)| (found - exact).abs() <= MATCHED_WITHIN_PX);
    let (slope, deviation, spread_px) = slope_of(&near.map(|(_, exact, found)| (*exact, *found)).collect::<Vec<_>>())?;
    let is_off = spread_px >= measure.spread_px && (slope - 1.0).abs() > measure.steeper + 5.0 * deviation;
    is_off.then(|| {
        format!("{count} measured disparities grow {slope:.2} times as fast as the exact ones (deviation {deviation:.2}): they are of other pixels")
    })
}

/// Slope of the line through points, its standard deviation and that of the first numbers; none of few points.
fn slope_of(points: &[(f64, f64)]) -> Option<(f64, f64, f64)> {
    let count = points.len() as f64;
    if points.len() < LEAST_MATCHED {
        return None;
    }
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (middle_x, middle_y) = (mean(|it| it.0), mean(|it| it.1));
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for (x, y) in points.iter().map(|(x, y)| (x - middle_x, y - middle_y)) {
        (xx, xy, yy) = (xx + x * x, xy + x * y, yy + y * y);
    }
    let slope = xy / xx;
    let rest = (yy - slope * xy).max(0.0) / (count - 2.0);
    (xx > 0.0).then(|| (slope, (rest / xx).sqrt(), (xx / count).sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measured_depths_are_whole_steps_near_the_exact_ones_of_the_same_pixels() {
        let steps = |px: f64| (STEPS * px).round() / STEPS;
        let sound: Vec<(usize, f64, f64)> = (0..200).map(|k| (k, 2.0 + 0.017 * k as f64, 0.0)).collect();
        let judged = |measured: &dyn Fn(usize, f64) -> f64| {
            let both: Vec<_> =
                sound.iter().map(|(pixel, exact, _)| (*pixel, *exact, measured(*pixel, *exact))).collect();
            MEASURES.iter().map(|measure| measured_finding(&both, measure)).collect::<Vec<_>>()
        };
        assert_eq!(judged(&|k, exact| steps(exact + 0.1 * ((k * 7 % 5) as f64 - 2.0) / 2.0)), [None, None]);
        let words = |found: Vec<Option<String>>, words: &str| {
            assert!(found.iter().all(|it| it.as_ref().is_some_and(|it| it.contains(words))), "{found:?}");
        };
        words(judged(&|_, exact| 1.02 * steps(exact)), "no whole number of 1/16 px");
        words(judged(&|_, exact| steps(exact) + 3.0), "half of 200");
        let mirrored = judged(&|k, _| steps(sound[199 - k].1)).swap_remove(0);
        words(vec![mirrored], "of other pixels");
    }
}
