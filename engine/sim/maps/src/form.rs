//! Figures of a town's form: how much is built on, how high, how wide people's ways are and what they see of the sky.
//!
//! All are measured on cells seen from above, over the ground within [`AROUND_M`] of where people walk.

use cosfly_domain::{ObstacleKind, SemanticLabel, Town, WalkablePolygon};
use cosfly_frames::{DVec2, real};
use cosfly_town::polygons::twice_area_m2;
use cosfly_town::terrain::beside;

/// Ground this close to a walk belongs to the town, metres.
const AROUND_M: f64 = 30.0;
/// Side of a cell, metres; wider in towns of more than [`MOST_CELLS`] along a side.
const CELL_M: f64 = 1.0;
const MOST_CELLS: f64 = 1500.0;
/// Places of walks that are looked from, at most.
const MOST_PLACES: usize = 1500;
/// Height of the eyes, metres.
const EYES_M: f64 = 1.6;
/// Directions and reach of looks, metres.
const LOOKS: usize = 16;
const REACH_M: f64 = 80.0;
/// Bins of half a turn for directions of streets.
const BINS: usize = 18;

/// Figures of form.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Form {
    /// Share of the ground under buildings, 0 to 1.
    pub built_share: f64,
    /// Mean height of buildings over the ground that they cover, metres.
    pub height_m: f64,
    /// Share of the ground under crowns of trees, 0 to 1.
    pub tree_share: f64,
    /// Size of the land that walks and carriageways enclose, square metres: the median, where land counts by its size.
    pub block_m2: f64,
    /// Distance between buildings through places of walks, in the direction in which it is shortest, metres: the median,
    /// at most twice the reach of looks.
    pub free_width_m: f64,
    /// Entropy of the directions of streets, as a share of its largest value: 0 one direction, 1 all alike.
    pub direction_entropy: f64,
    /// Share of the sky that is seen from walks, 0 to 1.
    pub sky_share: f64,
}

/// Figures of a town's form; none where nobody walks.
pub fn form(town: &Town) -> Option<Form> {
    let cells = Cells::of(town)?;
    let near = cells.near_walks();
    let share = |is_it: &dyn Fn(usize) -> bool| {
        let all = near.iter().filter(|near| **near).count().max(1);
        (0..near.len()).filter(|cell| near[*cell] && is_it(*cell)).count() as f64 / all as f64
    };
    let heights: Vec<f64> = cells.built_m.iter().copied().filter(|height_m| *height_m > 0.0).collect();
    let places = cells.places();
    let widths = places.iter().map(|place| cells.free_width_m(*place));
    Some(Form {
        built_share: share(&|cell| cells.built_m[cell] > 0.0),
        height_m: mean(&heights),
        tree_share: share(&|cell| cells.crown_m[cell] > 0.0),
        block_m2: cells.block_m2(),
        free_width_m: median(widths.collect()),
        direction_entropy: direction_entropy(town),
        sky_share: mean(&places.iter().map(|place| cells.sky_share(*place)).collect::<Vec<_>>()),
    })
}

/// The town from above.
struct Cells {
    low: DVec2,
    cell_m: f64,
    columns: usize,
    rows: usize,
    is_walk: Vec<bool>,
    is_road: Vec<bool>,
    /// Level of the ground: that of the nearest walk.
    ground_m: Vec<f64>,
    /// Height of buildings and of crowns over the ground; 0 without any.
    built_m: Vec<f64>,
    crown_m: Vec<f64>,
}

