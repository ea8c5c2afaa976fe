//! Features and outcomes of trained baselines, relative to the current pose and rotated by its yaw.

use super::prediction::InputFrames;
use cosfly_frames::{DVec3, Pose, real};

/// Numbers per predicted waypoint: ahead, right, up in metres, pitch, yaw and roll in radians.
pub const PER_WAYPOINT: usize = 6;

/// Rotates horizontal offsets so that the drone's heading is ahead; the inverse for `-yaw_rad`.
fn turned(offset: DVec3, yaw_rad: f64) -> DVec3 {
    let (s, c) = real::sin_cos(yaw_rad);
    DVec3::new(c * offset.x + s * offset.y, c * offset.y - s * offset.x, offset.z)
}

/// Knowledge that a trained baseline has of the target.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Known {
    /// Its true place in the world: no sensor of a drone gives it, and no model sees it.
    #[default]
    Places,
    /// The box around its visible pixels.
    Boxes,
}

/// Appends the features of a window to `features`: for every frame before the current one the pose relative to it, the
/// current pitch and roll, and in every input frame the target's position, or middle, height and presence of its box in
/// shares of the image.
pub fn push_features(view: &InputFrames<'_>, known: Known, features: &mut Vec<f64>) {
    let current = view.current();
    for pose in &view.poses[..view.poses.len().saturating_sub(1)] {
        features.extend(relative(&current, pose));
    }
    features.extend([current.pitch_rad, current.roll_rad]);
    match known {
        Known::Places => {
            for feet in view.feet {
                features.extend(turned(*feet - current.position_in_world, current.yaw_rad).to_array());
            }
        }
        Known::Boxes => features.extend(view.boxes.iter().flat_map(|edges| box_features(*edges, view.image_px))),
    }
}

/// Middle from the image's middle, height, and presence of a box.
fn box_features(edges: Option<[f32; 4]>, [width, height]: [f32; 2]) -> [f64; 4] {
    let Some([left, top, right, bottom]) = edges else { return [0.0; 4] };
    let [across, down] = [0.5 * (left + right) / width - 0.5, 0.5 * (top + bottom) / height - 0.5];
    [across, down, (bottom - top) / height, 1.0].map(f64::from)
}

/// `pose` relative to `current`.
pub fn relative(current: &Pose, pose: &Pose) -> [f64; PER_WAYPOINT] {
    let offset = turned(pose.position_in_world - current.position_in_world, current.yaw_rad);
    let turn = |angle: f64, from: f64| real::wrap_angle_rad(angle - from);
    [
        offset.x,
        offset.y,
        offset.z,
        turn(pose.pitch_rad, current.pitch_rad),
        turn(pose.yaw_rad, current.yaw_rad),
        turn(pose.roll_rad, current.roll_rad),
    ]
}

/// `pose` relative to `start`, but along the axes of the current pose, which a model knows.
pub fn outcome(view: &InputFrames<'_>, start: &Pose, pose: &Pose) -> [f64; PER_WAYPOINT] {
    let mut numbers = relative(&Pose { yaw_rad: view.current().yaw_rad, ..*start }, pose);
    numbers[4] = real::wrap_angle_rad(pose.yaw_rad - start.yaw_rad);
    numbers
}

/// Pose that is `relative` to `current`.
pub fn absolute(current: &Pose, [ahead, right, up, pitch, yaw, roll]: [f64; PER_WAYPOINT]) -> Pose {
    Pose {
        position_in_world: current.position_in_world + turned(DVec3::new(ahead, right, up), -current.yaw_rad),
        pitch_rad: current.pitch_rad + pitch,
        yaw_rad: current.yaw_rad + yaw,
        roll_rad: current.roll_rad + roll,
    }
}

/// Poses from a flat list of [`PER_WAYPOINT`] numbers each.
pub fn waypoints_of(current: &Pose, outcomes: &[f64]) -> Vec<Pose> {
    let (waypoints, _) = outcomes.as_chunks::<PER_WAYPOINT>();
    waypoints.iter().map(|numbers| absolute(current, *numbers)).collect()
}

