//! Gaps between the lanes of a junction: small pieces of grass that carriageways enclose are paved.
//!
//! The ways through a junction are strips beside and over one another; files leave the triangles between them out, or
//! give them as lanes of no kind.

use cosfly_domain::SemanticLabel;
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::GroundIndex;
use cosfly_town::mesh::MeshBuilder;
use cosfly_town::terrain::beside;

/// Side of the cells in which gaps are found, metres.
const CELL_M: f64 = 0.4;
/// Largest gap that is paved; larger ones are islands, square metres.
const LARGEST_M2: f64 = 40.0;
/// Least share of a gap's border that is carriageway.
const PAVED_SHARE: f64 = 0.8;
/// Beside a pavement, as at junction corners between the gutter and the lanes, larger gaps are paved, square metres, and the
/// pavement itself may be a part of the border.
const LARGEST_BESIDE_PAVEMENT_M2: f64 = 300.0;
const PAVED_SHARE_BESIDE_PAVEMENT: f64 = 0.5;
/// Least share of a border whose carriageway is that of a pavement, and the reach of pavements, cells.
const PAVEMENT_SHARE: f64 = 0.2;
const PAVEMENT_REACH: usize = 3;
/// Smallest gap that may be an island, square metres.
const SMALLEST_ISLAND_M2: f64 = 3.0;
/// Gaps may reach this far beyond the ways of their junction, metres.
const MARGIN_M: f64 = 4.0;
/// Paved gaps lie this much below the carriageways, which keep their edges, metres.
const BELOW_M: f64 = 0.006;
/// Paved gaps lie at least this much above lanes of grass, metres.
const ABOVE_GRASS_M: f64 = 0.01;
/// Most cells of a junction; larger ones stay as they are.
const MOST_CELLS: usize = 1 << 20;

/// Bounds of a junction in the world frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct JunctionArea {
    low: DVec3,
    high: DVec3,
}

impl JunctionArea {
    /// An area without points.
    pub(super) const EMPTY: Self = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    /// Extends the area to a point.
    pub(super) fn add(&mut self, point: DVec3) {
        (self.low, self.high) = (self.low.min(point), self.high.max(point));
    }
}

/// A cell as it is seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Cell {
    /// Carriageway at a height, metres.
    Paved(f64),
    /// Pavements and other ground of the file.
    Other,
    /// Grass, or nothing.
    Open,
}

/// Paves the gaps of a junction and returns their number, and a place in each other piece of grass of a town, which may
/// be an island; `ground` is all ground so far, `things` are places where something stands.
pub(super) fn pave(
    builder: &mut MeshBuilder,
    ground: &GroundIndex,
    area: &JunctionArea,
    things: &[DVec2],
) -> (usize, Vec<DVec3>) {
    let Some(grid) = Grid::of(ground, area) else { return (0, vec![]) };
    let mut with_things = vec![false; grid.cells.len()];
    things.iter().filter_map(|place| grid.cell_at(*place)).for_each(|cell| with_things[cell] = true);
    let is_in_town = grid.cells.contains(&Cell::Other);
    let (mut count, mut islands) = (0, vec![]);
    let mut seen = vec![false; grid.cells.len()];
    for start in 0..grid.cells.len() {
        if seen[start] || grid.cells[start] != Cell::Open {
            continue;
        }
        let (gap, border, is_enclosed) = grid.component(start, &mut seen);
        let area_m2 = gap.len() as f64 * CELL_M * CELL_M;
        let share = |count: usize| count as f64 / border.len() as f64;
        let paved = share(border.iter().filter(|cell| matches!(grid.cells[**cell], Cell::Paved(_))).count());
        let is_beside_pavement =
            |cell: &usize| grid.paved_m(*cell).is_some() && grid.is_near_pavement(*cell, PAVEMENT_REACH);
        let is_corner = share(border.iter().filter(|cell| is_beside_pavement(cell)).count()) >= PAVEMENT_SHARE;
        let is_empty = !gap.iter().any(|cell| with_things[*cell]);
        let is_gap = is_corner && area_m2 <= LARGEST_BESIDE_PAVEMENT_M2 || is_empty && area_m2 <= LARGEST_M2;
        let least_share = if is_corner { PAVED_SHARE_BESIDE_PAVEMENT } else { PAVED_SHARE };
        if is_enclosed && is_gap && paved >= least_share {
            grid.add_quads(builder, ground, [&gap, &border]);
            count += 1;
        } else if is_in_town && area_m2 >= SMALLEST_ISLAND_M2 {
            islands.extend(grid.place_in(&gap, &border));
        }
    }
    (count, islands)
}

