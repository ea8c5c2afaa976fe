//! Roads: people step on one when no vehicle comes in the time that they need to cross, and on it they wait for a vehicle
//! that would hit them if they went on.

use crate::WalkableGrid;
use crate::crowd::CrowdConfig;
use crate::crowd::company::{Company, is_road};
use crate::crowd::person::{HARDEST_MPS2, Person};
use cosfly_frames::{DVec2, real};
use cosfly_world::Present;

/// Nodes ahead among which a road is looked for, and the most nodes of a road.
const AHEAD_NODES: usize = 8;
const ROAD_NODES: usize = 60;

/// People wait this far before the first node of a road, metres.
const KERB_M: f64 = 0.7;

/// Steps ahead at which a kerb is looked for: their length, metres, and number.
const PROBE_M: f64 = 0.4;
const PROBES: i32 = 9;

/// Speeds at which a person on a road goes on or back, as multiples of the own one, in order of preference; and the one of the
/// way straight out of a vehicle's lane.
const ESCAPES: [f64; 4] = [1.0, 1.5, 0.0, -1.0];
const ASIDE: f64 = 1.5;

/// Vehicles slower than this let people pass, m/s.
const WAITING_MPS: f64 = 0.5;

/// On a road, people look so far ahead, seconds, and keep so far from vehicles, metres; this near where there is no other way.
const LOOK_S: f64 = 4.0;
const KEEP_M: f64 = 0.6;
const NEAR_M: f64 = 0.1;

/// Right that a person has on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Right {
    /// Walk on.
    Free,
    /// On a road: walk on and wait for nobody.
    Cross,
    /// Walk on to a kerb so many metres away and wait.
    Wait(f64),
    /// On a road with vehicles near: walk at once with this velocity, as a multiple of the own speed.
    Escape(DVec2),
}

/// Right that the vehicles leave to a person who walks `ahead` (a unit vector).
pub(crate) fn right(
    grid: &WalkableGrid,
    config: &CrowdConfig,
    company: &Company,
    person: &Person,
    ahead: DVec2,
    vehicles: &[Present],
) -> Right {
    if vehicles.is_empty() {
        return Right::Free;
    }
    if grid.kind_at(person.at).is_some_and(is_road) {
        return escape(company, person, ahead, vehicles);
    }
    let route = &company.route[person.progress..];
    let on_road = |node: &u32| is_road(grid.nodes[*node as usize].kind);
    let Some(first) = route.iter().take(AHEAD_NODES).position(on_road) else { return Right::Free };
    let beyond = route[first..].iter().take(ROAD_NODES).position(|node| !on_road(node)).unwrap_or(ROAD_NODES);
    let [from, to] = [route[first], route[(first + beyond).min(route.len() - 1)]].map(|node| grid.center(node));
    // The kerb may be nearer than the route's own place at it.
    let is_on_road = |step: &i32| grid.kind_at(person.at + PROBE_M * f64::from(*step) * ahead).is_some_and(is_road);
    let probed_m = (1..=PROBES).find(is_on_road).map_or(f64::INFINITY, |step| PROBE_M * f64::from(step));
    let kerb_m = (from - person.at).length().min(probed_m);
    let crossing = Crossing { from, to, before_m: kerb_m, speed_mps: company.cruise_mps.max(0.1) };
    match vehicles.iter().all(|vehicle| crossing.is_clear_of(vehicle, config.gap_s)) {
        true => Right::Free,
        false => Right::Wait((kerb_m - KERB_M).max(0.0)),
    }
}

/// The first way of going on a road that no vehicle hits; the one that is hit last where all are.
fn escape(company: &Company, person: &Person, ahead: DVec2, vehicles: &[Present]) -> Right {
    let mut best = (ahead, 0.0);
    for keep_m in [KEEP_M, NEAR_M] {
        let Some((vehicle, _)) = first_hit(person, DVec2::ZERO, vehicles, keep_m) else { return Right::Cross };
        let (sin, cos) = real::sin_cos(vehicle.state.heading_rad);
        let aside = [ASIDE, -ASIDE].map(|share| share * DVec2::new(sin, -cos));
        best = (ahead, 0.0);
        for way in ESCAPES.into_iter().map(|share| share * ahead).chain(aside) {
            match first_hit(person, way * company.cruise_mps, vehicles, keep_m) {
                None => return Right::Escape(way),
                Some((_, hit_s)) if hit_s > best.1 => best = (way, hit_s),
                Some(_) => {}
            }
        }
    }
    Right::Escape(best.0)
}

