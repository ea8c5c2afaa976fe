//! Light that stays in place: how much sky the ground sees, and how much lamps give, on a coarse grid over the town.

use crate::ground_kinds::GroundKinds;
use crate::parts::{Cluster, SceneBox};
use crate::pattern::{blend, draw, fixed_size, floor_int, four_bytes, hash, least, lerp, most, nearest_index, share};
use crate::thing_tints::bulb;
use cosfly_domain::ObstacleKind;
use cosfly_frames::{DVec2, DVec3};
use std::collections::BTreeSet;

/// Most cells along one side.
const MAX_CELLS: usize = 508;
/// Cells along a side of the packed tables.
const TABLE_SIDE: usize = 512;
/// Distances to walls are told up to this, metres.
pub const FAR_FROM_WALLS_M: f32 = 6.0;
/// Lamps that no map tells of stand about this far apart, metres, and at most this far from a building.
const UNTOLD_LAMPS_M: f64 = 18.0;
const BESIDE_BUILDINGS_M: f64 = 15.0;
/// Places that are tried for each.
const TRIED: u32 = 12;
/// Lamp light of a byte's step.
const LAMP_STEP: f32 = 1.0 / 64.0;

/// Values of the grid at one place.
#[derive(Clone, Copy, Debug, Default)]
pub struct GridSample {
    /// Height of the ground, metres.
    pub ground_m: f32,
    /// Share of the sky the ground sees, 0..=1.
    pub sky: f32,
    /// Light of lamps on the ground at night, 0..=1 and above.
    pub lamps: f32,
    /// Distance to the nearest wall of a building, metres, up to [`FAR_FROM_WALLS_M`].
    pub wall_m: f32,
}

/// Ground height, sky share and lamp light in square cells.
pub struct LightGrid {
    min: [f32; 2],
    cells_per_m: f32,
    columns: usize,
    rows: usize,
    cells: Vec<GridSample>,
    tables: Box<GridTables>,
    /// Whether lamps light a place at night.
    has_lamps: bool,
}

/// The cells as kernels read them: sky shares of a cell, the one to the right, below, and below right, in bytes; then
/// their lamp light likewise; then heights of the ground, the bits of an f32. A bare array, so that compilers see that
/// kernels' results lie elsewhere.
pub type GridTables = [u32; 4 * TABLE];
const TABLE: usize = TABLE_SIDE * TABLE_SIDE;

/// A place between four cells.
#[derive(Clone, Copy)]
pub struct GridPlace {
    at: usize,
    fx: f32,
    fy: f32,
}

impl GridPlace {
    /// Share of the sky that the ground sees.
    #[inline(always)]
    pub fn sky(self, tables: &GridTables) -> f32 {
        blend(tables[self.at], self.fx, self.fy) * (1.0 / 255.0)
    }

    /// Light of lamps on the ground.
    #[inline(always)]
    pub fn lamps(self, tables: &GridTables) -> f32 {
        blend(tables[TABLE + self.at], self.fx, self.fy) * LAMP_STEP
    }

    /// Distance to the nearest wall of a building, metres, up to [`FAR_FROM_WALLS_M`].
    #[inline(always)]
    pub fn wall_m(self, tables: &GridTables) -> f32 {
        blend(tables[3 * TABLE + self.at], self.fx, self.fy) * (FAR_FROM_WALLS_M / 255.0)
    }

    /// Height of the ground of the cell there, metres.
    #[inline(always)]
    pub fn ground_m(self, tables: &GridTables) -> f32 {
        f32::from_bits(tables[2 * TABLE + self.at])
    }
}

/// Place of the tables in the world.
#[derive(Clone, Copy, Debug)]
pub struct GridFrame {
    min: [f32; 2],
    cells_per_m: f32,
    last: [f32; 2],
}

