//! The safe corridor: half-spaces around each frame in which every straight flight is free.
//!
//! For a segment and a box near it, the plane through the box's closest point separates them. If both ends of
//! the segment stay on its free side by the clearance, so does all between: swept safety by construction, for
//! turned boxes too. A plane of a box that moves goes along with it. Planes of the boxes' shadows keep the line of sight open in the same way, as wishes.

use cosfly_frames::{DVec3, TargetTrack};
use cosfly_surroundings::Surroundings;
use cosfly_surroundings::local::{GUARDED_POINTS, LocalObstacles};
use cosfly_surroundings::solid::HalfSpace;

/// Largest distance of a waypoint from the place where its planes were taken, metres.
pub const TRUST_M: f64 = 4.0;
/// The floor is this much above the lowest altitude, so that what the programme leaves open stays above that, metres.
const FLOOR_EXTRA_M: f64 = 0.2;
const MUCH_LOWER_M: f64 = 1.0;
/// Distance wished between the line of sight and the edge of a shadow, metres.
const SIGHT_MARGIN_M: f64 = 0.4;
/// A waypoint deeper in shadow than this is not pulled, metres: the way out is likely the wrong one.
const HOPELESS_M: f64 = 1.5;

/// The half-spaces of one frame.
#[derive(Clone)]
pub struct FrameCorridor {
    center: DVec3,
    /// Must hold.
    pub hard: Vec<HalfSpace>,
    /// Should hold.
    pub soft: Vec<HalfSpace>,
}

/// Inputs of a corridor.
pub struct CorridorInput<'a> {
    /// The target.
    pub track: &'a TargetTrack,
    /// Planning boxes.
    pub obstacles: &'a LocalObstacles<'a>,
    /// Distance kept from them, metres.
    pub keep_out_m: f64,
    /// Lowest altitude above the ground, metres.
    pub min_altitude_m: f64,
    /// Waypoints whose lines of sight are worth keeping.
    pub wished: &'a [DVec3],
    /// Planes found by looking at the unsimplified map, per frame.
    pub learned: &'a [Vec<HalfSpace>],
    /// The first waypoints, where they are given.
    pub head: &'a [DVec3],
    /// Planes of the first frame: sides of the sector in which flights start.
    pub start: &'a [HalfSpace],
    /// Least horizontal distance from the target, metres.
    pub min_radius_m: f64,
    /// Largest turns of yaw and pitch from frame to frame, radians.
    pub turn_rad: [f64; 2],
}

/// Builds the corridor around `waypoints`.
pub fn build(input: &CorridorInput<'_>, waypoints: &[DVec3]) -> Vec<FrameCorridor> {
    let mut corridor: Vec<FrameCorridor> =
        waypoints.iter().map(|&center| FrameCorridor { center, hard: Vec::new(), soft: Vec::new() }).collect();
    for frame in 0..waypoints.len() {
        add_separations(input, waypoints, frame, &mut corridor);
        add_floor(input, waypoints[frame], frame, &mut corridor[frame]);
        if !input.obstacles.is_to_be_lost(frame) {
            add_sight(input, waypoints[frame], frame, &mut corridor[frame]);
        }
        corridor[frame].hard.extend_from_slice(&input.learned[frame]);
    }
    if let Some(first) = corridor.first_mut() {
        first.hard.extend_from_slice(input.start);
    }
    corridor
}

fn add_separations(input: &CorridorInput<'_>, waypoints: &[DVec3], frame: usize, corridor: &mut [FrameCorridor]) {
    let last = (frame + 1).min(waypoints.len() - 1);
    let (from, to) = (waypoints[frame], waypoints[last]);
    let (low, high) = (from.min(to), from.max(to));
    let reach = input.keep_out_m + TRUST_M;
    for solid in input.obstacles.still_at(frame) {
        if solid.bounds_gap_m(low, high) > reach {
            continue;
        }
        let approach = solid.approach(from, to);
        if approach.distance_m > reach {
            continue;
        }
        let mut plane = approach.separation;
        plane.offset_m += input.keep_out_m;
        corridor[frame].hard.push(plane);
        if last != frame {
            corridor[last].hard.push(plane);
        }
    }
    for moving in input.obstacles.moving_at(frame) {
        if moving.gap_m(from, to) > reach {
            continue;
        }
        let approach = moving.approach(from, to);
        if approach.distance_m > reach {
            continue;
        }
        let mut plane = approach.separation;
        plane.offset_m += input.keep_out_m;
        corridor[frame].hard.push(plane);
        if last != frame {
            corridor[last].hard.push(moving.at_next(plane));
        }
    }
}

