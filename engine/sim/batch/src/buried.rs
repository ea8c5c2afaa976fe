//! Ground without what other ground covers: kerbs and embankments reach far below the surface, terrain goes on under
//! pavements. Nothing of it is seen from above the ground.

use cosfly_frames::{DVec2, DVec3};
use cosfly_render::outside::SceneFace;
use cosfly_town::GroundIndex;
use std::collections::BTreeMap;

/// Distance between the places along an edge where polygons are compared, metres.
const STEP_M: f64 = 0.1;
/// Distance between such places within surfaces, metres.
const INSIDE_STEP_M: f64 = 0.5;
/// Most places along an edge.
const MOST_STEPS: f64 = 300.0;
/// Distance of the places beside a wall from it, metres.
const BESIDE_M: f64 = 2e-3;
/// A wall reaches this far below the ground beside it, metres.
const INTO_GROUND_M: f64 = 0.02;
/// Ground this far above may be a bridge, under which one can look, metres.
const DEEPEST_M: f64 = 0.6;
/// Ground that covers a surface lies at least this far above, metres.
const COVER_M: f64 = 0.01;
/// Surfaces that reach farther than this from their middle are never left out, metres.
const LARGEST_M: f64 = 6.0;

/// The ground polygons that may be seen from above: walls down to just below the ground beside them, their halves joined;
/// surfaces but for those closely below others. Heights are compared every tenth of a metre along edges.
pub fn seen_from_above(faces: &[SceneFace], ground: &GroundIndex) -> Vec<SceneFace> {
    let is_wall = |face: &&SceneFace| face.normal_in_world.z.abs() < 1e-3;
    let surfaces = faces.iter().filter(|face| !is_wall(face) && !is_covered(face, ground)).cloned();
    let walls = joined(faces.iter().filter(is_wall));
    surfaces.chain(walls.into_iter().filter_map(|wall| above_ground(wall, ground))).collect()
}

/// Walls with the two triangles of each rectangle joined.
fn joined<'a>(triangles: impl Iterator<Item = &'a SceneFace>) -> Vec<SceneFace> {
    let mut walls: Vec<SceneFace> = Vec::new();
    // Triangles that wait for their other half, by each of their edges.
    let mut halves: BTreeMap<[[u64; 3]; 2], usize> = BTreeMap::new();
    let bits = |corner: DVec3| corner.to_array().map(f64::to_bits);
    for face in triangles {
        let corners = &face.corners_in_world;
        let edge = |k: usize| {
            let mut ends = [bits(corners[k]), bits(corners[(k + 1) % corners.len()])];
            ends.sort_unstable();
            ends
        };
        let is_half = corners.len() == 3;
        let other = (0..3).filter(|_| is_half).find_map(|k| {
            let number = *halves.get(&edge(k))?;
            let wall = &walls[number];
            let tip = corners[(k + 2) % 3];
            let is_flat = (tip - wall.point_in_world).dot(wall.normal_in_world).abs() < 1e-6;
            (is_flat && wall.label == face.label && wall.corners_in_world.len() == 3).then_some((k, number))
        });
        if let Some((k, number)) = other
            && let Some(quad) =
                with_tip(&walls[number].corners_in_world, corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3])
        {
            walls[number].corners_in_world = quad;
            continue;
        }
        if is_half {
            halves.extend((0..3).map(|k| (edge(k), walls.len())));
        }
        walls.push(face.clone());
    }
    walls
}

/// A triangle with a fourth corner put between the ends of one of its edges; `None` where that is not convex.
fn with_tip(triangle: &[DVec3], one: DVec3, other: DVec3, tip: DVec3) -> Option<Vec<DVec3>> {
    let at = (0..3).find(|k| {
        let ends = [triangle[*k], triangle[(*k + 1) % 3]];
        ends == [one, other] || ends == [other, one]
    })?;
    let quad = vec![triangle[at], tip, triangle[(at + 1) % 3], triangle[(at + 2) % 3]];
    let turn = |k: usize| (quad[(k + 1) % 4] - quad[k]).cross(quad[(k + 2) % 4] - quad[(k + 1) % 4]);
    (1..4).all(|k| turn(k).dot(turn(0)) > 0.0).then_some(quad)
}

