//! [`Route`]: the lanes that a vehicle drives along, and places on them.

use crate::network::{BEND_M, Drive, Network};
use cosfly_frames::{DVec2, DVec3, RandomStream, TargetState, real};

/// Axles lie this far from the middle, as a share of the length.
const AXLE_SHARE: f64 = 0.3;
/// Drivers round the corners of lanes: an axle is at the mean of places around its way, metres and weights. They reach as far as
/// the bends that speeds are chosen for.
const ROUNDED: [(f64, f64); 5] =
    [(-0.5 * BEND_M, 0.125), (-0.25 * BEND_M, 0.25), (0.0, 0.25), (0.25 * BEND_M, 0.25), (0.5 * BEND_M, 0.125)];
/// Routes are drawn so far ahead, metres.
const AHEAD_M: f64 = 120.0;
/// Lanes that lead farther are preferred, metres.
const LEADS_M: f64 = 250.0;

/// Lanes one after the other; ways count from the beginning of the first.
#[derive(Clone, Debug)]
pub(crate) struct Route {
    pub lanes: Vec<u32>,
    /// Where each lane begins, metres.
    pub starts_m: Vec<f64>,
    /// Where the last one ends, metres.
    pub end_m: f64,
    /// Distance from the lanes' middle to the right, metres.
    pub aside_m: f64,
}

impl Route {
    pub fn new(network: &Network, lane: u32, aside_m: f64) -> Self {
        let end_m = network.lanes[lane as usize].length_m;
        Self { lanes: vec![lane], starts_m: vec![0.0], end_m, aside_m }
    }

    /// Draws further lanes until the route reaches far enough beyond a way, or nothing follows. Lanes that lead far and are at least
    /// `width_m` wide are preferred.
    pub fn extend(&mut self, network: &Network, way_m: f64, width_m: f64, random: &mut RandomStream) {
        while self.end_m < way_m + AHEAD_M {
            let last = &network.lanes[self.lanes[self.lanes.len() - 1] as usize];
            let is_good = |next: &&u32| {
                let lane = &network.lanes[**next as usize];
                lane.leads_m >= LEADS_M && lane.width_m >= width_m
            };
            let next = match last.successors.iter().filter(is_good).count() {
                0 if last.successors.is_empty() => None,
                0 => last.successors.get(random.index(last.successors.len())),
                count => last.successors.iter().filter(is_good).nth(random.index(count)),
            };
            let Some(next) = next.copied() else { return };
            self.lanes.push(next);
            self.starts_m.push(self.end_m);
            self.end_m += network.lanes[next as usize].length_m;
        }
    }

    /// Index in the route of the lane at a way.
    pub fn index(&self, way_m: f64) -> usize {
        self.starts_m.partition_point(|start| *start <= way_m).saturating_sub(1)
    }

    /// Lane at a way, and the way along that lane.
    pub fn lane<'n>(&self, network: &'n Network, way_m: f64) -> (&'n Drive, f64) {
        let index = self.index(way_m);
        (&network.lanes[self.lanes[index] as usize], way_m - self.starts_m[index])
    }

    /// Point and direction at a way.
    pub fn at(&self, network: &Network, way_m: f64) -> (DVec3, DVec2) {
        let (lane, own_m) = self.lane(network, way_m);
        let (point, along) = lane.at(own_m);
        (point + (self.aside_m * along.perp()).extend(0.0), along)
    }

    /// Place of an axle whose way is given.
    fn axle(&self, network: &Network, way_m: f64) -> DVec3 {
        ROUNDED.iter().map(|(offset_m, weight)| *weight * self.at(network, way_m + offset_m).0).sum()
    }

    /// State of a vehicle whose middle is at a way: its axles lie on the rounded route.
    pub fn state(&self, network: &Network, way_m: f64, length_m: f64, speed_mps: f64) -> TargetState {
        let axle_m = AXLE_SHARE * length_m;
        let [rear, front] = [-axle_m, axle_m].map(|offset| self.axle(network, way_m + offset));
        let ahead = (front - rear).truncate();
        let ahead = if ahead.length_squared() > 1e-6 { ahead } else { self.at(network, way_m).1 };
        TargetState { feet_in_world: 0.5 * (rear + front), heading_rad: real::atan2(ahead.y, ahead.x), speed_mps }
    }
}
