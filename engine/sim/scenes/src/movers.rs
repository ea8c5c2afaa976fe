//! Bodies that move around a walker: people, vehicles, and things that fly at the height of drones.

use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec3, TargetTrack, real};
use cosfly_random::{RandomStream, Seed};

/// `count` boxes around a track, each given by its places frame by frame: of five, three are people, one is a vehicle and
/// one flies. They go along the walker's route, in both directions and beside it, or circle above it.
pub fn movers_around(track: &TargetTrack, count: usize, seed: Seed) -> Vec<Vec<OrientedBox>> {
    let mover = |index: usize| {
        let mut stream = seed.child("mover", index as u64).stream("way");
        match index % 5 {
            0..3 => on_foot(track, &mut stream),
            3 => vehicle(track, &mut stream),
            _ => flying(track, &mut stream),
        }
    };
    (0..count).map(mover).collect()
}

fn on_foot(track: &TargetTrack, stream: &mut RandomStream) -> Vec<OrientedBox> {
    let half_extents_m = DVec3::new(0.25, 0.25, 0.5 * stream.uniform(1.5, 1.95));
    let pace = if stream.chance(0.5) { -1.0 } else { 1.0 } * stream.uniform(0.6, 1.2);
    along(track, half_extents_m, pace, stream.uniform(0.8, 5.0), stream)
}

fn vehicle(track: &TargetTrack, stream: &mut RandomStream) -> Vec<OrientedBox> {
    let sizes_m =
        [DVec3::new(4.5, 1.9, 1.5), DVec3::new(5.9, 2.1, 2.6), DVec3::new(12.0, 2.55, 3.2), DVec3::new(1.8, 0.6, 1.7)];
    let size_m = sizes_m[stream.index(sizes_m.len())];
    let pace = if stream.chance(0.5) { -1.0 } else { 1.0 } * stream.uniform(2.0, 8.0);
    along(track, 0.5 * size_m, pace, stream.uniform(3.0, 7.0), stream)
}

/// A box on the ground that goes along the walker's route at a multiple of the walker's pace, meets the walker at some
/// frame, and stands at the route's ends.
fn along(
    track: &TargetTrack,
    half_extents_m: DVec3,
    pace: f64,
    beside_m: f64,
    stream: &mut RandomStream,
) -> Vec<OrientedBox> {
    let last = (track.len() - 1) as f64;
    let meets_at = stream.uniform(0.0, last);
    let side = if stream.chance(0.5) { beside_m } else { -beside_m };
    let ahead = stream.uniform(-12.0, 12.0);
    let place = |frame: usize| {
        let at = (meets_at + ahead + pace * (frame as f64 - meets_at)).clamp(0.0, last);
        let next = (at as usize + 1).min(track.len() - 1);
        let (state, other) = (&track.states[at as usize], &track.states[next]);
        let (sin, cos) = real::sin_cos(state.heading_rad);
        let feet = state.feet_in_world.lerp(other.feet_in_world, at.fract());
        let center_in_world = feet + side * DVec3::new(-sin, cos, 0.0) + DVec3::Z * half_extents_m.z;
        OrientedBox { center_in_world, half_extents_m, yaw_rad: state.heading_rad }
    };
    (0..track.len()).map(place).collect()
}

/// A box that circles above the walker's route, rises, sinks and turns.
fn flying(track: &TargetTrack, stream: &mut RandomStream) -> Vec<OrientedBox> {
    let mut v = |low: f64, high: f64| stream.uniform(low, high);
    let half_extents_m = DVec3::new(v(0.3, 2.5), v(0.3, 1.0), v(0.2, 1.0));
    let (radius_m, height_m, swing_m) = (v(12.0, 40.0), v(18.0, 32.0), v(0.0, 6.0));
    let (azimuth, turn, sway, spin) = (v(-3.1, 3.1), v(-0.15, 0.15), v(0.02, 0.2), v(-0.6, 0.6));
    let place = |frame: usize| {
        let time_s = frame as f64 * track.dt_s;
        let (sin, cos) = real::sin_cos(azimuth + turn * time_s);
        let up = height_m + swing_m * real::sin(sway * time_s);
        let around = DVec3::new(radius_m * cos, radius_m * sin, up);
        OrientedBox {
            center_in_world: track.states[frame].feet_in_world + around,
            half_extents_m,
            yaw_rad: real::wrap_angle_rad(azimuth + spin * time_s),
        }
    };
    (0..track.len()).map(place).collect()
}
