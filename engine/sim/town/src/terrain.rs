//! Terrain between the roads: a grid that stays just below every road and meets the feet of what stands beside them.
//!
//! Heights are solved on a fine grid, so that grass meets pavements at their edge; open land is meshed in larger cells.

use crate::MapError;
use crate::mesh::MeshBuilder;
use cosfly_domain::{Obstacle, ObstacleKind, SemanticLabel, SurfaceMesh};
use cosfly_frames::{DVec2, DVec3};
use std::collections::BTreeMap;

/// Distance that the terrain usually reaches beyond everything else, metres.
pub const USUAL_MARGIN_M: f64 = 60.0;
/// Distance of the terrain below roads and pavements, metres.
const BELOW_ROADS_M: f64 = 0.11;
/// Cells along one side that are aimed at; 2 to 4 m wide in towns of usual size.
const AIMED_CELLS: f64 = 400.0;
/// Widest cells of towns of usual size, metres.
const WIDEST_CELL_M: f64 = 4.0;
/// Most cells along one side: towns longer than 3.2 km have wider cells.
const MOST_CELLS: f64 = 800.0;
/// Cells along the side of a block, which is one large cell where neither roads nor feet bind it.
const BLOCK: usize = 4;
/// Passes that smooth the land between the roads.
const SMOOTHING_PASSES: usize = 80;
/// Most samples over all roads and pavements; a hundred times what a large city takes.
const MOST_SAMPLES: f64 = 1e9;
/// Distance of the samples that bind cells to a road, as a share of the cell's width.
const SAMPLE_SHARE: f64 = 0.5;

/// A grid of heights in the world frame.
struct HeightGrid {
    low: DVec2,
    cell_m: f64,
    columns: usize,
    rows: usize,
    /// Highest allowed by roads; infinite where there is none.
    ceiling_m: Vec<f64>,
    /// Sum and count of the feet of obstacles near a vertex.
    feet: Vec<(f64, u32)>,
}

/// The up to four neighbours of a cell of a grid, row by row.
pub fn beside(cell: usize, columns: usize, rows: usize) -> impl Iterator<Item = usize> + use<> {
    let (column, row) = (cell % columns, cell / columns);
    [
        (column > 0).then(|| cell - 1),
        (column + 1 < columns).then_some(cell + 1),
        (row > 0).then(|| cell - columns),
        (row + 1 < rows).then_some(cell + columns),
    ]
    .into_iter()
    .flatten()
}

/// Adds the terrain (synthetic, label Terrain) under all meshes made so far, and `margin_m` beyond them and `obstacles`. Gives
/// a warning where its cells are wider than usual.
///
/// # Errors
/// Roads and pavements of absurd area.
pub fn add_terrain(
    builder: &mut MeshBuilder,
    obstacles: &[Obstacle],
    margin_m: f64,
) -> Result<Option<String>, MapError> {
    let Some(mut grid) = HeightGrid::around(builder.meshes(), obstacles, margin_m) else { return Ok(None) };
    let mut samples = 0.0;
    for mesh in builder.meshes().filter(|mesh| mesh.label != SemanticLabel::RoadLine) {
        for triangle in &mesh.triangles {
            let corners = triangle.map(|corner| mesh.vertices_in_world[corner as usize]);
            if !is_upright(corners) {
                samples += grid.lower_below(corners);
            }
            if samples > MOST_SAMPLES {
                let message = format!(
                    "the roads and pavements of the map are too large: more than {MOST_SAMPLES} samples of their heights"
                );
                return Err(
                    MapError::new(message).hint("widths of this file may be absurd; cut it into smaller pieces")
                );
            }
        }
    }
    for (obstacle, _) in obstacles.iter().zip(standing(obstacles)).filter(|(_, stands)| *stands) {
        grid.note_foot(obstacle);
    }
    let heights_m = grid.solved();
    grid.add_mesh(builder, heights_m);
    Ok(grid.coarseness())
}

/// Whether a triangle is a kerb's face or a skirt: what lies above it binds the terrain, not its lower edge.
fn is_upright([a, b, c]: [DVec3; 3]) -> bool {
    let normal = (b - a).cross(c - a);
    normal.z.abs() < 0.1 * normal.length()
}

