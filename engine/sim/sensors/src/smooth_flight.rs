//! [`SmoothFlight`]: a flight between its frames, smooth enough for a quadrotor to fly it.

use crate::airframe::{Airframe, Derivatives};
use cosfly_frames::{DVec3, Pose, real};

/// Position and yaw: x, y, z in metres, radians.
type Point = [f64; 4];

/// Points beyond each end that the filter runs in from: its slower pole has fallen to 1e-17 there.
const MARGIN: usize = 48;

/// Poles of the filter that turns points into control points of a uniform quintic spline.
const POLES: [f64; 2] = [-0.430_575_347_099_973_8, -0.043_096_288_203_264_66];

/// Time between the angular velocities whose difference is the angular acceleration, in frames.
const TURN_SHARE: f64 = 1e-3;

/// The uniform quintic spline through the positions and the yaws of all frames.
///
/// It has four continuous derivatives, so that acceleration, jerk, attitude and angular velocity of the quadrotor that flies it are
/// continuous. Beyond its ends a flight goes on turned by half a turn around its end: it begins and ends without acceleration.
pub struct SmoothFlight {
    /// Control points, [`MARGIN`] of them before the first frame.
    controls: Vec<Point>,
    dt_s: f64,
    last: f64,
}

impl SmoothFlight {
    /// The spline through poses that are `dt_s` apart; at least one.
    pub fn new(poses_in_world: &[Pose], dt_s: f64) -> Self {
        let points = unwound(poses_in_world);
        let margin = MARGIN as i64;
        let padded: Vec<Point> =
            (-margin..points.len() as i64 + margin).map(|number| beyond_ends(&points, number)).collect();
        Self { controls: filtered(padded), dt_s, last: points.len().saturating_sub(1) as f64 }
    }

    /// The airframe at a frame number, which may lie between two frames.
    pub fn at(&self, at: f64) -> Airframe {
        let at = at.clamp(0.0, self.last);
        let middle = self.without_turn_acceleration(at);
        let [before, after] = [-0.5, 0.5].map(|side| self.without_turn_acceleration(at + side * TURN_SHARE));
        let change = after.rates_in_body - before.rates_in_body;
        Airframe { turn_acceleration_in_body: change / (TURN_SHARE * self.dt_s), ..middle }
    }

    /// The airframe at a frame number within the flight, whose angular acceleration is 0.
    pub(crate) fn without_turn_acceleration(&self, at: f64) -> Airframe {
        let derivatives = self.derivatives(at);
        let vector = |order: usize| DVec3::from_slice(&derivatives[order][..3]);
        let motion = Derivatives {
            position_in_world: vector(0),
            velocity_in_world: vector(1),
            acceleration_in_world: vector(2),
            jerk_in_world: vector(3),
        };
        Airframe::flying(&motion, derivatives[0][3], derivatives[1][3])
    }

    /// The point and its first three derivatives by time at a frame number, which may lie a frame beyond the ends.
    fn derivatives(&self, at: f64) -> [Point; 4] {
        let knot = at.floor();
        let first = (MARGIN as i64 + knot as i64 - 2) as usize;
        let mut differences: [Point; 6] = core::array::from_fn(|number| self.controls[first + number]);
        let mut scale = 1.0;
        core::array::from_fn(|order| {
            let degree = 5 - order;
            let weights = weights(degree, at - knot);
            let sum = |axis: usize| (0..=degree).map(|number| weights[number] * differences[number][axis]).sum::<f64>();
            let value: Point = core::array::from_fn(|axis| scale * sum(axis));
            for number in 0..degree {
                let [before, after] = [differences[number], differences[number + 1]];
                differences[number] = core::array::from_fn(|axis| after[axis] - before[axis]);
            }
            scale /= self.dt_s;
            value
        })
    }
}

/// Positions, and yaws that turn the short way from frame to frame.
fn unwound(poses_in_world: &[Pose]) -> Vec<Point> {
    let mut yaw_rad = poses_in_world.first().map_or(0.0, |pose| pose.yaw_rad);
    let point = |pose: &Pose| {
        yaw_rad += real::wrap_angle_rad(pose.yaw_rad - yaw_rad);
        let [x, y, z] = pose.position_in_world.to_array();
        [x, y, z, yaw_rad]
    };
    poses_in_world.iter().map(point).collect()
}

/// Point of a number, which may lie beyond the ends: the flight turned by half a turn around its end, again and again.
fn beyond_ends(points: &[Point], number: i64) -> Point {
    let last = points.len() as i64 - 1;
    if last <= 0 {
        return points.first().copied().unwrap_or_default();
    }
    let (turns, within) = (number.div_euclid(2 * last) as f64, number.rem_euclid(2 * last));
    let (start, end) = (&points[0], &points[last as usize]);
    core::array::from_fn(|axis| {
        let inside = match within {
            there if there <= last => points[there as usize][axis],
            back => 2.0 * end[axis] - points[(2 * last - back) as usize][axis],
        };
        inside + 2.0 * turns * (end[axis] - start[axis])
    })
}

