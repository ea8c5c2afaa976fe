//! [`Terraces`]: the upper faces of a building's boxes on a grid, and the surface between their edges.

use crate::parts::SceneBox;
use crate::roof_steps::{ends_m, half_m};
use cosfly_frames::{DVec2, real};

/// Highest step that is part of a slope, metres.
pub const STEP_M: f64 = 1.3;
/// Upper faces whose heights differ by less are one terrace, metres.
const ONE_TERRACE_M: f64 = 0.06;
/// Sides of cells, metres.
const CELL_M: [f64; 2] = [0.25, 0.6];
/// Cells along a building that are enough.
const ENOUGH: f64 = 240.0;
/// Most cells of one building.
const MOST_CELLS: f64 = 250_000.0;
/// Widest terrace of a slope, metres, and the flattest slope, run over rise.
const WIDEST_M: f64 = 5.0;
const FLATTEST: f64 = 4.5;
/// Directions over half a turn in which terraces are crossed.
const DIRECTIONS: usize = 6;
/// Cracks between boxes are narrower, metres.
const CRACK_M: f64 = 0.05;

/// Heights of a building's upper faces.
pub struct Terraces {
    /// A corner of the grid, world.
    origin: DVec2,
    /// Unit vectors along columns and rows, world.
    axes: [DVec2; 2],
    /// Side of a cell, metres.
    pub cell_m: f64,
    /// Columns and rows.
    pub size: [usize; 2],
    /// Height of each cell's highest box, world, metres; minus infinity where none stands.
    pub tops_m: Vec<f64>,
    /// Foot of that box, world, metres.
    pub feet_m: Vec<f64>,
    /// Rows and columns to the nearest cell at the end of its terrace.
    to_end: Vec<u16>,
}

/// What ends a terrace in a direction.
#[derive(Clone, Copy)]
enum End {
    Upper(f64),
    Lower(f64),
    Edge,
}

impl Terraces {
    /// The terraces of boxes; `None` where they are too wide for a grid.
    pub fn of(boxes: &[SceneBox], members: &[usize]) -> Option<Self> {
        let area = |index: &usize| half_m(&boxes[*index]).element_product();
        let main = members.iter().copied().max_by(|a, b| area(a).total_cmp(&area(b)).then(b.cmp(a)))?;
        let axes = boxes[main].axes_in_world.map(|axis| axis.truncate());
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for index in members {
            for corner in &boxes[*index].corners_in_world[..4] {
                let at = DVec2::new(corner.x * axes[0].x + corner.y * axes[0].y, corner.truncate().dot(axes[1]));
                (low, high) = (low.min(at), high.max(at));
            }
        }
        let wide = high - low;
        let narrow_m = members.iter().map(|index| half_m(&boxes[*index]).min_element()).fold(f64::INFINITY, f64::min);
        let cell_m = (wide.max_element() / ENOUGH).max(narrow_m).clamp(CELL_M[0], CELL_M[1]);
        let size = (wide / cell_m).ceil() + 2.0;
        if !size.is_finite() || size.element_product() > MOST_CELLS {
            return None;
        }
        let size = [size.x as usize, size.y as usize];
        let start = low - cell_m;
        let origin = axes[0] * start.x + axes[1] * start.y;
        let tops_m = vec![f64::NEG_INFINITY; size[0] * size[1]];
        let feet_m = tops_m.clone();
        let mut terraces = Self { origin, axes, cell_m, size, tops_m, feet_m, to_end: Vec::new() };
        members.iter().for_each(|index| terraces.add(&boxes[*index]));
        terraces.to_end = terraces.steps_to_end();
        Some(terraces)
    }

    fn add(&mut self, b: &SceneBox) {
        let [foot_m, top_m] = ends_m(b);
        for cell in self.cells_of(b, CRACK_M) {
            if top_m > self.tops_m[cell] {
                (self.feet_m[cell], self.tops_m[cell]) = (foot_m, top_m);
            }
        }
    }

