//! The voxels around a moving target, layer by layer in time, and what they cost before any ray is cast.

use super::moving_layers::MovingLayers;
use super::sight::StaticSight;
use crate::config::muco::MucoConfig;
use crate::error::PlanError;
use crate::problem::Problem;
use crate::terms::place::PlaceCosts;
use crate::terms::{length, viewpoint};
use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec3, TargetState};
use cosfly_surroundings::ground::GroundGrid;
use cosfly_surroundings::local::LocalObstacles;
use cosfly_surroundings::visibility::{BODY_POINTS, body_points};

/// Time between layers that one move of a voxel fits, seconds (the paper's time step).
const LAYER_S: f64 = 0.5;
/// Largest number of (voxel, layer) pairs: 16 bytes each, touched only where the search goes.
const MAX_NODES: usize = 1 << 26;
/// Moves per layer: stay, or one voxel along each axis.
pub const MOVES: usize = 27;

/// Size of voxels, and price of motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoxelOptions {
    /// Edge of a voxel, metres.
    pub voxel_m: f64,
    /// Cost of a metre flown, on top of the length term: what stands in for smoothness, which a search over
    /// positions cannot see.
    pub motion_per_m: f64,
}

impl Default for VoxelOptions {
    fn default() -> Self {
        Self { voxel_m: 2.0, motion_per_m: 1.0 }
    }
}

/// A place in the grid: layer and voxel counted from the layer's window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    /// Index of the layer.
    pub layer: usize,
    /// Voxel in the window: x, y, z.
    pub at: [i32; 3],
}

/// One layer: a frame of the track and the window of voxels around its target.
pub struct Layer {
    /// The frame that the layer looks at.
    pub frame: usize,
    /// Frames that the layer stands for.
    pub frames: f64,
    /// Lowest voxel of the window.
    pub low: [i32; 3],
    /// Body points to be seen.
    pub body: [DVec3; BODY_POINTS],
}

/// Voxels x layers.
pub struct VoxelGrid<'a> {
    problem: &'a Problem<'a>,
    ground: &'a GroundGrid,
    costs: PlaceCosts<'a>,
    clearance_m: f64,
    options: VoxelOptions,
    origin: DVec3,
    /// Voxels per window along x, y and z.
    pub size: [i32; 3],
    /// In time.
    pub layers: Vec<Layer>,
    /// Cost of each move.
    pub move_cost: [f32; MOVES],
    /// Length of each move, metres.
    pub move_m: [f64; MOVES],
    /// Boxes that move.
    pub moving: MovingLayers,
}

impl<'a> VoxelGrid<'a> {
    /// The grid over the band of altitudes and radii of `config.view`; refused when it would be too large.
    pub fn new(
        problem: &'a Problem<'a>,
        ground: &'a GroundGrid,
        config: &MucoConfig,
        options: VoxelOptions,
    ) -> Result<Self, PlanError> {
        let (track, view, weights) = (problem.track, problem.view, config.resolved_weights());
        let Some(first) = track.states.first() else {
            return Err(PlanError::Request("the target track has no frame".to_owned()));
        };
        let origin = DVec3::new(0.0, 0.0, first.feet_in_world.z + view.min_altitude_m);
        let reach = (view.max_radius_m / options.voxel_m).ceil() as i32;
        let levels = ((view.max_altitude_m - view.min_altitude_m) / options.voxel_m).floor() as i32 + 1;
        let size = [2 * reach + 1, 2 * reach + 1, levels];
        let stride = ((LAYER_S / track.dt_s).round() as usize).max(1);
        let layer = |frame: usize| {
            let state = &track.states[frame];
            let at = (state.feet_in_world + DVec3::new(0.0, 0.0, view.min_altitude_m) - origin) / options.voxel_m;
            let low = [at.x.round() as i32 - reach, at.y.round() as i32 - reach, (at.z - 0.5).ceil() as i32];
            let frames = (track.len() - frame).min(stride) as f64;
            Layer { frame, frames, low, body: body_points(state, track.height_m) }
        };
        let layers: Vec<Layer> = (0..track.len()).step_by(stride).map(layer).collect();
        let nodes = layers.len() as f64 * f64::from(size[0]) * f64::from(size[1]) * f64::from(size[2]);
        if nodes > MAX_NODES as f64 {
            return Err(PlanError::Request(format!(
                "a voxel search would need {nodes:.0} nodes; at most {MAX_NODES} are searched"
            )));
        }
        let move_m: [f64; MOVES] = core::array::from_fn(|m| {
            options.voxel_m * f64::from(move_step(m).iter().map(|step| step * step).sum::<i32>()).sqrt()
        });
        let per_m = options.motion_per_m + length::COST_PER_M * weights.length;
        let move_cost = move_m.map(|length_m| (per_m * length_m) as f32);
        let clearance_m = config.limits.clearance_m;
        let costs = PlaceCosts { weights, view };
        let moving = MovingLayers::default();
        Ok(Self { problem, ground, costs, clearance_m, options, origin, size, layers, move_cost, move_m, moving })
    }

    /// This grid among boxes that move.
    pub fn among(mut self, movers: &[Vec<OrientedBox>], config: &MucoConfig) -> Self {
        let (view, influence_m) = (self.problem.view, config.view.safety_influence_m);
        let obstacles =
            LocalObstacles::filter(self.problem.track, &[], self.ground, config.search.filter_radius_m, influence_m)
                .with_movers(movers);
        let band = (view.min_altitude_m - 0.5 * self.options.voxel_m, view.max_radius_m);
        let frames: Vec<usize> = self.layers.iter().map(|layer| layer.frame).collect();
        self.moving = MovingLayers::new(&obstacles, &frames, band, influence_m.max(self.clearance_m));
        self
    }

