//! Where vehicles begin.

use crate::config::VehicleConfig;
use crate::kinds::{draw_kind, drives_on, keeps_to_edges, size_m};
use crate::network::Network;
use crate::outlines::{Solid, meet};
use crate::route::Route;
use crate::vehicle::{BESIDE_M, Doing, Vehicle};
use cosfly_domain::{BodyKind, BodyPlan, LaneKind, Town};
use cosfly_frames::Seed;

/// Places that are tried for each vehicle.
const TRIES: u64 = 40;
/// Free space around a vehicle in the beginning, metres.
const APART_M: f64 = 2.0;
/// Distance between a bicycle and the edge of the lane, metres.
const FROM_EDGE_M: f64 = 0.35;

/// Vehicles that drive.
pub(crate) fn driving(
    network: &Network,
    town: &Town,
    config: &VehicleConfig,
    closed: &[u32],
    seed: Seed,
) -> Vec<Vehicle> {
    let solid = Solid::new(town);
    let lanes: Vec<u32> = (0u32..)
        .zip(&network.lanes)
        .filter(|(number, lane)| !lane.in_junction && lane.length_m > 8.0 && !closed.contains(number))
        .map(|(number, _)| number)
        .collect();
    // Long lanes begin more vehicles.
    let mut ends_m = vec![];
    let mut sum_m = 0.0;
    for lane in &lanes {
        sum_m += network.lanes[*lane as usize].length_m;
        ends_m.push(sum_m);
    }
    let mut vehicles: Vec<Vehicle> = vec![];
    for number in 0..u64::from(config.count) {
        let own = seed.child("vehicle", number);
        let mut random = own.stream("start");
        let kind = draw_kind(&config.mix, &mut random);
        let size_m = size_m(kind, &mut random);
        let speed_share = random.normal(config.speed_share, config.speed_deviation_share).clamp(0.2, 1.5);
        let looks = own.child("looks", 0);
        let plan = BodyPlan { source: String::new(), kind, size_m, looks, group: None };
        for _ in 0..TRIES {
            let at_m = random.unit() * sum_m;
            let place = ends_m.partition_point(|end| *end <= at_m).min(lanes.len().saturating_sub(1));
            let Some(number) = lanes.get(place) else { break };
            let lane = &network.lanes[*number as usize];
            let way_m = at_m - (ends_m[place] - lane.length_m);
            let room_m = 0.5 * size_m.x + 0.5;
            let fits = drives_on(kind, lane.kind)
                && (lane.kind == LaneKind::Biking || lane.width_m > size_m.y + 2.0 * BESIDE_M)
                && (room_m..lane.length_m - room_m).contains(&way_m);
            if !fits {
                continue;
            }
            let aside_m = aside_m(network, lane.kind, lane.width_m, kind, size_m.y);
            let route = Route::new(network, *number, aside_m, size_m.x);
            let vehicle = Vehicle::new(network, plan.clone(), route, way_m, Doing::Drives);
            let place = vehicle.state.feet_in_world;
            let is_inside = config.area_m.is_none_or(|[left, top, right, bottom]| {
                (left..=right).contains(&place.x) && (top..=bottom).contains(&place.y)
            });
            let on_crossing = lane
                .crossings
                .iter()
                .any(|crossing| (crossing.from_m - room_m - 1.0..crossing.to_m + room_m + 1.0).contains(&way_m));
            if is_inside
                && !on_crossing
                && is_free(&vehicle, &vehicles, APART_M)
                && !solid.touches(&vehicle.plan.box_at(&vehicle.state))
            {
                vehicles.push(Vehicle { speed_share, ..vehicle });
                break;
            }
        }
    }
    vehicles
}

/// Whether a vehicle keeps away from all others.
pub(crate) fn is_free(vehicle: &Vehicle, others: &[Vehicle], apart_m: f64) -> bool {
    others.iter().all(|other| !meet(&vehicle.plan, &vehicle.state, &other.plan, &other.state, apart_m))
}

/// Distance of a vehicle from the middle of its lanes to the right: bicycles ride at the edge of lanes that they share.
fn aside_m(network: &Network, lane: LaneKind, lane_m: f64, kind: BodyKind, width_m: f64) -> f64 {
    let is_shared = keeps_to_edges(kind) && lane == LaneKind::Driving;
    if is_shared { network.kerb * (0.5 * (lane_m - width_m) - FROM_EDGE_M).max(0.0) } else { 0.0 }
}
