//! The walkable grid of a town: cells on walkable ground and the steps between them that are free.

use crate::areas::Weights;
use crate::ground::Ground;
use crate::obstruction::Obstruction;
use crate::polygon::Cut;
use crate::{PedestrianConfig, PedestrianError};
use cosfly_domain::{Town, WalkableKind};
use cosfly_frames::{DVec2, DVec3};
use cosfly_maps::advice::{WIDEST_WALKS_M2, busiest_part};
use raster::MAX_CELLS;
use tiles::{Lattice, Numbering, Tiles};

mod raster;
#[cfg(test)]
pub(crate) mod test_towns;
mod tiles;

/// Largest step up or down between neighbouring cells, metres: a kerb, not a wall.
const MAX_RISE_M: f64 = 0.4;

/// The eight steps to neighbours: column, row. Step `i` and step `(i + 4) % 8` are opposite.
pub(crate) const STEPS: [(isize, isize); 8] = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)];

const NO_NODE: u32 = u32::MAX;

/// One walkable cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    /// Index of its cell in the dense grid.
    pub cell: u32,
    /// Height of the ground at its centre, metres.
    pub z: f32,
    /// Distance to the nearest cell that is not freely walkable, metres.
    pub edge_distance_m: f32,
    /// Number of its connected piece.
    pub component: u32,
    /// Bit `i`: the step `STEPS[i]` is free.
    pub steps: u8,
    /// Kind of the ground.
    pub kind: WalkableKind,
    /// The whole cell is ground and no obstacle is within the body radius of it.
    pub open: bool,
}

/// A connected piece of ground.
#[derive(Clone, Debug)]
pub(crate) struct Component {
    /// Nodes, ascending.
    pub nodes: Vec<u32>,
    /// Diagonal of its bounds, metres.
    pub extent_m: f64,
    /// Sum of the weights of its nodes for starts and goals.
    pub weight: f64,
}

/// The walkable ground of a town as a graph of cells, shared between all pedestrians.
///
/// Every step between two nodes is free in the exact sense: it lies on walkable polygons over its whole
/// length and the widest body passes every obstacle. So corners cannot be cut, and any grid route is valid.
#[derive(Clone, Debug)]
pub struct WalkableGrid {
    pub(crate) cell_m: f64,
    numbering: Numbering,
    corner: DVec2,
    node_of_cell: Tiles<u32>,
    pub(crate) nodes: Vec<Node>,
    pub(crate) components: Vec<Component>,
    ground: Ground,
    obstruction: Obstruction,
    weights: Weights,
    radius_m: f64,
    height_m: f64,
}

impl WalkableGrid {
    /// Builds the grid of a town: walkable polygons minus obstacles grown by the largest body radius.
    pub fn build(town: &Town, config: &PedestrianConfig) -> Result<Self, PedestrianError> {
        config.check()?;
        let mut ground = Ground::new(town, &config.areas)?;
        let size = (ground.max - ground.min).truncate() / config.grid_m;
        // One cell of margin all round, so that neighbours never leave the array.
        let cells = (size.x + 4.0) * (size.y + 4.0);
        let too_large = |cells: f64, limit| PedestrianError::TooLarge { cells, limit, grid_m: config.grid_m };
        let extent_m2 = cells * config.grid_m * config.grid_m;
        if extent_m2 > WIDEST_WALKS_M2 {
            let part = busiest_part(town).map_or_else(String::new, |part| part.written());
            return Err(PedestrianError::TooWide { extent_m2, limit_m2: WIDEST_WALKS_M2, part });
        }
        let (columns, rows) = (size.x as usize + 3, size.y as usize + 3);
        let numbering = Numbering::new(columns, rows).ok_or_else(|| too_large(cells, u32::MAX as usize))?;
        ground.index();
        let corner = ground.min.truncate() - config.grid_m;
        let obstruction =
            Obstruction::new(town, corner, corner + config.grid_m * DVec2::new(columns as f64, rows as f64))?;
        let mut grid = Self {
            cell_m: config.grid_m,
            numbering,
            corner,
            node_of_cell: Tiles::new(numbering, NO_NODE),
            nodes: vec![],
            components: vec![],
            ground,
            obstruction,
            weights: Weights::new(&config.areas),
            radius_m: config.kinds.clearance_m(config.radius.max_m),
            height_m: config.height.max_m,
        };
        let ground_cells = grid.lay_nodes().map_err(|count| too_large(count as f64, MAX_CELLS))?;
        grid.join_nodes();
        grid.part_by_obstacles();
        grid.find_components();
        grid.measure_edge_distance();
        if grid.components.is_empty() {
            return Err(PedestrianError::NothingFree {
                polygons: town.walkable.len(),
                ground_cells,
                grid_m: config.grid_m,
            });
        }
        Ok(grid)
    }