impl Cells {
    fn of(town: &Town) -> Option<Self> {
        let walks: Vec<Vec<DVec2>> = town.walkable.iter().map(WalkablePolygon::plan).collect();
        let corners = walks.iter().flatten();
        let [low, high] =
            corners.fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], at| [low.min(*at), high.max(*at)]);
        let size_m = high - low + 2.0 * AROUND_M;
        if !size_m.is_finite() {
            return None;
        }
        let cell_m = CELL_M.max(size_m.max_element() / MOST_CELLS);
        let [columns, rows] = (size_m / cell_m).ceil().to_array().map(|count| count as usize + 1);
        let none = vec![0.0; columns * rows];
        let mut cells = Self {
            low: low - AROUND_M,
            cell_m,
            columns,
            rows,
            is_walk: vec![false; columns * rows],
            is_road: vec![false; columns * rows],
            ground_m: vec![f64::NAN; columns * rows],
            built_m: none.clone(),
            crown_m: none,
        };
        for (walk, level_m) in walks.iter().zip(town.walkable.iter().map(WalkablePolygon::mean_height_m)) {
            cells.cover(walk, |cells, cell| (cells.is_walk[cell], cells.ground_m[cell]) = (true, level_m));
        }
        cells.spread_ground();
        for mesh in town.surfaces.iter().filter(|mesh| mesh.label == SemanticLabel::Roads) {
            for triangle in &mesh.triangles {
                let plan = triangle.map(|corner| mesh.vertices_in_world[corner as usize].truncate());
                cells.cover(&plan, |cells, cell| cells.is_road[cell] = true);
            }
        }
        for obstacle in &town.obstacles {
            let plan: Vec<DVec2> =
                [0, 1, 3, 2].iter().map(|corner| obstacle.shape.corners_in_world()[*corner].truncate()).collect();
            let top_m = obstacle.shape.bounds_in_world().1.z;
            match obstacle.kind {
                ObstacleKind::Building => {
                    cells.cover(&plan, |cells, cell| {
                        cells.built_m[cell] = cells.built_m[cell].max(top_m - cells.ground_m[cell]);
                    });
                }
                ObstacleKind::TreeCrown => {
                    cells.cover(&plan, |cells, cell| {
                        cells.crown_m[cell] = cells.crown_m[cell].max(top_m - cells.ground_m[cell]);
                    });
                }
                _ => {}
            }
        }
        Some(cells)
    }

    /// Gives ground beyond the walks the level of the nearest, by steps from cell to cell.
    fn spread_ground(&mut self) {
        let mut front: Vec<usize> = (0..self.is_walk.len()).filter(|cell| self.is_walk[*cell]).collect();
        while !front.is_empty() {
            let mut next = Vec::new();
            for cell in front {
                for other in beside(cell, self.columns, self.rows) {
                    if self.ground_m[other].is_nan() {
                        self.ground_m[other] = self.ground_m[cell];
                        next.push(other);
                    }
                }
            }
            front = next;
        }
    }

    /// Calls with each cell whose middle lies in an outline (even-odd rule, row by row).
    fn cover(&mut self, outline: &[DVec2], mut mark: impl FnMut(&mut Self, usize)) {
        if outline.len() < 3 || twice_area_m2(outline) == 0.0 {
            return;
        }
        let at = |corner: DVec2| ((corner - self.low) / self.cell_m).floor().max(DVec2::ZERO);
        let mut corners = outline.iter().map(|corner| at(*corner));
        let first = corners.next().unwrap_or_default();
        let (low, high) = corners.fold((first, first), |(low, high), at| (low.min(at), high.max(at)));
        for row in low.y as usize..=(high.y as usize).min(self.rows - 1) {
            let y = self.middle(row * self.columns).y;
            let sides = outline.iter().zip(outline.iter().cycle().skip(1)).filter(|(a, b)| (a.y > y) != (b.y > y));
            let crossed: Vec<f64> = sides.map(|(a, b)| a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y))).collect();
            for column in low.x as usize..=(high.x as usize).min(self.columns - 1) {
                let cell = row * self.columns + column;
                let x = self.middle(cell).x;
                if crossed.iter().filter(|at| x < **at).count() % 2 == 1 {
                    mark(self, cell);
                }
            }
        }
    }

    fn middle(&self, cell: usize) -> DVec2 {
        let at = DVec2::new((cell % self.columns) as f64, (cell / self.columns) as f64);
        self.low + self.cell_m * (at + 0.5)
    }

    fn cell_at(&self, at: DVec2) -> Option<usize> {
        let [column, row] = ((at - self.low) / self.cell_m).floor().to_array();
        let is_inside = column >= 0.0 && row >= 0.0 && column < self.columns as f64 && row < self.rows as f64;
        is_inside.then(|| row as usize * self.columns + column as usize)
    }

    /// Cells within [`AROUND_M`] of a walk, by steps from cell to cell.
    fn near_walks(&self) -> Vec<bool> {
        let mut near = self.is_walk.clone();
        let mut front: Vec<usize> = (0..near.len()).filter(|cell| near[*cell]).collect();
        for _ in 0..(AROUND_M / self.cell_m) as usize {
            let mut next = Vec::new();
            for cell in front {
                for other in beside(cell, self.columns, self.rows) {
                    if !core::mem::replace(&mut near[other], true) {
                        next.push(other);
                    }
                }
            }
            front = next;
        }
        near
    }

    /// Places of walks, spread evenly.
    fn places(&self) -> Vec<DVec2> {
        let walks: Vec<usize> = (0..self.is_walk.len()).filter(|cell| self.is_walk[*cell]).collect();
        let step = walks.len().div_ceil(MOST_PLACES).max(1);
        walks.iter().step_by(step).map(|cell| self.middle(*cell)).collect()
    }

    fn block_m2(&self) -> f64 {
        let mut open: Vec<bool> =
            (0..self.is_walk.len()).map(|cell| !self.is_walk[cell] && !self.is_road[cell]).collect();
        let mut sizes_m2 = Vec::new();
        for start in 0..open.len() {
            let (mut next, mut size, mut is_enclosed) = (vec![start], 0_usize, true);
            while let Some(cell) = next.pop() {
                if core::mem::take(&mut open[cell]) {
                    size += 1;
                    let around: Vec<usize> = beside(cell, self.columns, self.rows).collect();
                    is_enclosed &= around.len() == 4;
                    next.extend(around);
                }
            }
            if size > 0 && is_enclosed {
                sizes_m2.push(size as f64 * self.cell_m * self.cell_m);
            }
        }
        sizes_m2.sort_by(f64::total_cmp);
        let half_m2 = 0.5 * sizes_m2.iter().sum::<f64>();
        let mut sum_m2 = 0.0;
        let found = sizes_m2.into_iter().find(|size_m2| {
            sum_m2 += size_m2;
            sum_m2 >= half_m2
        });
        found.unwrap_or_default()
    }

    /// Distance and height of each cell that a look meets, by steps of a cell.
    fn along(&self, from: DVec2, direction: DVec2) -> impl Iterator<Item = (f64, usize)> + '_ {
        let steps = (REACH_M / self.cell_m) as usize;
        let step = move |at: usize| at as f64 * self.cell_m;
        (1..=steps).map_while(move |at| Some((step(at), self.cell_at(from + step(at) * direction)?)))
    }

    fn free_width_m(&self, place: DVec2) -> f64 {
        let free_m = |direction: DVec2| {
            let wall = self.along(place, direction).find(|(_, cell)| self.built_m[*cell] > 0.0);
            wall.map_or(REACH_M, |(distance_m, _)| distance_m)
        };
        let widths = (0..LOOKS).map(|look| {
            let direction = direction(look as f64 / (2 * LOOKS) as f64);
            free_m(direction) + free_m(-direction)
        });
        widths.fold(f64::INFINITY, f64::min)
    }

    fn sky_share(&self, place: DVec2) -> f64 {
        let looks = (0..LOOKS).map(|look| {
            let slopes = self
                .along(place, direction(look as f64 / LOOKS as f64))
                .map(|(distance_m, cell)| (self.built_m[cell].max(self.crown_m[cell]) - EYES_M).max(0.0) / distance_m);
            let slope = slopes.fold(0.0, f64::max);
            // The squared cosine of the height of the horizon.
            1.0 / (1.0 + slope * slope)
        });
        looks.sum::<f64>() / LOOKS as f64
    }
}

