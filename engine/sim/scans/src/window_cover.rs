//! [`Window`]: columns of a part of a grid, covered by few blocks, the one that covers most new columns first.

use crate::solid_cells::{Bases, Column};
use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

/// Levels of blocks' tops in one tolerance.
const STEPS: i64 = 4;
/// Bases that differ by more are never joined, metres.
pub const SAME_BASE_M: f64 = 0.5;
/// Thinnest block, metres.
const THINNEST_M: f64 = 0.1;

/// Columns of some cells in rows.
#[derive(Clone, Debug)]
pub struct Window {
    first: [usize; 2],
    size: [usize; 2],
    columns: Vec<Option<Column>>,
}

/// A block over a rectangle of cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block {
    /// First column, first row, number of columns, number of rows.
    pub cells: [usize; 4],
    /// Lower end, metres.
    pub base_m: f64,
    /// Upper end, metres.
    pub top_m: f64,
}

/// Steps of a top and of a base: columns up to a tolerance lower, on bases of this step, are what a block of the level covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Level {
    top: i64,
    base: i64,
}

/// New columns that a rectangle covers, its level, and the rectangle.
type Offer = (usize, Reverse<Level>, Reverse<[usize; 4]>);

impl Window {
    /// Columns by their cells of the grid: column and row.
    pub fn of(cells: &[([usize; 2], Column)]) -> Self {
        let places = || cells.iter().map(|(place, _)| *place);
        let first = places().reduce(|a, b| [a[0].min(b[0]), a[1].min(b[1])]).unwrap_or_default();
        let last = places().reduce(|a, b| [a[0].max(b[0]), a[1].max(b[1])]).unwrap_or_default();
        let size = [last[0] + 1 - first[0], last[1] + 1 - first[1]];
        let mut columns = vec![None; size[0] * size[1]];
        for ([column, row], solid) in cells {
            columns[(row - first[1]) * size[0] + column - first[0]] = Some(*solid);
        }
        Self { first, size, columns }
    }

    /// Blocks that hold every column. None stands over a column by more than the tolerance, or over a cell without one;
    /// a block may reach under higher columns.
    pub fn blocks(&self, tolerance_m: f64, bases: Bases) -> Vec<Block> {
        let mut cover = Cover::new(self, tolerance_m);
        let levels: BTreeSet<Level> = cover.levels.iter().flatten().copied().collect();
        let mut offers: BinaryHeap<Offer> = levels.into_iter().filter_map(|level| cover.best(level)).collect();
        let mut blocks = Vec::new();
        // What was offered before shrinks by what is covered since, and never grows: the first offer that still holds is the best.
        while let Some((count, Reverse(level), Reverse(cells))) = offers.pop() {
            if cover.count(level, cells) == count {
                blocks.push(cover.take(self, level, cells, bases));
            }
            offers.extend(cover.best(level));
        }
        stack(&mut blocks);
        for block in &mut blocks {
            (block.cells[0], block.cells[1]) = (block.cells[0] + self.first[0], block.cells[1] + self.first[1]);
        }
        blocks
    }
}

/// A block within the plan of a lower one begins at its top.
fn stack(blocks: &mut [Block]) {
    let lower = blocks.to_vec();
    for block in blocks {
        let holds = |other: &&Block| {
            let [x, y, width, height] = block.cells;
            let [left, low, across, along] = other.cells;
            x >= left && y >= low && x + width <= left + across && y + height <= low + along
        };
        let stands_on = lower.iter().filter(|other| other.top_m < block.top_m && other.base_m <= block.base_m);
        let highest_m = stands_on.filter(holds).map(|other| other.top_m).fold(block.base_m, f64::max);
        block.base_m = highest_m.min(block.top_m - THINNEST_M).max(block.base_m);
    }
}

/// Which columns are covered.
struct Cover {
    size: [usize; 2],
    /// Level of each column by its own top.
    levels: Vec<Option<Level>>,
    is_covered: Vec<bool>,
}

impl Cover {
    fn new(window: &Window, tolerance_m: f64) -> Self {
        let step_m = tolerance_m / STEPS as f64;
        // Steps of bases count from the lowest, so that a foot and the ground that was seen a little above are one step.
        let foot_m = window.columns.iter().flatten().map(|column| column.base_m).fold(f64::INFINITY, f64::min);
        let level = |column: &Column| Level {
            top: (column.top_m / step_m).ceil() as i64,
            base: ((column.base_m - foot_m) / SAME_BASE_M).floor() as i64,
        };
        let levels = window.columns.iter().map(|column| column.as_ref().map(level)).collect();
        Self { size: window.size, levels, is_covered: vec![false; window.columns.len()] }
    }

