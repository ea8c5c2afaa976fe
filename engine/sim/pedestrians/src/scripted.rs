//! Scripted people: waypoints with optional times, joined by routes over the walkable ground.

use crate::motion::ArcPath;
use crate::route::{LONE_COSTS, RouteSearch};
use crate::smooth::smooth;
use crate::{PedestrianConfig, PedestrianConfigRule, PedestrianError, WalkableGrid};
use cosfly_domain::{Body, BodyKind, BodyPlan};
use cosfly_frames::{DVec2, DVec3, Seed, TargetState};
use cosfly_world::{Clock, Prescribed};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Acceleration and deceleration at the ends of a leg at which the person stands, m/s2.
const BRAKING_MPS2: f64 = 0.8;

/// Distance from a waypoint to walkable ground, in cells, that is bridged.
const REACH_CELLS: isize = 4;

/// One scripted person.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ScriptedPerson {
    /// Name in tables.
    pub id: String,
    /// Places in the order in which the person visits them; at least one.
    pub route: Vec<Waypoint>,
    /// Speed of legs without times, m/s. Default 1.34.
    #[serde(default = "speed_mps")]
    #[schemars(range(min = 0.05, max = 10.0))]
    pub speed_mps: f64,
    /// Body height, metres. Default 1.75.
    #[serde(default = "height_m")]
    #[schemars(range(min = 0.5, max = 3.0))]
    pub height_m: f64,
    /// Body radius seen from above, metres; not above the crowd's largest. Default 0.25.
    #[serde(default = "radius_m")]
    #[schemars(range(min = 0.05, max = 2.0))]
    pub radius_m: f64,
}

/// A place that a scripted person visits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Waypoint {
    /// World place: x, y, metres; moved to walkable ground where that is within two metres or so.
    pub at_m: [f64; 2],
    /// Time of arrival, seconds since the first frame. Without it, the person walks at `speed_mps`.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub time_s: Option<f64>,
    /// Time for which the person stands there, seconds. Default 0.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub wait_s: f64,
}

fn speed_mps() -> f64 {
    1.34
}

fn height_m() -> f64 {
    1.75
}

fn radius_m() -> f64 {
    0.25
}

impl ScriptedPerson {
    /// Checks the ranges and the rules between values.
    ///
    /// # Errors
    /// The first broken rule.
    pub fn check(&self) -> Result<(), PedestrianConfigRule> {
        PedestrianConfigRule::within(&["speed_mps"], self.speed_mps, 0.05, 10.0)?;
        PedestrianConfigRule::within(&["height_m"], self.height_m, 0.5, 3.0)?;
        PedestrianConfigRule::within(&["radius_m"], self.radius_m, 0.05, 2.0)?;
        if self.route.is_empty() {
            let message = format!("the route of `{}` has no waypoint; it needs at least one", self.id);
            return Err(PedestrianConfigRule { path: vec!["route"], message });
        }
        let mut before_s = 0.0;
        for point in &self.route {
            PedestrianConfigRule::within(&["route", "at_m"], point.at_m[0], -1e7, 1e7)?;
            PedestrianConfigRule::within(&["route", "at_m"], point.at_m[1], -1e7, 1e7)?;
            PedestrianConfigRule::within(&["route", "wait_s"], point.wait_s, 0.0, 1e6)?;
            if let Some(time_s) = point.time_s {
                PedestrianConfigRule::within(&["route", "time_s"], time_s, before_s, 1e6)?;
                before_s = time_s;
            }
            before_s += point.wait_s;
        }
        Ok(())
    }
}

/// Why a script cannot be played.
fn impossible(person: &ScriptedPerson, waypoint: usize, problem: String) -> PedestrianError {
    let message = format!("waypoint {} of `{}` {problem}", waypoint + 1, person.id);
    PedestrianError::Config(PedestrianConfigRule { path: vec!["route"], message })
}

/// Problem of a place off the ground, in words: the nearest place that is on it.
fn off_ground(at: DVec2, grid: &WalkableGrid) -> String {
    let places = (0..grid.len() as u32).map(|node| grid.center(node));
    let nearest = places.min_by(|a, b| (*a - at).length().total_cmp(&(*b - at).length())).unwrap_or(at);
    format!("at ({}, {}) is not on walkable ground; the nearest is at ({:.1}, {:.1})", at.x, at.y, nearest.x, nearest.y)
}

/// Plays scripts over the ground of a town. Everybody is present in all frames: standing at the first waypoint before its time,
/// and at the last one after the script.
///
/// # Errors
/// When a rule is broken, a waypoint is off the ground, or a leg would have to be run faster than `fastest_mps`.
pub fn scripted(
    people: &[ScriptedPerson],
    grid: &WalkableGrid,
    fastest_mps: f64,
    clock: Clock,
    seed: Seed,
) -> Result<Prescribed, PedestrianError> {
    let mut search = RouteSearch::new(grid, PedestrianConfig::default().edge_distance_m, LONE_COSTS, 0.0, seed);
    let mut bodies = Vec::with_capacity(people.len());
    for (number, person) in people.iter().enumerate() {
        person.check()?;
        let timeline = Timeline::of(person, grid, &mut search, fastest_mps)?;
        let size_m = DVec3::new(2.0 * person.radius_m, 2.0 * person.radius_m, person.height_m);
        let looks = seed.child("scripted", number as u64);
        let plan = BodyPlan { source: person.id.clone(), kind: BodyKind::Pedestrian, size_m, looks, group: None };
        let states = (0..clock.frames).map(|frame| timeline.state(f64::from(frame) * clock.dt_s, grid));
        bodies.push(Body { plan, first_frame: 0, states: states.collect() });
    }
    Ok(Prescribed::new(bodies, clock.dt_s, vec![]))
}

