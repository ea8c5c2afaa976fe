//! `patrol`: timed waypoints are met, one after the other; the camera looks ahead.
//!
//! A smooth reference runs through all waypoints at their times. The drone is drawn to each waypoint at its time, and
//! lightly to the reference between them; the point to be watched runs below the reference, ahead of it.

use super::config::{DT_S, LONGEST_S, PatrolConfig};
use super::facade::is_free;
use super::meeting::Meeting;
use super::{Mission, POINT_HEIGHT_M, Site};
use cosfly_frames::{DVec2, DVec3, Pose, TargetState, TargetTrack, real};
use cosfly_planner::MucoConfig;
use cosfly_random::Seed;

/// Weight of a waypoint at its time.
const WEIGHT: f64 = 60.0;
/// Share of that for the reference between waypoints.
const BETWEEN_SHARE: f64 = 0.01;
/// The watched point is this far below the reference, in leads: the camera looks half down, over roofs.
const BELOW_SHARE: f64 = 0.5;
/// Weight of seeing the watched point, unless the recipe says otherwise: it only leads the camera.
const VISIBILITY_WEIGHT: f64 = 2.0;
/// Draws of a loop before giving up.
const MAX_DRAWS: u64 = 200;
/// A waypoint counts as met within this distance, metres.
pub const MET_M: f64 = 2.0;

/// The waypoints and the flight along them.
#[derive(Clone, Debug)]
pub struct Patrol {
    /// The planner's request.
    pub mission: Mission,
    /// (place in the world frame, metres; frame) of each waypoint.
    pub waypoints: Vec<(DVec3, usize)>,
}

impl Patrol {
    /// Distance of the drone from each waypoint at the waypoint's time, metres.
    pub fn shortfalls_m(&self, poses: &[Pose]) -> Vec<f64> {
        let miss = |(place, frame): &(DVec3, usize)| {
            poses.get(*frame).map_or(f64::INFINITY, |pose| pose.position_in_world.distance(*place))
        };
        self.waypoints.iter().map(miss).collect()
    }
}

/// A patrol along the configured waypoints, or along a loop drawn from the seed.
///
/// # Errors
/// When a waypoint is too near an obstacle or the ground, or no loop fits into the town.
pub fn mission(site: &Site<'_>, wanted: &PatrolConfig, config: &MucoConfig, seed: Seed) -> Result<Patrol, String> {
    let keep_m = config.limits.clearance_m;
    let waypoints = if wanted.waypoints.is_empty() {
        drawn(site, wanted, keep_m + 1.0, seed)?
    } else {
        let given = wanted.waypoints.iter().map(|[x, y, z, t]| (DVec3::new(*x, *y, *z), *t));
        given.collect()
    };
    for (index, (place, _)) in waypoints.iter().enumerate() {
        if !is_free(site, *place, keep_m) {
            return Err(format!("waypoint {index} at {place} is less than {keep_m} m from an obstacle or the ground"));
        }
    }
    Ok(along(site, &waypoints, wanted, config))
}

/// Corners round a centre in the town at even angles, give or take; the last one is the first again.
fn drawn(site: &Site<'_>, wanted: &PatrolConfig, keep_m: f64, seed: Seed) -> Result<Vec<(DVec3, f64)>, String> {
    let (low, high) = site.bounds;
    for draw in 0..MAX_DRAWS {
        let mut stream = seed.child("loop", draw).stream("corners");
        let center = DVec2::new(stream.uniform(low.x, high.x), stream.uniform(low.y, high.y));
        let start = stream.uniform(0.0, real::TAU);
        let corner = |k: u32| {
            let angle = start + real::TAU * (f64::from(k) + stream.uniform(-0.2, 0.2)) / f64::from(wanted.corners);
            let (sin, cos) = real::sin_cos(angle);
            let place = center + wanted.radius_m * stream.uniform(0.8, 1.1) * DVec2::new(cos, sin);
            let ground = (site.ground)(place.x, place.y);
            let up = stream.uniform(wanted.altitude_m[0], wanted.altitude_m[1].max(wanted.altitude_m[0] + 1e-9));
            place.extend(up + if ground.is_finite() { ground } else { 0.0 })
        };
        let mut corners: Vec<DVec3> = (0..wanted.corners).map(corner).collect();
        if corners.iter().all(|place| is_free(site, *place, keep_m)) {
            corners.push(corners[0]);
            let mut time = 0.0;
            let mut timed = vec![(corners[0], time)];
            for pair in corners.windows(2) {
                time += (pair[1].distance(pair[0]) / wanted.speed_mps / DT_S).ceil().max(1.0) * DT_S;
                timed.push((pair[1], time));
            }
            if time > LONGEST_S {
                return Err(format!("the loop takes {time} s; it must be at most {LONGEST_S} s"));
            }
            return Ok(timed);
        }
    }
    Err(format!(
        "no loop with {} free waypoints fits into the town in {MAX_DRAWS} draws: other `patrol.altitude_m`, a smaller \
         `patrol.radius_m` or fewer `patrol.corners` help",
        wanted.corners
    ))
}

