//! Before a road: people step on it when no vehicle comes in the time that they need to cross.

use crate::WalkableGrid;
use crate::crowd::CrowdConfig;
use crate::crowd::company::{Company, is_road};
use crate::crowd::person::Person;
use cosfly_frames::{DVec2, real};
use cosfly_world::Present;

/// Nodes ahead among which a road is looked for, and the most nodes of a road.
const AHEAD_NODES: usize = 8;
const ROAD_NODES: usize = 60;

/// People wait this far before the first node of a road, metres.
const KERB_M: f64 = 0.7;

/// Vehicles slower than this let people pass, m/s.
const WAITING_MPS: f64 = 0.5;

/// Distance that people may walk before they have to wait, metres; infinite where the way is free.
pub(crate) fn free_way_m(
    grid: &WalkableGrid,
    config: &CrowdConfig,
    company: &Company,
    person: &Person,
    vehicles: &[Present],
) -> f64 {
    if vehicles.is_empty() {
        return f64::INFINITY;
    }
    let ahead = &company.route[person.progress..];
    let on_road = |node: &u32| is_road(grid.nodes[*node as usize].kind);
    let Some(first) = ahead.iter().take(AHEAD_NODES).position(on_road) else { return f64::INFINITY };
    if first == 0 {
        return f64::INFINITY;
    }
    let beyond = ahead[first..].iter().take(ROAD_NODES).position(|node| !on_road(node)).unwrap_or(ROAD_NODES);
    let [from, to] = [ahead[first], ahead[(first + beyond).min(ahead.len() - 1)]].map(|node| grid.center(node));
    let kerb_m = (from - person.at).length();
    let is_free =
        vehicles.iter().all(|vehicle| leaves_time(vehicle, from, to, kerb_m, company.cruise_mps, config.gap_s));
    if is_free { f64::INFINITY } else { (kerb_m - KERB_M).max(0.0) }
}

/// Whether a vehicle that goes on as now is not within the time `gap_s` of a person who walks `before_m` and then from one
/// place to another.
fn leaves_time(vehicle: &Present, from: DVec2, to: DVec2, before_m: f64, speed_mps: f64, gap_s: f64) -> bool {
    let along_mps = vehicle.state.speed_mps;
    if along_mps < WAITING_MPS {
        return true;
    }
    let (sin, cos) = real::sin_cos(vehicle.state.heading_rad);
    let own = |point: DVec2| {
        let offset = point - vehicle.state.feet_in_world.truncate();
        DVec2::new(cos * offset.x + sin * offset.y, cos * offset.y - sin * offset.x)
    };
    let (from, to) = (own(from), own(to));
    let half = 0.5 * vehicle.size_m.truncate() + 0.5;
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
    let places = [from + enter * step, from + leave * step];
    let (near, far) = (places[0].x.min(places[1].x), places[0].x.max(places[1].x));
    if far < -half.x {
        return true;
    }
    let vehicle_s = [(near - half.x) / along_mps, (far + half.x) / along_mps];
    let walked = |share: f64| (before_m + share * step.length()) / speed_mps.max(0.1);
    walked(leave) + gap_s < vehicle_s[0] || walked(enter) > vehicle_s[1] + gap_s
}
