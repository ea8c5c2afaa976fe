//! A scan that is one surface, as photogrammetry makes it: its ground and all that stands on it, told apart by shape.

use super::parts::{Part, bounds};
use super::solid::height_at;
use crate::grid::Grid;
use crate::ground_filter::{least_heights, near_ground_m};
use crate::relief::Relief;
use cosfly_frames::{DVec2, DVec3};

/// Cells of the ground, metres, and most of them.
const CELL_M: f64 = 1.0;
const MOST_CELLS: f64 = 4e6;

/// The parts without names of their own: one of the ground, one of the rest. Those that are told by their names stay as they are.
pub fn apart(parts: Vec<Part>, is_named: impl Fn(&str) -> bool) -> Vec<Part> {
    let (mut named, plain): (Vec<Part>, Vec<Part>) = parts.into_iter().partition(|part| is_named(&part.name));
    if plain.is_empty() {
        return named;
    }
    let triangles = || plain.iter().flat_map(|part| part.triangles.iter().map(|triangle| part.corners(*triangle)));
    let (low, high) = bounds(plain.iter().flat_map(|part| &part.vertices));
    let cell_m = CELL_M.max(((high - low).truncate().element_product() / MOST_CELLS).sqrt());
    let grid = Grid::around([low.truncate(), high.truncate()].into_iter(), cell_m, 0.0);
    let mut lowest = vec![f32::NAN; grid.cells()];
    triangles().for_each(|triangle| {
        each_height(&grid, &triangle, |cell, height| lowest[cell] = lowest[cell].min(height));
    });
    let least = least_heights(lowest, [grid.columns, grid.rows], grid.cell_m);
    let mut ground = vec![f32::NAN; grid.cells()];
    triangles().for_each(|triangle| {
        each_height(&grid, &triangle, |cell, height| {
            if height >= least[cell] {
                ground[cell] = ground[cell].min(height);
            }
        });
    });
    let ground = Relief::new(grid, ground);
    let is_near = |corner: &DVec3| (corner.z - ground.height_m(corner.truncate())).abs() <= near_ground_m(cell_m);
    let first = named.iter().map(|part| part.owner + 1).max().unwrap_or(0);
    let mut two = ["terrain", ""].map(|name| Part { name: name.to_owned(), owner: first, ..Part::default() });
    two[1].owner += 1;
    for part in &plain {
        let before = two.each_ref().map(|part| part.vertices.len() as u32);
        two.iter_mut().for_each(|own| own.vertices.extend(&part.vertices));
        for triangle in &part.triangles {
            let side = usize::from(!part.corners(*triangle).iter().all(is_near));
            two[side].triangles.push(triangle.map(|corner| before[side] + corner));
        }
    }
    named.extend(two.into_iter().filter(|part| !part.triangles.is_empty()));
    named
}

/// Heights of a triangle: of its corners in their cells, and over the middles of all others.
fn each_height(grid: &Grid, triangle: &[DVec3; 3], mut visit: impl FnMut(usize, f32)) {
    triangle.iter().for_each(|corner| visit(grid.cell_of(corner.truncate()), corner.z as f32));
    let plan = triangle.map(|corner| grid.in_cells(corner.truncate()));
    let from = plan.iter().copied().fold(DVec2::INFINITY, DVec2::min).floor().max(DVec2::ZERO);
    let to = plan.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    for row in from.y as usize..(to.y as usize + 1).min(grid.rows) {
        for column in from.x as usize..(to.x as usize + 1).min(grid.columns) {
            let cell = row * grid.columns + column;
            if let Some(height_m) = height_at(triangle, grid.center(cell)) {
                visit(cell, height_m as f32);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A slope of 60 m with a block on it, as one surface of triangles of half a metre.
    fn scan() -> Part {
        let side = 120;
        let height =
            |x: f64, y: f64| 0.05 * x + if (20.0..30.0).contains(&x) && (25.0..33.0).contains(&y) { 7.0 } else { 0.0 };
        let mut part = Part::default();
        for row in 0..=side {
            for column in 0..=side {
                let (x, y) = (0.5 * f64::from(column), 0.5 * f64::from(row));
                part.vertices.push(DVec3::new(x, y, height(x, y)));
            }
        }
        let number = |column: u32, row: u32| row * (side + 1) + column;
        for (row, column) in (0..side).flat_map(|row| (0..side).map(move |column| (row, column))) {
            let [a, b] = [number(column, row), number(column + 1, row)];
            let [c, d] = [number(column + 1, row + 1), number(column, row + 1)];
            part.triangles.extend([[a, b, c], [a, c, d]]);
        }
        part
    }

    #[test]
    fn a_block_on_a_slope_is_told_from_it() {
        let parts = apart(vec![scan()], |_| false);
        let [ground, rest] = &parts[..] else { panic!("two parts") };
        assert_eq!((ground.name.as_str(), rest.name.as_str()), ("terrain", ""));
        // The block covers 80 of 3,600 square metres; its walls stand on half a metre more.
        assert!(rest.triangles.len() > 600 && rest.triangles.len() < 900, "{}", rest.triangles.len());
        let highest =
            ground.triangles.iter().flat_map(|it| ground.corners(*it)).map(|corner| corner.z - 0.05 * corner.x);
        assert!(highest.fold(0.0, f64::max) < 0.5);
    }
}
