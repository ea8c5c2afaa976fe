//! Buildings: roofs as columns of cells down to the ground, on grids that are turned along the walls.

use super::class;
use super::numbers::next_id;
use super::outline::smooth_unseen;
use super::slopes::{PITCHED_SHARE, SLOPE_STEP_M, Slopes};
use super::survey::{Survey, is_ground, plan_of};
use crate::grid::{Grid, nearest_seeds, parts};
use crate::plan::{convex_hull, smallest_rectangle_rad};
use crate::solid_cells::{BoxCover, boxes_of};
use crate::window_cover::{Bases, Column, Volumes};
use cosfly_domain::{Obstacle, ObstacleKind};
use cosfly_frames::{DVec2, DVec3, real};
use rayon::prelude::*;

/// A roof over ground that was seen under it is no wall where it hangs higher than this, metres.
const OVERHANG_M: f64 = 2.5;
/// Cells from a wall within which a roof over ground that was seen counts as eaves, not as hanging.
const EAVES: usize = 2;
/// Distance of a column's foot above ground that was seen in its cell, metres.
const ABOVE_GROUND_M: f64 = 0.1;
/// Number of the eight cells around an unseen one that must be of a building to make it a notch, which boxes may cover.
const NOTCH: usize = 3;
/// Cells at the edge over which the direction of a wall is felt.
const EDGE_REACH: usize = 2;

/// Adds all buildings; gives what their cells became.
pub fn add(survey: &Survey<'_>, obstacles: &mut Vec<Obstacle>) -> Volumes {
    let grid = &survey.grid;
    let classes = |cell: usize| &survey.cloud.classes[survey.points_of(cell)];
    let has_roof: Vec<bool> =
        (0..grid.cells()).into_par_iter().map(|cell| classes(cell).contains(&class::BUILDING)).collect();
    let seeds = nearest_seeds(grid, |cell| !survey.points_of(cell).is_empty(), survey.reach_cells());
    let is_building = |cell: usize| seeds[cell] != u32::MAX && has_roof[seeds[cell] as usize];
    let (part, count) = parts(grid, is_building);
    let mut cells = vec![Vec::new(); count as usize + 1];
    for (cell, number) in part.iter().enumerate().filter(|(_, number)| **number != 0) {
        cells[*number as usize].push(cell);
    }
    let covers: Vec<BoxCover> = cells[1..]
        .par_iter()
        .map(|cells| {
            let site = Site::new(survey, cells, &part);
            let rasters = site.directions_rad(cells, &is_building).map(|yaw_rad| site.columns(yaw_rad));
            // Walls along the cells take few boxes and have few corners.
            let mut rasters = rasters.map(|raster| (corners(&raster), raster));
            rasters.sort_by_key(|(corners, _)| *corners);
            let covers = rasters[..2].iter().map(|(_, Raster { grid, columns, is_free, step_m })| {
                boxes_of(grid, columns, *step_m, Bases::Highest, |cell| is_free[cell])
            });
            covers.min_by_key(|cover| cover.shapes.len()).unwrap_or_default()
        })
        .collect();
    let mut volumes = Volumes::default();
    let mut object_id = next_id(obstacles);
    for cover in covers {
        volumes = volumes.plus(cover.volumes, 1.0);
        let has_boxes = !cover.shapes.is_empty();
        let obstacle = |shape| Obstacle { shape, kind: ObstacleKind::Building, object_id, synthetic: false };
        obstacles.extend(cover.shapes.into_iter().map(obstacle));
        object_id += u32::from(has_boxes);
    }
    volumes
}

/// Corners of the outlines of a roof's levels: middles of four cells that no straight line parts.
fn corners(Raster { grid, columns, step_m, .. }: &Raster) -> usize {
    let level = |column: &Option<Column>| column.map(|column| (column.top_m / step_m).ceil() as i64);
    let levels: Vec<Option<i64>> = columns.iter().map(level).collect();
    let is_corner = |cell: usize| {
        let [a, b, c, d] = [cell, cell + 1, cell + grid.columns, cell + grid.columns + 1].map(|cell| levels[cell]);
        !(a == b && c == d || a == c && b == d)
    };
    let rows = 0..grid.rows - 1;
    rows.flat_map(|row| (0..grid.columns - 1).map(move |column| row * grid.columns + column))
        .filter(|cell| is_corner(*cell))
        .count()
}

/// A building on a grid.
struct Raster {
    grid: Grid,
    columns: Vec<Option<Column>>,
    /// Notches of its outline in which nothing was seen.
    is_free: Vec<bool>,
    /// Height of the steps in which boxes follow its roof, metres.
    step_m: f64,
}

/// One building: the points on it and on the ground beside it.
struct Site<'a> {
    survey: &'a Survey<'a>,
    roof: Vec<usize>,
    /// Points on and beside it that are no roof.
    others: Vec<usize>,
    /// Lowest ground beside or under it, metres.
    foot_m: f64,
}