    /// The exact ground under the grid.
    pub fn ground(&self) -> &Ground {
        &self.ground
    }

    /// Number of walkable cells.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Number of walkable cells where walks may begin and lead to.
    pub fn start_cells(&self) -> usize {
        (0..self.nodes.len() as u32).filter(|node| self.weight(*node) > 0.0).count()
    }

    /// Never true for a grid that was built.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Number and extents of the connected pieces, metres, largest first.
    pub fn piece_extents_m(&self) -> Vec<f64> {
        let mut extents: Vec<f64> = self.components.iter().map(|piece| piece.extent_m).collect();
        extents.sort_by(|a, b| b.total_cmp(a));
        extents
    }

    /// Whether a body can walk the straight step: on walkable ground over its whole length, and at no point
    /// nearer to an obstacle than the largest body radius.
    pub fn step_is_free(&self, from_in_world: DVec2, to_in_world: DVec2) -> bool {
        let (Some(z_from), Some(z_to)) = (self.z_near(from_in_world), self.z_near(to_in_world)) else { return false };
        let mut open = true;
        raster::cells_on_segment(&self.lattice(), from_in_world, to_in_world, &mut |cell| {
            let node = self.node_of_cell.get(cell);
            open = open && node != NO_NODE && self.nodes[node as usize].open;
        });
        open || {
            let (from, to) = (from_in_world.extend(z_from), to_in_world.extend(z_to));
            self.ground.covers(from, to) && self.obstruction.lets_through(from, to, self.radius_m, self.height_m)
        }
    }

    /// Height of the ground at or beside a point, from the cells; `None` far from walkable ground.
    pub(crate) fn z_near(&self, point: DVec2) -> Option<f64> {
        let cell = self.cell_at(point)?;
        let node = self.node_of_cell.get(cell);
        if node != NO_NODE {
            return Some(f64::from(self.nodes[node as usize].z));
        }
        STEPS.iter().find_map(|&step| {
            let node = self.node_of_cell.get(self.beside(cell, step)?);
            (node != NO_NODE).then(|| f64::from(self.nodes[node as usize].z))
        })
    }

    /// Kind of the ground at a point, by cells.
    pub(crate) fn kind_at(&self, point: DVec2) -> Option<WalkableKind> {
        let node = self.node_of_cell.get(self.cell_at(point)?);
        (node != NO_NODE).then(|| self.nodes[node as usize].kind)
    }

    /// Whether the straight step is free and ends on walkable ground itself, not in a seam of it.
    pub(crate) fn step_ends_on_ground(&self, from: DVec2, to: DVec2) -> bool {
        let is_open = || {
            let node = self.cell_at(to).map_or(NO_NODE, |cell| self.node_of_cell.get(cell));
            node != NO_NODE && self.nodes[node as usize].open
        };
        let is_on_ground = || is_open() || self.z_near(to).is_some_and(|z| self.ground.exactly_at(to, z).is_some());
        is_on_ground() && self.step_is_free(from, to)
    }

