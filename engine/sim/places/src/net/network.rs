//! Streets and junctions laid out by a plan.

use super::plan::{Profile, StreetPlan};
use crate::alignment::{Alignment, Pose2};
use cosfly_frames::{DVec2, real};

/// Radius of bends between junctions, metres.
const BEND_M: f64 = 30.0;
/// Shortest distance from the middle of a junction to the mouth of an arm, metres.
const SHORTEST_MOUTH_M: f64 = 2.0;
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
        let mut cuts_m = vec![[0.0; 2]; plan.links.len()];
        let mut junctions = Vec::new();
        for node in 0..plan.nodes.len() {
            let spokes = spokes(plan, node);
            for (spoke, mouth_m) in spokes.iter().zip(mouths_m(&spokes)) {
                cuts_m[spoke.arm.street][usize::from(spoke.arm.at_end)] = mouth_m;
            }
            junctions.push(spokes.into_iter().map(|spoke| spoke.arm).collect());
        }
        let streets = plan.links.iter().zip(cuts_m).map(|(link, cut_m)| Street {
            line: Alignment::through(&plan.points(link), cut_m, BEND_M),
            profile: link.profile,
            junctions: link.ends,
        });
        Self { streets: streets.collect(), junctions }
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
        let mut between_rad = other.angle_rad - one.angle_rad;
        between_rad += if between_rad <= 0.0 { 2.0 * real::PI } else { 0.0 };
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