impl<'a> Site<'a> {
    fn new(survey: &'a Survey<'a>, cells: &[usize], part: &[u32]) -> Self {
        let number = part[cells[0]];
        let mut near: Vec<usize> =
            cells.iter().flat_map(|cell| survey.grid.around_cell(*cell, survey.reach_cells())).collect();
        near.sort_unstable();
        near.dedup();
        let (mut roof, mut others) = (Vec::new(), Vec::new());
        for cell in near {
            for point in survey.points_of(cell) {
                match survey.cloud.classes[point] {
                    class::BUILDING if part[cell] == number => roof.push(point),
                    class::BUILDING => {}
                    _ => others.push(point),
                }
            }
        }
        let heights = cells.iter().map(|cell| survey.relief.height_m(survey.grid.center(*cell)));
        Self { survey, roof, others, foot_m: heights.fold(f64::INFINITY, f64::min) }
    }

    /// Directions that the walls may have: of the edge of the cells in the mean, of the smallest rectangle around the
    /// points, and of the map.
    fn directions_rad(&self, cells: &[usize], is_building: &impl Fn(usize) -> bool) -> [f64; 3] {
        let hull = convex_hull(plan_of(self.survey.cloud, &self.roof).collect());
        [edge_direction_rad(&self.survey.grid, cells, is_building), smallest_rectangle_rad(&hull), 0.0]
    }

    /// Columns on a grid of a direction.
    fn columns(&self, yaw_rad: f64) -> Raster {
        let (cloud, cell_m) = (self.survey.cloud, self.survey.grid.cell_m);
        let grid = Grid::flush(plan_of(cloud, &self.roof), cell_m, yaw_rad);
        let mut roof: Vec<Option<Column>> = vec![None; grid.cells()];
        let mut highest: Vec<Option<DVec3>> = vec![None; grid.cells()];
        for point in &self.roof {
            let at = cloud.point(*point);
            let cell = grid.cell_of(at.truncate());
            let column = roof[cell].get_or_insert(Column { base_m: at.z, top_m: at.z });
            *column = Column { base_m: column.base_m.min(at.z), top_m: column.top_m.max(at.z) };
            if highest[cell].is_none_or(|highest| highest.z < at.z) {
                highest[cell] = Some((cell_m * grid.in_cells(at.truncate())).extend(at.z));
            }
        }
        let mut ground_m = vec![f64::NEG_INFINITY; grid.cells()];
        let mut is_seed: Vec<bool> = roof.iter().map(Option::is_some).collect();
        for point in &self.others {
            let at = cloud.point(*point);
            let in_cells = grid.in_cells(at.truncate());
            if in_cells.cmpge(DVec2::ZERO).all() && in_cells.x < grid.columns as f64 && in_cells.y < grid.rows as f64 {
                let cell = grid.cell_of(at.truncate());
                is_seed[cell] = true;
                if is_ground(cloud.classes[*point]) {
                    ground_m[cell] = ground_m[cell].max(at.z);
                }
            }
        }
        let seeds = nearest_seeds(&grid, |cell| is_seed[cell], self.survey.reach_cells());
        // Beyond the edge of the cloud nothing was seen: no roof grows there.
        let [low, high] = cloud.bounds;
        let is_seen = |cell: usize| is_seed[cell] || grid.center(cell).clamp(low, high) == grid.center(cell);
        let nearest =
            |(cell, seed): (usize, &u32)| roof.get(*seed as usize).copied().flatten().filter(|_| is_seen(cell));
        let mut roofs: Vec<Option<Column>> = seeds.iter().enumerate().map(nearest).collect();
        drop_slivers(&grid, &mut roofs, |cell| roof[cell].is_some());
        smooth_unseen(&grid, &mut roofs, |cell| !is_seed[cell] && is_seen(cell));
        fill_pits(&grid, &mut roofs, (self.survey.reach_cells() / 2).max(1));
        let reach = self.survey.reach_cells();
        let slopes = Slopes::of(&grid, &highest, reach);
        let on_slopes = slopes.follow(&grid, &mut roofs, &seeds, (&highest, reach));
        let is_pitched = on_slopes > PITCHED_SHARE && self.survey.follows_slopes;
        let step_m = if is_pitched { SLOPE_STEP_M.min(self.survey.step_m) } else { self.survey.step_m };
        let columns = self.standing(&grid, &roofs, &ground_m);
        let beside = |cell: usize| grid.around_cell(cell, 1).filter(|near| columns[*near].is_some()).count();
        let is_free = |cell: usize| !is_seed[cell] && is_seen(cell) && beside(cell) >= NOTCH;
        let is_free = (0..grid.cells()).map(is_free).collect();
        Raster { grid, columns, is_free, step_m }
    }

