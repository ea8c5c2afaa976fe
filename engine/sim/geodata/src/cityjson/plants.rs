//! Trees and stands of plants as obstacles.

use super::document::Attributes;
use super::faces::Face;
use super::layers::{Steps, layered, pieces};
use super::shapes::{Shape, Space};
use cosfly_domain::{ObstacleKind, OrientedBox};
use cosfly_frames::{DVec2, DVec3, real};
use cosfly_town::crown::crown_boxes;
use cosfly_town::solids::SolidBoxes;
use serde_json::Value;
use std::collections::BTreeMap;

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
/// Boxes of higher stands that are narrower are parts of single trees, metres.
const SLENDER_M: f64 = 3.0;
/// Radius of a crown as a share of the tree's height; thinnest and widest, metres.
const CROWN_SHARE: f64 = 0.25;
const CROWN_RADII_M: [f64; 2] = [0.8, 4.0];
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
    let trunk = trunk(foot, height_m, base_m);
    let crown = upright(foot + base_m * DVec3::Z, radius_m, height_m - base_m);
    let crowns = crown_boxes(&crown, object_id).map(|shape| (ObstacleKind::TreeCrown, shape));
    let boxes = core::iter::once((ObstacleKind::TreeTrunk, trunk)).chain(crowns).collect();
    Some(Tree { boxes, is_assumed, is_absurd, unread })
}

/// A square box that stands on a place.
fn upright(foot: DVec3, half_m: f64, height_m: f64) -> OrientedBox {
    OrientedBox {
        center_in_world: foot + 0.5 * height_m * DVec3::Z,
        half_extents_m: DVec3::new(half_m, half_m, 0.5 * height_m),
        yaw_rad: 0.0,
    }
}

/// The trunk of a tree of a height, up to its lowest branches, metres.
fn trunk(foot: DVec3, height_m: f64, branches_m: f64) -> OrientedBox {
    upright(foot, (0.015 * height_m).clamp(0.08, 0.4), branches_m)
}

/// Boxes under faces that rise from the ground; [`grown`] makes plants of them.
pub(super) fn stand(faces: &[Face], base_m: f64) -> Vec<SolidBoxes> {
    let upper: Vec<Face> = faces.iter().filter(|face| face.highest_m() > base_m + GROUND_RISE_M).cloned().collect();
    pieces(&upper, PIECE_M).into_iter().map(|piece| layered(&[], &piece, base_m, STAND)).collect()
}

/// Bushes, and trees under what is higher: slender boxes that stand together are the crown of one tree, whose trunk stands under its highest
/// place; wide ones are the roof of a wood. Every box is held by what is made of it, from the lowest branches up.
pub(super) fn grown(boxes: Vec<OrientedBox>, base_m: f64) -> Vec<(ObstacleKind, OrientedBox)> {
    let (mut grown, mut slender) = (vec![], vec![]);
    for (kind, shape) in boxes.into_iter().filter_map(|shape| of_height(shape, base_m)) {
        let is_slender = shape.half_extents_m.x.min(shape.half_extents_m.y) < 0.5 * SLENDER_M;
        if kind == ObstacleKind::TreeCrown && is_slender {
            slender.extend(short_pieces(shape));
        } else {
            grown.push((kind, shape));
        }
    }
    // The highest ones first; of those, the first.
    slender.sort_by(|a, b| top_m(b).total_cmp(&top_m(a)));
    let cell = |at: DVec3| [at.x, at.y].map(|at| (at / CROWN_RADII_M[1]).floor() as i64);
    let mut left: BTreeMap<[i64; 2], Vec<usize>> = BTreeMap::new();
    for (number, shape) in slender.iter().enumerate() {
        left.entry(cell(shape.center_in_world)).or_default().push(number);
    }
    let mut is_taken = vec![false; slender.len()];
    for number in 0..slender.len() {
        if is_taken[number] {
            continue;
        }
        let peak = slender[number];
        let height_m = top_m(&peak) - base_m;
        let radius_m = (CROWN_SHARE * height_m).clamp(CROWN_RADII_M[0], CROWN_RADII_M[1]);
        let [column, row] = cell(peak.center_in_world);
        let around = |at: i64| at.saturating_sub(1)..=at.saturating_add(1);
        let cells = around(column).flat_map(|column| around(row).map(move |row| [column, row]));
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for near in cells.filter_map(|cell| left.get(&cell)).flatten().copied() {
            let shape = &slender[near];
            let apart = (shape.center_in_world - peak.center_in_world).truncate();
            if !is_taken[near] && apart.length() <= radius_m {
                is_taken[near] = true;
                let bounds = shape.bounds_in_world();
                (low, high) = (low.min(bounds.0.truncate()), high.max(bounds.1.truncate()));
            }
        }
        let (middle, half) = (0.5 * (low + high), (0.5 * (high - low)).max(DVec2::splat(CROWN_RADII_M[0])));
        let branches_m = BRANCHES_M.min(0.5 * height_m);
        let (foot_m, top_m) = (base_m + branches_m, base_m + height_m);
        let crown = OrientedBox::from_corners((middle - half).extend(foot_m), (middle + half).extend(top_m));
        let trunk = trunk(peak.center_in_world.with_z(base_m), height_m, branches_m);
        grown.extend([(ObstacleKind::TreeTrunk, trunk), (ObstacleKind::TreeCrown, crown)]);
    }
    grown
}

