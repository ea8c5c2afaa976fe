//! The shapes that pictures show of boxes: slanted walls, slopes of pitched roofs, round crowns, furniture, containers and boats.

use crate::furniture::furnish;
use crate::ground_kinds::GroundKinds;
use crate::parts::SceneBox;
use crate::roof_slopes::cut_to_slopes;
use crate::round_crowns::round_crowns;
use crate::wall_slants::cut_slanted_walls;

/// Cuts boxes to what is drawn of them on the ground of their town.
pub fn cut_to_drawn(boxes: &mut Vec<SceneBox>, ground: &GroundKinds) {
    cut_slanted_walls(boxes);
    cut_to_slopes(boxes);
    round_crowns(boxes);
    furnish(boxes, ground);
}
