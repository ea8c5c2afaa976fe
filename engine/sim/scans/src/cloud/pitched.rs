//! Pitched roofs of clouds: rectangles of a building whose points lie on a gable or on slopes from all walls.

use crate::grid::Grid;
use crate::solid_cells::{BoxCover, boxes_of};
use crate::window_cover::{Bases, Column, Volumes};
use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec2, DVec3, real};
use cosfly_town::solids::{Footprint, ROOF_STEP_M, Roof, building_boxes};

/// Narrowest rectangle, metres, and smallest, square metres.
const NARROWEST_M: f64 = 4.0;
const SMALLEST_M2: f64 = 24.0;
/// Most rectangles of a building that are looked at, and how often one is halved.
const MOST: usize = 16;
const HALVINGS: usize = 3;
/// Share of the cells of a ragged edge, and most such rows on each side.
const RAGGED: core::ops::Range<f64> = 0.15..1.0;
const MOST_RAGGED: usize = 2;
/// Lowest rise, metres, and slopes, rise over run.
const LEAST_RISE_M: f64 = 0.75;
const SLOPES: core::ops::RangeInclusive<f64> = 0.15..=1.7;
/// Share of the highest points of the cells that must lie on the slopes, and their least number.
const LEAST_SHARE: f64 = 0.8;
const LEAST_POINTS: usize = 10;
/// Space below a slope that boxes over it fill as well: they stand on the roof, metres.
const FOOT_M: f64 = 1.0;
/// Points this little above a slope lie on it, metres.
const ROUNDING_M: f64 = 0.005;

/// A building on a grid.
pub struct Site<'a> {
    /// The grid, turned along the walls.
    pub grid: &'a Grid,
    /// Its columns of cells.
    pub columns: &'a [Option<Column>],
    /// Cells without a column that boxes may cover.
    pub is_free: &'a [bool],
    /// Its points, metres.
    pub points: Vec<DVec3>,
    /// Lowest ground beside or under it, metres.
    pub foot_m: f64,
    /// Height of the steps in which boxes follow roofs, metres.
    pub step_m: f64,
}

/// Shapes of a roof.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    /// Two slopes from a ridge along the first or second axis.
    Gable(usize),
    /// Slopes from all walls.
    Hip,
}

/// A rectangle under one roof, in the axes of the grid, cells.
#[derive(Clone, Copy, Debug)]
struct Pitched {
    /// First column and row, their numbers.
    cells: [usize; 4],
    low: DVec2,
    high: DVec2,
    form: Form,
    /// Height of the ridge, metres, and fall for each cell.
    ridge_m: f64,
    slope: f64,
}

/// The highest point of a cell, and bounds of all its points in plan.
#[derive(Clone, Copy, Debug)]
struct Seen {
    top: DVec3,
    low: DVec2,
    high: DVec2,
}

impl Pitched {
    /// Way down from the ridge in plan, cells.
    fn way_down(&self, at: DVec2) -> f64 {
        let (away, half) = ((at - 0.5 * (self.low + self.high)).abs(), self.half());
        match self.form {
            Form::Gable(along) => away[1 - along],
            Form::Hip => half.min_element() - (half - away).min_element(),
        }
    }

    /// Way from the ridge to the eaves, cells.
    fn run(&self) -> f64 {
        match self.form {
            Form::Gable(along) => self.half()[1 - along],
            Form::Hip => self.half().min_element(),
        }
    }

    fn half(&self) -> DVec2 {
        0.5 * (self.high - self.low)
    }

    fn height_m(&self, at: DVec2) -> f64 {
        self.ridge_m - self.slope * self.way_down(at)
    }

    fn holds(&self, at: DVec2) -> bool {
        at.cmpge(self.low).all() && at.cmple(self.high).all()
    }

    /// The straight line through heights over ways from the ridge, twice without what is off it; the share of points on it.
    fn fitted(mut self, tops: &[DVec3], loose_m: f64) -> Option<(f64, Self)> {
        let samples: Vec<(f64, f64)> = tops.iter().map(|at| (self.way_down(at.truncate()), at.z)).collect();
        let mut kept = samples.clone();
        for _ in 0..3 {
            if kept.len() < LEAST_POINTS {
                return None;
            }
            let count = kept.len() as f64;
            let (t, z) = kept.iter().fold((0.0, 0.0), |(t, z), sample| (t + sample.0 / count, z + sample.1 / count));
            let squares: f64 = kept.iter().map(|sample| (sample.0 - t) * (sample.0 - t)).sum();
            let products: f64 = kept.iter().map(|sample| (sample.0 - t) * (sample.1 - z)).sum();
            self.slope = -products / squares.max(1e-9);
            self.ridge_m = z + self.slope * t;
            let is_on = |(t, z): &(f64, f64)| (z - self.ridge_m + self.slope * t).abs() <= loose_m;
            kept = samples.iter().copied().filter(is_on).collect();
        }
        let share = kept.len() as f64 / samples.len() as f64;
        (share >= LEAST_SHARE).then_some((share, self))
    }
}