/// Features and true outcomes of training windows, row by row.
#[derive(Clone, Debug, Default)]
pub struct Examples {
    /// Knowledge of the target behind the features.
    pub known: Known,
    /// Numbers in a row of features.
    pub width: usize,
    /// Numbers in a row of outcomes.
    pub depth: usize,
    /// Features, row-major.
    pub features: Vec<f64>,
    /// Outcomes, row-major.
    pub outcomes: Vec<f64>,
}

impl Examples {
    /// Adds a window with the true waypoints `truth`; `start` is the pose to which they are relative: the view's
    /// current pose unless increments start elsewhere. Windows of another shape than the first are skipped.
    pub fn push(&mut self, view: &InputFrames<'_>, start: &Pose, truth: &[Pose]) {
        let (features, outcomes) = (self.features.len(), self.outcomes.len());
        push_features(view, self.known, &mut self.features);
        for pose in truth {
            self.outcomes.extend(outcome(view, start, pose));
        }
        let (width, depth) = (self.features.len() - features, self.outcomes.len() - outcomes);
        if features == 0 {
            (self.width, self.depth) = (width, depth);
        } else if (width, depth) != (self.width, self.depth) {
            self.features.truncate(features);
            self.outcomes.truncate(outcomes);
        }
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.features.len().checked_div(self.width).unwrap_or(0)
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Means and spreads of the columns of a table, for scaling features.
#[derive(Clone, Debug, PartialEq)]
pub struct Scaling {
    means: Vec<f64>,
    /// 1 / deviation; 0 for constant columns.
    factors: Vec<f64>,
}

impl Scaling {
    /// Computes the scaling of a table with rows of `width` numbers.
    pub fn of(table: &[f64], width: usize) -> Self {
        let rows = (table.len().checked_div(width).unwrap_or(0) as f64).max(1.0);
        let (mut means, mut squares) = (vec![0.0; width], vec![0.0; width]);
        for row in table.chunks_exact(width.max(1)) {
            means.iter_mut().zip(row).for_each(|(mean, value)| *mean += value / rows);
        }
        for row in table.chunks_exact(width.max(1)) {
            for ((square, value), mean) in squares.iter_mut().zip(row).zip(&means) {
                *square += (value - mean) * (value - mean) / rows;
            }
        }
        let factors =
            squares.iter().map(|square: &f64| if *square > 1e-18 { 1.0 / square.sqrt() } else { 0.0 }).collect();
        Self { means, factors }
    }

    /// Scales a row in place.
    pub fn apply(&self, row: &mut [f64]) {
        for ((value, mean), factor) in row.iter_mut().zip(&self.means).zip(&self.factors) {
            *value = (*value - mean) * factor;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relative_poses_lead_back_and_do_not_depend_on_place_or_heading() {
        let current = Pose { yaw_rad: 3.0, ..Pose::looking_at(DVec3::new(9.0, 8.0, 30.0), DVec3::new(1.0, 2.0, 3.0)) };
        let pose = Pose { yaw_rad: -3.0, ..Pose::looking_at(DVec3::new(10.0, 6.0, 29.0), DVec3::ZERO) };
        let back = absolute(&current, relative(&current, &pose));
        assert!((back.position_in_world - pose.position_in_world).length() < 1e-12);
        assert!(real::wrap_angle_rad(back.yaw_rad - pose.yaw_rad).abs() < 1e-12);
        let ahead = absolute(&current, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert!(
            (ahead.position_in_world - current.position_in_world - DVec3::new(real::cos(3.0), real::sin(3.0), 0.0))
                .length()
                < 1e-12
        );
    }

    #[test]
    fn boxes_are_shares_of_the_image_and_absent_ones_are_zeros() {
        let poses = [Pose::looking_at(DVec3::ZERO, DVec3::X)];
        let boxes = [Some([30.0, 10.0, 50.0, 30.0]), None];
        let view = InputFrames { poses: &poses, boxes: &boxes, image_px: [80.0, 40.0], ..InputFrames::default() };
        let mut features = vec![];
        push_features(&view, Known::Boxes, &mut features);
        assert_eq!(features[2..], [0.0, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn scaled_columns_have_mean_zero_and_spread_one() {
        let mut table = vec![1.0, 5.0, 3.0, 5.0];
        let scaling = Scaling::of(&table, 2);
        table.chunks_exact_mut(2).for_each(|row| scaling.apply(row));
        assert_eq!(table, [-1.0, 0.0, 1.0, 0.0]);
    }
}