/// Whether things of this kind stand on the ground (crowns and plates hang).
pub fn stands_on_ground(kind: ObstacleKind) -> bool {
    !matches!(
        kind,
        ObstacleKind::TreeCrown | ObstacleKind::TrafficSign | ObstacleKind::TrafficLight | ObstacleKind::Bridge
    )
}

/// For each box whether it stands on the ground: by its kind, and no higher than the lowest box of its thing and a bit
/// (roofs and upper parts stand on others).
pub fn standing(obstacles: &[Obstacle]) -> Vec<bool> {
    const HIGHER_M: f64 = 2.0;
    let foot_m = |obstacle: &Obstacle| obstacle.shape.center_in_world.z - obstacle.shape.half_extents_m.z;
    let mut lowest_m: BTreeMap<u32, f64> = BTreeMap::new();
    for obstacle in obstacles.iter().filter(|obstacle| stands_on_ground(obstacle.kind)) {
        let lowest = lowest_m.entry(obstacle.object_id).or_insert(f64::INFINITY);
        *lowest = lowest.min(foot_m(obstacle));
    }
    let is_low = |one: &Obstacle| lowest_m.get(&one.object_id).is_some_and(|lowest| foot_m(one) <= lowest + HIGHER_M);
    obstacles.iter().map(|one| stands_on_ground(one.kind) && is_low(one)).collect()
}