    /// Whether the cell at a point is walkable ground.
    pub(crate) fn is_ground(&self, point: DVec2) -> bool {
        self.cell_at(point).is_some_and(|cell| self.node_of_cell.get(cell) != NO_NODE)
    }

    /// Sum of the directions away from the steps that are not free at a point, unit vectors; zero in the open.
    pub(crate) fn away_from_edge(&self, point: DVec2) -> DVec2 {
        let node = self.cell_at(point).map_or(NO_NODE, |cell| self.node_of_cell.get(cell));
        if node == NO_NODE {
            return DVec2::ZERO;
        }
        let steps = self.nodes[node as usize].steps;
        let closed = STEPS.iter().enumerate().filter(|(step, _)| steps & (1 << step) == 0);
        closed.map(|(_, way)| -DVec2::new(way.0 as f64, way.1 as f64).normalize()).sum()
    }

    /// Weight of a node for starts and goals, 0..=1: 1 on the ground of the largest weight.
    pub(crate) fn weight(&self, node: u32) -> f64 {
        if self.weights.are_one() { 1.0 } else { self.weights.at(self.center(node)) / self.weights.largest }
    }

    /// Whether ground differs in weight.
    pub(crate) fn is_weighted(&self) -> bool {
        !self.weights.are_one()
    }

    /// Centre of a node's cell in plan.
    pub(crate) fn center(&self, node: u32) -> DVec2 {
        self.center_of_cell(self.nodes[node as usize].cell as usize)
    }

    /// Column and row of a node.
    pub(crate) fn column_row(&self, node: u32) -> (usize, usize) {
        self.numbering.column_row(self.nodes[node as usize].cell as usize)
    }

    /// The node one free step away, if that step is free.
    pub(crate) fn neighbour(&self, node: u32, step: usize) -> Option<u32> {
        let from = &self.nodes[node as usize];
        if from.steps & (1 << step) == 0 {
            return None;
        }
        // A free step leads to a node, so its cell is in the grid.
        Some(self.node_of_cell.get(self.beside(from.cell as usize, STEPS[step])?))
    }

    /// The joined node of `component` nearest to `point` within `reach` cells.
    pub(crate) fn node_near(&self, point: DVec2, component: u32, reach: isize) -> Option<u32> {
        let middle = ((point - self.corner) / self.cell_m).floor();
        if middle.abs().max_element() > 1e7 {
            return None;
        }
        let (column, row) = (middle.x as isize, middle.y as isize);
        let mut best: Option<(f64, u32)> = None;
        for row in (row - reach).max(0)..=(row + reach).min(self.numbering.rows as isize - 1) {
            for column in (column - reach).max(0)..=(column + reach).min(self.numbering.columns as isize - 1) {
                let node = self.node_of_cell.get(self.numbering.cell(column as usize, row as usize));
                if node != NO_NODE && self.nodes[node as usize].component == component {
                    let distance = (self.center(node) - point).length_squared();
                    if best.is_none_or(|kept| distance < kept.0) {
                        best = Some((distance, node));
                    }
                }
            }
        }
        best.map(|(_, node)| node)
    }

    fn center_of_cell(&self, cell: usize) -> DVec2 {
        self.lattice().center(cell)
    }

    fn cell_at(&self, point: DVec2) -> Option<usize> {
        let place = ((point - self.corner) / self.cell_m).floor();
        let (columns, rows) = (self.numbering.columns as f64, self.numbering.rows as f64);
        let inside = place.x >= 0.0 && place.y >= 0.0 && place.x < columns && place.y < rows;
        inside.then(|| self.numbering.cell(place.x as usize, place.y as usize))
    }

    fn beside(&self, cell: usize, (column, row): (isize, isize)) -> Option<usize> {
        let (own_column, own_row) = self.numbering.column_row(cell);
        let (c, r) = (own_column as isize + column, own_row as isize + row);
        let inside = c >= 0 && r >= 0 && c < self.numbering.columns as isize && r < self.numbering.rows as isize;
        inside.then(|| self.numbering.cell(c as usize, r as usize))
    }

