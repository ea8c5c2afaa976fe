//! Open ground around obstacles as walkable plazas, for maps that know of buildings only.

use cosfly_frames::{DVec2, DVec3, real};
use cosfly_geometry::OrientedBox;
use cosfly_town::{GroundIndex, Obstacle, SurfaceMesh, WalkableKind, WalkablePolygon};

/// Narrowest cells, metres.
const NARROWEST_CELL_M: f64 = 2.0;
/// Most cells.
const MOST_CELLS: f64 = 4e6;
/// Distance from obstacles within which the ground is walkable, metres.
const REACH_M: f64 = 20.0;
/// Obstacles that begin higher above the ground leave room for a person, metres.
const HEADROOM_M: f64 = 2.2;
/// Longest side of a plaza, metres.
const LONGEST_M: f64 = 24.0;
/// Largest distance of the ground from a plaza, metres.
const MOST_BEND_M: f64 = 0.15;
/// Steepest plaza, rise over run.
const STEEPEST: f64 = 0.35;

/// Widest ground that becomes plazas, metres: walks of a few hundred metres need no more, and grids over it stay small.
const WIDEST_M: f64 = 2000.0;
/// Cells in which obstacles are counted to find their densest part, and how many of them make the widest ground.
const COUNTED_M: f64 = 250.0;
const COUNTED: usize = (WIDEST_M / COUNTED_M) as usize;

#[derive(Clone, Copy, PartialEq)]
enum Cell {
    Far,
    Open,
    Taken,
}

struct Cells {
    low: DVec2,
    cell_m: f64,
    columns: usize,
    rows: usize,
    cells: Vec<Cell>,
}

/// Adds plazas, synthetic, on the ground of `surfaces` near the obstacles, in their densest part where they lie far
/// apart. Gives a note about them.
pub(crate) fn add_open_ground(
    walkable: &mut Vec<WalkablePolygon>,
    obstacles: &[Obstacle],
    surfaces: &[SurfaceMesh],
) -> String {
    let before = walkable.len();
    let (obstacles, is_part) = densest(obstacles);
    fill(walkable, &obstacles, surfaces);
    let part = if is_part { format!(", in the densest {WIDEST_M} m square of the map") } else { String::new() };
    format!(
        "{} plazas on the open ground around the buildings are invented{part}: the file has no ground for people to walk on",
        walkable.len() - before
    )
}

/// The obstacles in the square that holds most of them; whether some are left out.
fn densest(obstacles: &[Obstacle]) -> (Vec<&Obstacle>, bool) {
    let center = |obstacle: &Obstacle| obstacle.shape.center_in_world.truncate();
    let low = obstacles.iter().map(center).fold(DVec2::INFINITY, DVec2::min);
    let size = obstacles.iter().map(center).fold(DVec2::NEG_INFINITY, DVec2::max) - low;
    if obstacles.is_empty() || size.max_element() <= WIDEST_M || !size.is_finite() {
        return (obstacles.iter().collect(), false);
    }
    let [columns, rows] = size.to_array().map(|side_m| (side_m / COUNTED_M) as usize + 1);
    let cell = |obstacle: &Obstacle| ((center(obstacle) - low) / COUNTED_M).as_usizevec2().to_array();
    let mut counts = vec![0_usize; columns * rows];
    for [column, row] in obstacles.iter().map(cell) {
        counts[row * columns + column] += 1;
    }
    let within = |first: usize| {
        let (column, row) = (first % columns, first / columns);
        let rows = row..(row + COUNTED).min(rows);
        rows.map(|row| {
            counts[row * columns + column..row * columns + (column + COUNTED).min(columns)].iter().sum::<usize>()
        })
        .sum::<usize>()
    };
    // The first one of equals.
    let best = (0..counts.len()).rev().max_by_key(|first| within(*first)).unwrap_or(0);
    let (column, row) = (best % columns, best / columns);
    let is_inside = |obstacle: &&Obstacle| {
        let [x, y] = cell(obstacle);
        (column..column + COUNTED).contains(&x) && (row..row + COUNTED).contains(&y)
    };
    (obstacles.iter().filter(is_inside).collect(), true)
}

fn fill(walkable: &mut Vec<WalkablePolygon>, obstacles: &[&Obstacle], surfaces: &[SurfaceMesh]) {
    let Some(mut cells) = Cells::around(obstacles) else { return };
    for obstacle in obstacles {
        cells.mark(&obstacle.shape, REACH_M, Cell::Open, |old| old == Cell::Far);
    }
    let ground = GroundIndex::of_surfaces(surfaces, |_| true);
    for obstacle in obstacles {
        let foot_m = obstacle.shape.center_in_world.z - obstacle.shape.half_extents_m.z;
        let center = obstacle.shape.center_in_world;
        let is_low = ground.ground_height_m(center.x, center.y).is_none_or(|ground_m| foot_m < ground_m + HEADROOM_M);
        if is_low {
            cells.mark(&obstacle.shape, 0.5 * cells.cell_m, Cell::Taken, |_| true);
        }
    }
    for first in 0..cells.cells.len() {
        if cells.cells[first] == Cell::Open {
            walkable.extend(cells.plaza(first, &ground));
        }
    }
}