/// Control points of the spline through points, but for those near the ends of the list: a filter forward and back for each pole.
fn filtered(mut points: Vec<Point>) -> Vec<Point> {
    let gain: f64 = POLES.iter().map(|pole| (1.0 - pole) * (1.0 - 1.0 / pole)).product();
    points.iter_mut().flatten().for_each(|value| *value *= gain);
    let last = points.len() - 1;
    for pole in POLES {
        points[0] = points[0].map(|value| value / (1.0 - pole));
        for number in 1..=last {
            points[number] = core::array::from_fn(|axis| points[number][axis] + pole * points[number - 1][axis]);
        }
        points[last] = points[last].map(|value| -pole * value / (1.0 - pole));
        for number in (0..last).rev() {
            points[number] = core::array::from_fn(|axis| pole * (points[number + 1][axis] - points[number][axis]));
        }
    }
    points
}

/// Weights of the `degree` + 1 control points of a uniform B-spline at a share of the way between two knots.
fn weights(degree: usize, share: f64) -> [f64; 6] {
    let mut weights = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    for next in 1..=degree {
        let lower = weights;
        weights = core::array::from_fn(|number| {
            let (place, own) = (number as f64, if number < next { lower[number] } else { 0.0 });
            let before = if (1..=next).contains(&number) { lower[number - 1] } else { 0.0 };
            ((share + next as f64 - place) * before + (1.0 + place - share) * own) / next as f64
        });
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::Seed;

    const DT_S: f64 = 0.25;

    /// Random steps, also over the yaw that jumps.
    fn poses(frames: usize) -> Vec<Pose> {
        let mut random = Seed([4; 32]).stream("poses");
        let mut pose =
            Pose { position_in_world: DVec3::new(900.0, -70.0, 30.0), pitch_rad: -0.3, yaw_rad: 3.0, roll_rad: 0.0 };
        let mut step = DVec3::ZERO;
        let mut next = || {
            step += DVec3::from_array(core::array::from_fn(|_| random.uniform(-0.1, 0.1)));
            pose.position_in_world += step;
            pose.yaw_rad = real::wrap_angle_rad(pose.yaw_rad + random.uniform(-0.1, 0.2));
            pose
        };
        (0..frames).map(|_| next()).collect()
    }

    #[test]
    fn the_spline_passes_every_frame() {
        for frames in [1, 2, 3, 4, 40] {
            let poses = poses(frames);
            let smooth = SmoothFlight::new(&poses, DT_S);
            for (frame, pose) in poses.iter().enumerate() {
                let airframe = smooth.at(frame as f64);
                assert!(airframe.position_in_world.distance(pose.position_in_world) < 1e-10, "{frame} of {frames}");
                let nose = DVec3::new(real::cos(pose.yaw_rad), real::sin(pose.yaw_rad), 0.0);
                assert!(airframe.world_from_body.y_axis.dot(nose).abs() < 1e-10, "{frame} of {frames}");
            }
            let [start, end] = [0.0, frames as f64 - 1.0].map(|at| smooth.at(at).acceleration_in_world.length());
            assert!(start.max(end) < 1e-9, "{start} {end}");
        }
    }

    #[test]
    fn derivatives_and_angular_velocities_are_those_of_differences() {
        let smooth = SmoothFlight::new(&poses(40), DT_S);
        let step = 1e-5;
        for at in (1..380).map(|place| 0.1013 * f64::from(place)) {
            let [before, here, after] = [at - step, at, at + step].map(|at| smooth.at(at));
            let by_difference = |of: fn(&Airframe) -> DVec3| (of(&after) - of(&before)) / (2.0 * step * DT_S);
            let close = |a: DVec3, b: DVec3, within: f64| assert!(a.distance(b) < within, "{at}: {a} {b}");
            close(by_difference(|it| it.position_in_world), here.velocity_in_world, 1e-5);
            close(by_difference(|it| it.velocity_in_world), here.acceleration_in_world, 1e-5);
            close(by_difference(|it| it.rates_in_body), here.turn_acceleration_in_body, 1e-3);
            // R' = R [w]x
            let turn = here.world_from_body.transpose() * (after.world_from_body - before.world_from_body);
            let turn = turn * (0.5 / (step * DT_S));
            close(DVec3::new(turn.y_axis.z, turn.z_axis.x, turn.x_axis.y), here.rates_in_body, 1e-5);
        }
    }
}
