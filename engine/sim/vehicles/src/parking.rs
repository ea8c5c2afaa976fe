//! Kerbs along which cars are parked, and what that does to the lanes there.

use crate::network::{Drive, Network};
use crate::paved::Paved;
use cosfly_domain::LaneKind;
use cosfly_frames::Seed;
use std::collections::BTreeSet;

/// No car is parked so near to the end of a lane or to a crossing, metres.
pub(crate) const FROM_ENDS_M: f64 = 6.0;
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
    /// or in one of the two lanes of a street with traffic in both directions, which becomes a street in one direction.
    pub fn new(network: &Network, paved: &Paved, share: f64, seed: Seed) -> Self {
        let mut parking = Self::default();
        let before = network.predecessors();
        for number in 0..network.lanes.len() as u32 {
            let lane = &network.lanes[number as usize];
            let is_drawn = seed.child("parking", u64::from(number)).stream("parking").chance(share);
            if !is_drawn || !is_at_kerb(network, number) || !paved.is_street(network, lane, 0.5 * lane.length_m) {
                continue;
            }
            if paved.has_room_beside(network, lane, 0.5 * lane.length_m) {
                parking.beside.push(number);
            } else if lane.width_m < 4.2
                && (network.inner_neighbour(number).is_some() || parking.may_turn_one_way(network, &before, number))
            {
                parking.taken.push(number);
            }
        }
        parking
    }

    /// Whether a lane has an open one in the other direction beside it, and nobody needs it to go on.
    fn may_turn_one_way(&self, network: &Network, before: &[Vec<u32>], number: u32) -> bool {
        let is_open = |lane: &u32| self.taken.binary_search(lane).is_err();
        let is_free = |lane: &u32| *lane != number && is_open(lane);
        let leading = leading_to(network, before, number);
        network.opposite_neighbour(number).as_ref().is_some_and(is_open)
            && leading.iter().all(|lane| !is_open(lane) || goes_on(network, *lane, &is_free, MOST_IN_JUNCTION))
    }
}

/// Whether a lane is at a kerb, and long enough for cars.
fn is_at_kerb(network: &Network, number: u32) -> bool {
    let lane = &network.lanes[number as usize];
    lane.kind == LaneKind::Driving
        && !lane.in_junction
        && lane.length_m > 3.0 * FROM_ENDS_M
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