/// A unit vector after a share of a turn.
fn direction(share: f64) -> DVec2 {
    let (sin, cos) = real::sin_cos(2.0 * real::PI * share);
    DVec2::new(cos, sin)
}

/// The mean; 0 of nothing.
fn mean(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |sum, value| sum + value) / values.len().max(1) as f64
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or_default()
}

/// See [`Form::direction_entropy`]; the streets are the lanes outside junctions.
fn direction_entropy(town: &Town) -> f64 {
    let mut bins_m = [0.0; BINS];
    for lane in town.lanes.iter().filter(|lane| !lane.in_junction) {
        for pair in lane.middle_in_world.windows(2) {
            let along = (pair[1] - pair[0]).truncate();
            let share = (real::atan2(along.y, along.x) / real::PI).rem_euclid(1.0);
            bins_m[((share * BINS as f64) as usize).min(BINS - 1)] += along.length();
        }
    }
    let sum_m: f64 = bins_m.iter().sum();
    let shares = bins_m.into_iter().map(|bin_m| bin_m / sum_m.max(1e-9)).filter(|share| *share > 0.0);
    shares.fold(0.0, |sum, share| sum - share * real::ln(share)) / real::ln(BINS as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::{Obstacle, OrientedBox, WalkableKind};
    use cosfly_frames::DVec3;

    /// A street between two rows of houses 10 m high.
    fn street(east_m: f64, level_m: f64) -> Town {
        let row = |y: f64| Obstacle {
            shape: OrientedBox {
                center_in_world: DVec3::new(east_m, y, level_m + 5.0),
                half_extents_m: DVec3::new(100.0, 5.0, 5.0),
                yaw_rad: 0.0,
            },
            kind: ObstacleKind::Building,
            object_id: 1,
            synthetic: false,
        };
        let corners = [[-50.0, -5.0], [50.0, -5.0], [50.0, 5.0], [-50.0, 5.0]];
        let outline_in_world = corners.map(|[x, y]| DVec3::new(east_m + x, y, level_m)).to_vec();
        let walk = WalkablePolygon { kind: WalkableKind::Plaza, outline_in_world, synthetic: false };
        Town { obstacles: vec![row(-15.0), row(15.0)], walkable: vec![walk], ..Town::default() }
    }

    #[test]
    fn a_walk_between_two_rows_of_houses_is_as_wide_as_their_distance() {
        let form = form(&street(0.0, 0.0)).unwrap();
        assert!((form.free_width_m - 20.0).abs() <= 2.0 && form.height_m == 10.0, "{form:?}");
        assert!(form.sky_share > 0.3 && form.sky_share < 0.8 && form.built_share > 0.2, "{form:?}");
        assert_eq!((form.tree_share, form.direction_entropy), (0.0, 0.0));
        assert_eq!(super::form(&Town::default()), None);
    }

    #[test]
    fn houses_on_a_hill_are_as_high_as_those_in_the_valley() {
        let [mut town, hill] = [street(0.0, 0.0), street(300.0, 60.0)];
        town.obstacles.extend(hill.obstacles);
        town.walkable.extend(hill.walkable);
        assert_eq!(form(&town).unwrap().height_m, 10.0);
    }
}