/// A smooth way through timed places: cubic Hermite pieces, each slope that between the two neighbours.
struct Reference<'a> {
    waypoints: &'a [(DVec3, f64)],
    slopes: Vec<DVec3>,
}

impl<'a> Reference<'a> {
    fn new(waypoints: &'a [(DVec3, f64)]) -> Self {
        let last = waypoints.len() - 1;
        let is_loop = last > 1 && waypoints[0].0.distance(waypoints[last].0) < 1e-6;
        let between = |a: (DVec3, f64), b: (DVec3, f64)| (b.0 - a.0) / (b.1 - a.1).max(1e-9);
        let end = |time: f64| (waypoints[last - 1].0, waypoints[last - 1].1 - time);
        let slope = |k: usize| match k {
            0 if is_loop => between(end(waypoints[last].1), waypoints[1]),
            0 => between(waypoints[0], waypoints[1]),
            k if k == last && is_loop => {
                between(waypoints[last - 1], (waypoints[1].0, waypoints[1].1 + waypoints[last].1))
            }
            k if k == last => between(waypoints[last - 1], waypoints[last]),
            k => between(waypoints[k - 1], waypoints[k + 1]),
        };
        Self { waypoints, slopes: (0..=last).map(slope).collect() }
    }

    /// The place at a time; straight on after the end.
    fn at(&self, time_s: f64) -> DVec3 {
        let last = self.waypoints.len() - 1;
        let (end, end_s) = self.waypoints[last];
        if time_s >= end_s {
            return end + (time_s - end_s) * self.slopes[last];
        }
        let k = self.waypoints.partition_point(|(_, t)| *t <= time_s).clamp(1, last) - 1;
        let ((a, from), (b, to)) = (self.waypoints[k], self.waypoints[k + 1]);
        let (span, t) = (to - from, (time_s - from) / (to - from));
        let (t2, t3) = (t * t, t * t * t);
        (2.0 * t3 - 3.0 * t2 + 1.0) * a
            + (t3 - 2.0 * t2 + t) * span * self.slopes[k]
            + (3.0 * t2 - 2.0 * t3) * b
            + (t3 - t2) * span * self.slopes[k + 1]
    }
}

fn along(site: &Site<'_>, timed: &[(DVec3, f64)], wanted: &PatrolConfig, config: &MucoConfig) -> Patrol {
    let reference = Reference::new(timed);
    let end_s = timed[timed.len() - 1].1;
    let frames = (end_s / DT_S).round() as usize + 1;
    let way: f64 = timed.windows(2).map(|pair| pair[1].0.distance(pair[0].0)).sum();
    let lead_s = wanted.lead_m / (way / end_s.max(DT_S)).max(0.5);
    let places: Vec<DVec3> = (0..frames).map(|frame| reference.at(frame as f64 * DT_S)).collect();
    let watched = |frame: usize| {
        let ahead = reference.at(frame as f64 * DT_S + lead_s);
        let (ground, below) = ((site.ground)(ahead.x, ahead.y), ahead.z - BELOW_SHARE * wanted.lead_m);
        ahead.with_z(if ground.is_finite() { below.max(ground) } else { below })
    };
    let points: Vec<DVec3> = (0..=frames).map(watched).collect();
    let state = |pair: &[DVec3]| {
        let step = pair[1] - pair[0];
        TargetState {
            feet_in_world: pair[0],
            heading_rad: real::atan2(step.y, step.x),
            speed_mps: step.length() / DT_S,
        }
    };
    let states: Vec<TargetState> = points.windows(2).map(state).collect();
    let mut drawn: Vec<(DVec3, f64)> = places.iter().map(|place| (*place, BETWEEN_SHARE)).collect();
    let met = |(place, time): &(DVec3, f64)| (*place, ((time / DT_S).round() as usize).min(frames - 1));
    let waypoints: Vec<(DVec3, usize)> = timed.iter().map(met).collect();
    waypoints.iter().for_each(|(place, frame)| drawn[*frame] = (*place, 1.0));
    let heights = places.iter().zip(&states).map(|(place, state)| place.z - state.feet_in_world.z);
    let config = wishes(heights, wanted, config);
    let track = TargetTrack { dt_s: DT_S, height_m: POINT_HEIGHT_M, radius_m: 0.0, states };
    let meetings = vec![(Meeting::new("rendezvous", drawn), WEIGHT)];
    Patrol { mission: Mission { track, config, meetings }, waypoints }
}

