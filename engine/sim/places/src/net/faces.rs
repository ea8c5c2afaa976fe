//! Land between the streets: the faces of the network, bounded by the outer edges of pavements.

use super::network::{Arm, Network};
use super::ways::Way;
use crate::geometry::twice_area_m2;
use cosfly_frames::DVec2;

/// Land that streets enclose, or the land around all of them.
#[derive(Clone, Debug)]
pub struct Face {
    /// Edge of the pavements, with the land to the left.
    pub outline: Vec<DVec2>,
    /// The parts of the edge along streets, without the corners.
    pub fronts: Vec<Front>,
    /// Whether streets enclose it.
    pub is_enclosed: bool,
}

/// Edge of the land along one side of a street, with the land to the left.
#[derive(Clone, Debug)]
pub struct Front {
    /// Its points.
    pub points: Vec<DVec2>,
    /// The street.
    pub street: usize,
}

impl Front {
    /// First and last point.
    pub fn ends(&self) -> [DVec2; 2] {
        [self.points[0], self.points[self.points.len() - 1]]
    }
}

/// All faces: the land to the right of each street's two directions, followed around.
pub fn faces(network: &Network, ways: &[Way]) -> Vec<Face> {
    let mut seen = vec![[false; 2]; network.streets.len()];
    let mut faces = Vec::new();
    for street in 0..network.streets.len() {
        for backward in [false, true] {
            if !seen[street][usize::from(backward)] {
                faces.push(face(network, ways, (street, backward), &mut seen));
            }
        }
    }
    faces
}

fn face(network: &Network, ways: &[Way], first: (usize, bool), seen: &mut [[bool; 2]]) -> Face {
    let (mut outline, mut fronts) = (Vec::new(), Vec::new());
    let mut at = first;
    loop {
        let (street, backward) = at;
        seen[street][usize::from(backward)] = true;
        let mut points = side(network, street, backward);
        outline.extend(points.iter().copied());
        points.reverse();
        fronts.push(Front { points, street });
        let incoming = Arm { street, at_end: !backward };
        let corner = ways.iter().find(|way| way.arms[0] == incoming && way.sidewalk_m.is_some());
        let Some(way) = corner else { break };
        outline.extend(outer_edge(way));
        at = (way.arms[1].street, way.arms[1].at_end);
        if at == first || seen[at.0][usize::from(at.1)] {
            break;
        }
    }
    outline.reverse();
    fronts.reverse();
    outline.dedup_by(|a, b| a.distance(*b) < 1e-3);
    let is_enclosed = twice_area_m2(&outline) > 0.0;
    Face { outline, fronts, is_enclosed }
}

/// Outer edge of the pavement to the right of a street, in the direction of travel.
fn side(network: &Network, street: usize, backward: bool) -> Vec<DVec2> {
    let (line, profile) = (&network.streets[street].line, network.streets[street].profile);
    let side = if backward { 1.0 } else { -1.0 };
    let edge = |s_m: f64| line.pose_at(s_m).moved(0.0, side * profile.half_width_m()).at;
    let mut points: Vec<DVec2> = line.stations_m().into_iter().map(edge).collect();
    if backward {
        points.reverse();
    }
    points
}

fn outer_edge(way: &Way) -> Vec<DVec2> {
    let length_m = way.line.length_m();
    let stations = way.line.stations_m().into_iter();
    stations.map(|s_m| way.line.pose_at(s_m).moved(0.0, -way.width_m(s_m / length_m)).at).collect()
}