impl Site<'_> {
    /// Boxes of the building with slopes in steps; none where no roof of it is pitched.
    pub fn cover(&self) -> Option<BoxCover> {
        let places: Vec<DVec3> = self.points.iter().map(|at| self.grid.in_cells(at.truncate()).extend(at.z)).collect();
        let roofs = self.roofs(&places);
        if roofs.is_empty() || self.step_m < ROOF_STEP_M + self.loose_m() {
            return None;
        }
        let mut columns = self.columns.to_vec();
        let mut cover = BoxCover::default();
        let mut is_free = self.is_free.to_vec();
        for mut roof in roofs {
            let own = || places.iter().filter(|at| roof.holds(at.truncate()));
            let above_m = |at: &DVec3| at.z - roof.height_m(at.truncate());
            // The slopes are lifted onto all points that are near them.
            let lift_m =
                own().map(above_m).filter(|above_m| *above_m <= self.loose_m()).fold(0.0, f64::max) + ROUNDING_M;
            let off: Vec<DVec3> = own().filter(|at| above_m(at) > lift_m).copied().collect();
            roof.ridge_m += lift_m;
            let shapes = self.boxes_of(&roof);
            let solid = self.take(&roof, &off, &mut columns, &mut is_free);
            let filled: f64 = shapes.iter().map(|shape| 8.0 * shape.half_extents_m.element_product()).sum();
            let volumes = Volumes { solid, gained: (filled - solid).max(0.0), lost: 0.0 };
            cover.volumes = cover.volumes.plus(volumes, 1.0);
            cover.shapes.extend(shapes);
        }
        let rest = boxes_of(self.grid, &columns, self.step_m, Bases::Highest, |cell| is_free[cell]);
        cover.volumes = cover.volumes.plus(rest.volumes, 1.0);
        cover.shapes.extend(rest.shapes);
        Some(cover)
    }

    /// Farthest from a slope that points of it are, metres.
    fn loose_m(&self) -> f64 {
        0.25 * self.step_m
    }

    /// Takes the cells of a roof from the columns but for what stands on it; gives the space that they had.
    fn take(&self, roof: &Pitched, off: &[DVec3], columns: &mut [Option<Column>], is_free: &mut [bool]) -> f64 {
        let [first, low, width, height] = roof.cells;
        let mut solid = 0.0;
        for cell in (low..low + height).flat_map(|row| (first..first + width).map(move |column| (row, column))) {
            let cell = cell.0 * self.grid.columns + cell.1;
            solid += columns[cell].take().map_or(0.0, |column| column.top_m - column.base_m);
            is_free[cell] = false;
        }
        for at in off {
            let cell = at.y as usize * self.grid.columns + at.x as usize;
            let base_m = (roof.height_m(at.truncate()) - FOOT_M).max(self.foot_m);
            let column = columns[cell].get_or_insert(Column { base_m, top_m: at.z });
            *column = Column { base_m: column.base_m.min(base_m), top_m: column.top_m.max(at.z) };
        }
        solid * self.grid.cell_m * self.grid.cell_m
    }

    /// The boxes of a roof and of the walls under it.
    fn boxes_of(&self, roof: &Pitched) -> Vec<OrientedBox> {
        let corners = [roof.low, DVec2::new(roof.high.x, roof.low.y), roof.high, DVec2::new(roof.low.x, roof.high.y)];
        let footprint = Footprint { outer: corners.map(|corner| self.grid.point(corner)).to_vec(), holes: vec![] };
        let rise_m = roof.slope * roof.run();
        let eaves_m = roof.ridge_m - rise_m;
        let roof = match roof.form {
            Form::Hip => Roof::Hipped { rise_m },
            Form::Gable(along) => {
                let ridge_yaw_rad = Some(self.grid.yaw_rad + real::FRAC_PI_2 * along as f64);
                Roof::Gabled { rise_m, ridge_yaw_rad }
            }
        };
        building_boxes(&footprint, self.foot_m, eaves_m, roof).boxes
    }

    /// All pitched roofs, the largest rectangles first.
    fn roofs(&self, places: &[DVec3]) -> Vec<Pitched> {
        let stands = |column: &Option<Column>| column.is_some_and(|column| column.base_m < self.foot_m + FOOT_M);
        let mut is_open: Vec<bool> = self.columns.iter().map(stands).collect();
        let tops = self.highest(places);
        let mut roofs = Vec::new();
        for _ in 0..MOST {
            let Some(cells) = largest_rectangle(&is_open, self.grid.columns) else { break };
            if (cells[2] * cells[3]) as f64 * self.grid.cell_m * self.grid.cell_m < SMALLEST_M2 {
                break;
            }
            let [first, low, width, height] = self.grown(cells);
            self.add_roofs([first, low, width, height], HALVINGS, &tops, &mut roofs);
            for row in low..low + height {
                is_open[row * self.grid.columns + first..][..width].fill(false);
            }
        }
        roofs
    }

    /// A rectangle with the ragged edges beside it: rows of cells some of which are of the building, and not all.
    fn grown(&self, mut cells: [usize; 4]) -> [usize; 4] {
        for side in [0, 1, 2, 3].repeat(MOST_RAGGED) {
            let [first, low, width, height] = cells;
            let (along, [at, from, count], wider) = match side {
                0 => (first > 0, [first.wrapping_sub(1), low, height], [first.wrapping_sub(1), low, width + 1, height]),
                1 => (low > 0, [low.wrapping_sub(1), first, width], [first, low.wrapping_sub(1), width, height + 1]),
                2 => (true, [first + width, low, height], [first, low, width + 1, height]),
                _ => (true, [low + height, first, width], [first, low, width, height + 1]),
            };
            let is_upright = side % 2 == 0;
            let own = (from..from + count).filter(|it| if is_upright { self.has(at, *it) } else { self.has(*it, at) });
            let share = own.count() as f64 / count as f64;
            if along && RAGGED.contains(&share) {
                cells = wider;
            }
        }
        cells
    }

    /// Whether a cell is of the building.
    fn has(&self, column: usize, row: usize) -> bool {
        let is_inside = column < self.grid.columns && row < self.grid.rows;
        is_inside && self.columns[row * self.grid.columns + column].is_some()
    }

    /// The points of each cell in short.
    fn highest(&self, places: &[DVec3]) -> Vec<Option<Seen>> {
        let mut tops: Vec<Option<Seen>> = vec![None; self.grid.cells()];
        for at in places {
            let plan = at.truncate();
            let seen = tops[at.y as usize * self.grid.columns + at.x as usize].get_or_insert(Seen {
                top: *at,
                low: plan,
                high: plan,
            });
            (seen.low, seen.high) = (seen.low.min(plan), seen.high.max(plan));
            if at.z > seen.top.z {
                seen.top = *at;
            }
        }
        tops
    }

    /// Adds the roof of a rectangle, else those of its halves.
    fn add_roofs(&self, cells: [usize; 4], halvings: usize, tops: &[Option<Seen>], roofs: &mut Vec<Pitched>) {
        let [first, low, width, height] = cells;
        if width.min(height) as f64 * self.grid.cell_m < NARROWEST_M {
            return;
        }
        let rows = (low..low + height).flat_map(|row| tops[row * self.grid.columns + first..][..width].iter());
        let seen: Vec<Seen> = rows.flatten().copied().collect();
        let own: Vec<DVec3> = seen.iter().map(|seen| seen.top).collect();
        let forms = [Form::Gable(0), Form::Gable(1), Form::Hip];
        let fits = forms.into_iter().filter_map(|form| {
            let roof = self.rectangle(cells, form, &seen)?;
            let (share, roof) = roof.fitted(&own, self.loose_m())?;
            let is_roof = SLOPES.contains(&(roof.slope / self.grid.cell_m)) && roof.slope * roof.run() >= LEAST_RISE_M;
            is_roof.then_some((share, roof))
        });
        match fits.max_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((_, roof)) => roofs.push(roof),
            None if halvings == 0 => {}
            None if width >= height => {
                self.add_roofs([first, low, width / 2, height], halvings - 1, tops, roofs);
                self.add_roofs([first + width / 2, low, width - width / 2, height], halvings - 1, tops, roofs);
            }
            None => {
                self.add_roofs([first, low, width, height / 2], halvings - 1, tops, roofs);
                self.add_roofs([first, low + height / 2, width, height - height / 2], halvings - 1, tops, roofs);
            }
        }
    }

    /// The rectangle of some cells: out to their borders where the building goes on, else to the last points.
    fn rectangle(&self, cells: [usize; 4], form: Form, own: &[Seen]) -> Option<Pitched> {
        let [first, low, width, height] = cells;
        let borders = [[first, low], [first + width, low + height]].map(|[x, y]| DVec2::new(x as f64, y as f64));
        let seen = own.iter().fold((borders[1], borders[0]), |(low, high), at| (low.min(at.low), high.max(at.high)));
        let has = |column: usize, row: usize| self.has(column, row);
        let goes_on = [
            first > 0 && (low..low + height).any(|row| has(first - 1, row)),
            low > 0 && (first..first + width).any(|column| has(column, low - 1)),
            (low..low + height).any(|row| has(first + width, row)),
            (first..first + width).any(|column| has(column, low + height)),
        ];
        let pick = |goes_on: bool, border: f64, seen: f64| if goes_on { border } else { seen };
        let [from, to] = borders;
        let roof = Pitched {
            cells,
            low: DVec2::new(pick(goes_on[0], from.x, seen.0.x), pick(goes_on[1], from.y, seen.0.y)),
            high: DVec2::new(pick(goes_on[2], to.x, seen.1.x), pick(goes_on[3], to.y, seen.1.y)),
            form,
            ridge_m: 0.0,
            slope: 0.0,
        };
        (roof.half().min_element() * self.grid.cell_m >= 0.4 * NARROWEST_M).then_some(roof)
    }
}

