//! Ground as few large polygons: neighbouring triangles of one label that lie in one plane, joined while convex.

use crate::lane_marks::lane_marks;
use cosfly_domain::{SemanticLabel, Town};
use cosfly_frames::DVec3;
use std::collections::BTreeMap;

/// Largest distance of a corner from its polygon's plane, metres.
const OFF_PLANE_M: f64 = 1e-3;
/// Largest distance of a corner inside of the line through its neighbours, metres.
const INSIDE_LINE_M: f64 = 1e-3;
/// Most corners of a joined polygon.
const MAX_CORNERS: usize = 16;
/// Rounds over all edges.
const ROUNDS: usize = 4;

/// A flat convex polygon of ground.
pub struct GroundPolygon {
    /// Numbers of points, in order around it.
    pub corners: Vec<u32>,
    /// Label.
    pub label: SemanticLabel,
    /// Upward unit normal.
    pub normal_in_world: DVec3,
    /// A point of its plane, metres.
    pub middle_in_world: DVec3,
}

/// All points of ground, and the polygons between them. Points at the same place are one point.
#[derive(Default)]
pub struct GroundPolygons {
    /// Points, metres.
    pub points_in_world: Vec<DVec3>,
    /// Polygons in the order of their first triangles.
    pub polygons: Vec<GroundPolygon>,
}

impl GroundPolygons {
    /// Joins the town's ground triangles; triangles that are not finite or have no area are left out.
    pub fn of(town: &Town) -> Self {
        let mut mesh = Mesh::of(town);
        mesh.join();
        mesh.drop_straight_corners();
        let points = mesh.points;
        let polygons = mesh
            .polygons
            .into_iter()
            .filter(|polygon| !polygon.corners.is_empty())
            .filter_map(|Polygon { corners, label }| {
                let (normal_in_world, middle_in_world) = plane(&points, &corners)?;
                Some(GroundPolygon { corners, label, normal_in_world, middle_in_world })
            })
            .collect();
        Self { points_in_world: points, polygons }
    }
}

#[derive(Clone)]
struct Polygon {
    /// Counter-clockwise seen from above; empty once joined to another.
    corners: Vec<u32>,
    label: SemanticLabel,
}

/// From one point to another, and the label.
type Edge = ((u32, u32), u8);

struct Mesh {
    points: Vec<DVec3>,
    polygons: Vec<Polygon>,
    /// Directed edges with their label and the polygon on their left, in order.
    edges: Vec<Edge>,
    left_of: Vec<u32>,
}

impl Mesh {
    fn of(town: &Town) -> Self {
        let mut numbers: BTreeMap<[u64; 3], u32> = BTreeMap::new();
        let (mut points, mut polygons) = (Vec::new(), Vec::new());
        for surface in town.surfaces.iter().chain(&lane_marks(town)) {
            let of_surface: Vec<Option<u32>> = surface
                .vertices_in_world
                .iter()
                .map(|point| {
                    // Adding zero makes -0 and 0 one place.
                    let place = (*point + DVec3::ZERO).to_array().map(f64::to_bits);
                    let number = || {
                        points.push(*point);
                        (points.len() - 1) as u32
                    };
                    point.is_finite().then(|| *numbers.entry(place).or_insert_with(number))
                })
                .collect();
            for triangle in &surface.triangles {
                let corner = |k: usize| of_surface.get(triangle[k] as usize).copied().flatten();
                if let (Some(a), Some(b), Some(c)) = (corner(0), corner(1), corner(2)) {
                    let normal = newell(&points, &[a, b, c]);
                    let corners = if normal.z < 0.0 { vec![c, b, a] } else { vec![a, b, c] };
                    polygons.push(Polygon { corners, label: surface.label });
                }
            }
        }
        let mut edges: Vec<(Edge, u32)> = Vec::with_capacity(3 * polygons.len());
        for (number, polygon) in polygons.iter().enumerate() {
            let around = |k: usize| (polygon.corners[k], polygon.corners[(k + 1) % 3]);
            edges.extend((0..3).map(|k| ((around(k), polygon.label.id()), number as u32)));
        }
        edges.sort_unstable();
        let left_of = edges.iter().map(|(_, number)| *number).collect();
        Self { points, polygons, edges: edges.into_iter().map(|(edge, _)| edge).collect(), left_of }
    }