/// Cells of a junction, row by row.
struct Grid {
    low: DVec2,
    columns: usize,
    rows: usize,
    cells: Vec<Cell>,
}

impl Grid {
    fn of(ground: &GroundIndex, area: &JunctionArea) -> Option<Self> {
        let size = (area.high - area.low).truncate() + 2.0 * MARGIN_M;
        if !size.is_finite() || size.max_element() > CELL_M * MOST_CELLS as f64 {
            return None;
        }
        let [columns, rows] = size.to_array().map(|side| (side / CELL_M) as usize + 1);
        let mut grid = Self { low: area.low.truncate() - MARGIN_M, columns, rows, cells: vec![] };
        if columns.checked_mul(rows)? > MOST_CELLS {
            return None;
        }
        let cell = |at: usize| match ground.ground_below(grid.middle(at).extend(area.high.z), 0.5) {
            Some(found) if found.height_m < area.low.z - 1.0 => Cell::Open,
            Some(found) => match found.label {
                SemanticLabel::Roads => Cell::Paved(found.height_m),
                SemanticLabel::Terrain => Cell::Open,
                _ => Cell::Other,
            },
            None => Cell::Open,
        };
        let cells = (0..columns * rows).map(cell).collect();
        grid.cells = cells;
        Some(grid)
    }

    fn paved_m(&self, cell: usize) -> Option<f64> {
        match self.cells[cell] {
            Cell::Paved(height_m) => Some(height_m),
            Cell::Other | Cell::Open => None,
        }
    }

    fn middle(&self, cell: usize) -> DVec2 {
        self.low + CELL_M * DVec2::new((cell % self.columns) as f64 + 0.5, (cell / self.columns) as f64 + 0.5)
    }

    fn cell_at(&self, place: DVec2) -> Option<usize> {
        let at = (place - self.low) / CELL_M;
        let is_within =
            at.cmpge(DVec2::ZERO).all() && at.cmplt(DVec2::new(self.columns as f64, self.rows as f64)).all();
        is_within.then(|| at.y as usize * self.columns + at.x as usize)
    }

    /// Whether a pavement is at most some cells away.
    fn is_near_pavement(&self, cell: usize, reach: usize) -> bool {
        let (column, row) = (cell % self.columns, cell / self.columns);
        let around = |at: usize, most: usize| at.saturating_sub(reach)..(at + reach + 1).min(most);
        around(row, self.rows).any(|row| {
            around(column, self.columns).any(|column| self.cells[row * self.columns + column] == Cell::Other)
        })
    }

    /// A place in a gap at the height of a carriageway around it.
    fn place_in(&self, gap: &[usize], border: &[usize]) -> Option<DVec3> {
        let cell = *gap.first()?;
        let away = |at: usize| self.middle(at).distance_squared(self.middle(cell));
        let heights = border.iter().filter_map(|at| Some((away(*at), self.paved_m(*at)?)));
        let (_, height_m) = heights.min_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(self.middle(cell).extend(height_m))
    }

    /// The cells of a gap, those around it, and whether the gap stays within the grid.
    fn component(&self, start: usize, seen: &mut [bool]) -> (Vec<usize>, Vec<usize>, bool) {
        let (mut gap, mut border, mut is_enclosed) = (vec![start], vec![], true);
        seen[start] = true;
        let mut next = 0;
        while let Some(&cell) = gap.get(next) {
            next += 1;
            let (column, row) = (cell % self.columns, cell / self.columns);
            is_enclosed &= column > 0 && row > 0 && column + 1 < self.columns && row + 1 < self.rows;
            for neighbour in beside(cell, self.columns, self.rows) {
                if self.cells[neighbour] != Cell::Open {
                    border.push(neighbour);
                } else if !seen[neighbour] {
                    seen[neighbour] = true;
                    gap.push(neighbour);
                }
            }
        }
        border.sort_unstable();
        border.dedup();
        (gap, border, is_enclosed)
    }

