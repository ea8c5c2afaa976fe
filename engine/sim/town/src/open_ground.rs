//! [`OpenGround`]: ground that no obstacle stands on as walkable plazas, in rectangles that follow it.

use cosfly_domain::{Obstacle, OrientedBox, WalkableKind, WalkablePolygon};
use cosfly_frames::{DVec2, DVec3, real};

/// Most cells.
const MOST_CELLS: f64 = 4e6;
/// Obstacles that begin higher above the ground leave room for a person; those that end lower are part of it, metres.
const HEADROOM_M: f64 = 2.2;
const LOWEST_M: f64 = 0.1;
/// Longest side of a plaza, metres.
const LONGEST_M: f64 = 24.0;
/// Largest distance of the ground from a plaza unless somebody asks for less, metres.
const MOST_BEND_M: f64 = 0.2;
/// Steepest ground to walk on, rise over run.
pub const STEEPEST: f64 = 0.35;

/// Square cells in rows, some of them open.
#[derive(Clone, Debug)]
pub struct OpenGround {
    low: DVec2,
    /// Side of a cell, metres.
    pub cell_m: f64,
    /// Largest distance of the ground from a plaza, metres.
    pub most_bend_m: f64,
    columns: usize,
    rows: usize,
    /// By rows.
    pub is_open: Vec<bool>,
}

/// Height of the ground at a place, metres; none where there is no ground.
pub type HeightAt<'a> = &'a dyn Fn(DVec2) -> Option<f64>;

impl OpenGround {
    /// Closed cells between two corners, wider than `narrowest_m` where there would be too many.
    pub fn new(low: DVec2, high: DVec2, narrowest_m: f64) -> Self {
        let size = (high - low).max(DVec2::ZERO);
        let cell_m = narrowest_m.max((size.element_product() / MOST_CELLS).sqrt()).max(size.max_element() / 1e5);
        let [columns, rows] = size.to_array().map(|side_m| (side_m / cell_m).ceil().max(1.0) as usize);
        Self { low, cell_m, most_bend_m: MOST_BEND_M, columns, rows, is_open: vec![false; columns * rows] }
    }

    /// Middle of a cell.
    pub fn middle(&self, cell: usize) -> DVec2 {
        self.point((cell % self.columns) as f64 + 0.5, (cell / self.columns) as f64 + 0.5)
    }

    fn point(&self, column: f64, row: f64) -> DVec2 {
        self.low + self.cell_m * DVec2::new(column, row)
    }

    /// Opens the cells whose middle is within a distance of a box in plan.
    pub fn open_near(&mut self, shape: &OrientedBox, reach_m: f64) {
        for cell in self.cells_near(shape, reach_m) {
            self.is_open[cell] = true;
        }
    }

    /// Closes the cells that an obstacle stands on.
    pub fn close_under(&mut self, obstacle: &Obstacle, ground_m: HeightAt<'_>) {
        let (low, high) = obstacle.shape.bounds_in_world();
        for cell in self.cells_near(&obstacle.shape, 0.5 * self.cell_m) {
            let is_in_the_way = |ground_m: f64| low.z < ground_m + HEADROOM_M && high.z > ground_m + LOWEST_M;
            if self.is_open[cell] && ground_m(self.middle(cell)).is_none_or(is_in_the_way) {
                self.is_open[cell] = false;
            }
        }
    }

    fn cells_near(&self, shape: &OrientedBox, reach_m: f64) -> Vec<usize> {
        let (low, high) = shape.bounds_in_world();
        let cell = |point: DVec2| ((point - self.low) / self.cell_m).max(DVec2::ZERO);
        let (from, to) = (cell(low.truncate() - reach_m), cell(high.truncate() + reach_m));
        let (sin, cos) = real::sin_cos(shape.yaw_rad);
        let is_near = |cell: &usize| {
            let away = self.middle(*cell) - shape.center_in_world.truncate();
            let local = DVec2::new(cos * away.x + sin * away.y, cos * away.y - sin * away.x).abs();
            local.cmple(shape.half_extents_m.truncate() + reach_m).all()
        };
        let rows = from.y as usize..(to.y as usize + 1).min(self.rows);
        let columns = from.x as usize..(to.x as usize + 1).min(self.columns);
        rows.flat_map(|row| columns.clone().map(move |column| row * self.columns + column)).filter(is_near).collect()
    }

    /// Plazas on all open cells, synthetic.
    pub fn plazas(mut self, ground_m: HeightAt<'_>) -> Vec<WalkablePolygon> {
        let mut plazas = Vec::new();
        for first in 0..self.is_open.len() {
            if self.is_open[first] {
                plazas.extend(self.plaza(first, ground_m));
            }
        }
        plazas
    }

