//! Errors of predicted depth by how far away things truly are.

use super::report::DistanceReport;
use cosfly_diagnose::plausible;

/// Borders of the ranges of true depth, metres; the last one ends at the largest depth that counts.
const DISTANCES_M: [f64; 6] = [0.0, 10.0, 20.0, 40.0, 80.0, 160.0];

/// Errors by range of true depth, and sums of predicted and true depths.
#[derive(Clone, Copy, Default)]
pub struct Ratio {
    by_distance: [(u64, f64); DISTANCES_M.len()],
    /// Sum over all pixels that count, metres.
    pub predicted_m: f64,
    /// See `predicted_m`.
    pub true_m: f64,
    /// Pixels whose predicted depth is none: not a number, below 0, or finite and implausibly large.
    pub nonsense: u64,
}

impl Ratio {
    /// Sums of one frame, up to `most_m` of true depth, metres.
    pub fn of(predicted_m: &[f32], true_m: &[f32], most_m: f64) -> Self {
        let mut sum = Self::default();
        for (predicted, truth) in predicted_m.iter().zip(true_m) {
            let (predicted, truth) = (f64::from(*predicted), f64::from(*truth));
            if !(truth.is_finite() && truth > 0.0 && truth <= most_m) {
                continue;
            }
            let is_depth = predicted >= 0.0 && (predicted.is_infinite() || plausible(predicted).is_ok());
            sum.nonsense += u64::from(!is_depth);
            // Before it is clamped: it shows a wrong unit.
            if is_depth && predicted.is_finite() {
                (sum.predicted_m, sum.true_m) = (sum.predicted_m + predicted, sum.true_m + truth);
            }
            let clamped = if predicted.is_nan() { most_m } else { predicted.clamp(0.001, most_m.max(0.001)) };
            let range = DISTANCES_M.iter().rposition(|from| truth >= *from).unwrap_or(0);
            let (pixels, errors) = &mut sum.by_distance[range];
            (*pixels, *errors) = (*pixels + 1, *errors + (clamped - truth).abs() / truth);
        }
        sum
    }

    /// Adds another frame's.
    pub fn add(&mut self, other: &Self) {
        for (sum, more) in self.by_distance.iter_mut().zip(&other.by_distance) {
            (sum.0, sum.1) = (sum.0 + more.0, sum.1 + more.1);
        }
        self.predicted_m += other.predicted_m;
        self.true_m += other.true_m;
        self.nonsense += other.nonsense;
    }

    /// By range; those without a pixel are left out.
    pub fn reports(&self, most_m: f64) -> Vec<DistanceReport> {
        let ends = DISTANCES_M[1..].iter().copied().chain([f64::INFINITY]);
        let ranges = DISTANCES_M.into_iter().zip(ends).zip(self.by_distance);
        ranges
            .filter(|(_, (pixels, _))| *pixels > 0)
            .map(|((from_m, to_m), (pixels, sum))| DistanceReport {
                from_m,
                to_m: to_m.min(most_m),
                pixels,
                abs_rel: sum / pixels as f64,
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depths_that_are_none_are_counted_where_they_count() {
        let predicted = [f32::NAN, -1.0, 1e23, f32::INFINITY, 20.0, f32::NAN];
        let truth = [10.0, 10.0, 10.0, 10.0, 10.0, f32::INFINITY];
        let found = Ratio::of(&predicted, &truth, 80.0);
        assert_eq!((found.nonsense, found.predicted_m, found.true_m), (3, 20.0, 10.0));
    }
}