    fn steps_to_end(&self) -> Vec<u16> {
        let is_at_end = |cell: usize| {
            let own_m = self.tops_m[cell];
            self.around(cell, 1).any(|near| (self.tops_m[near] - own_m).abs() > ONE_TERRACE_M)
        };
        let count = self.tops_m.len();
        let mut steps: Vec<u16> = (0..count)
            .map(|cell| if !self.tops_m[cell].is_finite() || is_at_end(cell) { 0 } else { u16::MAX })
            .collect();
        // Once down the rows and once up: rings around the ends.
        for cell in (0..count).chain((0..count).rev()) {
            let nearest = self.around(cell, 1).map(|near| steps[near]).min().unwrap_or(u16::MAX);
            steps[cell] = steps[cell].min(nearest.saturating_add(1));
        }
        steps
    }

    /// Cells whose middles lie on a box, or so near to it.
    pub fn cells_of(&self, b: &SceneBox, margin_m: f64) -> Vec<usize> {
        let half = half_m(b) + margin_m;
        let own = b.axes_in_world.map(|axis| self.turned(axis.truncate()));
        let middle = self.local(b.center_in_world.truncate());
        let reach = half.x * own[0].abs() + half.y * own[1].abs();
        let last = |axis: usize| (((middle + reach)[axis] / self.cell_m).max(0.0) as usize + 1).min(self.size[axis]);
        let first = ((middle - reach) / self.cell_m).max(DVec2::ZERO);
        let mut cells = Vec::new();
        for row in first.y as usize..last(1) {
            for column in first.x as usize..last(0) {
                let cell = row * self.size[0] + column;
                let away = self.middle(cell) - middle;
                if away.dot(own[0]).abs() <= half.x && away.dot(own[1]).abs() <= half.y {
                    cells.push(cell);
                }
            }
        }
        cells
    }

    /// Places along the sides of a box above which it rises by a step: the place, the height of the terrace below the step, and the cells on both
    /// sides.
    pub fn steps_of(&self, b: &SceneBox) -> Vec<(DVec2, f64, [usize; 2])> {
        let (half, top_m) = (half_m(b), ends_m(b)[1]);
        let axes = b.axes_in_world.map(|axis| axis.truncate());
        let mut found = Vec::new();
        for side in 0..4 {
            let (out, along) = (axes[side / 2], axes[1 - side / 2]);
            let out = if side % 2 == 0 { -out } else { out };
            let (reach, length) = (half[side / 2], half[1 - side / 2]);
            let count = (2.0 * length / self.cell_m).ceil().clamp(1.0, 1000.0);
            for place in 0..count as usize {
                let share = 2.0 * (place as f64 + 0.5) / count - 1.0;
                let at = b.center_in_world.truncate() + reach * out + share * length * along;
                let near = [-1.0, 1.0].map(|way| self.cell_at(self.local(at + way * 0.75 * self.cell_m * out)));
                let [Some(inner), Some(outer)] = near else { continue };
                let rise_m = top_m - self.tops_m[outer];
                if (self.tops_m[inner] - top_m).abs() < 1e-6 && rise_m > ONE_TERRACE_M && rise_m <= STEP_M {
                    found.push((self.local(at), self.tops_m[outer], [inner, outer]));
                }
            }
        }
        found
    }

    /// A direction of the world along the grid.
    pub fn turned(&self, direction: DVec2) -> DVec2 {
        DVec2::new(direction.dot(self.axes[0]), direction.dot(self.axes[1]))
    }

    /// A direction of the grid in the world.
    pub fn in_world(&self, direction: DVec2) -> DVec2 {
        direction.x * self.axes[0] + direction.y * self.axes[1]
    }

    /// A place of the world on the grid, metres.
    pub fn local(&self, place: DVec2) -> DVec2 {
        self.turned(place - self.origin)
    }

    /// A place of the grid in the world.
    pub fn place(&self, local: DVec2) -> DVec2 {
        self.origin + self.in_world(local)
    }

    /// The middle of a cell on the grid, metres.
    pub fn middle(&self, cell: usize) -> DVec2 {
        self.cell_m * (DVec2::new((cell % self.size[0]) as f64, (cell / self.size[0]) as f64) + 0.5)
    }

    /// The cell of a place on the grid.
    pub fn cell_at(&self, at: DVec2) -> Option<usize> {
        let place = at / self.cell_m;
        let is_in = place.x >= 0.0 && place.y >= 0.0 && place.x < self.size[0] as f64 && place.y < self.size[1] as f64;
        is_in.then(|| place.y as usize * self.size[0] + place.x as usize)
    }

