//! Nearest-neighbour baseline: the waypoints of the most similar training window.

use super::features::{Examples, Known, Scaling, push_features, waypoints_of};
use super::prediction::{InputFrames, WorldPrediction};

/// Number of columns summed in parallel.
const LANES: usize = 8;

/// Nearest-neighbour model over training windows.
#[derive(Clone, Debug, PartialEq)]
pub struct NearestNeighbour {
    known: Known,
    scaling: Scaling,
    width: usize,
    depth: usize,
    /// Scaled features, rows padded to whole lanes with zeros.
    rows: Vec<f32>,
    outcomes: Vec<f64>,
}

impl NearestNeighbour {
    /// Stores at most `limit` of `examples`, evenly spread; `None` without any.
    pub fn fit(examples: &Examples, limit: usize) -> Option<Self> {
        let (width, depth) = (examples.width, examples.depth);
        let kept = examples.len().min(limit);
        if kept == 0 || depth == 0 {
            return None;
        }
        let scaling = Scaling::of(&examples.features, width);
        let (mut rows, mut outcomes) = (vec![], vec![]);
        for number in 0..kept {
            let at = number * examples.len() / kept;
            let mut row = examples.features[at * width..][..width].to_vec();
            scaling.apply(&mut row);
            rows.extend(lanes_of(&row));
            outcomes.extend_from_slice(&examples.outcomes[at * depth..][..depth]);
        }
        Some(Self { known: examples.known, scaling, width, depth, rows, outcomes })
    }

    /// Number of stored windows.
    pub fn len(&self) -> usize {
        self.outcomes.len().checked_div(self.depth).unwrap_or(0)
    }

    /// Whether no window is stored.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Waypoints of the nearest window, by the distance between scaled features; the first of equally near ones. `None`
    /// for a window of another shape.
    pub fn predict(&self, view: &InputFrames<'_>) -> Option<WorldPrediction> {
        let mut features = Vec::with_capacity(self.width);
        push_features(view, self.known, &mut features);
        if features.len() != self.width {
            return None;
        }
        self.scaling.apply(&mut features);
        let wanted = lanes_of(&features);
        let mut nearest = (f32::INFINITY, 0);
        for (number, row) in self.rows.chunks_exact(wanted.len()).enumerate() {
            let distance = squared_distance(&wanted, row);
            if distance < nearest.0 {
                nearest = (distance, number);
            }
        }
        let current = view.current();
        let outcomes = &self.outcomes[nearest.1 * self.depth..][..self.depth];
        Some(WorldPrediction { current, waypoints: waypoints_of(&current, outcomes) })
    }
}

fn lanes_of(row: &[f64]) -> Vec<f32> {
    let mut lanes: Vec<f32> = row.iter().map(|value| *value as f32).collect();
    lanes.resize(row.len().next_multiple_of(LANES), 0.0);
    lanes
}

fn squared_distance(a: &[f32], b: &[f32]) -> f32 {
    let (a, b) = (a.as_chunks::<LANES>().0, b.as_chunks::<LANES>().0);
    let mut sums = [0.0_f32; LANES];
    for (a, b) in a.iter().zip(b) {
        for lane in 0..LANES {
            sums[lane] += (a[lane] - b[lane]) * (a[lane] - b[lane]);
        }
    }
    sums.iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::{DVec3, Pose};

    #[test]
    fn a_window_that_was_seen_is_repeated() {
        let mut examples = Examples::default();
        let poses = |step: f64| -> Vec<Pose> {
            (0..10)
                .map(|k| Pose {
                    yaw_rad: 0.3,
                    ..Pose::looking_at(DVec3::new(step * f64::from(k), 0.0, 9.0), DVec3::ZERO)
                })
                .collect()
        };
        for step in [0.5, 1.0, 1.5, 2.0] {
            let poses = poses(step);
            examples.push(
                &InputFrames { poses: &poses[..5], feet: &[DVec3::ZERO; 5], horizon: 5, ..InputFrames::default() },
                &poses[4],
                &poses[5..],
            );
        }
        let memory = NearestNeighbour::fit(&examples, 100).unwrap();
        let poses = poses(1.5);
        let found = memory
            .predict(&InputFrames { poses: &poses[..5], feet: &[DVec3::ZERO; 5], horizon: 5, ..InputFrames::default() })
            .unwrap();
        assert!(crate::errors(&found.waypoints, &poses[5..]).fde_m < 1e-9);
        assert_eq!(NearestNeighbour::fit(&examples, 2).unwrap().len(), 2);
        assert_eq!(NearestNeighbour::fit(&examples, 0), None);
    }
}
