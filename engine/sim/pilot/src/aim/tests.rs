//! Aimed flights: exact without errors, off the middle as far as asked, bounded in rate, the same from the middle on.

use super::{AimConfig, aimed};
use cosfly_frames::{DVec3, Pose, TargetState, TargetTrack, real};
use cosfly_random::Seed;
use cosfly_surroundings::visibility::aim_point;

/// A target that walks a square, and a drone that stays 20 m west and 20 m above.
fn flight(count: usize) -> (TargetTrack, Vec<DVec3>) {
    let mut feet = DVec3::ZERO;
    let states: Vec<TargetState> = (0..count)
        .map(|frame| {
            let heading_rad = (frame / 40 % 4) as f64 * 0.5 * real::PI;
            let (sin, cos) = real::sin_cos(heading_rad);
            feet += 0.7 * DVec3::new(cos, sin, 0.0);
            TargetState { feet_in_world: feet, heading_rad, speed_mps: 1.4 }
        })
        .collect();
    let positions = states.iter().map(|state| state.feet_in_world + DVec3::new(-20.0, 0.0, 20.0)).collect();
    (TargetTrack { dt_s: 0.5, height_m: 1.7, radius_m: 0.25, states }, positions)
}

fn seed() -> Seed {
    Seed::of_item(4, "expert", "p1")
}

/// Angle between the optical axis and the target, degrees.
fn off_axis_deg(pose: &Pose, track: &TargetTrack, frame: usize) -> f64 {
    let seen = pose.body_from_world_point(aim_point(&track.states[frame], track.height_m));
    real::acos(seen.x / seen.length()).to_degrees()
}

#[test]
fn an_exact_aim_looks_at_the_target() {
    let (track, positions) = flight(60);
    for (frame, pose) in aimed(&positions, &track, 0, None, &AimConfig::exact(), seed()).iter().enumerate() {
        let exact = Pose::looking_at(positions[frame], aim_point(&track.states[frame], track.height_m));
        assert!(off_axis_deg(pose, &track, frame) < 1e-5);
        assert!((pose.yaw_rad - exact.yaw_rad).abs() + (pose.pitch_rad - exact.pitch_rad).abs() < 1e-12);
    }
}

#[test]
fn the_target_leaves_the_middle_but_not_the_picture() {
    let (track, positions) = flight(4000);
    let poses = aimed(&positions, &track, 0, None, &AimConfig::default(), seed());
    assert_eq!(poses.len(), 4000);
    let angles: Vec<f64> = poses.iter().enumerate().map(|(frame, pose)| off_axis_deg(pose, &track, frame)).collect();
    let mean = angles.iter().sum::<f64>() / 4000.0;
    assert!((8.0..12.0).contains(&mean), "{mean}");
    // Framing and quick error, and what the target walks while the pilot has not noticed.
    assert!(angles.iter().all(|angle| *angle < 18.0 + 6.0), "{}", angles.iter().copied().fold(0.0, f64::max));
    assert!(poses.iter().zip(&positions).all(|(pose, position)| pose.position_in_world == *position));
}

#[test]
fn a_lag_looks_where_the_target_was_and_a_lead_where_it_will_be() {
    let (track, positions) = flight(40);
    for (lag_s, behind) in [(1.0, -2_i64), (-1.0, 2)] {
        let config = AimConfig { lag_s, ..AimConfig::exact() };
        let poses = aimed(&positions, &track, 0, None, &config, seed());
        #[expect(clippy::needless_range_loop, reason = "frames number three lists")]
        for frame in 2..38_usize {
            let then = frame.saturating_add_signed(behind as isize);
            assert!(off_axis_deg(&poses[frame], &track, then) < 1e-5, "{lag_s} {frame}");
        }
    }
}

#[test]
fn rates_stay_below_their_limit_where_the_target_passes_below_the_drone() {
    let (track, _) = flight(200);
    let overhead: Vec<DVec3> = vec![DVec3::new(14.0, 0.3, 12.0); 200];
    for limit_deg_s in [20.0, 60.0] {
        let config = AimConfig { max_rate_deg_s: limit_deg_s, ..AimConfig::default() };
        let poses = aimed(&overhead, &track, 0, None, &config, seed());
        for pair in poses.windows(2) {
            let turn = real::wrap_angle_rad(pair[1].yaw_rad - pair[0].yaw_rad).abs();
            let tilt = (pair[1].pitch_rad - pair[0].pitch_rad).abs();
            assert!(turn.max(tilt).to_degrees() <= 0.5 * limit_deg_s + 1e-9, "{}", turn.to_degrees());
        }
    }
}

#[test]
fn a_flight_from_the_middle_on_is_aimed_as_the_whole_one() {
    let (track, positions) = flight(120);
    let config = AimConfig::default();
    let whole = aimed(&positions, &track, 0, None, &config, seed());
    assert_eq!(aimed(&positions[70..], &track, 70, Some(whole[69]), &config, seed()), whole[70..]);
    assert_ne!(whole, aimed(&positions, &track, 0, None, &config, Seed::of_item(4, "expert", "p2")));
}

#[test]
fn values_out_of_range_are_refused_by_name() {
    assert_eq!(AimConfig::default().validate(), Ok(()));
    assert_eq!(AimConfig::exact().validate(), Ok(()));
    let (path, rule) = AimConfig { framing_deg: 40.0, ..AimConfig::default() }.validate().unwrap_err();
    assert_eq!((path.as_str(), rule.as_str()), ("framing_deg", "`framing_deg` is 40; it must be between 0 and 30"));
}