impl GridFrame {
    /// The cells around a place; the border's beyond it.
    #[inline(always)]
    pub fn place(&self, x_m: f32, y_m: f32) -> GridPlace {
        let x = least(most((x_m - self.min[0]) * self.cells_per_m, 0.5), self.last[0]);
        let y = least(most((y_m - self.min[1]) * self.cells_per_m, 0.5), self.last[1]);
        let (column, row) = (floor_int(x), floor_int(y));
        let (fx, fy) = (share(x - column as f32), share(y - row as f32));
        let at = ((row as u32).wrapping_shl(9) | (column as u32 & 511)) as usize & (TABLE - 1);
        GridPlace { at, fx, fy }
    }
}

impl LightGrid {
    /// Measures the town, whose ground is paved where `ground` says.
    pub fn new(boxes: &[SceneBox], clusters: &[Cluster], ground: &GroundKinds) -> Self {
        let mut low = DVec3::INFINITY;
        let mut high = DVec3::NEG_INFINITY;
        for (center, half) in boxes
            .iter()
            .map(|b| (b.center_in_world, b.half_bounds_m))
            .chain(clusters.iter().map(|c| (c.center_in_world, c.half_bounds_m)))
            .filter(|(center, half)| center.is_finite() && half.is_finite())
        {
            low = low.min(center - half);
            high = high.max(center + half);
        }
        if !(low.is_finite() && high.is_finite()) {
            (low, high) = (DVec3::ZERO, DVec3::ONE);
        }
        let side = (high.x - low.x).max(high.y - low.y).clamp(1.0, 1e6);
        let cell = (side / MAX_CELLS as f64).max(1.0);
        let count = |length: f64| ((length / cell) as usize + 3).min(MAX_CELLS + 3);
        let (columns, rows) = (count(high.x - low.x), count(high.y - low.y));
        let mut grid = Self {
            min: [low.x as f32, low.y as f32],
            cells_per_m: (1.0 / cell) as f32,
            columns,
            rows,
            cells: vec![GridSample { ground_m: 0.0, sky: 1.0, lamps: 0.0, wall_m: FAR_FROM_WALLS_M }; columns * rows],
            tables: fixed_size(vec![]),
            has_lamps: false,
        };
        grid.measure_ground(clusters, boxes);
        grid.measure_sky(boxes);
        grid.measure_walls(boxes);
        match boxes.iter().any(|b| b.kind == ObstacleKind::Lamp) {
            true => grid.add_lamps(boxes),
            false => grid.add_untold_lamps(boxes, ground),
        }
        grid.has_lamps = grid.cells.iter().any(|cell| cell.lamps > 0.0);
        grid.pack();
        grid
    }

    /// Whether lamps light a place at night.
    pub fn has_lamps(&self) -> bool {
        self.has_lamps
    }

    /// Packs the cells into tables for the shading kernels.
    fn pack(&mut self) {
        for row in 0..self.rows.min(TABLE_SIDE) {
            for column in 0..self.columns.min(TABLE_SIDE) {
                let (right, below) = ((column + 1).min(self.columns - 1), (row + 1).min(self.rows - 1));
                let cell = |row: usize, column: usize| self.cells[row * self.columns + column];
                let four = [cell(row, column), cell(row, right), cell(below, column), cell(below, right)];
                let at = row * TABLE_SIDE + column;
                self.tables[at] = four_bytes(four.map(|c| (255.0 * c.sky + 0.5) as u8));
                self.tables[TABLE + at] = four_bytes(four.map(|c| (c.lamps / LAMP_STEP + 0.5) as u8));
                self.tables[2 * TABLE + at] = four[0].ground_m.to_bits();
                let near = four.map(|c| (255.0 / FAR_FROM_WALLS_M * c.wall_m + 0.5) as u8);
                self.tables[3 * TABLE + at] = four_bytes(near);
            }
        }
    }

