//! Streets and junctions laid out by a plan.

use super::plan::{Profile, StreetPlan};
use crate::alignment::{Alignment, Pose2};
use crate::relief::Relief;
use cosfly_frames::{DVec2, real};

/// Radius of bends between junctions where the plan has none, metres.
const BEND_M: f64 = 30.0;
/// Shortest distance from the middle of a junction to the mouth of an arm, metres.
const SHORTEST_MOUTH_M: f64 = 2.0;
/// Least angle between neighbouring arms, radians, and what a street keeps of each of its end legs, metres.
const LEAST_BETWEEN_RAD: f64 = 0.872;
const LEAST_LEG_M: f64 = 1.5;
/// Turning circles leave so much room inside the pavement, metres.
const CIRCLE_ROOM_M: f64 = 1.0;

/// A street between two junctions.
#[derive(Clone, Debug)]
pub struct Street {
    /// Reference line.
    pub line: Alignment,
    /// Cross-section.
    pub profile: Profile,
    /// Junctions at its start and end.
    pub junctions: [usize; 2],
}

/// A street's end at a junction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arm {
    /// Index of the street.
    pub street: usize,
    /// Whether it is the end of the street's reference line, not the start.
    pub at_end: bool,
}

/// The network, in the map frame.
#[derive(Clone, Debug, Default)]
pub struct Network {
    /// Streets, in the order of the plan.
    pub streets: Vec<Street>,
    /// Arms of each junction, counter-clockwise.
    pub junctions: Vec<Vec<Arm>>,
    /// Heights of the ground.
    pub relief: Relief,
    /// Whether land without a surface is lawn, also between houses; elsewhere readers may take courts for bare.
    pub has_lawn: bool,
    /// Whether dead ends just end.
    open_ends: bool,
}

/// An arm with its direction from the middle of the junction.
struct Spoke {
    arm: Arm,
    angle_rad: f64,
    profile: Profile,
}

impl Network {
    /// Lays the streets of a plan.
    pub fn lay(plan: &StreetPlan) -> Self {
        let nodes: Vec<Vec<Spoke>> = (0..plan.nodes.len()).map(|node| spokes(plan, node)).collect();
        let cuts_m = cuts_m(plan, &nodes);
        let junctions = nodes.into_iter().map(|spokes| spokes.into_iter().map(|spoke| spoke.arm).collect()).collect();
        let streets = plan.links.iter().zip(cuts_m).map(|(link, cut_m)| Street {
            line: Alignment::through(&plan.points(link), cut_m, plan.bend_m.unwrap_or(BEND_M)),
            profile: link.profile,
            junctions: link.ends,
        });
        Self { streets: streets.collect(), junctions, open_ends: plan.open_ends, ..Self::default() }
    }

    /// Whether ways lead through a junction: none do where a dead end just ends.
    pub fn has_ways(&self, junction: usize) -> bool {
        self.junctions[junction].len() > usize::from(self.open_ends)
    }

    /// Pose at an arm's mouth, looking out of the junction.
    pub fn mouth(&self, arm: Arm) -> Pose2 {
        let line = &self.streets[arm.street].line;
        if arm.at_end { reversed(line.end()) } else { line.pose_at(0.0) }
    }

    /// Cross-section of an arm.
    pub fn profile(&self, arm: Arm) -> Profile {
        self.streets[arm.street].profile
    }

    /// Smallest and largest corner around all streets, with room for what stands beside them.
    pub fn bounds(&self, margin_m: f64) -> [DVec2; 2] {
        let points = self
            .streets
            .iter()
            .flat_map(|street| street.line.stations_m().into_iter().map(|s_m| street.line.pose_at(s_m).at));
        let around = |[low, high]: [DVec2; 2], at: DVec2| [low.min(at), high.max(at)];
        let [low, high] = points.fold([DVec2::INFINITY, DVec2::NEG_INFINITY], around);
        [low - margin_m, high + margin_m]
    }
}

/// Streets of a plan that leave a point at less than 50 degrees from a longer one, and whether that is their end: one at each
/// point at most.
pub fn acute_ends(plan: &StreetPlan) -> Vec<(usize, bool)> {
    let nodes: Vec<Vec<Spoke>> = (0..plan.nodes.len()).map(|node| spokes(plan, node)).collect();
    let length_m = |street: usize| legs_m(plan, street).iter().sum::<f64>();
    let acute = |spokes: &Vec<Spoke>| {
        let at = (0..spokes.len()).find(|at| spokes.len() > 1 && between_rad(spokes, *at) < LEAST_BETWEEN_RAD)?;
        let [one, other] = [at, (at + 1) % spokes.len()].map(|spoke| spokes[spoke].arm);
        let shorter = if length_m(one.street) <= length_m(other.street) { one } else { other };
        Some((shorter.street, shorter.at_end))
    };
    nodes.iter().filter_map(acute).collect()
}

