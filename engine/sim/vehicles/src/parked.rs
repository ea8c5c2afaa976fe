//! Cars parked along kerbs.
//!
//! They are bodies that stand, not obstacles of the town: another traffic parks other cars in the same town, with the same
//! boxes, labels and ids as cars that drive, and no town is read anew.

use crate::kinds::size_m;
use crate::network::Network;
use crate::outlines::{Solid, to_outline};
use crate::parking::{FROM_ENDS_M, Parking};
use crate::paved::{FROM_KERB_M, Paved, room_m};
use crate::route::Route;
use crate::start::is_free;
use crate::vehicle::{Doing, Vehicle};
use cosfly_domain::{BodyKind, BodyPlan, Town};
use cosfly_frames::{DVec2, Seed, real};
use cosfly_world::Snapshot;
use std::collections::BTreeMap;

/// Distance between parked cars: least and most, metres.
const BETWEEN_M: [f64; 2] = [0.8, 2.2];
/// Share of the places that are taken.
const TAKEN: f64 = 0.75;
/// Most parked cars of a town.
const MOST: usize = 2_000;

/// Adds parked cars along kerbs.
pub(crate) fn park(
    network: &Network,
    town: &Town,
    (parking, paved): (&Parking, &Paved),
    area_m: Option<[f64; 4]>,
    seed: Seed,
    vehicles: &mut Vec<Vehicle>,
) {
    let solid = Solid::new(town);
    let driving = vehicles.len();
    let driven = Driven::new(network, &parking.taken);
    let taken = parking.taken.iter().map(|number| (*number, false));
    for (number, is_beside) in taken.chain(parking.beside.iter().map(|number| (*number, true))) {
        let lane = &network.lanes[number as usize];
        let own = seed.child("parked", u64::from(number));
        let mut random = own.stream("places");
        // Cars in a street of one direction stand as the others drive.
        let turned = if !is_beside && network.inner_neighbour(number).is_none() { 0.9 } else { 0.05 };
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
            let from_crossing_m = FROM_ENDS_M + 0.5 * size_m.x;
            let is_near_crossing = lane
                .crossings
                .iter()
                .any(|it| (it.from_m - from_crossing_m..it.to_m + from_crossing_m).contains(&middle_m));
            let edge_m = if is_beside { paved.reach_m(network, lane, middle_m) } else { 0.5 * lane.width_m };
            let aside_m = network.kerb * (edge_m - 0.5 * size_m.y - FROM_KERB_M).max(0.0);
            let plan = BodyPlan { source: String::new(), kind, size_m, looks: own.child("looks", place), group: None };
            let route = Route::new(network, number, aside_m, size_m.x);
            let mut vehicle = Vehicle::new(network, plan, route, middle_m, Doing::IsParked);
            if random.chance(turned) {
                vehicle.state.heading_rad = real::wrap_angle_rad(vehicle.state.heading_rad + real::PI);
            }
            let at = vehicle.state.feet_in_world;
            let is_inside = area_m.is_none_or(|[left, top, right, bottom]| {
                (left..=right).contains(&at.x) && (top..=bottom).contains(&at.y)
            });
            if !is_taken || !is_inside || is_near_crossing {
                continue;
            }
            if is_beside {
                let Some(height_m) = paved.under(&vehicle.plan.box_at(&vehicle.state)) else { continue };
                vehicle.state.feet_in_world.z = height_m;
            }
            let shape = vehicle.plan.box_at(&vehicle.state);
            if is_free(&vehicle, vehicles, 0.3) && !solid.touches(&shape) && !driven.is_near(&vehicle) {
                vehicles.push(vehicle);
            }
        }
    }
}

/// Middle lines of the lanes that stay open, in cells, with the room that each needs, metres.
struct Driven {
    cells: BTreeMap<[i64; 2], Vec<(DVec2, f64)>>,
}

impl Driven {
    fn new(network: &Network, parking: &[u32]) -> Self {
        let mut cells: BTreeMap<[i64; 2], Vec<(DVec2, f64)>> = BTreeMap::new();
        let open = (0u32..).zip(&network.lanes).filter(|(number, _)| parking.binary_search(number).is_err());
        for (point, room_m) in open.flat_map(|(_, lane)| lane.spaced().map(|point| (point.truncate(), room_m(lane)))) {
            cells.entry(Self::cell(point)).or_default().push((point, room_m));
        }
        Self { cells }
    }

    fn cell(point: DVec2) -> [i64; 2] {
        [point.x, point.y].map(|at| (at / 8.0).floor() as i64)
    }

    /// Whether a parked car leaves too little room for those who drive past.
    fn is_near(&self, vehicle: &Vehicle) -> bool {
        let body = Snapshot::present(0, &vehicle.plan, vehicle.state);
        let [column, row] = Self::cell(vehicle.state.feet_in_world.truncate());
        let around = (-1..=1).flat_map(|x| (-1..=1).map(move |y| [column + x, row + y]));
        let mut points = around.filter_map(|cell| self.cells.get(&cell)).flatten();
        points.any(|(point, room_m)| to_outline(*point, &body).length() < *room_m)
    }
}