    fn lattice(&self) -> Lattice {
        Lattice { corner: self.corner, cell_m: self.cell_m, numbering: self.numbering }
    }

    /// Rasters the polygons: one node for every cell whose centre is on walkable ground. Returns their number; the error
    /// is the number of cells that are too many.
    fn lay_nodes(&mut self) -> Result<usize, usize> {
        let mut cells = raster::Cells { values: Tiles::new(self.numbering, raster::Cell::default()), count: 0 };
        let mut cut = Cut::default();
        let lattice = self.lattice();
        for polygon in &self.ground.polygons {
            for (across, direction) in [(DVec2::Y, DVec2::X), (DVec2::X, DVec2::Y)] {
                raster::fill(&lattice, polygon, across, direction, &mut cut, &mut cells)?;
            }
        }
        for polygon in &self.ground.polygons {
            for (from, to) in polygon.edges() {
                raster::cells_on_segment(&lattice, from.truncate(), to.truncate(), &mut |cell| {
                    cells.values.get_mut(cell).outlined = true;
                });
            }
        }
        self.ground.closed.visit_edges(&mut |from, to| {
            raster::cells_on_segment(&lattice, from, to, &mut |cell| cells.values.get_mut(cell).outlined = true);
        });
        let is_closed = |cell| self.ground.closed.contains(lattice.center(cell));
        cells.values.visit(|cell, ground| {
            if let Some(kind) = ground.kind.filter(|_| !is_closed(cell)) {
                *self.node_of_cell.get_mut(cell) = self.nodes.len() as u32;
                self.nodes.push(Node {
                    cell: cell as u32,
                    z: ground.z,
                    edge_distance_m: 0.0,
                    component: u32::MAX,
                    steps: 0,
                    kind,
                    open: !ground.outlined,
                });
            }
        });
        Ok(self.nodes.len())
    }

    /// Frees the steps that stay on walkable ground.
    fn join_nodes(&mut self) {
        for node in 0..self.nodes.len() {
            let cell = self.nodes[node].cell as usize;
            for (step, &offset) in STEPS.iter().enumerate().take(4) {
                let Some(other) = self.beside(cell, offset).map(|beside| self.node_of_cell.get(beside)) else {
                    continue;
                };
                if other == NO_NODE {
                    continue;
                }
                let (a, b) = (self.nodes[node], self.nodes[other as usize]);
                if f64::from((a.z - b.z).abs()) > MAX_RISE_M {
                    continue;
                }
                let (from, to) = (self.center_of_cell(cell), self.center_of_cell(b.cell as usize));
                if (a.open && b.open) || self.ground.covers(from.extend(f64::from(a.z)), to.extend(f64::from(b.z))) {
                    self.nodes[node].steps |= 1 << step;
                    self.nodes[other as usize].steps |= 1 << (step + 4);
                }
            }
        }
    }

    /// Takes away the steps on which the widest body would touch an obstacle.
    fn part_by_obstacles(&mut self) {
        let reach = self.radius_m + self.cell_m;
        let footprints = std::mem::take(&mut self.obstruction.footprints);
        for footprint in &footprints {
            let low = ((footprint.center() - footprint.reach - reach - self.corner) / self.cell_m).floor();
            let high = ((footprint.center() + footprint.reach + reach - self.corner) / self.cell_m).floor();
            let low = low.max(DVec2::ZERO);
            let high = high.min(DVec2::new(self.numbering.columns as f64 - 1.0, self.numbering.rows as f64 - 1.0));
            if high.x < low.x || high.y < low.y {
                continue;
            }
            for row in low.y as usize..=high.y as usize {
                for column in low.x as usize..=high.x as usize {
                    let node = self.node_of_cell.get(self.numbering.cell(column, row));
                    if node != NO_NODE {
                        self.part_node(node as usize, footprint);
                    }
                }
            }
        }
        self.obstruction.footprints = footprints;
    }