    /// One quad per cell of the gap and of its border, whose heights follow from those of the carriageways around; above
    /// lanes of grass.
    fn add_quads(&self, builder: &mut MeshBuilder, ground: &GroundIndex, [gap, border]: [&[usize]; 2]) {
        let known: Vec<(DVec2, f64)> =
            border.iter().filter_map(|cell| Some((self.middle(*cell), self.paved_m(*cell)?))).collect();
        let even_m = |at: DVec2| {
            let weight = |place: &DVec2| 1.0 / (place.distance_squared(at) + 0.01).powi(2);
            let (sum, weights) = known.iter().fold((0.0, 0.0), |(sum, weights), (place, height_m)| {
                (sum + weight(place) * height_m, weights + weight(place))
            });
            sum / weights - BELOW_M
        };
        let height_m = |at: DVec2| {
            let even_m = even_m(at);
            match ground.ground_seen(at.extend(even_m), 0.5) {
                // Below the carriageway, whose lines stay on top.
                Some(own) if own.label == SemanticLabel::Roads => own.height_m - BELOW_M,
                Some(own) if own.label == SemanticLabel::Terrain => even_m.max(own.height_m + ABOVE_GRASS_M),
                _ => even_m,
            }
        };
        for cell in gap.iter().chain(border) {
            let middle = self.middle(*cell);
            let corner = |x: f64, y: f64| {
                let at = middle + 0.5 * CELL_M * DVec2::new(x, y);
                (at.extend(height_m(at)), at)
            };
            let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
            builder.quad(SemanticLabel::Roads, true, corners);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of carriageway from `from` to `to`, at a height.
    fn square(builder: &mut MeshBuilder, label: SemanticLabel, from: DVec2, to: DVec2, height_m: f64) {
        let corners = [from, DVec2::new(to.x, from.y), to, DVec2::new(from.x, to.y)];
        builder.quad(label, false, corners.map(|corner| (corner.extend(height_m), corner)));
    }

    /// Four carriageways around an opening of `side_m`; whether its middle is road afterwards, and the gaps that were paved.
    fn around_an_opening(side_m: f64, label: SemanticLabel) -> (usize, Option<SemanticLabel>) {
        let mut builder = MeshBuilder::default();
        let (inner, outer) = (0.5 * side_m, 0.5 * side_m + 4.0);
        for [x0, y0, x1, y1] in [
            [-outer, -outer, outer, -inner],
            [-outer, inner, outer, outer],
            [-outer, -outer, -inner, outer],
            [inner, -outer, outer, outer],
        ] {
            square(&mut builder, label, DVec2::new(x0, y0), DVec2::new(x1, y1), 2.0);
        }
        let mut area = JunctionArea::EMPTY;
        area.add(DVec3::new(-outer, -outer, 2.0));
        area.add(DVec3::new(outer, outer, 2.0));
        let surfaces = builder.finish();
        let ground = GroundIndex::of_surfaces(&surfaces, |_| true);
        let mut builder = MeshBuilder::from_meshes(surfaces);
        let (count, _) = pave(&mut builder, &ground, &area, &[]);
        let ground = GroundIndex::of_surfaces(&builder.finish(), |_| true);
        let middle = ground.ground_below(DVec3::new(0.1, 0.1, 5.0), 0.0);
        assert!(middle.is_none_or(|it| (it.height_m - 2.0 + BELOW_M).abs() < 1e-9), "{middle:?}");
        (count, middle.map(|it| it.label))
    }

    #[test]
    fn small_gaps_between_carriageways_are_paved_and_islands_stay() {
        assert_eq!(around_an_opening(3.0, SemanticLabel::Roads), (1, Some(SemanticLabel::Roads)));
        assert_eq!(around_an_opening(9.0, SemanticLabel::Roads), (0, None));
        assert_eq!(around_an_opening(3.0, SemanticLabel::SideWalks), (0, None));
    }

    #[test]
    fn the_corner_between_lanes_and_a_gutter_is_paved_and_an_island_of_its_size_is_not() {
        let pave_beside = |beyond_gutter: SemanticLabel| {
            let mut builder = MeshBuilder::default();
            let mut add = |label, [x0, y0, x1, y1]: [f64; 4], height_m| {
                square(&mut builder, label, DVec2::new(x0, y0), DVec2::new(x1, y1), height_m);
            };
            // Lanes on the left and below, a gutter of 0.8 m on the right and above.
            add(SemanticLabel::Roads, [-4.0, -4.0, 0.0, 14.0], 0.0);
            add(SemanticLabel::Roads, [0.0, -4.0, 14.0, 0.0], 0.0);
            add(SemanticLabel::Roads, [9.0, 0.0, 9.8, 9.8], 0.0);
            add(SemanticLabel::Roads, [0.0, 9.0, 9.0, 9.8], 0.0);
            add(beyond_gutter, [9.8, 0.0, 14.0, 14.0], 0.0);
            add(beyond_gutter, [0.0, 9.8, 9.8, 14.0], 0.0);
            let mut area = JunctionArea::EMPTY;
            area.add(DVec3::new(-4.0, -4.0, 0.0));
            area.add(DVec3::new(14.0, 14.0, 0.15));
            let ground = GroundIndex::of_surfaces(&builder.finish(), |_| true);
            pave(&mut MeshBuilder::default(), &ground, &area, &[]).0
        };
        assert_eq!(pave_beside(SemanticLabel::SideWalks), 1);
        assert_eq!(pave_beside(SemanticLabel::Roads), 0);
    }
}
