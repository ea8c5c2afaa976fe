//! Trees and stands of plants as obstacles.

use super::document::Attributes;
use super::faces::Face;
use super::layers::{Steps, layered, pieces};
use super::shapes::{Shape, Space};
use cosfly_domain::{ObstacleKind, OrientedBox};
use cosfly_frames::DVec3;
use cosfly_town::crown::crown_boxes;
use cosfly_town::solids::SolidBoxes;
use serde_json::Value;

/// Steps of stands of plants.
const STAND: Steps = Steps { height_m: 3.0, most_of_foot: 4, most_of_layer: 3 };
/// Side of the squares in which they are cut, metres.
const PIECE_M: f64 = 12.0;
/// Faces of a stand this far above its lowest corner are ground, metres.
pub(super) const GROUND_RISE_M: f64 = 1.0;
/// Stands up to this height are bushes, metres; people walk under higher ones.
const BUSH_M: f64 = 3.0;
/// Height of the lowest branches of higher stands, metres.
const BRANCHES_M: f64 = 2.0;
/// Height of a tree of which the file gives the place only, metres.
const USUAL_TREE_M: f64 = 8.0;
/// Lowest and highest tree, thinnest and widest crown by its radius, metres: the highest known tree has 116 m.
const HEIGHTS_M: [f64; 2] = [0.5, 120.0];
const RADII_M: [f64; 2] = [0.2, 20.0];

/// A tree as boxes.
pub(super) struct Tree<'a> {
    /// Trunk and crown.
    pub(super) boxes: Vec<(ObstacleKind, OrientedBox)>,
    /// Whether its size is assumed: the file gives its place only.
    pub(super) is_assumed: bool,
    /// Whether the file gives it a size that no tree has.
    pub(super) is_absurd: bool,
    /// Attributes that are asked for and no number above 0, by name.
    pub(super) unread: Vec<(&'static str, Option<&'a Value>)>,
}

/// Trunk and crown of a tree.
pub(super) fn tree<'a>(
    shape: &Shape,
    attributes: Option<&'a Attributes>,
    space: &Space,
    object_id: u32,
) -> Option<Tree<'a>> {
    let (low, high) = shape.bounds()?;
    let size = high - low;
    let mut is_absurd = false;
    let mut believed = |stated_m: f64, [least, most]: [f64; 2]| {
        let is_believed = (least..=most).contains(&stated_m);
        is_absurd |= !is_believed;
        is_believed.then_some(stated_m)
    };
    let (is_drawn_high, seen_m) = (size.z >= 0.5, 0.25 * (size.x + size.y));
    let stated_m = attributes.and_then(Attributes::height).map(|height| space.length_m(height));
    let is_assumed = !is_drawn_high && stated_m.is_none();
    let mut unread: Vec<_> = attributes.filter(|_| is_assumed).into_iter().flat_map(Attributes::heights).collect();
    let height_m = if is_drawn_high {
        believed(size.z, HEIGHTS_M).unwrap_or(HEIGHTS_M[1])
    } else {
        stated_m.and_then(|stated_m| believed(stated_m, HEIGHTS_M)).unwrap_or(USUAL_TREE_M)
    };
    let radius_m = if seen_m > 0.2 {
        believed(seen_m, RADII_M).unwrap_or(RADII_M[1])
    } else {
        let stated_m = attributes.and_then(Attributes::crown_diameter).map(|diameter| 0.5 * space.length_m(diameter));
        let crowns = attributes.filter(|_| stated_m.is_none()).map(Attributes::other_numbers);
        unread.extend(crowns.map(|[_, crown]| crown));
        stated_m.and_then(|stated_m| believed(stated_m, RADII_M)).unwrap_or((0.2 * height_m).clamp(1.0, 4.5))
    };
    let foot = (0.5 * (low + high)).with_z(low.z);
    let base_m = 0.35 * height_m;
    let upright = |foot: DVec3, half_m: f64, height_m: f64| OrientedBox {
        center_in_world: foot + 0.5 * height_m * DVec3::Z,
        half_extents_m: DVec3::new(half_m, half_m, 0.5 * height_m),
        yaw_rad: 0.0,
    };
    let trunk = upright(foot, (0.015 * height_m).clamp(0.08, 0.4), base_m);
    let crown = upright(foot + base_m * DVec3::Z, radius_m, height_m - base_m);
    let crowns = crown_boxes(&crown, object_id).map(|shape| (ObstacleKind::TreeCrown, shape));
    let boxes = core::iter::once((ObstacleKind::TreeTrunk, trunk)).chain(crowns).collect();
    Some(Tree { boxes, is_assumed, is_absurd, unread })
}

/// Boxes under faces that rise from the ground; [`of_height`] makes plants of them.
pub(super) fn stand(faces: &[Face], base_m: f64) -> Vec<SolidBoxes> {
    let upper: Vec<Face> = faces.iter().filter(|face| face.highest_m() > base_m + GROUND_RISE_M).cloned().collect();
    pieces(&upper, PIECE_M).into_iter().map(|piece| layered(&[], &piece, base_m, STAND)).collect()
}

/// A bush, or the part of a box above the lowest branches; `None` where next to nothing is left of it.
pub(super) fn of_height(shape: OrientedBox, base_m: f64) -> Option<(ObstacleKind, OrientedBox)> {
    let (foot_m, top_m) =
        (shape.center_in_world.z - shape.half_extents_m.z, shape.center_in_world.z + shape.half_extents_m.z);
    let is_bush = top_m <= base_m + BUSH_M;
    let foot_m = if is_bush { foot_m } else { foot_m.max(base_m + BRANCHES_M) };
    let half_height_m = 0.5 * (top_m - foot_m);
    let cut = OrientedBox {
        center_in_world: shape.center_in_world.with_z(foot_m + half_height_m),
        half_extents_m: shape.half_extents_m.with_z(half_height_m),
        ..shape
    };
    let kind = if is_bush { ObstacleKind::Bush } else { ObstacleKind::TreeCrown };
    (half_height_m > 0.05 && top_m > base_m + 0.3).then_some((kind, cut))
}