    fn part_node(&mut self, node: usize, footprint: &crate::obstruction::Footprint) {
        let own = self.nodes[node];
        let center = self.center_of_cell(own.cell as usize);
        let (z_low, z_high) = (f64::from(own.z) - MAX_RISE_M, f64::from(own.z) + MAX_RISE_M);
        let far = footprint.distance_m(center, center);
        if far > self.radius_m + 1.5 * self.cell_m || !footprint.meets_body(z_low, z_high, self.height_m) {
            return;
        }
        // The farthest corner of the cell is at most 0.71 cells from its centre.
        if far < self.radius_m + 0.71 * self.cell_m {
            self.nodes[node].open = false;
        }
        for (step, &offset) in STEPS.iter().enumerate() {
            let Some(other) = self.neighbour(node as u32, step) else { continue };
            let to = center + self.cell_m * DVec2::new(offset.0 as f64, offset.1 as f64);
            if footprint.distance_m(center, to) < self.radius_m {
                self.nodes[node].steps &= !(1 << step);
                self.nodes[other as usize].steps &= !(1 << ((step + 4) % 8));
            }
        }
    }

    /// Numbers the connected pieces; a node without steps belongs to none.
    fn find_components(&mut self) {
        for seed in 0..self.nodes.len() {
            if self.nodes[seed].component != u32::MAX || self.nodes[seed].steps == 0 {
                continue;
            }
            let component = self.components.len() as u32;
            self.nodes[seed].component = component;
            let mut nodes = vec![seed as u32];
            let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
            let mut next = 0;
            while next < nodes.len() {
                let node = nodes[next];
                next += 1;
                (low, high) = (low.min(self.center(node)), high.max(self.center(node)));
                for step in 0..8 {
                    if let Some(other) = self.neighbour(node, step)
                        && self.nodes[other as usize].component == u32::MAX
                    {
                        self.nodes[other as usize].component = component;
                        nodes.push(other);
                    }
                }
            }
            nodes.sort_unstable();
            let weight = nodes.iter().map(|node| self.weight(*node)).sum();
            self.components.push(Component { nodes, extent_m: (high - low).length(), weight });
        }
    }

    /// Two-pass chamfer distance to the nearest node from which not every step is free.
    fn measure_edge_distance(&mut self) {
        let half = 0.5 * self.cell_m as f32;
        for node in &mut self.nodes {
            node.edge_distance_m = if node.steps == u8::MAX { f32::INFINITY } else { half };
        }
        // Steps 4..8 lead to nodes with smaller numbers, steps 0..4 to larger ones.
        let (earlier, later) = ([4, 5, 6, 7], [0, 1, 2, 3]);
        let count = self.nodes.len();
        for (order, steps) in [(false, earlier), (true, later)] {
            for i in 0..count {
                let node = if order { count - 1 - i } else { i };
                for step in steps {
                    if let Some(other) = self.neighbour(node as u32, step) {
                        let length = self.cell_m as f32 * if step % 2 == 0 { 1.0 } else { core::f32::consts::SQRT_2 };
                        let through = self.nodes[other as usize].edge_distance_m + length;
                        let own = &mut self.nodes[node].edge_distance_m;
                        *own = own.min(through);
                    }
                }
            }
        }
    }

    /// Height of the ground in space under a point of a walk.
    pub(crate) fn feet_at(&self, point: DVec2) -> (DVec3, Option<WalkableKind>) {
        let near = self.z_near(point).unwrap_or_default();
        match self.ground.at(point, near) {
            Some((kind, z)) => (point.extend(z), Some(kind)),
            None => (point.extend(near), None),
        }
    }
}

#[cfg(test)]
mod tests;