impl HeightGrid {
    fn around<'m>(
        meshes: impl Iterator<Item = &'m SurfaceMesh>,
        obstacles: &[Obstacle],
        margin_m: f64,
    ) -> Option<Self> {
        let mut low = DVec2::INFINITY;
        let mut high = DVec2::NEG_INFINITY;
        for point in meshes.flat_map(|mesh| &mesh.vertices_in_world) {
            low = low.min(point.truncate());
            high = high.max(point.truncate());
        }
        for obstacle in obstacles {
            let (a, b) = obstacle.shape.bounds_in_world();
            low = low.min(a.truncate());
            high = high.max(b.truncate());
        }
        if !(low.is_finite() && high.is_finite()) {
            return None;
        }
        let (low, high) = (low - margin_m, high + margin_m);
        let longest_m = (high - low).max_element();
        let cell_m = (longest_m / AIMED_CELLS).clamp(2.0, WIDEST_CELL_M).max(longest_m / MOST_CELLS);
        let cells = |side_m: f64| ((side_m / cell_m).ceil() as usize).next_multiple_of(BLOCK);
        let [columns, rows] = (high - low).to_array().map(|side_m| cells(side_m).max(BLOCK) + 1);
        let count = columns * rows;
        Some(Self { low, cell_m, columns, rows, ceiling_m: vec![f64::INFINITY; count], feet: vec![(0.0, 0); count] })
    }

    /// Says how coarse the cells are where they are wider than usual.
    fn coarseness(&self) -> Option<String> {
        let longest_km = 1e-3 * self.cell_m * (self.columns.max(self.rows) - 1) as f64;
        (self.cell_m > WIDEST_CELL_M).then(|| {
            format!(
                "the map is {longest_km:.1} km long, so the land beside its roads has cells of {:.1} m instead of {WIDEST_CELL_M} m and follows \
                 roads and feet of things less closely, also in the part that `bounds_m` keeps. Cut the file into pieces of at most 3 km",
                self.cell_m
            )
        })
    }

    /// The four vertices of the cell at a point.
    fn corners_at(&self, point: DVec2) -> [usize; 4] {
        let at = (point - self.low) / self.cell_m;
        let column = (at.x.max(0.0) as usize).min(self.columns - 2);
        let row = (at.y.max(0.0) as usize).min(self.rows - 2);
        let first = row * self.columns + column;
        [first, first + 1, first + self.columns, first + self.columns + 1]
    }

    /// Keeps the cells under a triangle below it: close samples, each binding its whole cell. Gives their number.
    fn lower_below(&mut self, [a, b, c]: [DVec3; 3]) -> f64 {
        let sides = [(a, b, c), (b, c, a), (c, a, b)];
        let length_m = |(from, to, _): &(DVec3, DVec3, DVec3)| from.distance_squared(*to);
        // Few steps along the shortest side, many away from it: triangles of roads are long and thin.
        let Some(&(a, b, c)) = sides.iter().min_by(|one, other| length_m(one).total_cmp(&length_m(other))) else {
            return 0.0;
        };
        let steps = |side: DVec3| (side.length() / (SAMPLE_SHARE * self.cell_m)).ceil().clamp(1.0, 4096.0) as usize;
        let (across, along) = (steps(b - a), steps(c - a).max(steps(c - b)));
        for i in 0..=along {
            let toward = i as f64 / along as f64;
            let (low, high) = (a.lerp(c, toward), b.lerp(c, toward));
            for j in 0..=across {
                let point = low.lerp(high, j as f64 / across as f64);
                let ceiling_m = point.z - BELOW_ROADS_M;
                for corner in self.corners_at(point.truncate()) {
                    self.ceiling_m[corner] = self.ceiling_m[corner].min(ceiling_m);
                }
            }
        }
        (across + 1) as f64 * (along + 1) as f64
    }

    fn note_foot(&mut self, obstacle: &Obstacle) {
        let foot_m = obstacle.shape.center_in_world.z - obstacle.shape.half_extents_m.z;
        for corner in self.corners_at(obstacle.shape.center_in_world.truncate()) {
            let (sum, count) = &mut self.feet[corner];
            *sum += foot_m;
            *count += 1;
        }
    }

    /// Heights of all vertices: bound ones at their bound, the others smooth in between.
    fn solved(&self) -> Vec<f64> {
        let bound: Vec<Option<f64>> = self
            .ceiling_m
            .iter()
            .zip(&self.feet)
            .map(|(ceiling_m, (sum, count))| match (ceiling_m.is_finite(), *count) {
                (true, _) => Some(*ceiling_m),
                (false, 0) => None,
                (false, count) => Some(sum / f64::from(count)),
            })
            .collect();
        let mut heights_m = self.spread(&bound);
        for _ in 0..SMOOTHING_PASSES {
            let before = heights_m.clone();
            for vertex in (0..bound.len()).filter(|vertex| bound[*vertex].is_none()) {
                let (sum, count) = self.neighbours(vertex).fold((0.0, 0.0), |(sum, n), i| (sum + before[i], n + 1.0));
                heights_m[vertex] = sum / count;
            }
        }
        heights_m
    }

    /// Gives vertices without a bound the mean of their neighbours, ring by ring outwards.
    fn spread(&self, bound: &[Option<f64>]) -> Vec<f64> {
        let mut known = bound.to_vec();
        let mut ring: Vec<usize> = (0..bound.len()).filter(|vertex| bound[*vertex].is_some()).collect();
        while !ring.is_empty() {
            let mut next: Vec<usize> = ring
                .iter()
                .flat_map(|vertex| self.neighbours(*vertex))
                .filter(|vertex| known[*vertex].is_none())
                .collect();
            next.sort_unstable();
            next.dedup();
            let means: Vec<f64> = next.iter().map(|vertex| self.mean_of_known(*vertex, &known)).collect();
            for (vertex, mean) in next.iter().zip(means) {
                known[*vertex] = Some(mean);
            }
            ring = next;
        }
        known.into_iter().map(|height| height.unwrap_or(0.0)).collect()
    }

    fn mean_of_known(&self, vertex: usize, known: &[Option<f64>]) -> f64 {
        let (sum, count) = self
            .neighbours(vertex)
            .filter_map(|i| known[i])
            .fold((0.0, 0.0), |(sum, n), height| (sum + height, n + 1.0));
        sum / f64::max(count, 1.0)
    }

    fn neighbours(&self, vertex: usize) -> impl Iterator<Item = usize> + use<> {
        beside(vertex, self.columns, self.rows)
    }

    /// Columns and rows of blocks.
    fn blocks(&self) -> [usize; 2] {
        [(self.columns - 1) / BLOCK, (self.rows - 1) / BLOCK]
    }

    /// Whether each block is meshed finely: a road or a foot binds it or one of its eight neighbours.
    fn fine_blocks(&self) -> Vec<bool> {
        let [across, along] = self.blocks();
        let is_bound = |column: usize, row: usize| {
            let vertices = (row * BLOCK..=(row + 1) * BLOCK)
                .flat_map(|y| (column * BLOCK..=(column + 1) * BLOCK).map(move |x| y * self.columns + x));
            vertices.into_iter().any(|vertex| self.ceiling_m[vertex].is_finite() || self.feet[vertex].1 > 0)
        };
        let bound: Vec<bool> = (0..across * along).map(|block| is_bound(block % across, block / across)).collect();
        let is_near_bound = |column: usize, row: usize| {
            let rows = row.saturating_sub(1)..(row + 2).min(along);
            rows.into_iter().any(|y| {
                let columns = column.saturating_sub(1)..(column + 2).min(across);
                columns.into_iter().any(|x| bound[y * across + x])
            })
        };
        (0..across * along).map(|block| is_near_bound(block % across, block / across)).collect()
    }

    /// Puts the vertices on a large cell's sides onto the straight lines between its corners, so that no gap opens
    /// towards fine neighbours. Nothing binds these vertices.
    fn straighten_sides(&self, heights_m: &mut [f64], is_fine: &[bool]) {
        let [across, _] = self.blocks();
        for block in (0..is_fine.len()).filter(|block| !is_fine[*block]) {
            let first = (block / across * self.columns + block % across) * BLOCK;
            let (right, above) = (BLOCK, BLOCK * self.columns);
            for (start, step) in [(0, 1), (0, self.columns), (right, self.columns), (above, 1)] {
                let (low, high) = (heights_m[first + start], heights_m[first + start + BLOCK * step]);
                for i in 1..BLOCK {
                    heights_m[first + start + i * step] = low + (high - low) * (i as f64 / BLOCK as f64);
                }
            }
        }
    }

    fn add_mesh(&self, builder: &mut MeshBuilder, mut heights_m: Vec<f64>) {
        let is_fine = self.fine_blocks();
        self.straighten_sides(&mut heights_m, &is_fine);
        let [across, _] = self.blocks();
        let mut triangles = Vec::new();
        for (block, fine) in is_fine.iter().enumerate() {
            let (column, row) = (block % across * BLOCK, block / across * BLOCK);
            let step = if *fine { 1 } else { BLOCK };
            for y in (row..row + BLOCK).step_by(step) {
                for x in (column..column + BLOCK).step_by(step) {
                    let first = (y * self.columns + x) as u32;
                    let (right, above) = (first + step as u32, first + (step * self.columns) as u32);
                    triangles.push([first, right, above + step as u32]);
                    triangles.push([first, above + step as u32, above]);
                }
            }
        }
        let (vertices, triangles) = self.used_vertices(&heights_m, triangles);
        builder.polygon(SemanticLabel::Terrain, true, &vertices, &triangles);
    }

    /// The vertices that triangles use, and the triangles with their numbers.
    fn used_vertices(&self, heights_m: &[f64], triangles: Vec<[u32; 3]>) -> (Vec<(DVec3, DVec2)>, Vec<[u32; 3]>) {
        let mut numbers = vec![u32::MAX; heights_m.len()];
        let mut vertices = Vec::new();
        let mut number_of = |vertex: u32| {
            let i = vertex as usize;
            if numbers[i] == u32::MAX {
                numbers[i] = vertices.len() as u32;
                let plan = self.low + self.cell_m * DVec2::new((i % self.columns) as f64, (i / self.columns) as f64);
                vertices.push((plan.extend(heights_m[i]), plan));
            }
            numbers[i]
        };
        let triangles = triangles.into_iter().map(|triangle| triangle.map(&mut number_of)).collect();
        (vertices, triangles)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::OrientedBox;

    #[test]
    fn long_maps_say_how_coarse_their_land_is_and_others_say_nothing() {
        let house = |x: f64| Obstacle {
            shape: OrientedBox::from_corners(DVec3::new(x, 0.0, 0.0), DVec3::new(x + 10.0, 10.0, 6.0)),
            kind: ObstacleKind::Building,
            object_id: 1,
            synthetic: false,
        };
        let warning = |far_m: f64| add_terrain(&mut MeshBuilder::default(), &[house(0.0), house(far_m)], 0.0).unwrap();
        assert_eq!(warning(3180.0), None);
        let words = warning(6390.0).unwrap();
        assert!(words.contains("6.4 km long") && words.contains("cells of 8.0 m instead of 4 m"), "{words}");
    }
}
