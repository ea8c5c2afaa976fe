//! Boxes that cover a part: its surface and what it encloses, in cells of a grid turned along its longest sides.

use super::parts::{Part, bounds};
use crate::grid::Grid;
use crate::plan::{convex_hull, smallest_rectangle_rad};
use crate::solid_cells::boxes_of;
use crate::window_cover::{Bases, Column};
use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec2, DVec3, real};

/// Most cells that the triangles of one part may touch; larger parts get larger cells.
const MOST_TOUCHED: f64 = 4e6;
/// Most of all parts together, and the number that each may have when these are used up.
const MOST_TOUCHED_OF_ALL: f64 = 3e8;
const FEWEST_TOUCHED: f64 = 400.0;
/// Pieces of one column that are closer are one, metres.
const SAME_PIECE_M: f64 = 0.05;
/// Crossings of a vertical line closer than this are one surface, metres.
const SAME_CROSSING_M: f64 = 1e-6;
/// Thinnest box, metres.
const THINNEST_M: f64 = 0.02;
/// A corner this near to a side of a block is on it, metres; a side is whole from this share of its area on.
const ON_SIDE_M: f64 = 1e-3;
const WHOLE_SHARE: f64 = 0.99;
/// Where a vertical line through a cell is shot, in cells: off the middle, so that it meets no edge of a regular mesh.
const SHOT: [f64; 2] = [0.5137, 0.4871];

/// Makes boxes of one part after the other, in cells of which there is a bound for all parts together.
pub struct CellBudget {
    voxel_m: f64,
    left: f64,
    wider: usize,
    widest_m: f64,
}

impl CellBudget {
    /// Cells of a size as long as there are not too many.
    pub fn new(voxel_m: f64) -> Self {
        Self { voxel_m, left: MOST_TOUCHED_OF_ALL, wider: 0, widest_m: voxel_m }
    }

    /// [`boxes`] of the next part.
    pub fn boxes(&mut self, part: &Part) -> Vec<OrientedBox> {
        let (boxes, cells, cell_m) = boxes_within(part, self.voxel_m, self.left.clamp(FEWEST_TOUCHED, MOST_TOUCHED));
        self.left -= cells;
        if cell_m > self.voxel_m {
            self.wider += 1;
            self.widest_m = self.widest_m.max(cell_m);
        }
        boxes
    }

    /// Warning of parts whose boxes are coarser than asked for.
    pub fn warning(&self) -> Option<String> {
        let Self { voxel_m, wider, widest_m, .. } = self;
        (*wider > 0).then(|| {
            format!("{wider} meshes are too large for cells of {voxel_m:.2} m: theirs are up to {widest_m:.1} m wide; cut them into pieces")
        })
    }
}

/// Boxes that hold every point of the part's surface and of the space that it encloses, each within its smallest turned rectangle.
pub fn boxes(part: &Part, voxel_m: f64) -> Vec<OrientedBox> {
    boxes_within(part, voxel_m, MOST_TOUCHED).0
}

/// [`boxes`], the number of cells that they were made of, and their size.
fn boxes_within(part: &Part, voxel_m: f64, most_cells: f64) -> (Vec<OrientedBox>, f64, f64) {
    let plan: Vec<DVec2> = part.vertices.iter().map(|vertex| vertex.truncate()).collect();
    let yaw_rad = smallest_rectangle_rad(&convex_hull(plan.clone()));
    if let Some(block) = block(part, yaw_rad) {
        return (vec![block], 1.0, voxel_m);
    }
    let grid = grid_of(part, &plan, voxel_m, (most_cells, yaw_rad));
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
        clip(one, low.extend(bottom.z), high.extend(top.z));
    }
    (without_slivers(out), grid.cells() as f64, grid.cell_m)
}

