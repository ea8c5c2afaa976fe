//! [`Vehicle`]: one simulated vehicle, where it is and what it does.

use crate::kinds::{driving, keeps_to_edges};
use crate::network::Network;
use crate::route::Route;
use cosfly_domain::{BodyPlan, Driving};
use cosfly_frames::{RandomStream, TargetState};

/// Room that a vehicle needs beside itself on its lane, metres.
pub(crate) const BESIDE_M: f64 = 0.25;
/// Gap to a standing vehicle, metres.
pub(crate) const STANDING_GAP_M: f64 = 2.0;
/// Vehicles stop this far before a junction: the rear of one that bends off swings aside, metres.
pub(crate) const BEFORE_JUNCTION_M: f64 = 3.0;

/// One vehicle.
pub(crate) struct Vehicle {
    pub plan: BodyPlan,
    pub limits: &'static Driving,
    pub speed_share: f64,
    pub route: Route,
    pub passage: Passage,
    pub random: RandomStream,
    /// Way of its middle along the route, metres.
    pub way_m: f64,
    pub speed_mps: f64,
    pub state: TargetState,
    pub doing: Doing,
}

/// Activity of a vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Doing {
    Drives,
    IsParked,
    HasLeft,
}

impl Vehicle {
    /// A vehicle that stands on the first lane of a route.
    pub fn new(network: &Network, plan: BodyPlan, route: Route, way_m: f64, doing: Doing) -> Self {
        Self {
            limits: driving(plan.kind),
            speed_share: 1.0,
            passage: Passage::default(),
            random: plan.looks.stream("route"),
            way_m,
            speed_mps: 0.0,
            state: route.state(network, way_m, 0.0),
            route,
            plan,
            doing,
        }
    }

    /// Draws the way anew from a lane of the route on.
    pub fn turn_off(&mut self, network: &Network, first: usize) {
        let needed_m = self.needed_m();
        self.route.shorten(network, first);
        self.route.extend(network, self.way_m, needed_m, &mut self.random);
    }

    pub fn length_m(&self) -> f64 {
        self.plan.size_m.x
    }

    pub fn front_m(&self) -> f64 {
        self.way_m + 0.5 * self.length_m()
    }

    /// Width of lanes that the vehicle prefers, metres.
    pub fn needed_m(&self) -> f64 {
        if keeps_to_edges(self.plan.kind) { 0.0 } else { self.plan.size_m.y + 2.0 * BESIDE_M }
    }

    pub fn drives(&self) -> bool {
        self.doing == Doing::Drives
    }
}

/// The way of a vehicle through junctions.
#[derive(Clone, Debug, Default)]
pub(crate) struct Passage {
    /// Lanes of the route before this index are granted, or need no grant.
    pub granted: usize,
    /// Lanes before this index were left.
    pub left: usize,
    /// When the vehicle asked for the next way, seconds.
    pub asked_s: Option<f64>,
}
