//! [`Tiles`]: a value for each cell of a wide grid, where most of the grid is empty.

use cosfly_frames::DVec2;

/// Cells along the side of a tile, as a power of two.
const TILE_BITS: usize = 3;
const TILE: usize = 1 << TILE_BITS;

/// How cells are numbered: row by row, each row `1 << row_bits` cells apart.
#[derive(Clone, Copy, Debug)]
pub struct Numbering {
    /// Cells along x.
    pub columns: usize,
    /// Cells along y.
    pub rows: usize,
    row_bits: usize,
}

impl Numbering {
    /// Cells of a grid; `None` where their numbers would not fit into 32 bits.
    pub fn new(columns: usize, rows: usize) -> Option<Self> {
        let row_bits = (columns.checked_next_power_of_two()?.max(TILE)).trailing_zeros() as usize;
        let is_small = rows <= 1_usize.checked_shl(32_u32.checked_sub(row_bits as u32)?)?;
        is_small.then_some(Self { columns, rows, row_bits })
    }

    /// Number of the cell in a column and row.
    pub fn cell(&self, column: usize, row: usize) -> usize {
        row << self.row_bits | column
    }

    /// Column and row of a cell.
    pub fn column_row(&self, cell: usize) -> (usize, usize) {
        (cell & ((1 << self.row_bits) - 1), cell >> self.row_bits)
    }

    fn tile(&self, cell: usize) -> usize {
        let (column, row) = self.column_row(cell);
        (row >> TILE_BITS) << (self.row_bits - TILE_BITS) | column >> TILE_BITS
    }
}

/// Where the cells of a grid lie.
#[derive(Clone, Copy, Debug)]
pub struct Lattice {
    /// Corner of the first cell, world frame.
    pub corner: DVec2,
    /// Size of a cell, metres.
    pub cell_m: f64,
    /// Numbers of the cells.
    pub numbering: Numbering,
}

impl Lattice {
    /// Centre of a cell in plan.
    pub fn center(&self, cell: usize) -> DVec2 {
        let (column, row) = self.numbering.column_row(cell);
        self.corner + self.cell_m * DVec2::new(column as f64 + 0.5, row as f64 + 0.5)
    }
}

/// Values of cells. A tile takes room from its first value on.
#[derive(Clone, Debug)]
pub struct Tiles<T> {
    numbering: Numbering,
    /// Place of each tile in `values`, in tiles; 0 is the empty one.
    tiles: Vec<u32>,
    values: Vec<T>,
}

impl<T: Copy> Tiles<T> {
    /// A grid whose cells all have the value `empty`.
    pub fn new(numbering: Numbering, empty: T) -> Self {
        let tiles = (numbering.rows.div_ceil(TILE)) << (numbering.row_bits - TILE_BITS);
        Self { numbering, tiles: vec![0; tiles], values: vec![empty; TILE * TILE] }
    }

    fn place(&self, cell: usize) -> usize {
        let (column, row) = self.numbering.column_row(cell);
        let tile = self.tiles[self.numbering.tile(cell)] as usize;
        (((tile << TILE_BITS) + row % TILE) << TILE_BITS) + column % TILE
    }

    /// The value of a cell.
    pub fn get(&self, cell: usize) -> T {
        self.values[self.place(cell)]
    }

    /// The value of a cell, to be changed.
    pub fn get_mut(&mut self, cell: usize) -> &mut T {
        let tile = self.numbering.tile(cell);
        if self.tiles[tile] == 0 {
            self.tiles[tile] = (self.values.len() >> (2 * TILE_BITS)) as u32;
            let empty = self.values[0];
            self.values.resize(self.values.len() + TILE * TILE, empty);
        }
        let place = self.place(cell);
        &mut self.values[place]
    }

    /// Calls `visit` with the cells that take room and their values, row by row.
    pub fn visit(&self, mut visit: impl FnMut(usize, T)) {
        for row in 0..self.numbering.rows {
            let first = self.numbering.cell(0, row);
            for tile in (0..self.numbering.columns).step_by(TILE) {
                if self.tiles[self.numbering.tile(first + tile)] != 0 {
                    let end = (tile + TILE).min(self.numbering.columns);
                    (tile..end).for_each(|column| visit(first + column, self.get(first + column)));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_kept_where_they_were_put_and_visited_row_by_row() {
        let numbering = Numbering::new(1000, 300).unwrap();
        let mut tiles = Tiles::new(numbering, 0_u32);
        let places = [(0, 0), (999, 0), (63, 64), (64, 64), (500, 299)];
        for (value, (column, row)) in places.into_iter().enumerate() {
            *tiles.get_mut(numbering.cell(column, row)) = value as u32 + 1;
        }
        let mut seen = vec![];
        tiles.visit(|cell, value| {
            if value > 0 {
                seen.push((numbering.column_row(cell), value))
            }
        });
        assert_eq!(seen, places.into_iter().zip(1..).collect::<Vec<_>>());
        assert_eq!((tiles.get(numbering.cell(1, 0)), tiles.get(numbering.cell(700, 200))), (0, 0));
        assert_eq!(tiles.values.len(), (1 + places.len()) * TILE * TILE);
    }

    #[test]
    fn grids_whose_numbers_overflow_are_none() {
        assert!(Numbering::new(40_000, 65_000).is_some());
        for (columns, rows) in [(40_000, 70_000), (usize::MAX, 1), (1 << 40, 1), (1, 1 << 40)] {
            assert!(Numbering::new(columns, rows).is_none(), "{columns} {rows}");
        }
    }
}