    /// A plaza from a cell on, grown as long as the ground is open and nearly plane. Takes its cells.
    fn plaza(&mut self, first: usize, ground_m: HeightAt<'_>) -> Option<WalkablePolygon> {
        let at = [first % self.columns, first / self.columns];
        let most = (LONGEST_M / self.cell_m).floor().max(1.0) as usize;
        let (mut width, mut height) = (1, 1);
        let mut grows = [true; 2];
        // By turns to both sides, so that plazas become wide rather than long.
        while grows != [false; 2] {
            if grows[0] {
                grows[0] = width < most
                    && at[0] + width < self.columns
                    && (0..height).all(|line| self.is_open[first + width + line * self.columns])
                    && self.corners(at, [width + 1, height], ground_m).is_some();
                width += usize::from(grows[0]);
            }
            if grows[1] {
                grows[1] = height < most
                    && at[1] + height < self.rows
                    && self.is_open[first + height * self.columns..][..width].iter().all(|open| *open)
                    && self.corners(at, [width, height + 1], ground_m).is_some();
                height += usize::from(grows[1]);
            }
        }
        for line in 0..height {
            self.is_open[first + line * self.columns..][..width].fill(false);
        }
        let outline_in_world = self.corners(at, [width, height], ground_m)?.to_vec();
        Some(WalkablePolygon { kind: WalkableKind::Plaza, outline_in_world, synthetic: true })
    }

    /// Corners of a rectangle of cells on the ground, if the ground is nearly plane and not steep there.
    fn corners(&self, [column, row]: [usize; 2], size: [usize; 2], ground_m: HeightAt<'_>) -> Option<[DVec3; 4]> {
        let [width, height] = size.map(|cells| cells as f64);
        let at = |x: f64, y: f64| {
            let point = self.point(column as f64 + x * width, row as f64 + y * height);
            ground_m(point).map(|height_m| point.extend(height_m))
        };
        let [low, right, high, left] = [at(0.0, 0.0)?, at(1.0, 0.0)?, at(1.0, 1.0)?, at(0.0, 1.0)?];
        let slope = (right.z - low.z).abs().max((high.z - left.z).abs()) / (width * self.cell_m);
        let across = (left.z - low.z).abs().max((high.z - right.z).abs()) / (height * self.cell_m);
        let bends = [(0.5, 0.5), (0.5, 0.0), (0.5, 1.0), (0.0, 0.5), (1.0, 0.5)].into_iter().any(|(x, y)| {
            let between = low.lerp(right, x).lerp(left.lerp(high, x), y);
            at(x, y).is_none_or(|point| (point.z - between.z).abs() > self.most_bend_m)
        });
        (!bends && slope.max(across) <= STEEPEST).then_some([low, right, high, left])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::ObstacleKind;

    #[test]
    fn plazas_end_at_obstacles_edges_and_cliffs_and_pass_under_bridges() {
        let mut open = OpenGround::new(DVec2::ZERO, DVec2::new(40.0, 20.0), 1.0);
        // A cliff at x = 30, and nothing beyond x = 35.
        let ground_m = |at: DVec2| (at.x <= 35.0).then_some(if at.x < 30.0 { 0.1 * at.x } else { 9.0 });
        open.is_open.fill(true);
        let mut close = |center: [f64; 3], half: [f64; 3]| {
            let shape = OrientedBox { center_in_world: center.into(), half_extents_m: half.into(), yaw_rad: 0.0 };
            open.close_under(
                &Obstacle { shape, kind: ObstacleKind::Static, object_id: 1, synthetic: false },
                &ground_m,
            );
        };
        close([10.0, 10.0, 3.0], [3.0, 3.0, 3.0]);
        close([20.0, 10.0, 8.0], [2.0, 10.0, 1.0]);
        let plazas = open.plazas(&ground_m);
        let holds = |x: f64, y: f64| {
            let is_inside = |plaza: &&WalkablePolygon| crate::polygons::contains(&plaza.plan(), DVec2::new(x, y));
            plazas.iter().find(is_inside).is_some()
        };
        assert!(!holds(10.0, 10.0) && holds(20.5, 10.5), "the house stands in the way and the bridge does not");
        assert!(holds(2.5, 2.5) && holds(32.5, 2.5) && !holds(29.9, 2.5) && !holds(36.5, 2.5));
        for corner in plazas.iter().flat_map(|plaza| &plaza.outline_in_world) {
            assert_eq!(Some(corner.z), ground_m(corner.truncate()), "corners stand on the ground");
        }
    }
}