/// A part that is a block, alone on its feet or not: the block itself.
fn block(part: &Part, yaw_rad: f64) -> Option<OrientedBox> {
    let axis = DVec2::new(real::cos(yaw_rad), real::sin(yaw_rad));
    let turned: Vec<DVec3> = part.vertices.iter().map(|at| in_turned(*at, axis)).collect();
    let (low, high) = bounds(turned.iter());
    let size = high - low;
    if size.min_element() < THINNEST_M {
        return None;
    }
    // Area of the triangles on each side: low and high in x, y and z.
    let mut areas_m2 = [[0.0; 2]; 3];
    for corners in part.triangles.iter().map(|triangle| triangle.map(|corner| turned[corner as usize])) {
        let [a, b, c] = corners;
        let area_m2 = 0.5 * (b - a).cross(c - a).length();
        let is_on = |axis: usize, end: DVec3| corners.iter().all(|at| (at[axis] - end[axis]).abs() < ON_SIDE_M);
        let side = (0..6).find(|side| is_on(side / 2, [low, high][side % 2]));
        match side {
            Some(side) => areas_m2[side / 2][side % 2] += area_m2,
            None if area_m2 < 1e-9 => {}
            None => return None,
        }
    }
    let whole_m2 = [size.y * size.z, size.x * size.z, size.x * size.y];
    let is_whole = |axis: usize, end: usize| areas_m2[axis][end] >= WHOLE_SHARE * whole_m2[axis];
    // Houses may have no floor.
    let is_block = (0..6).all(|side| side == 4 || is_whole(side / 2, side % 2));
    is_block.then(|| {
        let middle = 0.5 * (low + high);
        let plan = middle.x * axis + middle.y * axis.perp();
        OrientedBox { center_in_world: plan.extend(middle.z), half_extents_m: 0.5 * size, yaw_rad }
    })
}

fn in_turned(at: DVec3, axis: DVec2) -> DVec3 {
    DVec3::new(at.truncate().dot(axis), at.truncate().dot(axis.perp()), at.z)
}

/// The boxes without those that are thin and within another one: what a wall along a border of cells leaves beyond it.
fn without_slivers(boxes: Vec<OrientedBox>) -> Vec<OrientedBox> {
    let is_thin = |one: &OrientedBox| one.half_extents_m.truncate().min_element() < THINNEST_M;
    let whole: Vec<OrientedBox> = boxes.iter().filter(|one| !is_thin(one)).copied().collect();
    let is_within = |one: &OrientedBox, other: &OrientedBox| {
        let axis = DVec2::new(real::cos(other.yaw_rad), real::sin(other.yaw_rad));
        let away = in_turned(one.center_in_world, axis) - in_turned(other.center_in_world, axis);
        (away.abs() + one.half_extents_m).cmple(other.half_extents_m + 1e-6).all()
    };
    boxes.into_iter().filter(|one| !is_thin(one) || !whole.iter().any(|other| is_within(one, other))).collect()
}

fn grid_of(part: &Part, plan: &[DVec2], voxel_m: f64, (most_cells, yaw_rad): (f64, f64)) -> Grid {
    let area_m2 = |triangle: &[u32; 3]| {
        let (low, high) = bounds(part.corners(*triangle).iter());
        (high - low).truncate()
    };
    let touched = |cell_m: f64| -> f64 {
        part.triangles.iter().map(|triangle| (1.42 * area_m2(triangle) / cell_m + 2.0).element_product()).sum()
    };
    let (low, high) = bounds_in(plan, yaw_rad);
    let mut cell_m = voxel_m;
    let most = most_cells.max(5.0 * part.triangles.len() as f64);
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

/// Cuts off what a box has outside of the bounds of its part, in the turned frame.
fn clip(one: &mut OrientedBox, low: DVec3, high: DVec3) {
    let axis = DVec2::new(real::cos(one.yaw_rad), real::sin(one.yaw_rad));
    let middle = in_turned(one.center_in_world, axis);
    // Thin parts keep a little thickness.
    let spare =
        DVec3::select((high - low).cmplt(DVec3::splat(THINNEST_M)), DVec3::splat(0.5 * THINNEST_M), DVec3::ZERO);
    let (low, high) = (low - spare, high + spare);
    let (mut from, mut to) = ((middle - one.half_extents_m).max(low), (middle + one.half_extents_m).min(high));
    // So do boxes of walls along a border of cells, inwards.
    to = to.max(from + THINNEST_M).min(high);
    from = from.min(to - THINNEST_M).max(low);
    let middle = 0.5 * (from + to);
    let plan = middle.x * axis + middle.y * axis.perp();
    one.center_in_world = plan.extend(middle.z);
    one.half_extents_m = 0.5 * (to - from);
}

/// Marks that triangles leave in cells.
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
