//! Motions along the axes of one body: increments that add up like vectors.

use cosfly_frames::{DVec3, Pose, action};

/// Number of increments of an action.
pub const STEPS: usize = 5;

/// Motion from one pose to another along the axes of the body at `axes` (x ahead, y right, z up): dx, dy, dz in metres;
/// differences of pitch, yaw and roll in degrees, wrapped to (-180, 180].
pub fn along(axes: &Pose, from: &Pose, to: &Pose) -> [f64; 6] {
    let [x, y, z, pitch, yaw, roll] = action::in_world(from, to);
    let step = axes.world_from_body().transpose() * DVec3::new(x, y, z);
    [step.x, step.y, step.z, pitch, yaw, roll]
}

/// The action at `frame` of a flight with the pose `own`: [`STEPS`] increments along the axes of `own`, the first from `own` to
/// the expert's next pose, the others along the expert, who waits at the end of the flight. The sum of the first k leads
/// from `own` to the expert's pose k frames later.
pub fn chunk(own: &Pose, expert: &[Pose], frame: usize) -> Vec<f64> {
    let mut from = *own;
    let ahead = (1..=STEPS).filter_map(|step| expert.get((frame + step).min(expert.len().saturating_sub(1))));
    ahead.flat_map(|to| along(own, &std::mem::replace(&mut from, *to), to)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn increments_of_an_action_add_up_to_the_expert() {
        let pose = |step: usize| Pose {
            position_in_world: DVec3::new(1.5 * step as f64, (step * step) as f64, 20.0 - step as f64),
            pitch_rad: -0.5 - 0.1 * step as f64,
            yaw_rad: 3.0 + 0.2 * step as f64,
            roll_rad: 0.0,
        };
        let expert: Vec<Pose> = (0..8).map(pose).collect();
        let own = Pose { position_in_world: expert[1].position_in_world + DVec3::new(2.0, -1.0, 0.5), ..expert[2] };
        for frame in [1, 5] {
            let increments = chunk(&own, &expert, frame);
            for count in 1..=STEPS {
                let sum: [f64; 6] = core::array::from_fn(|i| increments.iter().skip(i).step_by(6).take(count).sum());
                let truth = &expert[(frame + count).min(7)];
                let reached = own.position_in_world + own.world_from_body() * DVec3::new(sum[0], sum[1], sum[2]);
                assert!((reached - truth.position_in_world).length() < 1e-9);
                assert!((own.yaw_rad.to_degrees() + sum[4] - truth.yaw_rad.to_degrees()).abs() < 1e-9);
            }
        }
        assert_eq!(chunk(&own, &expert, 7)[6..], [0.0; 24], "the expert waits");
    }
}
