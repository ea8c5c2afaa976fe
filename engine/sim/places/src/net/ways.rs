//! Connecting roads: every way through every junction, with the pavements that run around its corners.

use super::network::{Arm, Network, circle_m, reversed};
use crate::alignment::Alignment;
use cosfly_frames::real;

/// Ways that turn less than this run straight on, radians.
const STRAIGHT_ON_RAD: f64 = 0.7;

/// A way through a junction. Its lanes lie to the right of its reference line.
#[derive(Clone, Debug)]
pub struct Way {
    /// Index of the junction.
    pub junction: usize,
    /// The arm it comes from and the arm it leads into.
    pub arms: [Arm; 2],
    /// Reference line.
    pub line: Alignment,
    /// Driving lanes.
    pub lanes: u32,
    /// Lanes of either arm between the middle of the street and this way's first lane.
    pub skipped_lanes: [u32; 2],
    /// Width of a lane at start and end, metres.
    pub lane_m: [f64; 2],
    /// Widths of its pavement at start and end, where it has one.
    pub sidewalk_m: Option<[f64; 2]>,
}

impl Way {
    /// From the reference line to its right edge, at a share of its length, metres.
    pub fn width_m(&self, share: f64) -> f64 {
        let mix = |[start, end]: [f64; 2]| start + share * (end - start);
        f64::from(self.lanes) * mix(self.lane_m) + self.sidewalk_m.map_or(0.0, mix)
    }
}

/// All ways of the network, junction by junction; the first of each arm leads to the next arm counter-clockwise and has
/// the pavement between the two.
pub fn all_ways(network: &Network) -> Vec<Way> {
    let mut ways = Vec::new();
    for (junction, arms) in network.junctions.iter().enumerate().filter(|(junction, _)| network.has_ways(*junction)) {
        for (at, from) in arms.iter().enumerate() {
            let onward = if arms.len() == 1 { 1..2 } else { 1..arms.len() };
            ways.extend(onward.map(|step| way(network, junction, [*from, arms[(at + step) % arms.len()]], step == 1)));
        }
    }
    ways
}

fn way(network: &Network, junction: usize, arms: [Arm; 2], with_sidewalk: bool) -> Way {
    let profiles = arms.map(|arm| network.profile(arm));
    let (start, goal) = (reversed(network.mouth(arms[0])), network.mouth(arms[1]));
    let turn_rad = real::wrap_angle_rad(goal.heading_rad - start.heading_rad);
    let fewest = profiles[0].lanes.min(profiles[1].lanes);
    let is_bend = network.junctions[junction].len() <= 2;
    let lanes = if is_bend || turn_rad.abs() < STRAIGHT_ON_RAD { fewest } else { 1 };
    // To the right along the kerb, else along the middle.
    let keeps_right = with_sidewalk || turn_rad < -STRAIGHT_ON_RAD;
    let skipped_lanes = profiles.map(|profile| if keeps_right { profile.lanes - lanes } else { 0 });
    let lane_m = profiles.map(|profile| profile.lane_m);
    let offset_m = [0, 1].map(|end| f64::from(skipped_lanes[end]) * lane_m[end]);
    let line = if arms[0] == arms[1] {
        Alignment::turning_circle(start, circle_m(&profiles[0]))
    } else {
        Alignment::corner(start.moved(0.0, -offset_m[0]), goal.moved(0.0, -offset_m[1]))
    };
    let sidewalk_m = with_sidewalk.then_some(profiles.map(|profile| profile.sidewalk_m));
    Way { junction, arms, line, lanes, skipped_lanes, lane_m, sidewalk_m }
}
