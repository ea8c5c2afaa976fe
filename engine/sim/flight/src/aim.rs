//! The aim of the pilot of a planned flight.

use cosfly_domain::Trajectory;
use cosfly_frames::{DVec3, Seed, TargetTrack};
use cosfly_pilot::aim::{AimConfig, aimed};
use cosfly_planner::certificate::view_rates_deg_s;

/// Turns the views of a planned flight behind `track`, whose first frame is `first_frame` of the track, as a pilot aims, within
/// the flight's limits; the certificate states the rates of the result.
pub fn take_aim(flight: &mut Trajectory, first_frame: usize, aim: &AimConfig, track: &TargetTrack, seed: Seed) {
    let limits = &flight.certificate.limits;
    let fastest = aim.max_rate_deg_s.min(limits.yaw_rate_deg_s).min(limits.pitch_rate_deg_s);
    let aim = AimConfig { max_rate_deg_s: fastest, ..aim.clone() };
    let positions: Vec<DVec3> = flight.poses_in_world.iter().map(|pose| pose.position_in_world).collect();
    flight.poses_in_world = aimed(&positions, track, first_frame, None, &aim, seed.child("aim", 0));
    let [yaw, pitch] = view_rates_deg_s(&flight.poses_in_world, track.dt_s);
    (flight.certificate.max_yaw_rate_deg_s, flight.certificate.max_pitch_rate_deg_s) = (yaw, pitch);
}