    /// Joins polygons over their common edges, longest edges first: diagonals of quads, then rows, then blocks.
    fn join(&mut self) {
        let mut inner: Vec<(u64, usize, usize)> = Vec::new();
        for (forth, &((a, b), label)) in self.edges.iter().enumerate() {
            if a < b
                && let Ok(back) = self.edges.binary_search(&((b, a), label))
            {
                let length = (self.points[a as usize] - self.points[b as usize]).length();
                inner.push((u64::MAX - (length * 1e3) as u64, forth, back));
            }
        }
        inner.sort_unstable();
        for _ in 0..ROUNDS {
            let before = inner.len();
            inner.retain(|&(_, forth, back)| !self.join_over(forth, back));
            if inner.len() == before {
                break;
            }
        }
    }

    /// Joins the polygons on both sides of an edge; true when nothing more can come of this edge.
    fn join_over(&mut self, forth: usize, back: usize) -> bool {
        let (left, right) = (self.left_of[forth], self.left_of[back]);
        if left == right {
            return true;
        }
        let (a, b) = self.edges[forth].0;
        let (one, other) = (&self.polygons[left as usize], &self.polygons[right as usize]);
        let Some(corners) = joined(&one.corners, &other.corners, a, b) else { return false };
        if !self.is_flat_and_convex(&corners, [&one.corners, &other.corners]) {
            return false;
        }
        let label = one.label.id();
        for k in 0..other.corners.len() {
            let edge = ((other.corners[k], other.corners[(k + 1) % other.corners.len()]), label);
            if let Ok(at) = self.edges.binary_search(&edge)
                && self.left_of[at] == right
            {
                self.left_of[at] = left;
            }
        }
        self.polygons[right as usize].corners.clear();
        self.polygons[left as usize].corners = corners;
        true
    }

    fn is_flat_and_convex(&self, corners: &[u32], parts: [&[u32]; 2]) -> bool {
        let Some((normal, middle)) = plane(&self.points, corners) else { return false };
        if corners.len() < 3 || corners.len() > MAX_CORNERS || normal.z < 0.5 {
            return false;
        }
        let point = |k: usize| self.points[corners[k % corners.len()] as usize];
        let is_flat = (0..corners.len()).all(|k| (point(k) - middle).dot(normal).abs() <= OFF_PLANE_M);
        let is_convex = (0..corners.len()).all(|k| {
            let (from, at, to) = (point(k), point(k + 1), point(k + 2));
            let turn = (at - from).cross(to - at).dot(normal);
            let goes_back = (at - from).dot(to - at) < 0.0;
            turn >= if goes_back { 1e-9 } else { -INSIDE_LINE_M * (to - from).length() }
        });
        // A cycle that winds twice or folds back has another area than its parts.
        let area = newell(&self.points, corners).length();
        let of_parts: f64 = parts.iter().map(|part| newell(&self.points, part).length()).sum();
        is_flat && (is_convex || corners.len() == 3) && (area - of_parts).abs() <= 1e-6 * of_parts
    }

    /// Drops points in the middle of straight edges where the polygons on both sides can do without.
    fn drop_straight_corners(&mut self) {
        // Up to three polygons around each point: more than two keep it.
        let mut around = vec![[u32::MAX; 3]; self.points.len()];
        for (number, polygon) in self.polygons.iter().enumerate() {
            for &corner in &polygon.corners {
                let places = &mut around[corner as usize];
                let free = places.iter().position(|place| *place == u32::MAX).unwrap_or(2);
                places[free] = number as u32;
            }
        }
        for (point, [one, other, third]) in around.into_iter().enumerate() {
            if other == u32::MAX || third != u32::MAX || one == other {
                continue;
            }
            let point = point as u32;
            let neighbours = |polygon: u32| {
                let corners = &self.polygons[polygon as usize].corners;
                let at = corners.iter().position(|corner| *corner == point)?;
                let count = corners.len();
                (count > 3).then(|| (at, corners[(at + count - 1) % count], corners[(at + 1) % count]))
            };
            if let (Some((at, before, after)), Some((other_at, other_before, other_after))) =
                (neighbours(one), neighbours(other))
                && (before, after) == (other_after, other_before)
                && self.is_straight(before, point, after)
            {
                self.polygons[one as usize].corners.remove(at);
                self.polygons[other as usize].corners.remove(other_at);
            }
        }
    }

    fn is_straight(&self, before: u32, at: u32, after: u32) -> bool {
        let [before, at, after] = [before, at, after].map(|i| self.points[i as usize]);
        let along = after - before;
        along.cross(at - before).length() <= 1e-6 * along.length().max(1e-9)
    }
}

