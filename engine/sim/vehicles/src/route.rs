//! [`Route`]: the lanes that a vehicle drives along, and places on them.

use crate::network::{Drive, Network};
use cosfly_frames::{DVec2, DVec3, RandomStream, TargetState, real};

/// Axles lie this far from the middle, as a share of the length.
const AXLE_SHARE: f64 = 0.3;
/// Drivers round the corners of lanes over this length: an axle is at the mean of places around its way, metres.
const ROUNDED_M: f64 = 3.0;
/// Number of these places, evenly spaced.
const ROUNDED: u32 = 12;
/// Bends are measured at places so far apart, metres.
const MEASURED_M: f64 = 0.5;
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
    aside_m: f64,
    /// Distance of the axles from the middle of the vehicle, metres.
    axle_m: f64,
    /// How much the vehicle turns, or the way of its middle where that is more, at places [`MEASURED_M`] apart, 1/m.
    bends: Vec<f64>,
}

impl Route {
    /// The route of a vehicle so long, which begins with a lane.
    pub fn new(network: &Network, lane: u32, aside_m: f64, length_m: f64) -> Self {
        let end_m = network.lanes[lane as usize].length_m;
        Self { lanes: vec![lane], starts_m: vec![0.0], end_m, aside_m, axle_m: AXLE_SHARE * length_m, bends: vec![] }
    }

    /// Draws further lanes until the route reaches far enough beyond a way, or nothing follows. Lanes that lead far and are at least
    /// `width_m` wide are preferred.
    pub fn extend(&mut self, network: &Network, way_m: f64, width_m: f64, random: &mut RandomStream) {
        let mut is_at_end = false;
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
            let Some(next) = next.copied() else {
                is_at_end = true;
                break;
            };
            self.lanes.push(next);
            self.starts_m.push(self.end_m);
            self.end_m += network.lanes[next as usize].length_m;
        }
        self.measure(network, if is_at_end { self.end_m } else { self.known_m() });
    }

    /// Forgets the lanes from an index on; the first one stays.
    pub fn shorten(&mut self, network: &Network, count: usize) {
        let count = count.clamp(1, self.lanes.len());
        self.lanes.truncate(count);
        self.starts_m.truncate(count);
        self.end_m = self.starts_m[count - 1] + network.lanes[self.lanes[count - 1] as usize].length_m;
        self.bends.truncate((self.known_m() / MEASURED_M) as usize);
    }

    /// Way up to which bends do not depend on lanes that will follow, metres.
    fn known_m(&self) -> f64 {
        (self.end_m - self.axle_m - ROUNDED_M).max(0.0)
    }

    /// Measures the bends up to a way.
    fn measure(&mut self, network: &Network, to_m: f64) {
        for place in self.bends.len()..(to_m / MEASURED_M) as usize {
            let [before, here, after] = [-1.0, 0.0, 1.0].map(|step| {
                let [rear, front] = self.axles(network, MEASURED_M * (place as f64 + step));
                (0.5 * (rear + front).truncate(), (front - rear).truncate())
            });
            let turn_rad = real::atan2(before.1.perp_dot(after.1), before.1.dot(after.1));
            let change = (after.0 - here.0) - (here.0 - before.0);
            let aside_m = change.perp_dot((after.0 - before.0).normalize_or_zero());
            let bend = (aside_m / (MEASURED_M * MEASURED_M)).abs().max((turn_rad / (2.0 * MEASURED_M)).abs());
            self.bends.push(bend);
        }
    }

    /// Largest curvature between a way and another one so far ahead, 1/m.
    pub fn curvature(&self, way_m: f64, ahead_m: f64) -> f64 {
        let place = |way_m: f64| (way_m.max(0.0) / MEASURED_M) as usize;
        let places = place(way_m)..(place(way_m + ahead_m) + 2).min(self.bends.len());
        self.bends.get(places).unwrap_or_default().iter().copied().fold(0.0, f64::max)
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
        let offset_m = |place: u32| ROUNDED_M * ((f64::from(place) + 0.5) / f64::from(ROUNDED) - 0.5);
        (0..ROUNDED).map(|place| self.at(network, way_m + offset_m(place)).0).sum::<DVec3>() / f64::from(ROUNDED)
    }

    /// Places of the axles of a vehicle whose middle is at a way: rear and front.
    fn axles(&self, network: &Network, way_m: f64) -> [DVec3; 2] {
        [-self.axle_m, self.axle_m].map(|offset_m| self.axle(network, way_m + offset_m))
    }

    /// State of the vehicle when its middle is at a way: its axles lie on the rounded route.
    pub fn state(&self, network: &Network, way_m: f64, speed_mps: f64) -> TargetState {
        let [rear, front] = self.axles(network, way_m);
        let ahead = (front - rear).truncate();
        let ahead = if ahead.length_squared() > 1e-6 { ahead } else { self.at(network, way_m).1 };
        TargetState { feet_in_world: 0.5 * (rear + front), heading_rad: real::atan2(ahead.y, ahead.x), speed_mps }
    }
}
