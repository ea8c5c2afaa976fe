//! Baselines without training: constant pose, constant velocity, constant acceleration, copying the target's motion.

use super::prediction::{InputFrames, WorldPrediction};
use cosfly_frames::{DVec3, Pose, real};

/// Extrapolation by polynomials through the past poses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extrapolation {
    /// Constant pose: all increments are zero.
    Zero,
    /// Line through the input poses by least squares, angles included; averages out noise.
    ConstantVelocity,
    /// Parabola through the input poses by least squares.
    ConstantAcceleration,
    /// From its current position the drone moves with the target's mean velocity over the input frames; its attitude is
    /// constant.
    CopyTarget,
}

impl Extrapolation {
    /// All methods.
    pub const ALL: [Self; 4] = [Self::Zero, Self::ConstantVelocity, Self::ConstantAcceleration, Self::CopyTarget];

    /// Predicts the waypoints of a window.
    pub fn predict(self, view: &InputFrames<'_>) -> WorldPrediction {
        let current = view.current();
        match self {
            Self::Zero => WorldPrediction { current, waypoints: vec![current; view.horizon] },
            Self::ConstantVelocity => fitted(view, 1),
            Self::ConstantAcceleration => fitted(view, 2),
            Self::CopyTarget => {
                let step = match (view.feet.first(), view.feet.last()) {
                    (Some(first), Some(last)) if view.feet.len() > 1 => (*last - *first) / (view.feet.len() - 1) as f64,
                    _ => DVec3::ZERO,
                };
                let moved =
                    |k: usize| Pose { position_in_world: current.position_in_world + k as f64 * step, ..current };
                WorldPrediction { current, waypoints: (1..=view.horizon).map(moved).collect() }
            }
        }
    }
}

/// Polynomials of `degree` through the six numbers of the poses, extrapolated. Fewer poses than required lower the
/// degree.
fn fitted(view: &InputFrames<'_>, degree: usize) -> WorldPrediction {
    let current = view.current();
    let degree = degree.min(view.poses.len().saturating_sub(1));
    let fit = Fit::new(view.poses.len(), degree);
    let pose_at = |time: f64| {
        let (mut offset, mut angles) = (DVec3::ZERO, DVec3::ZERO);
        for (number, pose) in view.poses.iter().enumerate() {
            let weight = fit.weight(number, time);
            let turn = |angle: f64, from: f64| real::wrap_angle_rad(angle - from);
            offset += weight * (pose.position_in_world - current.position_in_world);
            angles += weight
                * DVec3::new(
                    turn(pose.pitch_rad, current.pitch_rad),
                    turn(pose.yaw_rad, current.yaw_rad),
                    turn(pose.roll_rad, current.roll_rad),
                );
        }
        Pose {
            position_in_world: current.position_in_world + offset,
            pitch_rad: current.pitch_rad + angles.x,
            yaw_rad: current.yaw_rad + angles.y,
            roll_rad: current.roll_rad + angles.z,
        }
    };
    WorldPrediction { current: pose_at(0.0), waypoints: (1..=view.horizon).map(|step| pose_at(step as f64)).collect() }
}

/// Least-squares fit of values at the times 1 - n ..= 0 by orthogonal polynomials (Gram's).
struct Fit {
    first: f64,
    middle: f64,
    spread: f64,
    /// Sum of squares of each polynomial over the times.
    squares: [f64; 3],
    degree: usize,
}

impl Fit {
    fn new(values: usize, degree: usize) -> Self {
        let (first, count) = (1.0 - values as f64, (values as f64).max(1.0));
        let mut fit = Self { first, middle: 0.5 * first, spread: 0.0, squares: [0.0; 3], degree: degree.min(2) };
        let times = || (0..values).map(|number| first + number as f64);
        fit.spread = times().map(|time| (time - fit.middle) * (time - fit.middle)).sum::<f64>() / count;
        for time in times() {
            let polynomials = fit.polynomials(time);
            fit.squares.iter_mut().zip(polynomials).for_each(|(square, value)| *square += value * value);
        }
        fit
    }

    fn polynomials(&self, time: f64) -> [f64; 3] {
        let from_middle = time - self.middle;
        [1.0, from_middle, from_middle * from_middle - self.spread]
    }

    /// Weight of value `number` in the polynomial's value at `time`: sum of p(t) p(time) / |p|^2.
    fn weight(&self, number: usize, time: f64) -> f64 {
        let (here, there) = (self.polynomials(self.first + number as f64), self.polynomials(time));
        let terms = (0..=self.degree).filter(|degree| self.squares[*degree] > 0.0);
        terms.map(|degree| here[degree] * there[degree] / self.squares[degree]).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn along(position: impl Fn(f64) -> DVec3) -> Vec<Pose> {
        (-4..=5)
            .map(f64::from)
            .map(|t| Pose { yaw_rad: 3.1 + 0.02 * t, ..Pose::looking_at(position(t), DVec3::ZERO) })
            .collect()
    }

    #[test]
    fn lines_and_parabolas_are_continued_exactly() {
        let (a, b) = (DVec3::new(1.0, -2.0, 0.5), DVec3::new(0.1, 0.2, -0.05));
        for (method, curve) in [(Extrapolation::ConstantVelocity, 0.0), (Extrapolation::ConstantAcceleration, 1.0)] {
            let mut poses = along(|t| a * t + curve * b * t * t);
            poses.iter_mut().for_each(|pose| pose.pitch_rad = -0.7);
            let found =
                method.predict(&InputFrames { poses: &poses[..5], feet: &[], horizon: 5, ..InputFrames::default() });
            let errors = crate::errors(&found.waypoints, &poses[5..]);
            assert!(errors.ade_m < 1e-9 && errors.rotation_mae_deg < 1e-9, "{method:?} {errors:?}");
        }
    }

    #[test]
    fn the_target_is_copied_and_nothing_is_needed() {
        let poses = along(|_| DVec3::Z);
        let feet: Vec<DVec3> = (0..5).map(|k| DVec3::new(f64::from(k), 0.0, 0.0)).collect();
        let found = Extrapolation::CopyTarget.predict(&InputFrames {
            poses: &poses[..5],
            feet: &feet,
            horizon: 3,
            ..InputFrames::default()
        });
        assert_eq!(found.waypoints[2].position_in_world, DVec3::new(3.0, 0.0, 1.0));
        for method in Extrapolation::ALL {
            let alone = method.predict(&InputFrames {
                poses: &poses[..1],
                feet: &feet[..1],
                horizon: 2,
                ..InputFrames::default()
            });
            assert_eq!(alone.waypoints[1].position_in_world, DVec3::Z, "{method:?}");
            assert_eq!(
                method
                    .predict(&InputFrames { poses: &[], feet: &[], horizon: 2, ..InputFrames::default() })
                    .waypoints
                    .len(),
                2
            );
        }
    }

    #[test]
    fn an_anchor_moves_the_whole_prediction() {
        let poses = along(|t| DVec3::X * t);
        let found = Extrapolation::Zero.predict(&InputFrames {
            poses: &poses[..5],
            feet: &[],
            horizon: 2,
            ..InputFrames::default()
        });
        let anchor = Pose::looking_at(DVec3::new(0.0, 7.0, 0.0), DVec3::new(9.0, 7.0, 0.0));
        assert_eq!(found.started_at(&anchor), [anchor, anchor]);
    }
}
