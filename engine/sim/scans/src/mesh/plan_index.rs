//! [`PlanIndex`]: triangles by the square cells in plan that they touch.

use cosfly_frames::{DVec2, DVec3};

/// Narrowest cells, metres, and most of them along a side.
const CELL_M: f64 = 4.0;
const MOST_CELLS: f64 = 512.0;
/// Most entries of the cells: wide triangles get wide cells.
const MOST_ENTRIES: f64 = 2e7;

/// Triangles by cells.
pub struct PlanIndex {
    low: DVec2,
    cell_m: f64,
    columns: usize,
    rows: usize,
    cells: Vec<Vec<u32>>,
}

impl PlanIndex {
    /// Index of triangles, known by their numbers.
    pub fn of(triangles: &[[DVec3; 3]]) -> Self {
        let ends = || triangles.iter().map(bounds);
        let low = ends().map(|[low, _]| low.truncate()).fold(DVec2::INFINITY, DVec2::min);
        let high = ends().map(|[_, high]| high.truncate()).fold(DVec2::NEG_INFINITY, DVec2::max);
        let size = if triangles.is_empty() { DVec2::ZERO } else { high - low };
        let few = (triangles.len() as f64).sqrt().ceil().max(1.0);
        let mut cell_m = CELL_M.max(size.max_element() / MOST_CELLS.min(4.0 * few));
        let entries = |cell_m: f64| {
            ends().map(|[low, high]| ((high - low).truncate() / cell_m + 1.5).element_product()).sum::<f64>()
        };
        while entries(cell_m) > MOST_ENTRIES && cell_m < size.max_element() {
            cell_m *= 2.0;
        }
        let [columns, rows] = size.to_array().map(|side| (side / cell_m) as usize + 1);
        let mut index = Self { low, cell_m, columns, rows, cells: vec![Vec::new(); columns * rows] };
        for (at, triangle) in triangles.iter().enumerate() {
            for cell in index.touched(bounds(triangle)) {
                index.cells[cell].push(at as u32);
            }
        }
        index
    }

    fn touched(&self, ends: [DVec3; 2]) -> impl Iterator<Item = usize> + use<> {
        let [from, to] = ends.map(|corner| ((corner.truncate() - self.low) / self.cell_m).max(DVec2::ZERO));
        let columns = from.x as usize..(to.x as usize + 1).min(self.columns);
        let width = self.columns;
        (from.y as usize..(to.y as usize + 1).min(self.rows))
            .flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }

    /// Triangles that may touch another one, in the order of their numbers.
    pub fn near(&self, triangle: &[DVec3; 3]) -> Vec<usize> {
        let cells = self.touched(bounds(triangle));
        let mut near: Vec<usize> = cells.flat_map(|cell| &self.cells[cell]).map(|at| *at as usize).collect();
        near.sort_unstable();
        near.dedup();
        near
    }

    /// Triangles that may lie over or under a point.
    pub fn over(&self, point: DVec3) -> &[u32] {
        self.touched([point; 2]).next().map_or(&[], |cell| &self.cells[cell])
    }
}

/// Smallest and largest corner.
pub fn bounds([a, b, c]: &[DVec3; 3]) -> [DVec3; 2] {
    [a.min(*b).min(*c), a.max(*b).max(*c)]
}
