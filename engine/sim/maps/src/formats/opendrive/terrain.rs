//! Terrain between the roads: a grid that stays below every road and meets the feet of what stands beside them.

use super::surfaces::MeshBuilder;
use crate::{Obstacle, ObstacleKind, SemanticLabel, SurfaceMesh};
use cosfly_frames::{DVec2, DVec3};

/// How far the terrain reaches beyond everything else, metres.
const MARGIN_M: f64 = 60.0;
/// How far the terrain stays below roads and pavements, metres.
const BELOW_ROADS_M: f64 = 0.3;
/// Cells along one side that are aimed at; between 4 and 8 m wide in towns of usual size.
const AIMED_CELLS: f64 = 150.0;
/// Most cells along one side.
const MOST_CELLS: f64 = 600.0;
/// Passes that smooth the land between the roads.
const SMOOTHING_PASSES: usize = 40;

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

/// Adds the terrain (synthetic, label Terrain) under all meshes made so far.
pub(super) fn add_terrain(builder: &mut MeshBuilder, obstacles: &[Obstacle]) {
    let Some(mut grid) = HeightGrid::around(builder.meshes(), obstacles) else { return };
    for mesh in builder.meshes().filter(|mesh| mesh.label != SemanticLabel::RoadLine) {
        for triangle in &mesh.triangles {
            grid.lower_below(triangle.map(|corner| mesh.vertices_in_world[corner as usize]));
        }
    }
    for obstacle in obstacles.iter().filter(|obstacle| stands_on_ground(obstacle.kind)) {
        grid.note_foot(obstacle);
    }
    let heights_m = grid.solved();
    grid.add_mesh(builder, &heights_m);
}

/// Whether things of this kind stand on the ground (crowns and plates hang).
pub(super) fn stands_on_ground(kind: ObstacleKind) -> bool {
    !matches!(
        kind,
        ObstacleKind::TreeCrown | ObstacleKind::TrafficSign | ObstacleKind::TrafficLight | ObstacleKind::Bridge
    )
}

impl HeightGrid {
    fn around<'m>(meshes: impl Iterator<Item = &'m SurfaceMesh>, obstacles: &[Obstacle]) -> Option<Self> {
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
        let (low, high) = (low - MARGIN_M, high + MARGIN_M);
        let longest_m = (high - low).max_element();
        let cell_m = (longest_m / AIMED_CELLS).clamp(4.0, 8.0).max(longest_m / MOST_CELLS);
        let [columns, rows] = (high - low).to_array().map(|side| (side / cell_m).ceil() as usize + 1);
        let count = columns * rows;
        Some(Self { low, cell_m, columns, rows, ceiling_m: vec![f64::INFINITY; count], feet: vec![(0.0, 0); count] })
    }

    /// The four vertices of the cell at a point.
    fn corners_at(&self, point: DVec2) -> [usize; 4] {
        let at = (point - self.low) / self.cell_m;
        let column = (at.x.max(0.0) as usize).min(self.columns - 2);
        let row = (at.y.max(0.0) as usize).min(self.rows - 2);
        let first = row * self.columns + column;
        [first, first + 1, first + self.columns, first + self.columns + 1]
    }

    /// Keeps the cells under a triangle below it: samples at most half a cell apart, each binding its whole cell.
    fn lower_below(&mut self, [a, b, c]: [DVec3; 3]) {
        let longest_m = (b - a).length().max((c - a).length()).max((c - b).length());
        let steps = (longest_m / (0.5 * self.cell_m)).ceil().clamp(1.0, 4096.0) as usize;
        for i in 0..=steps {
            for j in 0..=steps - i {
                let (u, v) = (i as f64 / steps as f64, j as f64 / steps as f64);
                let point = a + u * (b - a) + v * (c - a);
                for corner in self.corners_at(point.truncate()) {
                    self.ceiling_m[corner] = self.ceiling_m[corner].min(point.z - BELOW_ROADS_M);
                }
            }
        }
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
        let (columns, rows) = (self.columns, self.rows);
        let (column, row) = (vertex % columns, vertex / columns);
        [
            (column > 0).then(|| vertex - 1),
            (column + 1 < columns).then(|| vertex + 1),
            (row > 0).then(|| vertex - columns),
            (row + 1 < rows).then(|| vertex + columns),
        ]
        .into_iter()
        .flatten()
    }

    fn add_mesh(&self, builder: &mut MeshBuilder, heights_m: &[f64]) {
        let vertices: Vec<(DVec3, DVec2)> = heights_m
            .iter()
            .enumerate()
            .map(|(i, height_m)| {
                let plan = self.low + self.cell_m * DVec2::new((i % self.columns) as f64, (i / self.columns) as f64);
                (plan.extend(*height_m), plan)
            })
            .collect();
        let mut triangles = Vec::with_capacity(2 * self.columns * self.rows);
        for row in 0..self.rows - 1 {
            for column in 0..self.columns - 1 {
                let first = (row * self.columns + column) as u32;
                let above = first + self.columns as u32;
                triangles.push([first, first + 1, above + 1]);
                triangles.push([first, above + 1, above]);
            }
        }
        builder.polygon(SemanticLabel::Terrain, true, &vertices, &triangles);
    }
}