    /// Columns from the roofs down to the foot, or to the ground that was seen in a cell, or only the roof where it
    /// hangs over that ground far from any wall.
    fn standing(&self, grid: &Grid, roofs: &[Option<Column>], ground_m: &[f64]) -> Vec<Option<Column>> {
        let is_solid = |cell: usize| roofs[cell].is_some() && ground_m[cell] == f64::NEG_INFINITY;
        let column = |cell: usize| {
            let roof = roofs[cell]?;
            let hangs = !is_solid(cell)
                && roof.base_m - ground_m[cell] > OVERHANG_M
                && !grid.around_cell(cell, EAVES).any(is_solid);
            let base_m = if hangs { roof.base_m } else { self.foot_m.max(ground_m[cell] + ABOVE_GROUND_M) };
            Some(Column { base_m, top_m: roof.top_m.max(base_m) })
        };
        (0..grid.cells()).map(column).collect()
    }
}

/// Drops roofs where none was seen and they are narrower than two cells: the edges of gaps between points are ragged.
fn drop_slivers(grid: &Grid, roofs: &mut [Option<Column>], is_seen: impl Fn(usize) -> bool) {
    let mut is_wide = vec![false; roofs.len()];
    for row in 1..grid.rows {
        for column in 1..grid.columns {
            let last = row * grid.columns + column;
            let square = [last, last - 1, last - grid.columns, last - grid.columns - 1];
            if square.iter().all(|cell| roofs[*cell].is_some()) {
                square.iter().for_each(|cell| is_wide[*cell] = true);
            }
        }
    }
    let slivers = roofs.iter_mut().enumerate().filter(|(cell, _)| !is_wide[*cell] && !is_seen(*cell));
    slivers.for_each(|(_, roof)| *roof = None);
}

/// Raises tops in pits that are narrower than twice `reach` cells to their rim: a closing of the roof's surface.
fn fill_pits(grid: &Grid, roofs: &mut [Option<Column>], reach: usize) {
    let near = |cell: usize, tops: &[Option<f64>], pick: fn(f64, f64) -> f64| {
        tops[cell]?;
        grid.around_cell(cell, reach).filter_map(|near| tops[near]).reduce(pick)
    };
    let tops: Vec<Option<f64>> = roofs.iter().map(|roof| roof.map(|column| column.top_m)).collect();
    let raised: Vec<Option<f64>> = (0..tops.len()).map(|cell| near(cell, &tops, f64::max)).collect();
    for (cell, roof) in roofs.iter_mut().enumerate() {
        if let (Some(column), Some(rim_m)) = (roof, near(cell, &raised, f64::min)) {
            column.top_m = column.top_m.max(rim_m);
        }
    }
}

/// Mean direction of the walls: each cell at the edge feels which way its neighbours lie; quarter turns count as one.
fn edge_direction_rad(grid: &Grid, cells: &[usize], is_building: &impl Fn(usize) -> bool) -> f64 {
    let (mut sine, mut cosine) = (0.0, 0.0);
    for cell in cells {
        let own = DVec2::new((cell % grid.columns) as f64, (cell / grid.columns) as f64);
        let inward: DVec2 = grid
            .around_cell(*cell, EDGE_REACH)
            .filter(|near| is_building(*near))
            .map(|near| DVec2::new((near % grid.columns) as f64, (near / grid.columns) as f64) - own)
            .sum();
        let strength = inward.length();
        if strength > 0.0 {
            let (sin, cos) = real::sin_cos(4.0 * real::atan2(inward.y, inward.x));
            sine += strength * sin;
            cosine += strength * cos;
        }
    }
    0.25 * real::atan2(sine, cosine)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn walls_of_a_turned_house_are_found() {
        let (sin, cos) = real::sin_cos(0.35);
        let corner = |x: f64, y: f64| DVec2::new(cos * x - sin * y, sin * x + cos * y);
        let points: Vec<DVec2> = (0..400).map(|i| corner(0.9 * f64::from(i % 20), 0.5 * f64::from(i / 20))).collect();
        let quarter = |angle: f64| (angle - (angle / real::FRAC_PI_2).round() * real::FRAC_PI_2).abs();
        assert!(quarter(smallest_rectangle_rad(&convex_hull(points.clone())) - 0.35) < 1e-6);
        let grid = Grid::around(points.iter().copied(), 0.5, 0.0);
        let mut is_house = vec![false; grid.cells()];
        for i in 0..4000 {
            is_house[grid.cell_of(corner(0.1 * f64::from(i % 180), 0.45 * f64::from(i / 180)))] = true;
        }
        let cells: Vec<usize> = (0..grid.cells()).filter(|cell| is_house[*cell]).collect();
        let found = edge_direction_rad(&grid, &cells, &|cell| is_house[cell]);
        assert!(quarter(found - 0.35) < 0.05, "{found}");
    }
}
