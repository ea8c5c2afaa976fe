//! Input and output of a baseline.

use crate::config::muco::MucoConfig;
use crate::problem::Problem;
use cosfly_domain::OrientedBox;
use cosfly_frames::DVec3;
use cosfly_geometry::SpatialQuery;
use cosfly_surroundings::ground::GroundGrid;

/// Problem, map and limits.
#[derive(Clone, Copy)]
pub struct BaselineInput<'a> {
    /// Target, wishes, cost.
    pub problem: &'a Problem<'a>,
    /// Boxes to avoid and look past; the same that the planner gets.
    pub planning_boxes: &'a [OrientedBox],
    /// All unsimplified boxes.
    pub exact: &'a dyn SpatialQuery,
    /// Boxes that move, frame by frame; see [`crate::PlanRequest::movers`].
    pub movers: &'a [Vec<OrientedBox>],
    /// Ground heights.
    pub ground: &'a GroundGrid,
    /// Limits, view, weights.
    pub config: &'a MucoConfig,
}

/// A path, before it is judged.
#[derive(Clone, Debug, PartialEq)]
pub struct BaselinePath {
    /// One waypoint per frame, world frame, metres.
    pub waypoints: Vec<DVec3>,
    /// Nodes that were expanded; 0 where the search has none.
    pub nodes_expanded: u64,
    /// The cost that the search itself minimised.
    pub cost: f64,
}
