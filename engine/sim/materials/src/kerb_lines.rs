//! Where pavements end at a kerb: edges that they share with a low upright face.

use crate::ground_polygons::{GroundPolygon, GroundPolygons};
use crate::kerbs::KerbLine;
use crate::paving::Squares;
use crate::square::Square;
use cosfly_domain::{SemanticLabel, Town};
use cosfly_frames::{DVec2, DVec3};

/// Faces that are less level than this are upright.
const UPRIGHT: f64 = 0.6;
/// Polygons one after the other over which paving goes on.
const MOST_ROUNDS: usize = 64;
/// Higher faces are not of kerbs, metres.
const HIGHEST_M: f64 = 0.6;

/// The line of the kerb beside each polygon of a town, and how pavements are laid.
pub fn edges_of_pavements(town: &Town, ground: &GroundPolygons) -> Vec<KerbLine> {
    let squares = Squares::of(town);
    let mut lines = kerb_lines(&ground.points_in_world, &ground.polygons);
    for (line, polygon) in lines.iter_mut().zip(&ground.polygons) {
        if polygon.label == SemanticLabel::SideWalks {
            let corners = polygon.corners.iter().map(|corner| ground.points_in_world[*corner as usize].truncate());
            line.square = squares.of_polygon(polygon.middle_in_world.truncate(), corners);
        }
    }
    pave_on(ground, &mut lines);
    lines
}

/// Ground without a kerb is laid as the squares that it goes on from, so that no seam shows where its polygons meet.
fn pave_on(ground: &GroundPolygons, lines: &mut [KerbLine]) {
    let mut laid = vec![Square::NONE; ground.points_in_world.len()];
    let is_open = |line: &KerbLine| line.inward == KerbLine::NONE.inward;
    for _ in 0..MOST_ROUNDS {
        let mut goes_on = false;
        for (line, polygon) in lines.iter_mut().zip(&ground.polygons) {
            let may_be =
                polygon.label == SemanticLabel::SideWalks && is_open(line) && polygon.normal_in_world.z > UPRIGHT;
            let beside = || polygon.corners.iter().map(|corner| laid[*corner as usize]);
            if may_be && line.square == Square::NONE {
                line.square = beside().find(|it| *it != Square::NONE).unwrap_or(Square::NONE);
            }
            if may_be && line.square != Square::NONE && beside().any(|it| it == Square::NONE) {
                polygon.corners.iter().for_each(|corner| laid[*corner as usize] = line.square);
                goes_on = true;
            }
        }
        if !goes_on {
            break;
        }
    }
}

/// The line of the kerb beside each polygon: that of its longest edge at one.
fn kerb_lines(points: &[DVec3], polygons: &[GroundPolygon]) -> Vec<KerbLine> {
    // Kerb faces around each point.
    let mut faces: Vec<Vec<u32>> = vec![Vec::new(); points.len()];
    for (number, polygon) in polygons.iter().enumerate().filter(|(_, polygon)| is_kerb(points, polygon)) {
        for corner in &polygon.corners {
            faces[*corner as usize].push(number as u32);
        }
    }
    polygons.iter().map(|polygon| kerb_line(points, &faces, polygon)).collect()
}

fn is_kerb(points: &[DVec3], polygon: &GroundPolygon) -> bool {
    let heights = || polygon.corners.iter().map(|corner| points[*corner as usize].z);
    let height_m = heights().fold(f64::NEG_INFINITY, f64::max) - heights().fold(f64::INFINITY, f64::min);
    polygon.label == SemanticLabel::SideWalks && polygon.normal_in_world.z < UPRIGHT && height_m < HIGHEST_M
}

fn kerb_line(points: &[DVec3], faces: &[Vec<u32>], polygon: &GroundPolygon) -> KerbLine {
    if polygon.label != SemanticLabel::SideWalks {
        return KerbLine::NONE;
    }
    let count = polygon.corners.len();
    let edges = (0..count).map(|k| [polygon.corners[k], polygon.corners[(k + 1) % count]]);
    let at_kerbs = edges.filter(|[a, b]| faces[*a as usize].iter().any(|face| faces[*b as usize].contains(face)));
    let ends = at_kerbs.map(|edge| edge.map(|corner| points[corner as usize].truncate()));
    let longest = ends.max_by(|one, other| length_m(one).total_cmp(&length_m(other)));
    let Some([from, to]) = longest.filter(|edge| length_m(edge) > 0.0) else { return KerbLine::NONE };
    let across = (to - from).perp().normalize();
    let middle = polygon.middle_in_world.truncate();
    let inward = if across.dot(middle - from) < 0.0 { -across } else { across };
    KerbLine { inward: inward.as_vec2().to_array(), offset_m: inward.dot(from) as f32, square: Square::NONE }
}

fn length_m([from, to]: &[DVec2; 2]) -> f64 {
    from.distance(*to)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(corners: &[u32], normal: DVec3, middle: DVec3) -> GroundPolygon {
        let label = SemanticLabel::SideWalks;
        GroundPolygon { corners: corners.to_vec(), label, normal_in_world: normal, middle_in_world: middle }
    }

    #[test]
    fn a_pavement_has_a_line_where_it_ends_at_a_low_face_and_none_at_a_skirt() {
        let point = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        let mut points =
            vec![point(0.0, 3.0, 0.15), point(9.0, 3.0, 0.15), point(9.0, 5.0, 0.15), point(0.0, 5.0, 0.15)];
        points.extend([point(0.0, 3.0, 0.0), point(9.0, 3.0, 0.0)]);
        let top = polygon(&[0, 1, 2, 3], DVec3::Z, point(4.5, 4.0, 0.15));
        let face = polygon(&[4, 5, 1, 0], DVec3::Y, point(4.5, 3.0, 0.075));
        let lines = kerb_lines(&points, &[top, face]);
        assert_eq!(lines[0], KerbLine { inward: [0.0, 1.0], offset_m: 3.0, square: Square::NONE });
        points[4].z = -1.5;
        points[5].z = -1.5;
        let top = polygon(&[0, 1, 2, 3], DVec3::Z, point(4.5, 4.0, 0.15));
        let skirt = polygon(&[4, 5, 1, 0], DVec3::Y, point(4.5, 3.0, -0.7));
        assert!(kerb_lines(&points, &[top, skirt]).iter().all(|line| *line == KerbLine::NONE));
    }

    #[test]
    fn paving_goes_on_over_ground_without_a_kerb_alone() {
        let points_in_world = (0..8).map(|k| DVec3::new(f64::from(k / 2), f64::from(k % 2), 0.0)).collect();
        let quad = |k: u32| polygon(&[k, k + 2, k + 3, k + 1], DVec3::Z, DVec3::ZERO);
        let ground = GroundPolygons { points_in_world, polygons: vec![quad(2), quad(0), quad(4)] };
        let mut lines = [KerbLine::NONE; 3];
        lines[0].square = Square { along: [1.0, 0.0], kind: 2.0 };
        lines[2].inward = [0.0, 1.0];
        pave_on(&ground, &mut lines);
        assert_eq!(lines.map(|line| line.square.kind), [2.0, 2.0, 0.0]);
    }
}