    /// Number of the target's points that are seen from a cell.
    pub fn visible_points(&self, cell: Cell, sight: &impl StaticSight) -> usize {
        let (camera, body) = (self.position(cell), &self.layers[cell.layer].body);
        let mut hidden = [false; BODY_POINTS];
        sight.hide(camera, body, &mut hidden);
        self.moving.hide(cell.layer, camera, body, &mut hidden);
        hidden.iter().filter(|&&hidden| !hidden).count()
    }

    /// Voxels of one layer.
    pub fn cells_per_layer(&self) -> usize {
        self.size.iter().map(|&count| count as usize).product()
    }

    /// All (voxel, layer) pairs.
    pub fn nodes(&self) -> usize {
        self.cells_per_layer() * self.layers.len()
    }

    /// Index of a cell among all nodes.
    #[inline]
    pub fn node_of(&self, cell: Cell) -> usize {
        let [x, y, z] = cell.at.map(|index| index as usize);
        let [sx, sy, _] = self.size.map(|count| count as usize);
        cell.layer * self.cells_per_layer() + (z * sy + y) * sx + x
    }

    /// The cell of a node.
    #[inline]
    pub fn cell_of(&self, node: usize) -> Cell {
        let (layer, rest) = (node / self.cells_per_layer(), node % self.cells_per_layer());
        let [sx, sy, _] = self.size.map(|count| count as usize);
        Cell { layer, at: [(rest % sx) as i32, (rest / sx % sy) as i32, (rest / (sx * sy)) as i32] }
    }

    /// Middle of a cell, world frame, metres.
    #[inline]
    pub fn position(&self, cell: Cell) -> DVec3 {
        let low = self.layers[cell.layer].low;
        let [x, y, z] = core::array::from_fn(|k| f64::from(low[k] + cell.at[k]));
        self.origin + self.options.voxel_m * DVec3::new(x, y, z)
    }

    /// The cell of the next layer that move `m` leads to, if it is in its window.
    #[inline]
    pub fn moved(&self, cell: Cell, m: usize) -> Option<Cell> {
        let (here, next) = (&self.layers[cell.layer], self.layers.get(cell.layer + 1)?);
        let step = move_step(m);
        let at = core::array::from_fn(|k| cell.at[k] + step[k] + here.low[k] - next.low[k]);
        (0..3).all(|k| at[k] >= 0 && at[k] < self.size[k]).then_some(Cell { layer: cell.layer + 1, at })
    }

    /// The cell of the layer before from which move `m` leads here.
    pub fn came_from(&self, cell: Cell, m: usize) -> Cell {
        let (here, before) = (&self.layers[cell.layer], &self.layers[cell.layer - 1]);
        let step = move_step(m);
        Cell { layer: cell.layer - 1, at: core::array::from_fn(|k| cell.at[k] - step[k] + here.low[k] - before.low[k]) }
    }

    /// The terms that need no obstacle (tracking, pitch, viewpoint, altitude), weighted; `None` outside the band.
    pub fn bare_cost(&self, cell: Cell) -> Option<f32> {
        let layer = &self.layers[cell.layer];
        let state: &TargetState = &self.problem.track.states[layer.frame];
        let view = self.problem.view;
        let position = self.position(cell);
        let sight = position - state.feet_in_world;
        let across = sight.truncate().length();
        let over_ground = position.z - self.ground.z_m(position.x, position.y);
        let half = 0.5 * self.options.voxel_m;
        let inside = across >= view.min_radius_m - half && across <= view.max_radius_m;
        if !inside || over_ground < self.clearance_m || sight.z > view.max_altitude_m + half {
            return None;
        }
        let walk = self.problem.walk;
        let cosine = sight.truncate().dot(walk.direction[layer.frame]) / across.max(1e-9);
        let front = self.costs.weights.viewpoint * viewpoint::front_cost(cosine) * walk.directness[layer.frame];
        let cost = self.costs.sight(sight) + front + self.costs.altitude(sight.z, sight.z.min(over_ground));
        Some((layer.frames * cost) as f32)
    }

    /// The safety term at a distance from obstacles, and the visibility term, weighted.
    pub fn obstacle_cost(&self, layer: usize, distance_m: f64, visible_points: usize) -> f32 {
        let hidden = 1.0 - visible_points as f64 / BODY_POINTS as f64;
        let cost = self.costs.safety(distance_m) + self.costs.weights.visibility * hidden * hidden;
        (self.layers[layer].frames * cost) as f32
    }

    /// One waypoint per frame: the cells' middles, straight between layers, resting after the last.
    pub fn waypoints(&self, cells: &[Cell]) -> Vec<DVec3> {
        let corners: Vec<DVec3> = cells.iter().map(|&cell| self.position(cell)).collect();
        let mut waypoints = Vec::with_capacity(self.problem.track.len());
        for (i, layer) in self.layers.iter().enumerate() {
            let end = self.layers.get(i + 1).map_or(self.problem.track.len(), |next| next.frame);
            let to = corners.get(i + 1).copied().unwrap_or(corners[i]);
            let share = |frame: usize| (frame - layer.frame) as f64 / (end - layer.frame) as f64;
            waypoints.extend((layer.frame..end).map(|frame| corners[i].lerp(to, share(frame))));
        }
        waypoints
    }
}

/// Voxels along x, y and z of move `m`.
#[inline]
pub fn move_step(m: usize) -> [i32; 3] {
    let m = m as i32;
    [m % 3 - 1, m / 3 % 3 - 1, m / 9 - 1]
}