/// The bands around the reference's own heights above the watched point.
fn wishes(heights: impl Iterator<Item = f64>, wanted: &PatrolConfig, config: &MucoConfig) -> MucoConfig {
    let (mut low, mut high, mut sum, mut count) = (f64::INFINITY, f64::NEG_INFINITY, 0.0, 0.0);
    for height in heights {
        (low, high) = (low.min(height), high.max(height));
        (sum, count) = (sum + height, count + 1.0);
    }
    let mean = sum / f64::max(count, 1.0);
    let mut config = super::agile(config);
    let view = &mut config.view;
    view.distance_m = real::hypot(mean, wanted.lead_m).clamp(2.0, 200.0);
    view.pitch_deg = real::atan2(mean, wanted.lead_m).to_degrees().clamp(5.0, 85.0);
    view.min_altitude_m = (low - 4.0).clamp(0.5, 200.0);
    view.preferred_altitude_m = high.clamp(view.min_altitude_m, 200.0);
    view.max_altitude_m = (high + 4.0).clamp(view.preferred_altitude_m, 400.0);
    view.min_radius_m = (0.3 * wanted.lead_m).max(0.5);
    view.max_radius_m = 1.8 * wanted.lead_m;
    (view.rear_sector_deg, view.start_sector_deg) = (180.0, 180.0);
    config.weights.visibility = config.weights.visibility.or(Some(VISIBILITY_WEIGHT));
    config.search.filter_radius_m = config.search.filter_radius_m.max(view.max_radius_m + 10.0);
    config
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::{OrientedBox, PlanOutcome};
    use cosfly_geometry::BoxBvh;
    use cosfly_planner::plan_request;

    fn tower(x: f64, y: f64, height: f64) -> OrientedBox {
        OrientedBox {
            center_in_world: DVec3::new(x, y, 0.5 * height),
            half_extents_m: DVec3::new(6.0, 6.0, 0.5 * height),
            yaw_rad: 0.2,
        }
    }

    fn check_met(wanted: &PatrolConfig, boxes: Vec<OrientedBox>) {
        let exact = BoxBvh::build(boxes.clone());
        let bounds = (DVec2::splat(-60.0), DVec2::splat(60.0));
        let site = Site { exact: &exact, structures: &[], ground: &|_, _| 0.0, bounds };
        let config = MucoConfig::default();
        let patrol = mission(&site, wanted, &config, Seed::of_item(2, "patrol", "f")).expect("a patrol");
        let flight = match plan_request(patrol.mission.request(&exact, &boxes, &|_, _| 0.0)) {
            PlanOutcome::Planned(flight) => *flight,
            PlanOutcome::Rejected { reason, .. } => panic!("{reason}"),
        };
        assert!(flight.certificate.holds, "{:?}", flight.certificate.violations);
        let shortfalls = patrol.shortfalls_m(&flight.poses_in_world);
        assert!(shortfalls.iter().all(|miss| *miss < MET_M), "{shortfalls:?}");
        assert!(flight.terms.iter().any(|term| term.name == "rendezvous"));
    }

    #[test]
    fn every_waypoint_is_met_at_its_time_and_towers_are_flown_round() {
        let corners =
            [[40.0, 0.0, 25.0, 0.0], [0.0, 40.0, 30.0, 14.0], [-40.0, 0.0, 25.0, 26.0], [0.0, -40.0, 22.0, 40.0]];
        let mut waypoints = corners.to_vec();
        waypoints.push([40.0, 0.0, 25.0, 54.0]);
        let wanted = PatrolConfig { waypoints, ..PatrolConfig::default() };
        check_met(&wanted, vec![]);
        check_met(&wanted, vec![tower(24.0, 24.0, 45.0), tower(-22.0, -22.0, 45.0)]);
    }

    #[test]
    fn the_shortest_patrol_that_is_allowed_is_met() {
        for (reach, seconds) in [(5.0, 3.0), (5.0, 20.0), (5.0, 100.0)] {
            let waypoints = vec![[0.0, 0.0, 30.0, 0.0], [reach, 0.0, 30.0, seconds]];
            check_met(&PatrolConfig { waypoints, ..PatrolConfig::default() }, vec![]);
        }
    }

    #[test]
    fn a_drawn_loop_is_met_too() {
        check_met(&PatrolConfig::default(), vec![tower(0.0, 0.0, 20.0)]);
    }

    #[test]
    fn a_waypoint_in_a_wall_is_named() {
        let boxes = vec![tower(0.0, 0.0, 30.0)];
        let exact = BoxBvh::build(boxes);
        let bounds = (DVec2::splat(-60.0), DVec2::splat(60.0));
        let site = Site { exact: &exact, structures: &[], ground: &|_, _| 0.0, bounds };
        let waypoints = vec![[30.0, 0.0, 25.0, 0.0], [0.0, 0.0, 25.0, 10.0]];
        let wanted = PatrolConfig { waypoints, ..PatrolConfig::default() };
        let refused = mission(&site, &wanted, &MucoConfig::default(), Seed::of_item(2, "patrol", "f")).expect_err("in");
        assert!(refused.starts_with("waypoint 1 at"), "{refused}");
    }
}
