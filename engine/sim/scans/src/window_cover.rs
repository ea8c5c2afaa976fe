//! [`CellWindow`]: columns of a part of a grid, covered by few blocks, the one that covers most new columns first.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// Levels of blocks' tops in one tolerance.
const STEPS: i64 = 4;
/// Bases that differ by more are never joined, metres.
pub const SAME_BASE_M: f64 = 0.5;
/// Thinnest block, metres.
const THINNEST_M: f64 = 0.1;
/// Most columns and rows of a window: a row is one word of bits. The work for a cell grows with its square.
pub const WIDEST: usize = 48;

/// Solid space over one cell, world, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column {
    /// Lower end.
    pub base_m: f64,
    /// Upper end.
    pub top_m: f64,
}

/// Which of the bases of joined columns is that of their box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bases {
    /// The highest: nothing below a base is taken.
    Highest,
    /// The lowest: nothing solid is lost.
    Lowest,
}

/// Columns of some cells in rows.
#[derive(Clone, Debug)]
pub struct CellWindow {
    first: [usize; 2],
    size: [usize; 2],
    columns: Vec<Option<Column>>,
    /// Cells without a column that blocks may stand over.
    is_free: Vec<bool>,
}

/// A block over a rectangle of cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoverBlock {
    /// First column, first row, number of columns, number of rows.
    pub cells: [usize; 4],
    /// Lower end, metres.
    pub base_m: f64,
    /// Upper end, metres.
    pub top_m: f64,
}

/// Solid space of columns and what their blocks make of it, cells times metres or cubic metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Volumes {
    /// Space of the columns.
    pub solid: f64,
    /// Space of blocks that is of no column.
    pub gained: f64,
    /// Space of columns that is in no block.
    pub lost: f64,
}

impl Volumes {
    /// The sum; the other ones count `unit` times.
    pub fn plus(self, other: Self, unit: f64) -> Self {
        Self {
            solid: self.solid + unit * other.solid,
            gained: self.gained + unit * other.gained,
            lost: self.lost + unit * other.lost,
        }
    }
}

/// Steps of a top and of a base: columns up to a tolerance lower, on bases of this step, are what a block of the level covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Level {
    top: i64,
    base: i64,
}

/// New columns that a rectangle covers, the layer, lowest level first, and the rectangle.
type Offer = (u32, Reverse<usize>, Reverse<[usize; 4]>);

impl CellWindow {
    /// Columns by their cells of the grid: column and row, within [`WIDEST`] of each other. Blocks may stand over free cells.
    pub fn of(cells: &[([usize; 2], Column)], is_free: impl Fn([usize; 2]) -> bool) -> Self {
        let places = || cells.iter().map(|(place, _)| *place);
        let first = places().reduce(|a, b| [a[0].min(b[0]), a[1].min(b[1])]).unwrap_or_default();
        let last = places().reduce(|a, b| [a[0].max(b[0]), a[1].max(b[1])]).unwrap_or_default();
        let size = [last[0] + 1 - first[0], last[1] + 1 - first[1]];
        let mut columns = vec![None; size[0] * size[1]];
        for ([column, row], solid) in cells {
            columns[(row - first[1]) * size[0] + column - first[0]] = Some(*solid);
        }
        let place = |cell: usize| [first[0] + cell % size[0], first[1] + cell / size[0]];
        let is_free = (0..columns.len()).map(|cell| columns[cell].is_none() && is_free(place(cell))).collect();
        Self { first, size, columns, is_free }
    }

    /// Blocks that hold every column. None stands over a column by more than the tolerance, or over a cell without one that is not free;
    /// a block may reach under higher columns.
    pub fn blocks(&self, tolerance_m: f64, bases: Bases) -> (Vec<CoverBlock>, Volumes) {
        let mut cover = Cover::new(self, tolerance_m);
        let mut offers: BinaryHeap<Offer> = (0..cover.layers.len()).filter_map(|layer| cover.best(layer)).collect();
        let mut blocks = Vec::new();
        // What was offered before shrinks by what is covered since, and never grows: the first offer that still holds is the best.
        while let Some((count, Reverse(layer), Reverse(cells))) = offers.pop() {
            if cover.count(layer, cells) == count {
                blocks.push(cover.take(self, layer, cells, bases));
            }
            offers.extend(cover.best(layer));
        }
        stack(&mut blocks);
        let volumes = self.volumes(&blocks);
        for block in &mut blocks {
            (block.cells[0], block.cells[1]) = (block.cells[0] + self.first[0], block.cells[1] + self.first[1]);
        }
        (blocks, volumes)
    }

