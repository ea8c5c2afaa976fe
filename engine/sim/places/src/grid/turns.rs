//! Connecting roads: every way through every junction, with the pavements that run around its corners.

use super::streets::{Arm, LANE_WIDTH_M, Network, Profile, RoadEnd};
use crate::alignment::{Alignment, Pose2};
use cosfly_frames::real;

/// A way through a junction. Its lanes lie to the right of its reference line.
#[derive(Clone, Debug)]
pub struct JunctionWay {
    /// Index of the junction.
    pub junction: usize,
    /// The arm it comes from.
    pub from: Arm,
    /// The arm it leads into.
    pub to: Arm,
    /// Reference line.
    pub line: Alignment,
    /// Driving lanes.
    pub lanes: u32,
    /// Lanes of either arm between the middle of the street and this way's first lane.
    pub skipped_lanes: [u32; 2],
    /// Widths of its pavement at start and end, where it has one.
    pub sidewalk_m: Option<[f64; 2]>,
}

impl JunctionWay {
    /// Width of everything to the right of the reference line, metres.
    pub fn width_m(&self) -> f64 {
        f64::from(self.lanes) * LANE_WIDTH_M + self.sidewalk_m.map_or(0.0, |[start, end]| start.max(end))
    }
}

/// All turns of the network, junction by junction.
pub fn all_turns(network: &Network) -> Vec<JunctionWay> {
    let mut turns = Vec::new();
    for (junction, ends) in network.junctions.iter().enumerate() {
        for side in 0..4 {
            let Some(from) = ends.arms[side] else { continue };
            // To the right of the arm, opposite, to its left: the first one there shares its pavement.
            let mut pavement_is_open = true;
            let ends_in_a_wall = |arm_side: usize| ends.arms[(arm_side + 2) % 4].is_none();
            for quarter in 1..4 {
                let to_side = (side + quarter) % 4;
                let Some(to) = ends.arms[to_side] else { continue };
                let way = [(side, from), (to_side, to)];
                for ways in lane_ways(network, &way, quarter, ends_in_a_wall) {
                    turns.push(turn(network, junction, &way, ways, pavement_is_open));
                    pavement_is_open = false;
                }
            }
        }
    }
    turns
}

/// Pose at an arm's mouth, looking out of the junction.
fn mouth(network: &Network, arm: &Arm) -> Pose2 {
    let line = &network.streets[arm.street].line;
    match arm.contact {
        RoadEnd::Start => line.pose_at(0.0),
        RoadEnd::End => reversed(line.end()),
    }
}

fn reversed(pose: Pose2) -> Pose2 {
    Pose2 { heading_rad: pose.heading_rad + real::PI, ..pose }
}

/// Lanes of one connecting road: how many, and how many of either arm lie between it and the middle of the street.
#[derive(Clone, Copy)]
struct LaneWay {
    lanes: u32,
    skipped: [u32; 2],
}

/// The connecting roads from one arm to another, `quarter` turns to its right. Right turns keep to the kerb, left
/// turns to the middle; where an arm has nothing opposite, all its lanes turn either way.
fn lane_ways(
    network: &Network,
    [(from_side, from), (to_side, to)]: &[(usize, Arm); 2],
    quarter: usize,
    ends_in_a_wall: impl Fn(usize) -> bool,
) -> Vec<LaneWay> {
    let lanes = [from, to].map(|arm| network.streets[arm.street].profile.lanes);
    if quarter == 2 {
        return vec![LaneWay { lanes: lanes[0].min(lanes[1]), skipped: [0, 0] }];
    }
    let usual = lanes.map(|count| if quarter == 1 { count - 1 } else { 0 });
    let mut ways = vec![LaneWay { lanes: 1, skipped: usual }];
    for (end, side) in [*from_side, *to_side].into_iter().enumerate() {
        for lane in (0..lanes[end]).filter(|&lane| lane != usual[end] && ends_in_a_wall(side)) {
            let mut skipped = usual;
            skipped[end] = lane;
            ways.push(LaneWay { lanes: 1, skipped });
        }
    }
    ways
}

/// A driver who comes in on the arm of side k and leaves on side k + 1 turns right: heading k + 2, then k + 1.
fn turn(
    network: &Network,
    junction: usize,
    [(from_side, from), (to_side, to)]: &[(usize, Arm); 2],
    LaneWay { lanes, skipped: skipped_lanes }: LaneWay,
    with_sidewalk: bool,
) -> JunctionWay {
    let profile = |arm: &Arm| network.streets[arm.street].profile;
    let (from_profile, to_profile): (Profile, Profile) = (profile(from), profile(to));
    let quarter = (to_side + 4 - from_side) % 4;
    let offset_m = skipped_lanes.map(|lanes| f64::from(lanes) * LANE_WIDTH_M);
    let start = reversed(mouth(network, from)).moved(0.0, -offset_m[0]);
    let goal = mouth(network, to).moved(0.0, -offset_m[1]);
    let reach = goal.at - start.at;
    let (ahead_m, left_m) = (reach.dot(start.ahead()), reach.dot(start.left()));
    let line = if quarter == 2 {
        Alignment::straight(start, ahead_m)
    } else {
        Alignment::quarter_turn(start, ahead_m, left_m.abs(), quarter == 3, f64::INFINITY, 0.0)
    };
    let sidewalk_m = with_sidewalk.then_some([from_profile.sidewalk_m, to_profile.sidewalk_m]);
    JunctionWay { junction, from: *from, to: *to, line, lanes, skipped_lanes, sidewalk_m }
}