/// The cycle around two polygons with the common edge from `a` to `b` of the first; `None` when they do not share it.
fn joined(one: &[u32], other: &[u32], a: u32, b: u32) -> Option<Vec<u32>> {
    if one.len() + other.len() > 2 * MAX_CORNERS {
        return None;
    }
    let start = one.iter().position(|corner| *corner == b)?;
    let other_start = other.iter().position(|corner| *corner == a)?;
    if one[(start + one.len() - 1) % one.len()] != a || other[(other_start + other.len() - 1) % other.len()] != b {
        return None;
    }
    let mut cycle: Vec<u32> = one.iter().cycle().skip(start).take(one.len()).copied().collect();
    cycle.extend(other.iter().cycle().skip(other_start + 1).take(other.len() - 2));
    // Points between two common edges are left as spikes: there and back.
    while let Some(tip) = (0..cycle.len()).find(|&k| {
        let count = cycle.len();
        count > 3 && cycle[(k + count - 1) % count] == cycle[(k + 1) % count]
    }) {
        let back = (tip + 1) % cycle.len();
        cycle.remove(tip.max(back));
        cycle.remove(tip.min(back));
    }
    Some(cycle)
}

/// Twice the area of a polygon, along its normal (Newell's sum).
fn newell(points: &[DVec3], corners: &[u32]) -> DVec3 {
    let origin = points[corners[0] as usize];
    let around = |k: usize| points[corners[k % corners.len()] as usize] - origin;
    (1..corners.len()).map(|k| around(k).cross(around(k + 1))).sum()
}

/// Upward unit normal and middle of a polygon's corners; `None` without area.
fn plane(points: &[DVec3], corners: &[u32]) -> Option<(DVec3, DVec3)> {
    let normal = newell(points, corners).normalize_or_zero();
    let middle = corners.iter().map(|corner| points[*corner as usize]).sum::<DVec3>() / corners.len() as f64;
    (normal != DVec3::ZERO).then_some((if normal.z < 0.0 { -normal } else { normal }, middle))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(height: impl Fn(u32, u32) -> f64) -> Mesh {
        let mut mesh = Mesh { points: vec![], polygons: vec![], edges: vec![], left_of: vec![] };
        for row in 0..9u32 {
            for column in 0..9u32 {
                mesh.points.push(DVec3::new(2.0 * f64::from(column), 2.0 * f64::from(row), height(column, row)));
                if row > 0 && column > 0 {
                    let at = row * 9 + column;
                    for corners in [vec![at - 10, at - 9, at], vec![at - 10, at, at - 1]] {
                        mesh.polygons.push(Polygon { corners, label: SemanticLabel::Terrain });
                    }
                }
            }
        }
        let mut edges: Vec<_> = (0..mesh.polygons.len())
            .flat_map(|number| {
                let corners = &mesh.polygons[number].corners;
                let label = SemanticLabel::Terrain.id();
                [0, 1, 2].map(|k| (((corners[k], corners[(k + 1) % 3]), label), number as u32))
            })
            .collect();
        edges.sort_unstable();
        mesh.left_of = edges.iter().map(|edge| edge.1).collect();
        mesh.edges = edges.into_iter().map(|edge| edge.0).collect();
        mesh
    }

    fn area(mesh: &Mesh) -> f64 {
        let kept = mesh.polygons.iter().filter(|polygon| !polygon.corners.is_empty());
        kept.map(|polygon| 0.5 * newell(&mesh.points, &polygon.corners).length()).sum()
    }

    #[test]
    fn flat_ground_becomes_few_polygons_of_the_same_area() {
        let mut mesh = grid(|column, _| 0.1 * f64::from(column));
        let before = area(&mesh);
        mesh.join();
        mesh.drop_straight_corners();
        let count = mesh.polygons.iter().filter(|polygon| !polygon.corners.is_empty()).count();
        assert!(count <= 24, "{count} of 128");
        assert!((area(&mesh) - before).abs() < 1e-9 * before);
    }

    #[test]
    fn bumpy_ground_keeps_its_triangles() {
        let mut mesh =
            grid(|column, row| 0.02 * f64::from((column * column * 7 + row * row * 5 + column * row * 3) % 5));
        mesh.join();
        let kept = mesh.polygons.iter().filter(|polygon| !polygon.corners.is_empty());
        assert!(kept.count() > 100);
    }
}
