//! The plan of a network: points where streets meet, and the streets between them.

use cosfly_frames::DVec2;

/// Cross-section of a street, the same on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profile {
    /// Driving lanes per direction.
    pub lanes: u32,
    /// Width of a driving lane, metres.
    pub lane_m: f64,
    /// Width of the pavement, metres.
    pub sidewalk_m: f64,
    /// Radius of the pavement's outer edge where it goes around a corner, metres.
    pub corner_m: f64,
}

impl Profile {
    /// From the middle to the kerb, metres.
    pub fn carriageway_m(&self) -> f64 {
        f64::from(self.lanes) * self.lane_m
    }

    /// From the middle to the far edge of the pavement, metres.
    pub fn half_width_m(&self) -> f64 {
        self.carriageway_m() + self.sidewalk_m
    }
}

/// A street between two points of the plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// Indices of the points.
    pub ends: [usize; 2],
    /// Points where it bends, in order.
    pub bends: Vec<DVec2>,
    /// Cross-section.
    pub profile: Profile,
}

/// Streets do not cross but at points; between neighbouring streets at a point lie at least 50 degrees, and a street
/// that runs straight on keeps its number of lanes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StreetPlan {
    /// Places of the points, map frame, metres.
    pub nodes: Vec<DVec2>,
    /// The streets.
    pub links: Vec<Link>,
    /// Whether dead ends just end, without a turning circle.
    pub open_ends: bool,
    /// Largest radius of bends, metres; that of gentle corners where there is none.
    pub bend_m: Option<f64>,
}

impl StreetPlan {
    /// A new point.
    pub fn node(&mut self, at: DVec2) -> usize {
        self.nodes.push(at);
        self.nodes.len() - 1
    }

    /// A new straight street.
    pub fn link(&mut self, from: usize, to: usize, profile: Profile) {
        self.bent(from, Vec::new(), to, profile);
    }

    /// A new street with bends.
    pub fn bent(&mut self, from: usize, bends: Vec<DVec2>, to: usize, profile: Profile) {
        self.links.push(Link { ends: [from, to], bends, profile });
    }

    /// All points of a street in order.
    pub fn points(&self, link: &Link) -> Vec<DVec2> {
        let [from, to] = link.ends.map(|end| self.nodes[end]);
        [from].into_iter().chain(link.bends.iter().copied()).chain([to]).collect()
    }
}