/// One leg: where it begins and ends along the path, when, and at which of its ends the person stands.
#[derive(Clone, Copy, Debug)]
struct Leg {
    from_s: f64,
    to_s: f64,
    from_m: f64,
    length_m: f64,
    stands: [bool; 2],
}

impl Leg {
    fn ramps(stands: [bool; 2]) -> f64 {
        stands.iter().filter(|stands| **stands).count() as f64
    }

    /// Distance and speed at a time within the leg: even speed, with ramps at the ends where the person stands.
    fn at(&self, time_s: f64) -> (f64, f64) {
        let whole_s = (self.to_s - self.from_s).max(1e-9);
        let time_s = (time_s - self.from_s).clamp(0.0, whole_s);
        let ramps = Self::ramps(self.stands);
        // length = v (T - ramps v / 2a); the ramps are steeper where the time is too short for them.
        let steepest = (2.0 * ramps * self.length_m / (whole_s * whole_s)).max(BRAKING_MPS2);
        let cruise_mps = match ramps {
            0.0 => self.length_m / whole_s,
            _ => {
                (whole_s - (whole_s * whole_s - 2.0 * ramps * self.length_m / steepest).max(0.0).sqrt()) * steepest
                    / ramps
            }
        };
        let ramp_s = cruise_mps / steepest;
        let rest_s = whole_s - time_s;
        match self.stands {
            [true, _] if time_s < ramp_s => (0.5 * steepest * time_s * time_s, steepest * time_s),
            [_, true] if rest_s < ramp_s => (self.length_m - 0.5 * steepest * rest_s * rest_s, steepest * rest_s),
            [first, _] => (cruise_mps * (time_s - if first { 0.5 * ramp_s } else { 0.0 }), cruise_mps),
        }
    }
}

/// The path of a person and its legs.
struct Timeline {
    path: ArcPath,
    legs: Vec<Leg>,
}

impl Timeline {
    fn of(
        person: &ScriptedPerson,
        grid: &WalkableGrid,
        search: &mut RouteSearch<&WalkableGrid>,
        fastest_mps: f64,
    ) -> Result<Self, PedestrianError> {
        let route = &person.route;
        let mut nodes = vec![];
        for (waypoint, point) in route.iter().enumerate() {
            let at = DVec2::from_array(point.at_m);
            let node = (0..grid.components.len() as u32).filter_map(|piece| grid.node_near(at, piece, REACH_CELLS));
            let nearest =
                node.min_by(|a, b| (grid.center(*a) - at).length().total_cmp(&(grid.center(*b) - at).length()));
            nodes.push(nearest.ok_or_else(|| impossible(person, waypoint, off_ground(at, grid)))?);
        }
        let mut points = vec![grid.center(nodes[0])];
        let mut legs = vec![];
        let mut now_s = route[0].time_s.unwrap_or(0.0) + route[0].wait_s;
        let mut stands_before = true;
        for waypoint in 1..route.len() {
            let way = search.find(nodes[waypoint - 1], nodes[waypoint], &[]);
            let unreached = || impossible(person, waypoint, "cannot be reached over the walkable ground".into());
            let way: Vec<DVec2> = way.ok_or_else(unreached)?.into_iter().map(|node| grid.center(node)).collect();
            let from_m = ArcPath::new(points.clone()).length_m();
            points.extend(smooth(grid, &way, PedestrianConfig::default().simplify_m).into_iter().skip(1));
            let length_m = ArcPath::new(points.clone()).length_m() - from_m;
            let stands = [stands_before, route[waypoint].wait_s > 0.0 || waypoint + 1 == route.len()];
            let own_s = length_m / person.speed_mps + 0.5 * Leg::ramps(stands) * person.speed_mps / BRAKING_MPS2;
            let to_s = route[waypoint].time_s.unwrap_or(now_s + own_s);
            let needed_mps = length_m / (to_s - now_s).max(1e-9);
            if needed_mps > fastest_mps && route[waypoint].time_s.is_some() {
                let problem = format!(
                    "is {length_m:.1} m away and asked for {:.1} s later, at {needed_mps:.1} m/s; at most {fastest_mps} m/s are allowed",
                    to_s - now_s
                );
                return Err(impossible(person, waypoint, problem));
            }
            legs.push(Leg { from_s: now_s, to_s, from_m, length_m, stands });
            now_s = to_s + route[waypoint].wait_s;
            stands_before = stands[1];
        }
        Ok(Self { path: ArcPath::new(points), legs })
    }

    fn state(&self, time_s: f64, grid: &WalkableGrid) -> TargetState {
        let (mut along_m, mut speed_mps) = (0.0, 0.0);
        for leg in self.legs.iter().filter(|leg| leg.from_s <= time_s) {
            let (walked_m, now_mps) = leg.at(time_s);
            (along_m, speed_mps) = (leg.from_m + walked_m, if time_s < leg.to_s { now_mps } else { 0.0 });
        }
        let (feet_in_world, _) = grid.feet_at(self.path.at(along_m));
        TargetState { feet_in_world, heading_rad: self.path.heading_rad(along_m), speed_mps }
    }
}