    /// Lowest and highest corner of the grid over the ground, metres.
    pub fn bounds_m(&self) -> [[f32; 2]; 2] {
        let size = [self.columns, self.rows].map(|count| count as f32 / self.cells_per_m);
        [self.min, [self.min[0] + size[0], self.min[1] + size[1]]]
    }

    /// Mean height of the ground along the border, metres.
    pub fn border_m(&self) -> f32 {
        let is_border = |at: &usize| {
            let (column, row) = (at % self.columns, at / self.columns);
            column == 0 || row == 0 || column + 1 == self.columns || row + 1 == self.rows
        };
        let heights = (0..self.cells.len()).filter(is_border).map(|at| self.cells[at].ground_m);
        heights.clone().sum::<f32>() / heights.count().max(1) as f32
    }

    /// The cells as kernels read them.
    #[inline]
    pub fn tables(&self) -> &GridTables {
        &self.tables
    }

    /// Place of the tables in the world.
    #[inline]
    pub fn frame(&self) -> GridFrame {
        let last = [self.columns, self.rows].map(|count| count as f32 - 1.501);
        GridFrame { min: self.min, cells_per_m: self.cells_per_m, last }
    }

    /// Blended values at a place; the border's beyond it.
    #[inline(always)]
    pub fn sample(&self, x_m: f32, y_m: f32) -> GridSample {
        let x = ((x_m - self.min[0]) * self.cells_per_m).clamp(0.5, self.columns as f32 - 1.501);
        let y = ((y_m - self.min[1]) * self.cells_per_m).clamp(0.5, self.rows as f32 - 1.501);
        let (column, row) = (nearest_index(x - 0.5), nearest_index(y - 0.5));
        let (fx, fy) = (x - column as i32 as f32, y - row as i32 as f32);
        let at = (row.min(self.rows - 2)) * self.columns + column.min(self.columns - 2);
        let mix = |pick: fn(&GridSample) -> f32| {
            let upper = lerp(pick(&self.cells[at]), pick(&self.cells[at + 1]), fx);
            let lower = lerp(pick(&self.cells[at + self.columns]), pick(&self.cells[at + self.columns + 1]), fx);
            lerp(upper, lower, fy)
        };
        GridSample {
            ground_m: mix(|c| c.ground_m),
            sky: mix(|c| c.sky),
            lamps: mix(|c| c.lamps),
            wall_m: mix(|c| c.wall_m),
        }
    }

    fn cell_of(&self, point: DVec3) -> usize {
        let column = ((point.x as f32 - self.min[0]) * self.cells_per_m) as usize;
        let row = ((point.y as f32 - self.min[1]) * self.cells_per_m) as usize;
        row.min(self.rows - 1) * self.columns + column.min(self.columns - 1)
    }

    /// Cells over which an upright box stands.
    fn cells_under(&self, b: &SceneBox) -> (core::ops::Range<usize>, core::ops::Range<usize>) {
        let low = self.cell_of(b.center_in_world - b.half_bounds_m);
        let high = self.cell_of(b.center_in_world + b.half_bounds_m);
        (low % self.columns..high % self.columns + 1, low / self.columns..high / self.columns + 1)
    }

    /// Ground height from triangle corners and centres, gaps filled from ever coarser means.
    fn measure_ground(&mut self, clusters: &[Cluster], boxes: &[SceneBox]) {
        let mut sums = vec![(0.0f32, 0.0f32); self.cells.len()];
        let mut add = |cell: usize, z: f64| {
            sums[cell].0 += z as f32;
            sums[cell].1 += 1.0;
        };
        for cluster in clusters {
            for polygon in &cluster.polygons {
                let corners = &cluster.corners[polygon.range()];
                let corner = |k: usize| cluster.points_in_world[usize::from(corners[k])];
                for k in 2..corners.len() {
                    let (a, ab, ac) = (corner(0), corner(k - 1) - corner(0), corner(k) - corner(0));
                    let steps =
                        (ab.length().max(ac.length()) * 0.7 * f64::from(self.cells_per_m)).clamp(1.0, 24.0) as u32;
                    for i in 0..=steps {
                        for j in 0..=steps - i {
                            let [u, v] = [i, j].map(|n| f64::from(n) / f64::from(steps));
                            let point = a + ab * u + ac * v;
                            add(self.cell_of(point), point.z);
                        }
                    }
                }
            }
        }
        if clusters.is_empty() {
            for b in boxes {
                add(self.cell_of(b.center_in_world), b.center_in_world.z - b.half_bounds_m.z);
            }
        }
        let filled = fill_gaps(sums, self.columns, self.rows);
        for (cell, ground) in self.cells.iter_mut().zip(filled) {
            cell.ground_m = ground;
        }
    }