/// The floor is level at the height of the ground under the waypoint; a waypoint that is much lower (the
/// search found nothing better) keeps its height.
fn add_floor(input: &CorridorInput<'_>, waypoint: DVec3, frame: usize, corridor: &mut FrameCorridor) {
    let feet_z = input.track.states[frame].feet_in_world.z;
    let floor = input.obstacles.ground_z_m(waypoint.x, waypoint.y).max(feet_z) + input.min_altitude_m + FLOOR_EXTRA_M;
    corridor.hard.push(HalfSpace {
        normal: DVec3::Z,
        offset_m: if waypoint.z < floor - MUCH_LOWER_M { waypoint.z } else { floor },
    });
}

/// One plane per box: that of the body point which the box hides most.
fn add_sight(input: &CorridorInput<'_>, waypoint: DVec3, frame: usize, corridor: &mut FrameCorridor) {
    let body = input.obstacles.body(frame);
    let wished = input.wished[frame];
    let (low, high) = (body[0].min(waypoint).min(wished), body[5].max(waypoint).max(wished));
    let moving = input.obstacles.moving_at(frame).iter().filter(|it| !it.is_target).map(|it| &it.here);
    for solid in input.obstacles.still_at(frame).chain(moving) {
        if solid.bounds_gap_m(low, high) > 0.0 {
            continue;
        }
        let worst = |point: DVec3| {
            GUARDED_POINTS.iter().filter_map(|&k| solid.lit_side(body[k], point)).min_by(|a, b| a.0.total_cmp(&b.0))
        };
        let Some((mut slack, mut plane)) = worst(waypoint) else { continue };
        if slack < 0.0 {
            // From the shadow, the way back to where it was lit is better known than the nearest way out.
            if let Some(lit) = worst(wished).filter(|(wished_slack, _)| *wished_slack > 0.0) {
                (slack, plane) = (lit.1.slack_m(waypoint), lit.1);
                slack = slack.max(-HOPELESS_M);
            }
        }
        if (-HOPELESS_M..SIGHT_MARGIN_M + TRUST_M).contains(&slack) {
            plane.offset_m += SIGHT_MARGIN_M;
            corridor.soft.push(plane);
        }
    }
}

impl FrameCorridor {
    /// Hard planes alone.
    #[cfg(test)]
    pub fn for_test(center: DVec3, hard: Vec<HalfSpace>) -> Self {
        Self { center, hard, soft: Vec::new() }
    }

    /// The point that balances being near `point` with the half-spaces: hard ones hold (nearly), soft
    /// ones are approached by `soft_share` of what is missing.
    pub fn pull_in(&self, point: DVec3, soft_share: f64) -> DVec3 {
        let mut p = point;
        for plane in &self.soft {
            let missing = -plane.slack_m(p);
            if missing > 0.0 {
                p += soft_share * missing * plane.normal;
            }
        }
        p = self.center + (p - self.center).clamp_length_max(TRUST_M);
        for _ in 0..10 {
            let worst =
                self.hard.iter().map(|plane| (plane.slack_m(p), plane.normal)).min_by(|a, b| a.0.total_cmp(&b.0));
            match worst {
                Some((slack, normal)) if slack < -1e-6 => p -= slack * normal,
                _ => break,
            }
        }
        p
    }

    /// Largest violation of the hard half-spaces, metres.
    pub fn violation_m(&self, point: DVec3) -> f64 {
        self.hard.iter().map(|plane| -plane.slack_m(point)).fold(0.0, f64::max)
    }
}
