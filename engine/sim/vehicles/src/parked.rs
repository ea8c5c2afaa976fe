//! Cars parked along kerbs.
//!
//! They are bodies that stand, not obstacles of the town: another traffic parks other cars in the same town, with the same
//! boxes, labels and ids as cars that drive, and no town is read anew. A kerb lane with parked cars is closed to traffic.

use crate::kinds::size_m;
use crate::network::Network;
use crate::outlines::Solid;
use crate::route::Route;
use crate::start::is_free;
use crate::vehicles::{Doing, Vehicle};
use cosfly_frames::{Seed, real};
use cosfly_maps::{LaneKind, Town};
use cosfly_world::{BodyKind, BodyPlan};

/// Distance between parked cars: least and most, metres.
const BETWEEN_M: [f64; 2] = [0.8, 2.2];
/// No car is parked so near to the end of a lane or to a crossing, metres.
const FROM_ENDS_M: f64 = 8.0;
/// Distance from the kerb, metres.
const FROM_KERB_M: f64 = 0.2;
/// Share of the places that are taken.
const TAKEN: f64 = 0.75;
/// Most parked cars of a town.
const MOST: usize = 2_000;

/// Kerb lanes in which cars are parked, ascending.
pub(crate) fn parking_lanes(network: &Network, share: f64, seed: Seed) -> Vec<u32> {
    if share <= 0.0 {
        return vec![];
    }
    let is_parked = |number: &u32| {
        let lane = &network.lanes[*number as usize];
        lane.kind == LaneKind::Driving
            && !lane.in_junction
            && lane.length_m > 3.0 * FROM_ENDS_M
            && lane.width_m < 4.2
            && network.inner_neighbour(*number).is_some()
            && network.outer_neighbour(*number).is_none()
            && seed.child("parking", u64::from(*number)).stream("parking").chance(share)
    };
    (0..network.lanes.len() as u32).filter(is_parked).collect()
}

/// Adds parked cars, along the kerbs of `parking`.
pub(crate) fn park(
    network: &Network,
    town: &Town,
    parking: &[u32],
    area_m: Option<[f64; 4]>,
    seed: Seed,
    vehicles: &mut Vec<Vehicle>,
) {
    let solid = Solid::new(town);
    let driving = vehicles.len();
    for number in parking {
        let lane = &network.lanes[*number as usize];
        let own = seed.child("parked", u64::from(*number));
        let mut random = own.stream("places");
        let mut way_m = FROM_ENDS_M;
        for place in 0.. {
            let kind = if random.chance(0.9) { BodyKind::Car } else { BodyKind::Van };
            let size_m = size_m(kind, &mut random);
            let middle_m = way_m + 0.5 * size_m.x;
            way_m += size_m.x + random.uniform(BETWEEN_M[0], BETWEEN_M[1]);
            let is_taken = random.chance(TAKEN);
            if middle_m + 0.5 * size_m.x > lane.length_m - FROM_ENDS_M || vehicles.len() - driving >= MOST {
                break;
            }
            let is_near_crossing =
                lane.crossings.iter().any(|it| (it.from_m - FROM_ENDS_M..it.to_m + FROM_ENDS_M).contains(&middle_m));
            let aside_m = network.kerb * (0.5 * (lane.width_m - size_m.y) - FROM_KERB_M).max(0.0);
            let plan = BodyPlan { source: String::new(), kind, size_m, looks: own.child("looks", place), group: None };
            let route = Route::new(network, *number, aside_m);
            let mut vehicle = Vehicle::new(network, plan, route, middle_m, Doing::IsParked);
            // Some are parked the other way round.
            if random.chance(0.05) {
                vehicle.state.heading_rad = real::wrap_angle_rad(vehicle.state.heading_rad + real::PI);
            }
            let at = vehicle.state.feet_in_world;
            let is_inside = area_m.is_none_or(|[left, top, right, bottom]| {
                (left..=right).contains(&at.x) && (top..=bottom).contains(&at.y)
            });
            let has_room = is_free(&vehicle, vehicles, 0.3) && !solid.touches(&vehicle.plan.box_at(&vehicle.state));
            if is_taken && is_inside && !is_near_crossing && has_room {
                vehicles.push(vehicle);
            }
        }
    }
}