/// The part of a wall that stands out of the ground on either side.
fn above_ground(mut wall: SceneFace, ground: &GroundIndex) -> Option<SceneFace> {
    let normal = wall.normal_in_world.truncate().normalize_or_zero();
    let along = normal.perp();
    let corners = &wall.corners_in_world;
    let place = |corner: &DVec3| along.dot(corner.truncate());
    let from = corners.iter().copied().reduce(|a, b| if place(&b) < place(&a) { b } else { a })?.truncate();
    let to = corners.iter().copied().reduce(|a, b| if place(&b) > place(&a) { b } else { a })?.truncate();
    let top_m = corners.iter().map(|corner| corner.z).fold(f64::NEG_INFINITY, f64::max);
    let steps = ((to - from).length() / STEP_M).ceil().clamp(2.0, MOST_STEPS);
    let mut lowest_m = f64::INFINITY;
    for step in 0..=steps as u32 {
        // A little within both ends.
        let at = from.lerp(to, (f64::from(step) / steps).clamp(0.01, 0.99));
        for side in [-BESIDE_M, BESIDE_M] {
            let mut beside_m = f64::NEG_INFINITY;
            let place = at + normal * side;
            ground.visit_at(place.x, place.y, |point| {
                if point.height_m <= top_m + DEEPEST_M {
                    beside_m = beside_m.max(point.height_m);
                }
            });
            lowest_m = lowest_m.min(beside_m);
        }
    }
    wall.corners_in_world = above(&wall.corners_in_world, lowest_m - INTO_GROUND_M);
    let height_m = top_m - lowest_m;
    (wall.corners_in_world.len() > 2 && height_m > 1e-6).then_some(wall)
}

/// The part of a convex polygon above a height.
fn above(corners: &[DVec3], height_m: f64) -> Vec<DVec3> {
    let mut kept = Vec::new();
    for (from, to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        if from.z >= height_m {
            kept.push(*from);
        }
        if (from.z >= height_m) != (to.z >= height_m) {
            let mut cut = from.lerp(*to, (height_m - from.z) / (to.z - from.z));
            cut.z = height_m;
            kept.push(cut);
        }
    }
    kept
}

/// Whether other ground lies closely above all of a surface.
fn is_covered(face: &SceneFace, ground: &GroundIndex) -> bool {
    let corners: Vec<DVec2> = face.corners_in_world.iter().map(|corner| corner.truncate()).collect();
    let normal = face.normal_in_world;
    let is_covered = |at: DVec2| {
        let away = at - face.point_in_world.truncate();
        let height_m = face.point_in_world.z - (normal.x * away.x + normal.y * away.y) / normal.z;
        let mut is_covered = false;
        ground.visit_at(at.x, at.y, |point| {
            is_covered |= (height_m + COVER_M..=height_m + DEEPEST_M).contains(&point.height_m);
        });
        is_covered
    };
    let middle = corners.iter().sum::<DVec2>() / corners.len().max(1) as f64;
    let edges = || corners.iter().zip(corners.iter().cycle().skip(1));
    let on_edges = || {
        edges().all(|(a, b)| {
            let steps = ((*b - *a).length() / STEP_M).ceil().clamp(1.0, MOST_STEPS);
            (0..steps as u32).all(|step| is_covered(a.lerp(*b, f64::from(step) / steps).lerp(middle, 1e-3)))
        })
    };
    let low = corners.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let high = corners.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    let inside = || {
        let [columns, rows] = ((high - low) / INSIDE_STEP_M).to_array().map(|count| count as u32);
        (0..rows).all(|row| {
            (0..columns).all(|column| {
                let at = low + INSIDE_STEP_M * DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
                let is_inside = edges().all(|(a, b)| (*b - *a).perp_dot(at - *a) * normal.z.signum() >= 0.0);
                !is_inside || is_covered(at)
            })
        })
    };
    let is_small = corners.iter().all(|corner| corner.distance(middle) < LARGEST_M);
    let is_level = normal.z.abs() > 0.5;
    is_level
        && is_small
        && is_covered(middle)
        && corners.iter().all(|corner| is_covered(corner.lerp(middle, 1e-3)))
        && on_edges()
        && inside()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wall_is_cut_at_a_height() {
        let corner = |x: f64, z: f64| DVec3::new(x, 0.0, z);
        let wall = [corner(0.0, -1.0), corner(2.0, -1.0), corner(2.0, 1.0), corner(0.0, 1.0)];
        assert_eq!(above(&wall, 0.5).len(), 4);
        assert!(above(&wall, 0.5).iter().all(|corner| corner.z >= 0.5));
        assert!(above(&wall, 2.0).is_empty() && above(&wall, -2.0) == wall);
        let half = [wall[0], wall[1], wall[2]];
        assert_eq!(with_tip(&half, wall[2], wall[0], wall[3]), Some(vec![wall[2], wall[3], wall[0], wall[1]]));
        assert_eq!(with_tip(&half, wall[2], wall[0], corner(1.5, -0.5)), None);
    }
}