/// The largest rectangle of open cells: first column and row, their numbers.
fn largest_rectangle(is_open: &[bool], columns: usize) -> Option<[usize; 4]> {
    let mut heights = vec![0_usize; columns + 1];
    let mut best: Option<[usize; 4]> = None;
    let mut open: Vec<(usize, usize)> = Vec::new();
    for (row, cells) in is_open.chunks(columns).enumerate() {
        for (column, own) in heights.iter_mut().enumerate() {
            let is_open = cells.get(column).is_some_and(|is_open| *is_open);
            *own = if is_open { *own + 1 } else { 0 };
            let mut start = column;
            while let Some((first, height)) = open.pop_if(|(_, height)| *height > *own) {
                start = first;
                let area = (column - first) * height;
                if best.is_none_or(|[_, _, width, height]| area > width * height) {
                    best = Some([first, row + 1 - height, column - first, height]);
                }
            }
            if *own > 0 && open.last().is_none_or(|(_, height)| *height < *own) {
                open.push((start, *own));
            }
        }
        open.clear();
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_geometry::{BoxBvh, SpatialQuery};

    #[test]
    fn the_largest_rectangle_is_found() {
        let is_open = |cell: usize| matches!((cell % 9, cell / 9), (1..=6, 2..=4) | (2..=3, 1..=6));
        let open: Vec<bool> = (0..72).map(is_open).collect();
        assert_eq!(largest_rectangle(&open, 9), Some([1, 2, 6, 3]));
        assert_eq!(largest_rectangle(&[false; 9], 3), None);
    }

    /// A turned house 16 m by 9 m, its eaves at 5 m, of a form, with a chimney.
    fn check_house(form: Form) {
        let (sin, cos) = real::sin_cos(0.3);
        let height_m = |x: f64, y: f64| match form {
            Form::Gable(0) => 5.0 + 0.7 * (4.5 - y.abs()),
            Form::Gable(_) => 5.0 + 0.35 * (8.0 - x.abs()),
            Form::Hip => 5.0 + 0.7 * (8.0 - x.abs()).min(4.5 - y.abs()),
        };
        let points: Vec<DVec3> = (0..41 * 31)
            .map(|i| {
                let (x, y) = (-8.0 + 0.4 * f64::from(i % 41), -4.5 + 0.3 * f64::from(i / 41));
                let chimney_m = if (2.0..2.7).contains(&x) && (1.0..1.7).contains(&y) { 2.0 } else { 0.0 };
                DVec3::new(cos * x - sin * y, sin * x + cos * y, height_m(x, y) + chimney_m)
            })
            .collect();
        let grid = Grid::flush(points.iter().map(|at| at.truncate()), 0.5, 0.3);
        let mut columns: Vec<Option<Column>> = vec![None; grid.cells()];
        for at in &points {
            let column = columns[grid.cell_of(at.truncate())].get_or_insert(Column { base_m: 0.0, top_m: at.z });
            column.top_m = column.top_m.max(at.z);
        }
        let is_free = vec![false; grid.cells()];
        let site = Site { grid: &grid, columns: &columns, is_free: &is_free, points, foot_m: 0.0, step_m: 1.0 };
        let places: Vec<DVec3> = site.points.iter().map(|at| grid.in_cells(at.truncate()).extend(at.z)).collect();
        let roofs = site.roofs(&places);
        assert!(roofs.len() == 1 && roofs[0].form == form, "{form:?}: {roofs:?}");
        let cover = site.cover().expect("the roof is pitched");
        assert!(cover.shapes.len() < 20, "{form:?}: {}", cover.shapes.len());
        let boxes = BoxBvh::build(cover.shapes);
        for at in &site.points {
            let near = boxes.nearest(*at, 1.0).map(|near| near.distance_m);
            assert!(near.is_some_and(|distance_m| distance_m <= 1e-6), "{form:?}: {at} is {near:?} m off");
        }
    }

    #[test]
    fn gables_and_hips_are_found_and_hold_all_points() {
        [Form::Gable(0), Form::Gable(1), Form::Hip].into_iter().for_each(check_house);
    }
}
