//! Kerbs along which cars are parked, and what that does to the lanes there.

use crate::network::{Drive, Network};
use crate::paved::Paved;
use cosfly_domain::LaneKind;
use cosfly_frames::{Seed, real};
use std::collections::BTreeSet;

/// No car is parked so near to the end of a lane or to a crossing, metres.
pub(crate) const FROM_ENDS_M: f64 = 6.0;
/// Places along a lane, shares of its length, where room is looked for: crossings have none.
const PLACES: [f64; 5] = [0.2, 0.35, 0.5, 0.65, 0.8];
/// A way through a junction has at most so many lanes one after the other.
const MOST_IN_JUNCTION: usize = 8;

/// Kerbs along which cars are parked.
#[derive(Clone, Debug, Default)]
pub(crate) struct Parking {
    /// Lanes that parked cars take, ascending: nobody drives there.
    pub taken: Vec<u32>,
    /// Lanes beside which cars are parked, ascending.
    pub beside: Vec<u32>,
}

impl Parking {
    /// The kerbs of a town, a share of those with room.
    ///
    /// Room is beside a lane (parking lanes, shoulders, wide streets), or in a kerb lane with a further one in its direction,
    /// or in one of the two lanes of a street with traffic in both directions, which becomes a street in one direction. A lane
    /// is taken only where everybody who is led to it finds another way.
    pub fn new(network: &Network, paved: &Paved, share: f64, seed: Seed) -> Self {
        let mut parking = Self::default();
        let is_drawn = |number: &u32| seed.child("parking", u64::from(*number)).stream("parking").chance(share);
        let drawn = (0..network.lanes.len() as u32).filter(is_drawn).filter(|number| is_at_kerb(network, *number));
        let mut inner = vec![];
        for number in drawn {
            let lane = &network.lanes[number as usize];
            if !paved.is_street(network, lane, 0.5 * lane.length_m) {
                continue;
            }
            if PLACES.iter().filter(|share| paved.has_room_beside(network, lane, **share * lane.length_m)).count()
                > PLACES.len() / 2
            {
                parking.beside.push(number);
            } else if lane.width_m < 4.2 && !is_at_bicycles(network, lane) {
                inner.push(number);
            }
        }
        // A lane that is taken may free the next one along the street.
        let before = network.predecessors();
        loop {
            let waiting = inner.len();
            inner.retain(|number| {
                let may = parking.may_take(network, &before, *number);
                if may {
                    let place = parking.taken.partition_point(|taken| taken < number);
                    parking.taken.insert(place, *number);
                }
                !may
            });
            if inner.len() == waiting {
                break;
            }
        }
        parking
    }

    /// Whether a lane has an open one beside it, and nobody needs it to go on.
    fn may_take(&self, network: &Network, before: &[Vec<u32>], number: u32) -> bool {
        let is_open = |lane: &u32| self.taken.binary_search(lane).is_err();
        let is_free = |lane: &u32| *lane != number && is_open(lane);
        let beside = network.inner_neighbour(number).or_else(|| network.opposite_neighbour(number));
        beside.as_ref().is_some_and(is_open)
            && leading_to(network, before, number)
                .iter()
                .all(|lane| !is_open(lane) || goes_on(network, *lane, &is_free, MOST_IN_JUNCTION))
    }
}

/// Whether people on bicycles ride along the kerb of a lane.
fn is_at_bicycles(network: &Network, lane: &Drive) -> bool {
    let (middle, along) = lane.at(0.5 * lane.length_m);
    let car = middle.truncate() + (0.5 * lane.width_m - 1.0) * network.kerb * along.perp();
    let mut bicycles = network.lanes.iter().filter(|other| other.kind == LaneKind::Biking).flat_map(Drive::spaced);
    bicycles.any(|point| point.truncate().distance(car) < 3.5 && (point.z - middle.z).abs() < 3.0)
}

/// Whether a lane is of a roundabout or its entries: it bends by more than 30 degrees around a point within 120 m.
fn is_round(lane: &Drive) -> bool {
    let [(_, first), (_, last)] = [0.0, lane.length_m].map(|way_m| lane.at(way_m));
    let turn_rad = real::acos(first.dot(last).clamp(-1.0, 1.0));
    turn_rad > real::PI / 6.0 && lane.length_m < 120.0 * turn_rad
}

/// Whether a lane is at a kerb, and long enough for cars.
fn is_at_kerb(network: &Network, number: u32) -> bool {
    let lane = &network.lanes[number as usize];
    lane.kind == LaneKind::Driving
        && !lane.in_junction
        && lane.length_m > 3.0 * FROM_ENDS_M
        && !is_round(lane)
        && network.outer_neighbour(number).is_none()
}

/// Lanes outside of junctions from which ways lead to a lane, through no other lane outside of junctions.
fn leading_to(network: &Network, before: &[Vec<u32>], number: u32) -> BTreeSet<u32> {
    let (mut found, mut passed, mut open) = (BTreeSet::new(), BTreeSet::new(), vec![number]);
    while let Some(next) = open.pop() {
        for lane in &before[next as usize] {
            if !network.lanes[*lane as usize].in_junction {
                found.insert(*lane);
            } else if passed.insert(*lane) {
                open.push(*lane);
            }
        }
    }
    found
}

/// Whether a lane leads to one beyond the junction that is free.
fn goes_on(network: &Network, lane: u32, is_free: &impl Fn(&u32) -> bool, most: usize) -> bool {
    let Drive { successors, is_exit, .. } = &network.lanes[lane as usize];
    let leads_on = |next: &u32| match network.lanes[*next as usize].in_junction {
        true => most > 0 && goes_on(network, *next, is_free, most - 1),
        false => is_free(next),
    };
    *is_exit || successors.iter().any(leads_on)
}