/// Height of the upper side.
fn top_m(shape: &OrientedBox) -> f64 {
    shape.center_in_world.z + shape.half_extents_m.z
}

/// A box cut across its longer side into pieces that are no longer than slender boxes are wide.
fn short_pieces(shape: OrientedBox) -> impl Iterator<Item = OrientedBox> {
    let DVec3 { x, y, .. } = shape.half_extents_m;
    let count = (2.0 * x.max(y) / SLENDER_M).ceil().clamp(1.0, 64.0);
    let (sin, cos) = real::sin_cos(shape.yaw_rad);
    let (along, half) = if x >= y {
        (DVec3::new(cos, sin, 0.0) * x, shape.half_extents_m.with_x(x / count))
    } else {
        (DVec3::new(-sin, cos, 0.0) * y, shape.half_extents_m.with_y(y / count))
    };
    (0..count as usize).map(move |piece| OrientedBox {
        center_in_world: shape.center_in_world + along * ((2.0 * piece as f64 + 1.0) / count - 1.0),
        half_extents_m: half,
        ..shape
    })
}

/// A bush, or the part of a box above the lowest branches; `None` where next to nothing is left of it.
fn of_height(shape: OrientedBox, base_m: f64) -> Option<(ObstacleKind, OrientedBox)> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::Seed;

    #[test]
    fn what_grows_holds_every_box_of_its_stand_and_crowns_stand_on_trunks() {
        let mut random = Seed([3; 32]).stream("boxes");
        let mut draw = |low: f64, high: f64| random.uniform(low, high);
        let boxes: Vec<OrientedBox> = (0..300)
            .map(|_| {
                let half_extents_m = DVec3::new(draw(0.1, 3.0), draw(0.1, 6.0), draw(0.2, 7.0));
                let foot = DVec3::new(draw(-20.0, 20.0), draw(-20.0, 20.0), draw(5.0, 6.0));
                OrientedBox {
                    center_in_world: foot + DVec3::Z * half_extents_m.z,
                    half_extents_m,
                    yaw_rad: draw(-3.0, 3.0),
                }
            })
            .collect();
        let grown = grown(boxes.clone(), 5.0);
        assert_eq!(grown, super::grown(boxes.clone(), 5.0));
        let holds = |shape: &OrientedBox, point: DVec3| {
            let (sin, cos) = real::sin_cos(shape.yaw_rad);
            let from = point - shape.center_in_world;
            let inside = DVec3::new(from.x * cos + from.y * sin, from.y * cos - from.x * sin, from.z).abs();
            inside.cmple(shape.half_extents_m + 1e-9).all()
        };
        for (_, cut) in boxes.iter().filter_map(|shape| of_height(*shape, 5.0)) {
            let (sin, cos) = real::sin_cos(cut.yaw_rad);
            for step in 0..125 {
                let share = [1, 5, 25].map(|of| f64::from(step / of % 5) / 2.0 - 1.0);
                let at = DVec3::from_array(share) * cut.half_extents_m;
                let turned = DVec3::new(at.x * cos - at.y * sin, at.x * sin + at.y * cos, at.z);
                let point = cut.center_in_world + turned;
                assert!(grown.iter().any(|(_, shape)| holds(shape, point)), "{cut:?} at {point}");
            }
        }
        let trees: Vec<_> = grown.windows(2).filter(|pair| pair[0].0 == ObstacleKind::TreeTrunk).collect();
        assert!(trees.len() > 10 && trees.len() < 200, "{}", trees.len());
        for pair in trees {
            let (trunk, crown) = (&pair[0].1, &pair[1].1);
            assert!((top_m(trunk) - (crown.center_in_world.z - crown.half_extents_m.z)).abs() < 1e-9);
            assert!(holds(crown, trunk.center_in_world.with_z(crown.center_in_world.z)));
        }
    }
}
