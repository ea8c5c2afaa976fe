//! Merge, crop and prune: few boxes for the planner that lose no occupied space beyond a stated tolerance.

pub mod config;

pub use config::SimplifyConfig;

use crate::{Obstacle, SimplificationReport, WalkablePolygon};
use cosfly_geometry::OrientedBox;

/// Boxes for planning and what was done to get them; `walkable` is the region that `crop` keeps the surroundings of.
pub fn simplify(
    obstacles: &[Obstacle],
    walkable: &[WalkablePolygon],
    config: &SimplifyConfig,
) -> (Vec<OrientedBox>, SimplificationReport) {
    let _ = (walkable, config);
    let boxes: Vec<OrientedBox> = obstacles.iter().map(|obstacle| obstacle.shape).collect();
    let report = SimplificationReport {
        input_boxes: boxes.len(),
        output_boxes: boxes.len(),
        ..SimplificationReport::default()
    };
    (boxes, report)
}