    /// Cells at most `reach` columns and rows away.
    pub fn around(&self, cell: usize, reach: usize) -> impl Iterator<Item = usize> + use<> {
        let [width, height] = self.size;
        let (column, row) = (cell % width, cell / width);
        let columns = column.saturating_sub(reach)..(column + reach + 1).min(width);
        let rows = row.saturating_sub(reach)..(row + reach + 1).min(height);
        rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }

    /// Where the terrace of a cell ends in a direction: distance, metres, and what is there.
    fn end(&self, cell: usize, direction: DVec2) -> Option<(f64, End)> {
        let (from, top_m) = (self.middle(cell), self.tops_m[cell]);
        let most = (WIDEST_M / self.cell_m).ceil();
        let mut step = 1.0 + f64::from(self.to_end[cell]);
        while step <= most {
            let next = self.cell_at(from + direction * (step * self.cell_m));
            let other_m = next.map_or(f64::NEG_INFINITY, |next| self.tops_m[next]);
            if (other_m - top_m).abs() > ONE_TERRACE_M {
                let rise_m = other_m - top_m;
                let end = match rise_m {
                    _ if rise_m.abs() > STEP_M => End::Edge,
                    _ if rise_m > 0.0 => End::Upper(other_m),
                    _ => End::Lower(other_m),
                };
                return Some(((step - 0.5) * self.cell_m, end));
            }
            step += next.map_or(0.0, |next| f64::from(self.to_end[next])).max(1.0);
        }
        None
    }

    /// Height of the slope below each cell where its terrace lies between a lower and an upper one, world, metres: the edge of a
    /// terrace below an upper one lies on the slope. Not a number elsewhere.
    pub fn slopes_m(&self) -> Vec<f64> {
        let directions = core::array::from_fn(|number| {
            let (sin, cos) = real::sin_cos(real::PI * number as f64 / DIRECTIONS as f64);
            DVec2::new(cos, sin)
        });
        (0..self.tops_m.len()).map(|cell| self.slope_m(cell, &directions).unwrap_or(f64::NAN)).collect()
    }

    fn slope_m(&self, cell: usize, directions: &[DVec2; 2 * DIRECTIONS]) -> Option<f64> {
        let top_m = self.tops_m[cell];
        if !top_m.is_finite() || f64::from(self.to_end[cell]) * self.cell_m > WIDEST_M {
            return None;
        }
        let mut best: Option<(f64, f64)> = None;
        for up in directions.iter().copied() {
            let Some((ahead_m, End::Upper(upper_m))) = self.end(cell, up) else { continue };
            let Some((behind_m, behind)) = self.end(cell, -up) else { continue };
            let run_m = ahead_m + behind_m;
            let rise_m = match behind {
                End::Lower(lower_m) => top_m - lower_m,
                // The lowest step of a roof of two.
                End::Edge if self.is_below_ridge(cell, (up, ahead_m), run_m) => upper_m - top_m,
                _ => continue,
            };
            let height_m = top_m - rise_m * ahead_m / run_m;
            if run_m <= FLATTEST * rise_m + self.cell_m && best.is_none_or(|(least_m, _)| run_m < least_m - 1e-9) {
                best = Some((run_m, height_m));
            }
        }
        best.map(|(_, height_m)| height_m)
    }

    /// Whether any terrace ends at one that is at most a step higher.
    pub fn have_steps(&self) -> bool {
        let is_step = |cell: usize, next: usize| {
            let rise_m = self.tops_m.get(next).map_or(0.0, |next_m| (next_m - self.tops_m[cell]).abs());
            rise_m > ONE_TERRACE_M && rise_m <= STEP_M
        };
        (0..self.tops_m.len()).any(|cell| is_step(cell, cell + 1) || is_step(cell, cell + self.size[0]))
    }

    /// Whether the next terrace is the last one before the roof falls again, about twice as wide as this one.
    fn is_below_ridge(&self, cell: usize, (up, ahead_m): (DVec2, f64), run_m: f64) -> bool {
        let Some(next) = self.cell_at(self.middle(cell) + up * (ahead_m + 0.5 * self.cell_m)) else { return false };
        match self.end(next, up) {
            Some((beyond_m, End::Lower(_))) => (0.5..2.2).contains(&(0.5 * (beyond_m + 0.5 * self.cell_m) / run_m)),
            _ => false,
        }
    }
}
