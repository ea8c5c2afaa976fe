//! Boxes that cover a part: its surface and what it encloses, in cells of a grid turned along its longest sides.

use super::parts::{Part, bounds};
use crate::grid::Grid;
use crate::plan::{convex_hull, smallest_rectangle_rad};
use crate::solid_cells::{Bases, Column, boxes_of};
use cosfly_frames::{DVec2, DVec3, real};
use cosfly_geometry::OrientedBox;

/// Most cells that the triangles of one part may touch; larger parts get larger cells.
const MOST_TOUCHED: f64 = 4e6;
/// Pieces of one column that are closer are one, metres.
const SAME_PIECE_M: f64 = 0.05;
/// Crossings of a vertical line closer than this are one surface, metres.
const SAME_CROSSING_M: f64 = 1e-6;
/// Where a vertical line through a cell is shot, in cells: off the middle, so that it meets no edge of a regular mesh.
const SHOT: [f64; 2] = [0.5137, 0.4871];

/// Boxes that hold every point of the part's surface and of the space that it encloses, each within its smallest turned rectangle.
pub fn boxes(part: &Part, voxel_m: f64) -> Vec<OrientedBox> {
    let plan: Vec<DVec2> = part.vertices.iter().map(|vertex| vertex.truncate()).collect();
    let yaw_rad = smallest_rectangle_rad(&convex_hull(plan.clone()));
    let grid = grid_of(part, &plan, voxel_m, yaw_rad);
    let mut cells = Cells { pieces: vec![Vec::new(); grid.cells()], crossings: vec![Vec::new(); grid.cells()] };
    for triangle in &part.triangles {
        cells.add(&grid, part.corners(*triangle));
    }
    let columns = cells.columns();
    let layers = columns.iter().map(Vec::len).max().unwrap_or(0);
    let (low, high) = bounds_in(&plan, yaw_rad);
    let (bottom, top) = bounds(part.vertices.iter());
    let mut out = Vec::new();
    for layer in 0..layers {
        let own: Vec<Option<Column>> = columns.iter().map(|pieces| pieces.get(layer).copied()).collect();
        out.extend(boxes_of(&grid, &own, grid.cell_m, Bases::Lowest, |_| false).shapes);
    }
    for one in &mut out {
        clip(one, low, high, [bottom.z, top.z]);
    }
    out
}

fn grid_of(part: &Part, plan: &[DVec2], voxel_m: f64, yaw_rad: f64) -> Grid {
    let area_m2 = |triangle: &[u32; 3]| {
        let (low, high) = bounds(part.corners(*triangle).iter());
        (high - low).truncate()
    };
    let touched = |cell_m: f64| -> f64 {
        part.triangles.iter().map(|triangle| (1.42 * area_m2(triangle) / cell_m + 2.0).element_product()).sum()
    };
    let (low, high) = bounds_in(plan, yaw_rad);
    let mut cell_m = voxel_m;
    let most = MOST_TOUCHED.max(5.0 * part.triangles.len() as f64);
    while touched(cell_m).max(((high - low) / cell_m + 3.0).element_product()) > most && cell_m < 1e5 {
        cell_m *= 1.5;
    }
    Grid::around(plan.iter().copied(), cell_m, yaw_rad)
}

/// Bounds in the turned frame.
fn bounds_in(plan: &[DVec2], yaw_rad: f64) -> (DVec2, DVec2) {
    let axis = DVec2::new(real::cos(yaw_rad), real::sin(yaw_rad));
    plan.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), point| {
        let turned = DVec2::new(point.dot(axis), point.dot(axis.perp()));
        (low.min(turned), high.max(turned))
    })
}

/// Cuts off what a box has outside of the bounds of its part.
fn clip(one: &mut OrientedBox, low: DVec2, high: DVec2, [bottom_m, top_m]: [f64; 2]) {
    let axis = DVec2::new(real::cos(one.yaw_rad), real::sin(one.yaw_rad));
    let center = one.center_in_world;
    let middle = DVec2::new(center.truncate().dot(axis), center.truncate().dot(axis.perp())).extend(center.z);
    // Thin parts keep a little thickness.
    let spare = DVec2::splat(0.01);
    let from = (middle - one.half_extents_m).max((low - spare).extend(bottom_m - 0.01));
    let to = (middle + one.half_extents_m).min((high + spare).extend(top_m + 0.01)).max(from);
    let middle = 0.5 * (from + to);
    let plan = middle.x * axis + middle.y * axis.perp();
    one.center_in_world = plan.extend(middle.z);
    one.half_extents_m = 0.5 * (to - from);
}

