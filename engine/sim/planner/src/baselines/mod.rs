//! Planners to be measured against: the paper's 4-D A*, the same made flyable, a beam search, the lattice alone.
//!
//! All take what the planner itself takes and give a path; the certificate judges them like any other flight.
//!
//! * [`astar`]: voxels of 2 m x timesteps, visibility and the static terms as costs, safety as a hard
//!   constraint. Once with a textbook tree ([`plain_bvh`]), once with the engine's own queries.
//! * [`flyable`]: the A* path smoothed to the limits by the same programme in the same corridor as ours.
//! * [`beam`]: one layer at a time with a bounded number of survivors.
//! * [`lattice_path`]: the path of the polar lattice with nothing after it.

pub mod astar;
pub mod beam;
pub mod clearance_cache;
pub mod flyable;
pub mod grid;
pub mod lattice_path;
pub mod plain_bvh;
pub mod queue;
pub mod sight;

use crate::config::MucoConfig;
use crate::muco::track_check::check_track;
use crate::obstacles::ground::GroundGrid;
use crate::problem::Problem;
use cosfly_frames::{DVec2, DVec3, TargetTrack};
use cosfly_geometry::{BoxBvh, OrientedBox, SpatialQuery};
use grid::{VoxelGrid, VoxelOptions};
use plain_bvh::PlainBvh;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which planner to measure against.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Baseline {
    /// The paper's A* over voxels of 2 m and timesteps, its rays cast through a textbook BVH.
    Astar,
    /// The same search with the engine's own ray and distance queries.
    AstarFast,
    /// Its path, made flyable: smoothed to the limits of speed, acceleration and jerk.
    AstarSmoothed,
    /// Layered beam search over the same voxels, in the manner of Track A*.
    Beam,
    /// The way through the polar lattice, with nothing after it.
    Dp,
}

impl Baseline {
    /// All, in the order of tables.
    pub const ALL: [Self; 5] = [Self::Astar, Self::AstarFast, Self::AstarSmoothed, Self::Beam, Self::Dp];

    /// Whether its flights are made to hold limits of speed, acceleration and jerk.
    pub fn bounds_kinematics(self) -> bool {
        self == Self::AstarSmoothed
    }

    /// Name in tables and on command lines.
    pub fn name(self) -> &'static str {
        match self {
            Self::Astar => "astar",
            Self::AstarFast => "astar_fast",
            Self::AstarSmoothed => "astar_smoothed",
            Self::Beam => "beam",
            Self::Dp => "dp",
        }
    }
}

/// What a baseline found.
#[derive(Clone, Debug, PartialEq)]
pub struct BaselinePath {
    /// One per frame, world frame, metres.
    pub waypoints: Vec<DVec3>,
    /// Nodes that were expanded; 0 where the search has none.
    pub nodes_expanded: u64,
    /// The cost that the search itself minimised.
    pub cost: f64,
}

/// What a baseline is given.
#[derive(Clone, Copy)]
pub struct BaselineInput<'a> {
    /// Target, wishes, cost.
    pub problem: &'a Problem<'a>,
    /// Boxes to avoid and look past; the same that the planner gets.
    pub planning_boxes: &'a [OrientedBox],
    /// All unsimplified boxes.
    pub exact: &'a dyn SpatialQuery,
    /// Ground heights.
    pub ground: &'a GroundGrid,
    /// Limits, view, weights.
    pub config: &'a MucoConfig,
}

/// Plans with a baseline: one waypoint per frame, or in words why there is none.
pub fn plan_baseline(kind: Baseline, input: &BaselineInput<'_>) -> Result<BaselinePath, String> {
    plan_baseline_with(kind, input, VoxelOptions::default())
}

/// [`plan_baseline`] with other voxels.
pub fn plan_baseline_with(
    kind: Baseline,
    input: &BaselineInput<'_>,
    options: VoxelOptions,
) -> Result<BaselinePath, String> {
    input.config.validate().map_err(|(_, rule)| rule)?;
    check_track(input.problem.track, input.config.limits.speed_mps)?;
    let (keep_m, influence_m) = (input.config.limits.clearance_m, input.config.view.safety_influence_m);
    let grid = || VoxelGrid::new(input.problem, input.ground, input.config, options);
    let near = || near_track(input.problem.track, input.planning_boxes, input.config.search.filter_radius_m);
    match kind {
        Baseline::Astar => astar::astar(&grid()?, &PlainBvh::build(&near()), keep_m, influence_m),
        Baseline::AstarFast => astar::astar(&grid()?, &BoxBvh::build(near()), keep_m, influence_m),
        Baseline::AstarSmoothed => {
            let found = astar::astar(&grid()?, &BoxBvh::build(near()), keep_m, influence_m)?;
            Ok(flyable::made_flyable(input, found))
        }
        Baseline::Beam => beam::beam(&grid()?, &BoxBvh::build(near()), keep_m, influence_m, beam::WIDTH),
        Baseline::Dp => lattice_path::lattice_path(input),
    }
}

/// The boxes within `radius_m` (from above) of the track (paper, section 3.3: per-path obstacle filtering).
fn near_track(track: &TargetTrack, boxes: &[OrientedBox], radius_m: f64) -> Vec<OrientedBox> {
    // Runs of frames, so that a box far from the whole run is settled at once.
    let runs: Vec<(DVec2, DVec2, &[_])> = track
        .states
        .chunks(16)
        .map(|run| {
            let feet = || run.iter().map(|state| state.feet_in_world.truncate());
            let low = feet().fold(DVec2::INFINITY, DVec2::min);
            (low, feet().fold(DVec2::NEG_INFINITY, DVec2::max), run)
        })
        .collect();
    let gap = |low: DVec2, high: DVec2, other_low: DVec2, other_high: DVec2| {
        (low - other_high).max(other_low - high).max(DVec2::ZERO).length_squared()
    };
    let near = |shape: &&OrientedBox| {
        let (min, max) = shape.bounds_in_world();
        let (min, max) = (min.truncate(), max.truncate());
        runs.iter().any(|&(low, high, run)| {
            gap(min, max, low, high) <= radius_m * radius_m
                && run.iter().any(|state| {
                    let feet = state.feet_in_world.truncate();
                    gap(min, max, feet, feet) <= radius_m * radius_m
                })
        })
    };
    boxes.iter().filter(near).copied().collect()
}

#[cfg(test)]
mod law;
