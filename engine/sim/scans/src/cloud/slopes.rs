//! [`Slopes`]: planes of a pitched roof through its highest points, and tops of columns that follow them.

use crate::grid::Grid;
use crate::window_cover::Column;
use cosfly_frames::{DVec2, DVec3};
use std::collections::VecDeque;

/// Height of the steps in which boxes follow slopes, metres.
pub const SLOPE_STEP_M: f64 = 0.75;
/// Share of a roof's cells that lie on slopes from which on it is pitched.
pub const PITCHED_SHARE: f64 = 0.4;
/// Points lie off their plane by less, metres.
const OFF_M: f64 = 0.25;
/// Rises of slopes, metres per metre: from 6 to 63 degrees.
const RISES: [f64; 2] = [0.1, 2.0];
/// Fewest points of a plane.
const FEWEST: usize = 6;
/// A slope that falls across the cells' axes by less than this share of its rise falls along them.
const STRAIGHT: f64 = 0.25;
/// Cells beside a slope follow it where they are higher by less, or lower by less, metres.
const BESIDE_M: [f64; 2] = [0.1, 1.0];
/// No plane.
const NONE: u16 = u16::MAX;

/// A plane over a grid: places in metres along the grid's axes.
#[derive(Clone, Copy, Debug)]
struct Slope {
    rise: DVec2,
    base_m: f64,
}

impl Slope {
    fn at(&self, place: DVec2) -> f64 {
        self.base_m + self.rise.dot(place)
    }

    /// The plane through points by least squares; `None` for few points or points in a line.
    fn through(points: &[DVec3]) -> Option<Self> {
        let count = points.len() as f64;
        let mean = points.iter().copied().sum::<DVec3>() / count.max(1.0);
        let [mut xx, mut xy, mut yy, mut xz, mut yz] = [0.0; 5];
        for away in points.iter().map(|point| *point - mean) {
            (xx, xy, yy) = (xx + away.x * away.x, xy + away.x * away.y, yy + away.y * away.y);
            (xz, yz) = (xz + away.x * away.z, yz + away.y * away.z);
        }
        let area = xx * yy - xy * xy;
        if points.len() < FEWEST || area < 0.02 * (xx + yy) * (xx + yy) {
            return None;
        }
        let rise = DVec2::new(xz * yy - yz * xy, yz * xx - xz * xy) / area;
        Some(Self { rise, base_m: mean.z - rise.dot(mean.truncate()) })
    }

    /// The plane that falls along an axis of the grid, where it nearly does.
    fn straight(self, points: &[DVec3]) -> Self {
        let axis = usize::from(self.rise.y.abs() > self.rise.x.abs());
        if self.rise[1 - axis].abs() > STRAIGHT * self.rise[axis].abs() {
            return self;
        }
        let count = points.len() as f64;
        let mean = points.iter().copied().sum::<DVec3>() / count.max(1.0);
        let (mut along, mut up) = (0.0, 0.0);
        for away in points.iter().map(|point| *point - mean) {
            along += away[axis] * away[axis];
            up += away[axis] * away.z;
        }
        let mut rise = DVec2::ZERO;
        rise[axis] = up / along.max(1e-9);
        Self { rise, base_m: mean.z - rise.dot(mean.truncate()) }
    }

    fn is_pitched(&self) -> bool {
        (RISES[0]..RISES[1]).contains(&self.rise.length())
    }
}

/// Planes through the highest points of cells.
pub struct Slopes {
    slopes: Vec<Slope>,
    labels: Vec<u16>,
}

impl Slopes {
    /// Planes through `highest`, each cell's highest point: place in metres along the grid's axes, height. `reach` is how many cells apart
    /// neighbouring points may be.
    pub fn of(grid: &Grid, highest: &[Option<DVec3>], reach: usize) -> Self {
        let near =
            |cell: usize| -> Vec<DVec3> { grid.around_cell(cell, reach).filter_map(|near| highest[near]).collect() };
        let own = |cell: usize| {
            highest[cell]?;
            let points = near(cell);
            let slope = Slope::through(&points)?;
            let off = |point: &DVec3| (point.z - slope.at(point.truncate())) * (point.z - slope.at(point.truncate()));
            Some((points.iter().map(off).sum::<f64>() / points.len() as f64, cell, slope))
        };
        let mut seeds: Vec<(f64, usize, Slope)> = (0..highest.len()).filter_map(own).collect();
        seeds.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut found = Self { slopes: Vec::new(), labels: vec![NONE; highest.len()] };
        let mut is_tried = vec![false; highest.len()];
        for (_, seed, slope) in seeds {
            if found.labels[seed] != NONE || is_tried[seed] || found.slopes.len() >= usize::from(NONE) {
                continue;
            }
            let members = found.grown(grid, highest, (seed, slope, reach));
            members.iter().for_each(|cell| is_tried[*cell] = true);
            let points: Vec<DVec3> = members.iter().filter_map(|cell| highest[*cell]).collect();
            let Some(slope) = Slope::through(&points).filter(Slope::is_pitched) else { continue };
            let slope = slope.straight(&points);
            // No point stands out of it.
            let over_m = points.iter().map(|point| point.z - slope.at(point.truncate())).fold(0.0, f64::max);
            members.iter().for_each(|cell| found.labels[*cell] = found.slopes.len() as u16);
            found.slopes.push(Slope { base_m: slope.base_m + over_m, ..slope });
        }
        found
    }