/// The vehicle that first comes too near to a person who takes on a velocity as fast as people can, and when, seconds.
fn first_hit<'a>(
    person: &Person,
    velocity_mps: DVec2,
    vehicles: &'a [Present],
    keep_m: f64,
) -> Option<(&'a Present, f64)> {
    let change_mps = person.velocity_mps - velocity_mps;
    let from = person.at + change_mps * (0.5 * change_mps.length() / HARDEST_MPS2);
    let reach_m = person.radius_m + keep_m;
    let hits = vehicles.iter().filter_map(|vehicle| Some((vehicle, hit_s(vehicle, from, velocity_mps, reach_m)?)));
    hits.filter(|(_, hit_s)| *hit_s < LOOK_S).min_by(|one, other| one.1.total_cmp(&other.1))
}

/// Offset from a vehicle's middle along and across it.
fn beside(vehicle: &Present, point: DVec2) -> DVec2 {
    turned(vehicle, point - vehicle.state.feet_in_world.truncate())
}

/// A vector along and across a vehicle.
fn turned(vehicle: &Present, vector: DVec2) -> DVec2 {
    let (sin, cos) = real::sin_cos(vehicle.state.heading_rad);
    DVec2::new(cos * vector.x + sin * vector.y, cos * vector.y - sin * vector.x)
}

/// Time after which a place that moves is within `reach_m` of a vehicle that goes on as now, seconds.
fn hit_s(vehicle: &Present, at: DVec2, velocity_mps: DVec2, reach_m: f64) -> Option<f64> {
    let half = 0.5 * vehicle.size_m.truncate() + reach_m;
    let place = beside(vehicle, at);
    let closing = turned(vehicle, velocity_mps) - DVec2::new(vehicle.state.speed_mps, 0.0);
    let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
    for axis in 0..2 {
        let (at, speed, half) = (place[axis], closing[axis], half[axis]);
        if speed.abs() < 1e-9 {
            if at.abs() > half {
                return None;
            }
            continue;
        }
        let times = [(-half - at) / speed, (half - at) / speed];
        enter = enter.max(times[0].min(times[1]));
        leave = leave.min(times[0].max(times[1]));
    }
    (enter <= leave).then_some(enter)
}

/// A way over a road.
struct Crossing {
    from: DVec2,
    to: DVec2,
    /// Distance to its beginning, metres.
    before_m: f64,
    speed_mps: f64,
}

impl Crossing {
    /// Whether a vehicle that goes on as now is away from the way by the time `gap_s` before and after the person.
    fn is_clear_of(&self, vehicle: &Present, gap_s: f64) -> bool {
        let along_mps = vehicle.state.speed_mps;
        if along_mps < WAITING_MPS {
            return true;
        }
        let (from, to) = (beside(vehicle, self.from), beside(vehicle, self.to));
        let half = 0.5 * vehicle.size_m.truncate() + KEEP_M;
        // Part of the way that lies in the vehicle's lane.
        let step = to - from;
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        if step.y.abs() > 1e-9 {
            let (a, b) = ((-half.y - from.y) / step.y, (half.y - from.y) / step.y);
            (enter, leave) = (enter.max(a.min(b)), leave.min(a.max(b)));
        } else if from.y.abs() > half.y {
            return true;
        }
        if enter > leave {
            return true;
        }
        let places = [from.x + enter * step.x, from.x + leave * step.x];
        let (near, far) = (places[0].min(places[1]), places[0].max(places[1]));
        if far < -half.x {
            return true;
        }
        let vehicle_s = [(near - half.x) / along_mps, (far + half.x) / along_mps];
        let walked_s = |share: f64| (self.before_m + share * step.length()) / self.speed_mps;
        walked_s(leave) + gap_s < vehicle_s[0] || walked_s(enter) > vehicle_s[1] + gap_s
    }
}
