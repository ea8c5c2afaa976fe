//! Ridge regression from the input frames to the waypoints, in closed form.

use super::features::{Examples, Known, Scaling, push_features, waypoints_of};
use super::prediction::{InputFrames, WorldPrediction};
use super::solve::solve;

/// Weight of the penalty per row: large enough for collinear columns, negligible otherwise.
const PENALTY: f64 = 1e-3;

/// A linear model of the waypoints.
#[derive(Clone, Debug, PartialEq)]
pub struct Ridge {
    known: Known,
    scaling: Scaling,
    width: usize,
    depth: usize,
    /// Weights: a row per scaled feature, then one for the constant.
    weights: Vec<f64>,
}

impl Ridge {
    /// Fits `examples`: W = (X'X + rows * penalty * I)^-1 X'Y over scaled features and an unpenalised constant. `None`
    /// without examples.
    pub fn fit(examples: &Examples) -> Option<Self> {
        let (width, depth) = (examples.width, examples.depth);
        if examples.is_empty() || depth == 0 {
            return None;
        }
        let scaling = Scaling::of(&examples.features, width);
        let n = width + 1;
        let (mut matrix, mut right) = (vec![0.0; n * n], vec![0.0; n * depth]);
        let mut row = vec![1.0; n];
        for (features, outcomes) in examples.features.chunks_exact(width).zip(examples.outcomes.chunks_exact(depth)) {
            row[..width].copy_from_slice(features);
            scaling.apply(&mut row[..width]);
            for (i, value) in row.iter().enumerate() {
                matrix[i * n..=i * n + i].iter_mut().zip(&row).for_each(|(sum, other)| *sum += value * other);
                right[i * depth..][..depth].iter_mut().zip(outcomes).for_each(|(sum, outcome)| *sum += value * outcome);
            }
        }
        for i in 0..width {
            matrix[i * n + i] += PENALTY * examples.len() as f64;
        }
        solve(&matrix, n, &mut right, depth)?;
        Some(Self { known: examples.known, scaling, width, depth, weights: right })
    }

    /// Knowledge that it has of the target.
    pub fn known(&self) -> Known {
        self.known
    }

    /// Predicts the waypoints of a window; `None` for one of another shape than the training windows.
    pub fn predict(&self, view: &InputFrames<'_>) -> Option<WorldPrediction> {
        let mut features = Vec::with_capacity(self.width + 1);
        push_features(view, self.known, &mut features);
        if features.len() != self.width {
            return None;
        }
        self.scaling.apply(&mut features);
        features.push(1.0);
        let mut outcomes = vec![0.0; self.depth];
        for (feature, weights) in features.iter().zip(self.weights.chunks_exact(self.depth)) {
            outcomes.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += feature * weight);
        }
        let current = view.current();
        Some(WorldPrediction { current, waypoints: waypoints_of(&current, &outcomes) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::{DVec3, Pose};
    use cosfly_random::Seed;

    #[test]
    fn what_is_linear_is_learnt() {
        let mut stream = Seed::of_item(2, "test", "ridge").stream("flights");
        let mut examples = Examples::default();
        let mut window = || {
            let (place, step) =
                (DVec3::new(stream.uniform(-9.0, 9.0), stream.uniform(-9.0, 9.0), 25.0), stream.uniform(0.2, 2.0));
            let yaw_rad = stream.uniform(-3.0, 3.0);
            let ahead = DVec3::new(cosfly_frames::real::cos(yaw_rad), cosfly_frames::real::sin(yaw_rad), 0.0);
            let pose = |k: usize| Pose {
                position_in_world: place + k as f64 * step * ahead,
                pitch_rad: -0.7,
                yaw_rad,
                roll_rad: 0.0,
            };
            (0..10).map(pose).collect::<Vec<_>>()
        };
        let feet = [DVec3::ZERO; 5];
        for _ in 0..200 {
            let poses = window();
            examples.push(
                &InputFrames { poses: &poses[..5], feet: &feet, horizon: 5, ..InputFrames::default() },
                &poses[4],
                &poses[5..],
            );
        }
        let ridge = Ridge::fit(&examples).unwrap();
        let poses = window();
        let found = ridge
            .predict(&InputFrames { poses: &poses[..5], feet: &feet, horizon: 5, ..InputFrames::default() })
            .unwrap();
        assert!(crate::errors(&found.waypoints, &poses[5..]).fde_m < 0.05);
        assert_eq!(
            ridge.predict(&InputFrames { poses: &poses[..4], feet: &feet, horizon: 5, ..InputFrames::default() }),
            None
        );
        assert_eq!(Ridge::fit(&Examples::default()), None);
    }
}
