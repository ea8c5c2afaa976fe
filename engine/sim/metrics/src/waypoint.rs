//! Errors of predicted waypoints (paper, section "Evaluation Metrics").

use cosfly_frames::{DVec2, DVec3, Pose, real};

/// Errors of the waypoints of one window. The paper defines the metrics in words only. Choices where it is silent:
/// distances are in space (not in plan), angular errors are at most 180 degrees, yaw errors and mean absolute errors
/// are means over all waypoints, and errors are of the poses reached, not of single increments.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WaypointErrors {
    /// Average displacement error: mean distance over the waypoints, metres.
    pub ade_m: f64,
    /// Final displacement error: distance at the last waypoint, metres.
    pub fde_m: f64,
    /// Absolute yaw error at the last waypoint, 0..=180 degrees.
    pub final_yaw_deg: f64,
    /// Mean absolute yaw error over the waypoints, degrees.
    pub yaw_mae_deg: f64,
    /// Mean absolute error of x, y and z along the world's axes, metres.
    pub position_mae_m: f64,
    /// Mean absolute error of pitch, yaw and roll, degrees.
    pub rotation_mae_deg: f64,
    /// Mean absolute error of all six numbers: metres and degrees mixed, as in the paper.
    pub mae: f64,
    /// Predicted less true place of the last waypoint along the true heading: ahead, right, up, metres.
    pub final_offset_m: DVec3,
    /// Predicted less true pitch and yaw at the last waypoint, -180..=180 degrees.
    pub final_turn_deg: DVec2,
}

/// Errors of the last waypoints of a flight, added up with their signs: errors of both signs cancel, an error that stays does not.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LastingErrors {
    offset_m: DVec3,
    turn_deg: DVec2,
}

impl LastingErrors {
    /// Adds a window of the flight.
    pub fn add(&mut self, errors: &WaypointErrors) {
        self.offset_m += errors.final_offset_m;
        self.turn_deg += errors.final_turn_deg;
    }

    /// Lengths of the sums: metres, degrees. Over the number of windows they are those of the flight's mean error.
    pub fn lengths(&self) -> [f64; 2] {
        [self.offset_m.length(), self.turn_deg.length()]
    }
}

/// Smallest difference of two angles, 0..=180 degrees.
pub fn angle_error_deg(a_rad: f64, b_rad: f64) -> f64 {
    real::wrap_angle_rad(a_rad - b_rad).abs().to_degrees()
}

/// Errors of `predicted` against `truth`; waypoints that only one of them has are ignored, and without common waypoints
/// all errors are 0.
pub fn errors(predicted: &[Pose], truth: &[Pose]) -> WaypointErrors {
    let mut sum = WaypointErrors::default();
    let steps = predicted.len().min(truth.len());
    for (a, b) in predicted.iter().zip(truth) {
        let offset = a.position_in_world - b.position_in_world;
        let distance_m = offset.length();
        let yaw_deg = angle_error_deg(a.yaw_rad, b.yaw_rad);
        let turn_deg = yaw_deg + angle_error_deg(a.pitch_rad, b.pitch_rad) + angle_error_deg(a.roll_rad, b.roll_rad);
        (sum.ade_m, sum.fde_m) = (sum.ade_m + distance_m, distance_m);
        (sum.final_offset_m, sum.final_turn_deg) = (along_heading(offset, b.yaw_rad), turn_deg_between(a, b));
        (sum.yaw_mae_deg, sum.final_yaw_deg) = (sum.yaw_mae_deg + yaw_deg, yaw_deg);
        sum.position_mae_m += offset.abs().element_sum();
        sum.rotation_mae_deg += turn_deg;
    }
    let steps = steps.max(1) as f64;
    let (position, rotation) = (sum.position_mae_m, sum.rotation_mae_deg);
    WaypointErrors {
        ade_m: sum.ade_m / steps,
        yaw_mae_deg: sum.yaw_mae_deg / steps,
        position_mae_m: position / (3.0 * steps),
        rotation_mae_deg: rotation / (3.0 * steps),
        mae: (position + rotation) / (6.0 * steps),
        ..sum
    }
}

/// A vector of the world along a heading on the level: ahead, right, up.
fn along_heading(vector: DVec3, yaw_rad: f64) -> DVec3 {
    let (sin, cos) = real::sin_cos(yaw_rad);
    DVec3::new(cos * vector.x + sin * vector.y, cos * vector.y - sin * vector.x, vector.z)
}

fn turn_deg_between(a: &Pose, b: &Pose) -> DVec2 {
    let turn = |a: f64, b: f64| real::wrap_angle_rad(a - b).to_degrees();
    DVec2::new(turn(a.pitch_rad, b.pitch_rad), turn(a.yaw_rad, b.yaw_rad))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pose(x: f64, y: f64, yaw_deg: f64) -> Pose {
        Pose { yaw_rad: yaw_deg.to_radians(), ..Pose::looking_at(DVec3::new(x, y, 0.0), DVec3::new(x + 1.0, y, 0.0)) }
    }

    #[test]
    fn a_constant_offset_of_three_and_four_metres_is_an_error_of_five() {
        let truth = [pose(0.0, 0.0, 0.0), pose(1.0, 0.0, 0.0)];
        let found = errors(&[pose(3.0, 4.0, 0.0), pose(4.0, 4.0, 0.0)], &truth);
        assert_eq!((found.ade_m, found.fde_m, found.position_mae_m), (5.0, 5.0, 7.0 / 3.0));
        assert_eq!(found.mae, 7.0 / 6.0);
    }

    #[test]
    fn yaw_errors_go_the_short_way_round() {
        let found = errors(&[pose(0.0, 0.0, 179.0)], &[pose(0.0, 0.0, -179.0)]);
        assert!((found.final_yaw_deg - 2.0).abs() < 1e-12 && (found.rotation_mae_deg - 2.0 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn a_lasting_error_turns_with_the_heading_and_cancels_with_its_opposite() {
        let mut lasting = LastingErrors::default();
        // Three metres ahead, once on the way along x, once along y.
        lasting.add(&errors(&[pose(3.0, 0.0, 0.0)], &[pose(0.0, 0.0, 0.0)]));
        lasting.add(&errors(&[pose(0.0, 3.0, 90.0)], &[pose(0.0, 0.0, 90.0)]));
        assert!((lasting.lengths()[0] - 6.0).abs() < 1e-12 && lasting.lengths()[1] == 0.0);
        lasting.add(&errors(&[pose(-6.0, 0.0, 179.0)], &[pose(0.0, 0.0, 0.0)]));
        lasting.add(&errors(&[pose(0.0, 0.0, -179.0)], &[pose(0.0, 0.0, 0.0)]));
        assert!(lasting.lengths()[0] < 1e-12 && lasting.lengths()[1] < 1e-12);
    }
}