    /// Volumes in cells times metres. The blocks over a cell stand on each other.
    fn volumes(&self, blocks: &[CoverBlock]) -> Volumes {
        let mut ends = vec![[f64::INFINITY, f64::NEG_INFINITY]; self.columns.len()];
        for CoverBlock { cells: [column, row, width, height], base_m, top_m } in blocks {
            for row in *row..row + height {
                for [low, high] in &mut ends[row * self.size[0] + column..][..*width] {
                    (*low, *high) = (low.min(*base_m), high.max(*top_m));
                }
            }
        }
        let covered = self.is_free.iter().zip(&ends).filter(|(is_free, [low, high])| **is_free && low < high);
        let gained = covered.map(|(_, [low, high])| high - low).sum();
        let columns = self.columns.iter().zip(&ends).filter_map(|(column, ends)| Some((column.as_ref()?, ends)));
        columns.fold(Volumes { gained, ..Volumes::default() }, |sum, (column, [low, high])| {
            let (above, below) = (high - column.top_m, column.base_m - low);
            let gained = above.max(0.0) + below.max(0.0);
            let lost = (-above).max(0.0) + (-below).max(0.0);
            sum.plus(Volumes { solid: column.top_m - column.base_m, gained, lost }, 1.0)
        })
    }
}

/// A block within the plan of a lower one begins at its top.
fn stack(blocks: &mut [CoverBlock]) {
    let lower = blocks.to_vec();
    for block in blocks {
        let holds = |other: &&CoverBlock| {
            let [x, y, width, height] = block.cells;
            let [left, low, across, along] = other.cells;
            x >= left && y >= low && x + width <= left + across && y + height <= low + along
        };
        let stands_on = lower.iter().filter(|other| other.top_m < block.top_m && other.base_m <= block.base_m);
        let highest_m = stands_on.filter(holds).map(|other| other.top_m).fold(block.base_m, f64::max);
        block.base_m = highest_m.min(block.top_m - THINNEST_M).max(block.base_m);
    }
}

/// Which columns are covered, and what may be. Bits of a word are the columns of a row.
struct Cover {
    /// By level, lowest first.
    layers: Vec<Layer>,
    is_covered: Vec<u64>,
    /// Sums of new columns over rectangles from the corner, of one layer at a time.
    sums: Vec<u16>,
}

/// Cells that a block of a level may stand over.
struct Layer {
    /// Cells by row.
    allowed: Vec<u64>,
    /// Cells by row whose columns such a block holds to their tops.
    held: Vec<u64>,
    /// Rows beyond which nothing new is held: first, and one after the last.
    rows: [usize; 2],
}

impl Cover {
    fn new(window: &CellWindow, tolerance_m: f64) -> Self {
        let step_m = tolerance_m / STEPS as f64;
        let [columns, rows] = window.size;
        // Steps of bases count from the lowest, so that a foot and the ground that was seen a little above are one step.
        let foot_m = window.columns.iter().flatten().map(|column| column.base_m).fold(f64::INFINITY, f64::min);
        let level = |column: &Column| Level {
            top: (column.top_m / step_m).ceil() as i64,
            base: ((column.base_m - foot_m) / SAME_BASE_M).floor() as i64,
        };
        let mut cells: BTreeMap<Level, Vec<u64>> = BTreeMap::new();
        for (cell, column) in window.columns.iter().enumerate() {
            if let Some(column) = column {
                cells.entry(level(column)).or_insert_with(|| vec![0; rows])[cell / columns] |= 1 << (cell % columns);
            }
        }
        let mut free = vec![0; rows];
        for cell in (0..window.is_free.len()).filter(|cell| window.is_free[*cell]) {
            free[cell / columns] |= 1 << (cell % columns);
        }
        let layer = |level: &Level| {
            let mut layer = Layer { allowed: free.clone(), held: vec![0; rows], rows: [0, rows] };
            for (own, bits) in &cells {
                let is_allowed = own.top > level.top.saturating_sub(STEPS) && own.base <= level.base;
                let is_held = is_allowed && own.top <= level.top && own.base == level.base;
                for (row, bits) in bits.iter().enumerate() {
                    layer.allowed[row] |= if is_allowed { *bits } else { 0 };
                    layer.held[row] |= if is_held { *bits } else { 0 };
                }
            }
            layer
        };
        let layers = cells.keys().map(layer).collect();
        Self { layers, is_covered: vec![0; rows], sums: Vec::new() }
    }

    /// Columns of a row that a block of the layer would cover and none covers yet.
    fn new_in_row(&self, layer: usize, row: usize) -> u64 {
        self.layers[layer].held[row] & !self.is_covered[row]
    }