    /// Sky share from the horizon in eight directions.
    fn measure_sky(&mut self, boxes: &[SceneBox]) {
        let mut tops: Vec<f32> = self.cells.iter().map(|cell| cell.ground_m).collect();
        for b in boxes {
            let (columns, rows) = self.cells_under(b);
            let top = (b.center_in_world.z + b.half_bounds_m.z) as f32;
            let share = if b.kind == ObstacleKind::TreeCrown { 0.6 } else { 1.0 };
            for row in rows {
                for column in columns.clone() {
                    let cell = row * self.columns + column;
                    let ground = self.cells[cell].ground_m;
                    tops[cell] = tops[cell].max(ground + share * (top - ground));
                }
            }
        }
        const DIRECTIONS: [(i32, i32); 8] = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)];
        for row in 0..self.rows {
            for column in 0..self.columns {
                let cell = row * self.columns + column;
                let ground = self.cells[cell].ground_m;
                let mut open = 0.0;
                for (dx, dy) in DIRECTIONS {
                    let mut tangent = 0.0f32;
                    for step in [1i32, 2, 4, 8, 16, 28] {
                        let x = (column as i32 + dx * step).clamp(0, self.columns as i32 - 1) as usize;
                        let y = (row as i32 + dy * step).clamp(0, self.rows as i32 - 1) as usize;
                        let away = step as f32 / self.cells_per_m * if dx * dy != 0 { 1.414 } else { 1.0 };
                        tangent = tangent.max((tops[y * self.columns + x] - ground) / away);
                    }
                    // 1 - sin(horizon): the open share of a uniform sky in this direction.
                    open += 1.0 - tangent / (1.0 + tangent * tangent).sqrt();
                }
                self.cells[cell].sky = (open / 8.0).clamp(0.08, 1.0);
            }
        }
    }

    /// Distances to the walls of buildings, from the corners of cells, between which places are blended.
    fn measure_walls(&mut self, boxes: &[SceneBox]) {
        let reach = DVec3::splat(f64::from(FAR_FROM_WALLS_M));
        for b in boxes.iter().filter(|b| b.kind == ObstacleKind::Building) {
            let low = self.cell_of(b.center_in_world - b.half_bounds_m - reach);
            let high = self.cell_of(b.center_in_world + b.half_bounds_m + reach);
            for row in low / self.columns..=high / self.columns {
                for column in low % self.columns..=high % self.columns {
                    let place = |at: usize, k: usize| f64::from(self.min[k] + at as f32 / self.cells_per_m);
                    let away = DVec3::new(place(column, 0), place(row, 1), b.center_in_world.z) - b.center_in_world;
                    let beyond =
                        |k: usize| (away.dot(b.axes_in_world[k]).abs() - f64::from(b.half_extents_m[k])).max(0.0);
                    let cell = &mut self.cells[row * self.columns + column];
                    let (x, y) = (beyond(0), beyond(1));
                    cell.wall_m = cell.wall_m.min((x * x + y * y).sqrt() as f32);
                }
            }
        }
    }

    /// Every lamp lights the ground around it.
    fn add_lamps(&mut self, boxes: &[SceneBox]) {
        let mut last = None;
        for b in boxes.iter().filter(|b| b.kind == ObstacleKind::Lamp) {
            // A lamp of several boxes shines once, from where its last box is.
            if last.replace(b.instance) != Some(b.instance) {
                self.add_lamp(self.cell_of(b.center_in_world), bulb(b.seed));
            }
        }
    }

    /// Lights paved ground beside buildings in a town whose map tells of no lamp at all: a real one is not dark there.
    fn add_untold_lamps(&mut self, boxes: &[SceneBox], ground: &GroundKinds) {
        let apart_m = UNTOLD_LAMPS_M.max(4.0 / f64::from(self.cells_per_m));
        let square = |m: f64| (m / apart_m).floor() as i64;
        let reach = DVec3::splat(BESIDE_BUILDINGS_M);
        let mut squares = BTreeSet::new();
        for b in boxes.iter().filter(|b| b.kind == ObstacleKind::Building) {
            let half = b.half_bounds_m + reach;
            if (b.center_in_world + half).is_finite() {
                let [low, high] = [b.center_in_world - half, b.center_in_world + half];
                for x in square(low.x)..=square(high.x) {
                    squares.extend((square(low.y)..=square(high.y)).map(|y| (x, y)));
                }
            }
        }
        for (x, y) in squares {
            let seed = hash(x as u32, y as u32);
            let along = |square: i64, index| apart_m * (square as f64 + f64::from(draw(seed, index)));
            let mut tried = (0..TRIED).map(|k| DVec2::new(along(x, 2 * k), along(y, 2 * k + 1)));
            let is_street =
                |place: &DVec2| ground.is_paved(*place) && self.cells[self.cell_of(place.extend(0.0))].wall_m > 0.5;
            if let Some(place) = tried.find(is_street) {
                self.add_lamp(self.cell_of(place.extend(0.0)), bulb(hash(seed, 1)));
            }
        }
    }

    /// Lights the ground around a cell like a bulb above it.
    fn add_lamp(&mut self, cell: usize, strength: f32) {
        let radius = (22.0 * self.cells_per_m) as usize + 1;
        let (column, row) = (cell % self.columns, cell / self.columns);
        for y in row.saturating_sub(radius)..(row + radius + 1).min(self.rows) {
            for x in column.saturating_sub(radius)..(column + radius + 1).min(self.columns) {
                let (dx, dy) = (x as f32 - column as f32, y as f32 - row as f32);
                let far = (dx * dx + dy * dy) / (self.cells_per_m * self.cells_per_m);
                let height = 5.5f32;
                let fall = height * height / (height * height + far);
                let edge = (1.0 - far / 484.0).max(0.0);
                self.cells[y * self.columns + x].lamps += strength * fall * fall * edge;
            }
        }
    }
}

/// Means where something was measured, and means of coarser and coarser neighbourhoods elsewhere.
fn fill_gaps(sums: Vec<(f32, f32)>, columns: usize, rows: usize) -> Vec<f32> {
    if columns <= 1 && rows <= 1 {
        return sums.iter().map(|(sum, count)| if *count > 0.0 { sum / count } else { 0.0 }).collect();
    }
    let (half_columns, half_rows) = (columns.div_ceil(2), rows.div_ceil(2));
    let mut coarse = vec![(0.0f32, 0.0f32); half_columns * half_rows];
    for (i, (sum, count)) in sums.iter().enumerate() {
        if *count > 0.0 {
            let cell = &mut coarse[(i / columns / 2) * half_columns + (i % columns) / 2];
            cell.0 += sum / count;
            cell.1 += 1.0;
        }
    }
    let wider = fill_gaps(coarse, half_columns, half_rows);
    let from_wider = |i: usize| wider[(i / columns / 2) * half_columns + (i % columns) / 2];
    sums.iter().enumerate().map(|(i, (sum, count))| if *count > 0.0 { sum / count } else { from_wider(i) }).collect()
}