    /// Cells that hang together with a seed and lie on its plane.
    fn grown(&self, grid: &Grid, highest: &[Option<DVec3>], (seed, slope, reach): (usize, Slope, usize)) -> Vec<usize> {
        let (mut slope, mut members) = (slope, Vec::new());
        for _ in 0..3 {
            let mut is_in = vec![false; highest.len()];
            (members, is_in[seed]) = (vec![seed], true);
            let mut next = 0;
            while next < members.len() {
                for near in grid.around_cell(members[next], reach) {
                    let is_on = |point: DVec3| (point.z - slope.at(point.truncate())).abs() < OFF_M;
                    if !is_in[near] && self.labels[near] == NONE && highest[near].is_some_and(is_on) {
                        is_in[near] = true;
                        members.push(near);
                    }
                }
                next += 1;
            }
            let points: Vec<DVec3> = members.iter().filter_map(|cell| highest[*cell]).collect();
            let Some(better) = Slope::through(&points) else { break };
            slope = better;
        }
        members
    }

    /// Raises or lowers the tops of roofs to the slopes over their cells; gives the share of cells on slopes. `seeds` are the cells whose points
    /// each cell takes after, `points` those of [`Self::of`].
    pub fn follow(
        mut self,
        grid: &Grid,
        roofs: &mut [Option<Column>],
        seeds: &[u32],
        points: (&[Option<DVec3>], usize),
    ) -> f64 {
        let of_seed = |cell: usize| self.labels.get(seeds[cell] as usize).copied().unwrap_or(NONE);
        let has_roof = |cell: usize| roofs[cell].is_some();
        let labels: Vec<u16> = (0..roofs.len()).map(|cell| if has_roof(cell) { of_seed(cell) } else { NONE }).collect();
        self.labels = labels;
        self.spread(grid, roofs);
        // Planes are a little above their points: no roof rises above the highest point of its building.
        let most_m = points.0.iter().flatten().map(|point| point.z).fold(f64::MIN, f64::max);
        let top_m = |cell: usize| self.top_m(grid, cell, points).map(|top_m| top_m.min(most_m));
        let tops_m: Vec<Option<f64>> = (0..roofs.len()).map(top_m).collect();
        let (mut all, mut on_slopes) = (0.0, 0.0_f64);
        for (roof, top_m) in roofs.iter_mut().zip(tops_m) {
            let Some(column) = roof else { continue };
            all += 1.0;
            if let Some(top_m) = top_m {
                on_slopes += 1.0;
                *column = Column { base_m: column.base_m.min(top_m), top_m };
            }
        }
        on_slopes / f64::max(all, 1.0)
    }

    /// Gives cells beside a slope to it where they are about as high.
    fn spread(&mut self, grid: &Grid, roofs: &[Option<Column>]) {
        let mut queue: VecDeque<usize> = (0..roofs.len()).filter(|cell| self.labels[*cell] != NONE).collect();
        while let Some(cell) = queue.pop_front() {
            let label = self.labels[cell];
            for next in grid.around_cell(cell, 1) {
                let Some(column) = roofs[next].filter(|_| self.labels[next] == NONE) else { continue };
                let over_m = column.top_m - self.slopes[usize::from(label)].at(middle(grid, next));
                if over_m < BESIDE_M[0] && over_m > -BESIDE_M[1] {
                    self.labels[next] = label;
                    queue.push_back(next);
                }
            }
        }
    }

    /// The highest place of the roof over a cell, below its own slope and those that it meets in ridges and hips.
    fn top_m(&self, grid: &Grid, cell: usize, (highest, reach): (&[Option<DVec3>], usize)) -> Option<f64> {
        let own = self.slopes.get(usize::from(self.labels[cell]))?;
        let at = middle(grid, cell);
        let of = |near: usize| Some((near, self.slopes.get(usize::from(self.labels[near]))?));
        let beside = grid.around_cell(cell, 1).filter_map(of);
        // Beyond a ridge or hip the other slope is the lower one; beyond a valley the higher one.
        let is_ridge = |(near, slope): &(usize, &Slope)| slope.at(middle(grid, *near)) < own.at(middle(grid, *near));
        let over: Vec<&Slope> = beside.filter(is_ridge).map(|(_, slope)| slope).collect();
        let places = (0..9).map(|k| at + 0.5 * grid.cell_m * DVec2::new(f64::from(k % 3 - 1), f64::from(k / 3 - 1)));
        let top_m =
            places.map(|at| over.iter().map(|slope| slope.at(at)).fold(own.at(at), f64::min)).fold(f64::MIN, f64::max);
        // No roof rises above all points around.
        let highest_m = grid.around_cell(cell, reach).filter_map(|near| highest[near]).map(|point| point.z);
        Some(top_m.min(highest_m.fold(f64::MIN, f64::max).max(own.at(at) - own.rise.length() * grid.cell_m)))
    }
}

/// The middle of a cell, metres along the grid's axes.
fn middle(grid: &Grid, cell: usize) -> DVec2 {
    grid.cell_m * (DVec2::new((cell % grid.columns) as f64, (cell / grid.columns) as f64) + 0.5)
}