    fn count(&self, layer: usize, [column, row, width, height]: [usize; 4]) -> u32 {
        (row..row + height).map(|row| (self.new_in_row(layer, row) & bits(column, width)).count_ones()).sum()
    }

    /// The rectangle that covers most new columns; none where there are none.
    fn best(&mut self, layer: usize) -> Option<Offer> {
        let [first, end] = self.layers[layer].rows;
        // What is farther out covers nothing new.
        let [left, low, width, height] = self.trimmed(layer, [0, first, WIDEST, end - first])?;
        self.layers[layer].rows = [low, low + height];
        self.sum_up(layer, [left, low, width, height]);
        let sum = |[column, row, across, along]: [usize; 4]| {
            let at = |column: usize, row: usize| self.sums[row * (width + 1) + column];
            at(column + across, row + along) + at(column, row) - at(column + across, row) - at(column, row + along)
        };
        let mut best = (0, Reverse([0; 4]));
        let mut heights = [0_usize; WIDEST + 1];
        let mut open: Vec<(usize, usize)> = Vec::with_capacity(width + 1);
        let allowed = |row: usize| self.layers[layer].allowed[low + row] >> left & bits(0, width);
        for row in 0..height {
            let (own, below) = (allowed(row), if row + 1 < height { allowed(row + 1) } else { 0 });
            for (column, height) in heights[..=width].iter_mut().enumerate() {
                *height = if own >> column & 1 == 1 { *height + 1 } else { 0 };
                let mut start = column;
                while let Some((first, above)) = open.pop_if(|(_, above)| *above > *height) {
                    start = first;
                    let run = bits(first, column - first);
                    // One that the next row continues is part of a larger one.
                    if below & run != run && (column - first) * above >= usize::from(best.0) {
                        let cells = [first, row + 1 - above, column - first, above];
                        best = best.max((sum(cells), Reverse(cells)));
                    }
                }
                if *height > 0 && open.last().is_none_or(|(_, above)| *above < *height) {
                    open.push((start, *height));
                }
            }
            open.clear();
        }
        let (count, Reverse([column, row, across, along])) = best;
        let cells = self.trimmed(layer, [left + column, low + row, across, along])?;
        Some((count.into(), Reverse(layer), Reverse(cells)))
    }

    /// Sets the sums over the rectangles of a part of the window.
    fn sum_up(&mut self, layer: usize, [left, low, width, height]: [usize; 4]) {
        let mut sums = std::mem::take(&mut self.sums);
        sums.clear();
        sums.resize((width + 1) * (height + 1), 0);
        for row in 0..height {
            let new = self.new_in_row(layer, low + row) >> left;
            let mut line = 0;
            for column in 0..width {
                line += (new >> column & 1) as u16;
                sums[(row + 1) * (width + 1) + column + 1] = sums[row * (width + 1) + column + 1] + line;
            }
        }
        self.sums = sums;
    }

    /// The rectangle around the new columns in one.
    fn trimmed(&self, layer: usize, [column, row, width, height]: [usize; 4]) -> Option<[usize; 4]> {
        let new = |row: &usize| self.new_in_row(layer, *row) & bits(column, width);
        let low = (row..row + height).find(|row| new(row) != 0)?;
        let high = (low..row + height).rfind(|row| new(row) != 0)?;
        let all = (low..=high).fold(0, |all, row| all | new(&row));
        let left = all.trailing_zeros() as usize;
        Some([left, low, (u64::BITS - all.leading_zeros()) as usize - left, high + 1 - low])
    }

    /// Covers what the rectangle may.
    fn take(&mut self, window: &CellWindow, layer: usize, cells: [usize; 4], bases: Bases) -> CoverBlock {
        let [column, row, width, height] = cells;
        let (mut top_m, mut lowest_m, mut highest_m) = (f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY);
        for row in row..row + height {
            let new = self.new_in_row(layer, row) & bits(column, width);
            for at in column..column + width {
                let Some(column) = window.columns[row * window.size[0] + at] else { continue };
                highest_m = highest_m.max(column.base_m);
                if new >> at & 1 == 1 {
                    (top_m, lowest_m) = (top_m.max(column.top_m), lowest_m.min(column.base_m));
                }
            }
            self.is_covered[row] |= new;
        }
        let base_m = if bases == Bases::Highest { highest_m } else { lowest_m };
        CoverBlock { cells, base_m, top_m: top_m.max(base_m + THINNEST_M) }
    }
}

/// Bits of some columns of a row; fewer than a word has.
fn bits(first: usize, count: usize) -> u64 {
    ((1 << count) - 1) << first
}
