//! Strips of ground along lines: roads, paths, pavements.

use cosfly_domain::{SemanticLabel, WalkableKind, WalkablePolygon};
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::mesh::MeshBuilder;

/// Points of a line closer than this are one, metres.
const SAME_POINT_M: f64 = 0.2;
/// A line that turns by more than this at a point is drawn as two strips, cosine of the angle: about 75 degrees.
const SHARP_COS: f64 = 0.26;

/// A cross-section: left and right end, distance from the beginning of the line, metres.
#[derive(Clone, Copy, Debug)]
pub struct Section {
    left: DVec2,
    right: DVec2,
    along_m: f64,
}

/// A strip of one width along a line, in pieces without sharp turns. Pieces that meet in a sharp turn overlap.
pub fn strips(points: &[DVec2], half_width_m: f64) -> Vec<Vec<Section>> {
    gentle_pieces(points, half_width_m).iter().map(|piece| sections(piece, half_width_m)).collect()
}

/// The line without points that nearly coincide.
pub fn thinned(points: &[DVec2]) -> Vec<DVec2> {
    let mut out: Vec<DVec2> = Vec::with_capacity(points.len());
    for point in points {
        match out.last() {
            Some(last) if last.distance(*point) < SAME_POINT_M => {}
            _ => out.push(*point),
        }
    }
    out
}

fn gentle_pieces(points: &[DVec2], reach_m: f64) -> Vec<Vec<DVec2>> {
    let points = thinned(points);
    let mut pieces = Vec::new();
    let mut piece: Vec<DVec2> = Vec::new();
    for (index, point) in points.iter().enumerate() {
        piece.push(*point);
        let (Some(before), Some(after)) = (index.checked_sub(1).map(|i| points[i]), points.get(index + 1)) else {
            continue;
        };
        let (into, out) = ((*point - before).normalize_or_zero(), (*after - *point).normalize_or_zero());
        if into.dot(out) < SHARP_COS {
            *piece.last_mut().expect("a point was pushed") += reach_m * into;
            pieces.push(std::mem::take(&mut piece));
            piece.push(*point - reach_m * out);
        }
    }
    pieces.push(piece);
    pieces.retain(|piece| piece.len() >= 2);
    pieces
}

/// The line moved to its left (towards decreasing y for a line along x) by a distance at each point, metres.
pub fn moved_left(points: &[DVec2], offsets_m: &[f64]) -> Vec<DVec2> {
    points
        .iter()
        .zip(offsets_m)
        .enumerate()
        .map(|(index, (point, offset))| *point + *offset * left_at(points, index))
        .collect()
}

/// Direction to the left at a point, longer than 1 where the line bends, so that sides stay parallel.
fn left_at(points: &[DVec2], index: usize) -> DVec2 {
    let direction = |from: usize, to: usize| (points[to] - points[from]).normalize_or_zero();
    let into = if index > 0 { direction(index - 1, index) } else { DVec2::ZERO };
    let out = if index + 1 < points.len() { direction(index, index + 1) } else { DVec2::ZERO };
    let middle = (into + out).normalize_or_zero();
    let one = if out == DVec2::ZERO { into } else { out };
    // y points south in plan: left of east is north.
    DVec2::new(middle.y, -middle.x) / middle.dot(one).max(0.5)
}

fn sections(points: &[DVec2], half_width_m: f64) -> Vec<Section> {
    let mut along_m = 0.0;
    (0..points.len())
        .map(|index| {
            if index > 0 {
                along_m += points[index].distance(points[index - 1]);
            }
            let aside = half_width_m * left_at(points, index);
            Section { left: points[index] + aside, right: points[index] - aside, along_m }
        })
        .collect()
}

/// Adds the surface of a strip at a height.
pub fn add_surface(meshes: &mut MeshBuilder, label: SemanticLabel, synthetic: bool, strip: &[Section], height_m: f64) {
    let mut vertices = Vec::with_capacity(2 * strip.len());
    for section in strip {
        let half_m = 0.5 * section.left.distance(section.right);
        vertices.push((section.left.extend(height_m), DVec2::new(section.along_m, half_m)));
        vertices.push((section.right.extend(height_m), DVec2::new(section.along_m, -half_m)));
    }
    let quads = 0..strip.len().saturating_sub(1) as u32;
    let triangles: Vec<[u32; 3]> = quads
        .flat_map(|quad| [[2 * quad, 2 * quad + 1, 2 * quad + 3], [2 * quad, 2 * quad + 3, 2 * quad + 2]])
        .collect();
    meshes.polygon(label, synthetic, &vertices, &triangles);
}

/// The strip as ground for people at a height.
pub fn walkable(kind: WalkableKind, synthetic: bool, strip: &[Section], height_m: f64) -> WalkablePolygon {
    let there = strip.iter().map(|section| section.left);
    let back = strip.iter().rev().map(|section| section.right);
    let outline_in_world: Vec<DVec3> = there.chain(back).map(|point| point.extend(height_m)).collect();
    WalkablePolygon { kind, outline_in_world, synthetic }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_town::polygons::{contains, twice_area_m2};

    fn line(points: &[(f64, f64)]) -> Vec<DVec2> {
        points.iter().map(|(x, y)| DVec2::new(*x, *y)).collect()
    }

    #[test]
    fn a_strip_holds_what_is_near_its_line() {
        let points = line(&[(0.0, 0.0), (20.0, 0.0), (40.0, 12.0), (41.0, 30.0), (20.0, 32.0)]);
        let pieces: Vec<Vec<DVec2>> = strips(&points, 1.5)
            .iter()
            .map(|strip| walkable(WalkableKind::Sidewalk, false, strip, 0.0).plan())
            .collect();
        assert_eq!(pieces.len(), 2, "the last turn is sharp");
        for pair in points.windows(2) {
            for step in 1..50 {
                let point = pair[0].lerp(pair[1], f64::from(step) / 50.0);
                let side = 1.4 * (pair[1] - pair[0]).normalize().perp();
                for probe in [point, point + side, point - side] {
                    assert!(pieces.iter().any(|piece| contains(piece, probe)), "{probe}");
                }
            }
        }
        let mut meshes = MeshBuilder::default();
        strips(&points, 1.5).iter().for_each(|strip| add_surface(&mut meshes, SemanticLabel::Roads, false, strip, 0.1));
        let mesh = &meshes.finish()[0];
        let area: f64 = mesh
            .triangles
            .iter()
            .map(|t| 0.5 * twice_area_m2(&t.map(|k| mesh.vertices_in_world[k as usize].truncate())).abs())
            .sum();
        let length: f64 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        assert!((area - 3.0 * length).abs() < 15.0, "{area} {length}");
    }

    #[test]
    fn left_of_a_line_to_the_east_is_north() {
        let moved = moved_left(&line(&[(0.0, 0.0), (10.0, 0.0)]), &[2.0, 2.0]);
        assert_eq!(moved, line(&[(0.0, -2.0), (10.0, -2.0)]));
        assert!(strips(&line(&[(1.0, 1.0), (1.0, 1.0)]), 1.0).is_empty());
    }
}
