//! [`Lane`]: where vehicles drive.

use cosfly_frames::DVec3;
use serde::{Deserialize, Serialize};

/// A lane for vehicles; they drive from its first point to its last.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lane {
    /// Use of the lane.
    pub kind: LaneKind,
    /// Its middle line, at least two points, in the direction of driving.
    pub middle_in_world: Vec<DVec3>,
    /// Width at its narrowest place, metres.
    pub width_m: f64,
    /// Speed limit, m/s.
    pub speed_limit_mps: f64,
    /// Whether it is a way through a junction.
    pub in_junction: bool,
    /// Lanes that follow: indices in [`Town::lanes`], ascending.
    pub successors: Vec<u32>,
    /// Crossings and other ground where people cross it: indices in [`Town::walkable`], ascending.
    pub crossings: Vec<u32>,
}

/// Use of a lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LaneKind {
    /// Motor vehicles, and bicycles where there is no lane for them.
    Driving,
    /// Bicycles.
    Biking,
}

impl Lane {
    /// A lane whose followers and crossings are not known yet, see `link_lanes` of `cosfly-town`; `None` for one without extent.
    /// Points that nearly coincide become one.
    pub fn new(kind: LaneKind, points: impl IntoIterator<Item = DVec3>, width_m: f64, limit_mps: f64) -> Option<Self> {
        let mut middle_in_world: Vec<DVec3> = points.into_iter().collect();
        middle_in_world.dedup_by(|next, before| (*next - *before).truncate().length() < 0.05);
        (middle_in_world.len() >= 2 && width_m > 0.0).then_some(Self {
            kind,
            middle_in_world,
            width_m,
            speed_limit_mps: limit_mps,
            in_junction: false,
            successors: vec![],
            crossings: vec![],
        })
    }

    /// Length in plan, metres.
    pub fn length_m(&self) -> f64 {
        self.middle_in_world.windows(2).map(|pair| (pair[1] - pair[0]).truncate().length()).sum()
    }
}