/// What triangles leave in cells.
struct Cells {
    /// Heights that the surface spans within a cell.
    pieces: Vec<Vec<Column>>,
    /// Heights at which the surface crosses a vertical line through a cell.
    crossings: Vec<Vec<f64>>,
}

impl Cells {
    fn add(&mut self, grid: &Grid, corners: [DVec3; 3]) {
        let flat = corners.map(|corner| grid.in_cells(corner.truncate()));
        let low = flat.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = flat.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        let last = DVec2::new((grid.columns - 1) as f64, (grid.rows - 1) as f64);
        let (from, to) = (low.floor().clamp(DVec2::ZERO, last), high.floor().clamp(DVec2::ZERO, last));
        let mut polygon = Vec::with_capacity(8);
        for row in from.y as usize..=to.y as usize {
            for column in from.x as usize..=to.x as usize {
                let cell = row * grid.columns + column;
                let corner = DVec2::new(column as f64, row as f64);
                let lifted = [0, 1, 2].map(|i| flat[i].extend(corners[i].z));
                if let Some(piece) = clipped_span(&lifted, corner, &mut polygon) {
                    self.pieces[cell].push(piece);
                }
                if let Some(height_m) = height_at(&lifted, corner + DVec2::from_array(SHOT)) {
                    self.crossings[cell].push(height_m);
                }
            }
        }
    }

    /// Solid pieces of each cell, from below.
    fn columns(mut self) -> Vec<Vec<Column>> {
        for (pieces, crossings) in self.pieces.iter_mut().zip(&mut self.crossings) {
            crossings.sort_by(f64::total_cmp);
            crossings.dedup_by(|a, b| (*a - *b).abs() < SAME_CROSSING_M);
            // A surface with a hole encloses nothing that can be told: its pieces stand alone.
            if crossings.len().is_multiple_of(2) {
                pieces.extend(crossings.chunks_exact(2).map(|pair| Column { base_m: pair[0], top_m: pair[1] }));
            }
            pieces.sort_by(|a, b| a.base_m.total_cmp(&b.base_m));
            let mut joined: Vec<Column> = Vec::new();
            for piece in pieces.drain(..) {
                match joined.last_mut() {
                    Some(last) if piece.base_m <= last.top_m + SAME_PIECE_M => last.top_m = last.top_m.max(piece.top_m),
                    _ => joined.push(piece),
                }
            }
            *pieces = joined;
        }
        self.pieces
    }
}

/// Heights of the part of a triangle over the unit cell at `corner`.
fn clipped_span(triangle: &[DVec3; 3], corner: DVec2, polygon: &mut Vec<DVec3>) -> Option<Column> {
    polygon.clear();
    polygon.extend(triangle);
    for (axis, bound, side) in
        [(0, corner.x, 1.0), (0, corner.x + 1.0, -1.0), (1, corner.y, 1.0), (1, corner.y + 1.0, -1.0)]
    {
        let depth = |point: &DVec3| side * (point[axis] - bound);
        let count = polygon.len();
        // The cut polygon is put behind the old one, which then goes.
        for i in 0..count {
            let (a, b) = (polygon[i], polygon[(i + 1) % count]);
            let (in_a, in_b) = (depth(&a), depth(&b));
            if in_a >= 0.0 {
                polygon.push(a);
            }
            if (in_a >= 0.0) != (in_b >= 0.0) {
                polygon.push(a.lerp(b, in_a / (in_a - in_b)));
            }
        }
        polygon.drain(..count);
        if polygon.is_empty() {
            return None;
        }
    }
    let heights = || polygon.iter().map(|point| point.z);
    Some(Column { base_m: heights().fold(f64::INFINITY, f64::min), top_m: heights().fold(f64::NEG_INFINITY, f64::max) })
}

/// Height of a triangle over a point, where it lies over it.
pub fn height_at([a, b, c]: &[DVec3; 3], at: DVec2) -> Option<f64> {
    let flat = |point: &DVec3| point.truncate() - at;
    let (pa, pb, pc) = (flat(a), flat(b), flat(c));
    let weights = [pb.perp_dot(pc), pc.perp_dot(pa), pa.perp_dot(pb)];
    let whole: f64 = weights.iter().sum();
    let is_inside = weights.iter().all(|weight| *weight >= 0.0) || weights.iter().all(|weight| *weight <= 0.0);
    (is_inside && whole.abs() > 1e-12).then(|| (weights[0] * a.z + weights[1] * b.z + weights[2] * c.z) / whole)
}