/// Streets of a plan that are too short for the mouths at their ends.
pub fn short_streets(plan: &StreetPlan) -> Vec<usize> {
    let nodes: Vec<Vec<Spoke>> = (0..plan.nodes.len()).map(|node| spokes(plan, node)).collect();
    let lacks = |room_m: f64| room_m < LEAST_LEG_M;
    let is_short = |street: usize, [start_m, end_m]: [f64; 2]| match legs_m(plan, street)[..] {
        [only_m] => lacks(only_m - start_m - end_m),
        [first_m, .., last_m] => lacks(first_m - start_m) || lacks(last_m - end_m),
        [] => true,
    };
    let cuts_m = cuts_m(plan, &nodes).into_iter().enumerate();
    cuts_m.filter(|(street, cuts_m)| is_short(*street, *cuts_m)).map(|(street, _)| street).collect()
}

/// Lengths of a street's straight parts.
fn legs_m(plan: &StreetPlan, street: usize) -> Vec<f64> {
    plan.points(&plan.links[street]).windows(2).map(|leg| leg[0].distance(leg[1])).collect()
}

/// The pose that looks back.
pub fn reversed(pose: Pose2) -> Pose2 {
    Pose2 { heading_rad: pose.heading_rad + real::PI, ..pose }
}

/// Radius of the turning circle of a dead end, metres.
pub fn circle_m(profile: &Profile) -> f64 {
    profile.half_width_m() + CIRCLE_ROOM_M
}

/// Arms of a point, counter-clockwise.
fn spokes(plan: &StreetPlan, node: usize) -> Vec<Spoke> {
    let mut spokes = Vec::new();
    for (street, link) in plan.links.iter().enumerate() {
        let points = plan.points(link);
        for at_end in [false, true] {
            let away = if at_end { points[points.len() - 2] - points[points.len() - 1] } else { points[1] - points[0] };
            if link.ends[usize::from(at_end)] == node {
                let angle_rad = real::atan2(away.y, away.x);
                spokes.push(Spoke { arm: Arm { street, at_end }, angle_rad, profile: link.profile });
            }
        }
    }
    spokes.sort_by(|a, b| a.angle_rad.total_cmp(&b.angle_rad));
    spokes
}

/// Distance from each end of all streets to the mouth there.
fn cuts_m(plan: &StreetPlan, nodes: &[Vec<Spoke>]) -> Vec<[f64; 2]> {
    let mut cuts_m = vec![[0.0; 2]; plan.links.len()];
    for spokes in nodes.iter().filter(|spokes| spokes.len() > usize::from(plan.open_ends)) {
        for (spoke, mouth_m) in spokes.iter().zip(mouths_m(spokes)) {
            cuts_m[spoke.arm.street][usize::from(spoke.arm.at_end)] = mouth_m;
        }
    }
    cuts_m
}

/// Angle from an arm to the next one.
fn between_rad(spokes: &[Spoke], at: usize) -> f64 {
    let between_rad = spokes[(at + 1) % spokes.len()].angle_rad - spokes[at].angle_rad;
    if between_rad <= 0.0 { between_rad + 2.0 * real::PI } else { between_rad }
}

/// Distance from the middle to the mouth of each arm, so that pavements go around all corners in arcs.
fn mouths_m(spokes: &[Spoke]) -> Vec<f64> {
    if let [only] = spokes {
        // Where the turning circle's middle is the point of the plan.
        return vec![2.0 * circle_m(&only.profile) * real::sin(real::PI / 3.0)];
    }
    let mut mouths_m = vec![SHORTEST_MOUTH_M; spokes.len()];
    for at in 0..spokes.len() {
        let next = (at + 1) % spokes.len();
        let [one, other] = [&spokes[at], &spokes[next]];
        let between_rad = between_rad(spokes, at);
        if between_rad < real::PI - 1e-6 {
            let width_m = one.profile.half_width_m().max(other.profile.half_width_m());
            let corner_m = one.profile.corner_m.max(other.profile.corner_m);
            let tangent_m = (width_m + corner_m) / real::tan(0.5 * between_rad);
            mouths_m[at] = mouths_m[at].max(tangent_m);
            mouths_m[next] = mouths_m[next].max(tangent_m);
        }
    }
    mouths_m
}