impl Cells {
    fn around(obstacles: &[&Obstacle]) -> Option<Self> {
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for obstacle in obstacles {
            let (a, b) = obstacle.shape.bounds_in_world();
            (low, high) = (low.min(a.truncate()), high.max(b.truncate()));
        }
        if !(low.is_finite() && high.is_finite()) {
            return None;
        }
        let (low, size) = (low - REACH_M, high - low + 2.0 * REACH_M);
        let cell_m = NARROWEST_CELL_M.max((size.element_product() / MOST_CELLS).sqrt()).max(size.max_element() / 1e5);
        let [columns, rows] = size.to_array().map(|side_m| (side_m / cell_m).ceil() as usize);
        Some(Self { low, cell_m, columns, rows, cells: vec![Cell::Far; columns * rows] })
    }

    fn point(&self, column: f64, row: f64) -> DVec2 {
        self.low + self.cell_m * DVec2::new(column, row)
    }

    /// Marks the cells whose middle is within a margin of a box.
    fn mark(&mut self, shape: &OrientedBox, margin_m: f64, new: Cell, applies: impl Fn(Cell) -> bool) {
        let (low, high) = shape.bounds_in_world();
        let cell = |point: DVec2| ((point - self.low) / self.cell_m).max(DVec2::ZERO);
        let (from, to) = (cell(low.truncate() - margin_m), cell(high.truncate() + margin_m));
        let (sin, cos) = real::sin_cos(shape.yaw_rad);
        for row in from.y as usize..(to.y as usize + 1).min(self.rows) {
            for column in from.x as usize..(to.x as usize + 1).min(self.columns) {
                let away = self.point(column as f64 + 0.5, row as f64 + 0.5) - shape.center_in_world.truncate();
                let local = DVec2::new(cos * away.x + sin * away.y, cos * away.y - sin * away.x).abs();
                let index = row * self.columns + column;
                if local.cmple(shape.half_extents_m.truncate() + margin_m).all() && applies(self.cells[index]) {
                    self.cells[index] = new;
                }
            }
        }
    }

    /// The largest plaza from a cell on: grows by columns, then by rows, while the ground is open and nearly plane.
    fn plaza(&mut self, first: usize, ground: &GroundIndex) -> Option<WalkablePolygon> {
        let (column, row) = (first % self.columns, first / self.columns);
        let most = (LONGEST_M / self.cell_m).floor().max(1.0) as usize;
        let (mut width, mut height) = (1, 1);
        let is_plane = |width: usize, height: usize| self.corners(column, row, [width, height], ground).is_some();
        while width < most
            && column + width < self.columns
            && self.cells[first + width] == Cell::Open
            && is_plane(width + 1, height)
        {
            width += 1;
        }
        while height < most
            && row + height < self.rows
            && self.cells[first + height * self.columns..][..width].iter().all(|cell| *cell == Cell::Open)
            && is_plane(width, height + 1)
        {
            height += 1;
        }
        let corners = self.corners(column, row, [width, height], ground);
        for line in 0..height {
            self.cells[first + line * self.columns..][..width].fill(Cell::Taken);
        }
        let outline_in_world = corners?.to_vec();
        Some(WalkablePolygon { kind: WalkableKind::Plaza, outline_in_world, synthetic: true })
    }

    /// Corners of a rectangle of cells on the ground, if the ground is nearly plane and not steep there.
    fn corners(&self, column: usize, row: usize, size: [usize; 2], ground: &GroundIndex) -> Option<[DVec3; 4]> {
        let [width, height] = size.map(|cells| cells as f64);
        let at = |x: f64, y: f64| {
            let point = self.point(column as f64 + x * width, row as f64 + y * height);
            ground.ground_height_m(point.x, point.y).map(|height_m| point.extend(height_m))
        };
        let [low, right, high, left] = [at(0.0, 0.0)?, at(1.0, 0.0)?, at(1.0, 1.0)?, at(0.0, 1.0)?];
        let slope = (right.z - low.z).abs().max((high.z - left.z).abs()) / (width * self.cell_m);
        let across = (left.z - low.z).abs().max((high.z - right.z).abs()) / (height * self.cell_m);
        let bends = [(0.5, 0.5), (0.5, 0.0), (0.5, 1.0), (0.0, 0.5), (1.0, 0.5)].into_iter().any(|(x, y)| {
            let between = low.lerp(right, x).lerp(left.lerp(high, x), y);
            at(x, y).is_none_or(|point| (point.z - between.z).abs() > MOST_BEND_M)
        });
        (!bends && slope.max(across) <= STEEPEST).then_some([low, right, high, left])
    }
}