    /// Whether a block of the level may stand over a cell.
    fn may_cover(&self, cell: usize, level: Level) -> bool {
        self.levels[cell].is_some_and(|own| own.top > level.top.saturating_sub(STEPS) && own.base <= level.base)
    }

    /// Whether a block of the level would cover a column that none covers yet.
    fn is_new(&self, cell: usize, level: Level) -> bool {
        let is_held = |own: Level| own.top <= level.top && own.base == level.base;
        !self.is_covered[cell] && self.may_cover(cell, level) && self.levels[cell].is_some_and(is_held)
    }

    fn cells(&self, [column, row, width, height]: [usize; 4]) -> impl Iterator<Item = usize> + use<> {
        let columns = self.size[0];
        (row..row + height).flat_map(move |row| (column..column + width).map(move |column| row * columns + column))
    }

    fn count(&self, level: Level, cells: [usize; 4]) -> usize {
        self.cells(cells).filter(|cell| self.is_new(*cell, level)).count()
    }

    /// The rectangle that covers most new columns; none where there are none.
    fn best(&self, level: Level) -> Option<Offer> {
        let all = [0, 0, self.size[0], self.size[1]];
        if self.count(level, all) == 0 {
            return None;
        }
        // What is farther out covers nothing new.
        let [left, low, columns, rows] = self.trimmed(level, all);
        let cell = |column: usize, row: usize| (low + row) * self.size[0] + left + column;
        let mut sums = vec![0_u32; (columns + 1) * (rows + 1)];
        for row in 0..rows {
            let mut line = 0;
            for column in 0..columns {
                line += u32::from(self.is_new(cell(column, row), level));
                sums[(row + 1) * (columns + 1) + column + 1] = sums[row * (columns + 1) + column + 1] + line;
            }
        }
        let sum = |[column, row, width, height]: [usize; 4]| {
            let at = |column: usize, row: usize| sums[row * (columns + 1) + column] as usize;
            at(column + width, row + height) + at(column, row) - at(column + width, row) - at(column, row + height)
        };
        let mut best = (0, Reverse([0; 4]));
        let mut heights = vec![0_usize; columns + 1];
        let mut open: Vec<(usize, usize)> = Vec::with_capacity(columns + 1);
        for row in 0..rows {
            for (column, height) in heights.iter_mut().enumerate() {
                let may_cover = column < columns && self.may_cover(cell(column, row), level);
                *height = if may_cover { *height + 1 } else { 0 };
                let mut start = column;
                while let Some((first, above)) = open.pop_if(|(_, above)| *above > *height) {
                    let cells = [first, row + 1 - above, column - first, above];
                    best = best.max((sum(cells), Reverse(cells)));
                    start = first;
                }
                if *height > 0 && open.last().is_none_or(|(_, above)| *above < *height) {
                    open.push((start, *height));
                }
            }
            open.clear();
        }
        let (count, Reverse([column, row, width, height])) = best;
        let cells = [left + column, low + row, width, height];
        (count > 0).then(|| (count, Reverse(level), Reverse(self.trimmed(level, cells))))
    }

    /// The rectangle around the new columns in one.
    fn trimmed(&self, level: Level, cells: [usize; 4]) -> [usize; 4] {
        let columns = self.size[0];
        let new = || self.cells(cells).filter(|cell| self.is_new(*cell, level));
        let (mut low, mut high) = ([usize::MAX; 2], [0; 2]);
        for cell in new() {
            for (axis, at) in [cell % columns, cell / columns].into_iter().enumerate() {
                (low[axis], high[axis]) = (low[axis].min(at), high[axis].max(at));
            }
        }
        [low[0], low[1], high[0] + 1 - low[0], high[1] + 1 - low[1]]
    }

    /// Covers what the rectangle may.
    fn take(&mut self, window: &Window, level: Level, cells: [usize; 4], bases: Bases) -> Block {
        let (mut top_m, mut lowest_m, mut highest_m) = (f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY);
        for cell in self.cells(cells) {
            let Some(column) = window.columns[cell] else { continue };
            highest_m = highest_m.max(column.base_m);
            if self.is_new(cell, level) {
                (top_m, lowest_m) = (top_m.max(column.top_m), lowest_m.min(column.base_m));
                self.is_covered[cell] = true;
            }
        }
        let base_m = if bases == Bases::Highest { highest_m } else { lowest_m };
        Block { cells, base_m, top_m: top_m.max(base_m + THINNEST_M) }
    }
}
