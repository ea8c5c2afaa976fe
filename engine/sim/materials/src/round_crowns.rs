//! Crowns and bushes that are boxes on top of each other, cut round: those of point clouds and of lists of boxes.
//!
//! Each box becomes turned squares that reach to its sides, with upper or lower ends drawn in towards its neighbours; a long
//! one becomes a row of them. What is drawn lies within the boxes. Crowns of boxes within each other are round as they are.

use crate::parts::{BOX_FACES, SceneBox};
use crate::pattern::draw;
use cosfly_domain::ObstacleKind;
use cosfly_frames::{DVec2, DVec3};
use std::collections::BTreeMap;

/// Boxes overlap by less in height where they lie on each other, metres.
const OVERLAP_M: f64 = 1e-3;
/// Length of each tree of a row, in widths of the row: crowns three times as long as wide are two trees, such bushes are
/// hedges, which stay.
const ROW: f64 = 2.0;
/// Most trees of a row, and how far each reaches over its share.
const MOST_IN_ROW: f64 = 8.0;
const IN_NEXT: f64 = 1.3;
/// Width of a crown's foot and of its top, as shares of the box there.
const ENDS: [f64; 2] = [0.6, 0.45];
/// Least and greatest share of a box that its end is drawn in to.
const DRAWN_IN: [f64; 2] = [0.45, 0.96];
/// Where the widest box of a crown is cut in two, share of its height.
const WAIST: f64 = 0.42;

/// A part of a box: its ends as shares of the box's height, and its width there as shares of the box's.
type Tier = ([f64; 2], [f64; 2]);

/// Cuts all crowns and bushes of boxes on top of each other.
pub fn round_crowns(boxes: &mut Vec<SceneBox>) {
    let mut plants: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (number, b) in boxes.iter().enumerate() {
        if matches!(b.kind, ObstacleKind::TreeCrown | ObstacleKind::Bush) {
            plants.entry(b.instance).or_default().push(number);
        }
    }
    let mut parts: BTreeMap<usize, Vec<SceneBox>> = BTreeMap::new();
    for plant in plants.values_mut() {
        plant.sort_by(|a, b| boxes[*a].center_in_world.z.total_cmp(&boxes[*b].center_in_world.z));
        let stack: Vec<&SceneBox> = plant.iter().map(|number| &boxes[*number]).collect();
        if is_stack(&stack) {
            let cut = tiers(&stack).into_iter().zip(&stack).map(|(tiers, b)| cut(b, &tiers));
            parts.extend(plant.iter().copied().zip(cut));
        }
    }
    if !parts.is_empty() {
        let all = std::mem::take(boxes).into_iter().enumerate();
        boxes.extend(all.flat_map(|(number, b)| parts.remove(&number).unwrap_or_else(|| vec![b])));
    }
}

/// Whether boxes from below to above lie on each other, and none is a hedge or a leaf of paper.
fn is_stack(stack: &[&SceneBox]) -> bool {
    let ends_m = |b: &SceneBox| [-1.0, 1.0].map(|side| b.center_in_world.z + side * b.half_bounds_m.z);
    let is_plant =
        |b: &&SceneBox| b.half_extents_m.min_element() > 0.05 && (b.kind != ObstacleKind::Bush || trees(b) == 1.0);
    stack.iter().all(is_plant) && stack.windows(2).all(|pair| ends_m(pair[1])[0] > ends_m(pair[0])[1] - OVERLAP_M)
}

/// Trees that stand in a row in a box.
fn trees(b: &SceneBox) -> f64 {
    let half = b.half_extents_m.truncate().as_dvec2();
    (half.max_element() / half.min_element() / ROW).round().clamp(1.0, MOST_IN_ROW)
}

/// The parts of each box of a stack: narrower from the widest one on.
fn tiers(stack: &[&SceneBox]) -> Vec<Vec<Tier>> {
    let width = |b: &SceneBox| f64::from(b.half_extents_m.x * b.half_extents_m.y).sqrt();
    let widest = (0..stack.len()).max_by(|a, b| width(stack[*a]).total_cmp(&width(stack[*b]))).unwrap_or(0);
    let towards = |own: usize, other: Option<usize>, end: f64| {
        let share = other.map_or(end, |other| 0.5 + 0.5 * width(stack[other]) / width(stack[own]));
        share.clamp(DRAWN_IN[0], DRAWN_IN[1])
    };
    let tier = |own: usize| {
        let foot = towards(own, own.checked_sub(1), ENDS[0]);
        let top = towards(own, Some(own + 1).filter(|above| *above < stack.len()), ENDS[1]);
        match own.cmp(&widest) {
            std::cmp::Ordering::Less => vec![([0.0, 1.0], [foot, 1.0])],
            std::cmp::Ordering::Equal => vec![([0.0, WAIST], [foot, 1.0]), ([WAIST, 1.0], [1.0, top])],
            std::cmp::Ordering::Greater => vec![([0.0, 1.0], [1.0, top])],
        }
    };
    (0..stack.len()).map(tier).collect()
}

/// Two turned squares for each part of each tree in a box.
fn cut(b: &SceneBox, tiers: &[Tier]) -> Vec<SceneBox> {
    let turn = 0.25 + 0.35 * f64::from(draw(b.instance, 30));
    let half = b.half_extents_m.as_dvec3();
    let (count, axis) = (trees(b), usize::from(half.y > half.x));
    let share = if count > 1.0 { IN_NEXT / count } else { 1.0 };
    let row = (0..count as u32).flat_map(|number| {
        let along = (1.0 - share) * if count > 1.0 { 2.0 * f64::from(number) / (count - 1.0) - 1.0 } else { 0.0 };
        let mut tree = b.clone();
        tree.center_in_world += along * half[axis] * b.axes_in_world[axis];
        tree.half_extents_m[axis] *= share as f32;
        tiers.iter().flat_map(move |tier| [turn, -turn].map(|turn| part(&tree, tier, turn))).collect::<Vec<_>>()
    });
    row.collect()
}

/// A part of a box whose corners lie `turn` half widths aside of the middles of its sides.
fn part(b: &SceneBox, ([low, high], widths): &Tier, turn: f64) -> SceneBox {
    let mut part = b.clone();
    let half = b.half_extents_m.as_dvec3();
    let z_m = [low, high].map(|share| b.center_in_world.z + (2.0 * share - 1.0) * b.half_bounds_m.z);
    let around = [[-1.0, -turn], [turn, -1.0], [-turn, 1.0], [1.0, turn]];
    for (number, corner) in part.corners_in_world.iter_mut().enumerate() {
        let place = widths[number / 4] * DVec2::from_array(around[number % 4]) * half.truncate();
        let aside = place.x * b.axes_in_world[0] + place.y * b.axes_in_world[1];
        *corner = (b.center_in_world + aside).with_z(z_m[number / 4]);
    }
    let corners = part.corners_in_world;
    let (least, most) = corners
        .iter()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(least, most), corner| (least.min(*corner), most.max(*corner)));
    (part.center_in_world, part.half_bounds_m) = (0.5 * (least + most), 0.5 * (most - least));
    part.half_extents_m.z = part.half_bounds_m.z as f32;
    part.axes_in_world = [[0, 1], [0, 2]].map(|[from, to]: [usize; 2]| (corners[to] - corners[from]).normalize());
    for (face, side) in part.sides_in_world.iter_mut().enumerate() {
        let [a, b, c, _] = BOX_FACES[face].2.map(|corner| corners[corner]);
        let normal = (b - a).cross(c - b).normalize();
        *side = normal * normal.dot(a - part.center_in_world).signum();
    }
    part
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parts::boxes_of;
    use cosfly_domain::{Obstacle, OrientedBox, Town};

    fn plant_of(kind: ObstacleKind, shapes: &[OrientedBox]) -> Vec<SceneBox> {
        let one = |shape: &OrientedBox| Obstacle { shape: *shape, kind, object_id: 5, synthetic: false };
        boxes_of(&Town { obstacles: shapes.iter().map(one).collect(), ..Town::default() }, 1)
    }

    fn layer(half: [f64; 2], [low_m, high_m]: [f64; 2]) -> OrientedBox {
        let center_in_world = DVec3::new(3.0, -2.0, 0.5 * (low_m + high_m));
        let half_extents_m = DVec3::new(half[0], half[1], 0.5 * (high_m - low_m));
        OrientedBox { center_in_world, half_extents_m, yaw_rad: 0.3 }
    }

    #[test]
    fn parts_of_a_stack_lie_within_its_boxes_and_reach_to_their_sides() {
        let stack = [layer([2.0, 1.5], [2.0, 4.0]), layer([4.0, 3.0], [4.0, 7.0]), layer([1.0, 4.0], [7.0, 9.0])];
        let mut boxes = plant_of(ObstacleKind::TreeCrown, &stack);
        round_crowns(&mut boxes);
        assert_eq!(boxes.len(), 10);
        for (shape, parts) in stack.iter().zip([&boxes[..2], &boxes[2..6], &boxes[6..]]) {
            let mut reach = DVec3::ZERO;
            for part in parts {
                for corner in part.corners_in_world {
                    let own = DVec2::from_angle(-0.3).rotate((corner - shape.center_in_world).truncate());
                    let off = own.extend(corner.z - shape.center_in_world.z).abs();
                    assert!((off - shape.half_extents_m).max_element() < 1e-6, "{corner} stands out");
                    reach = reach.max(off);
                }
                for (face, (_, _, around)) in BOX_FACES.iter().enumerate() {
                    let [from, normal] = [part.corners_in_world[around[0]], part.normal_in_world(face)];
                    let off = around.map(|corner| (part.corners_in_world[corner] - from).dot(normal).abs());
                    assert!(off.into_iter().all(|off_m| off_m < 1e-9), "{face}: {off:?}");
                    assert!(normal.dot(from - part.center_in_world) > 0.0, "{face} looks inwards");
                }
            }
            assert!((reach - shape.half_extents_m).abs().max_element() < 1e-6, "{reach}");
        }
    }

    #[test]
    fn hedges_and_boxes_within_each_other_stay() {
        for (kind, shapes) in [
            (ObstacleKind::Bush, vec![layer([6.0, 0.5], [0.0, 1.5])]),
            (ObstacleKind::TreeCrown, vec![layer([2.0, 2.0], [2.0, 8.0]), layer([3.0, 3.0], [3.0, 6.0])]),
        ] {
            let mut boxes = plant_of(kind, &shapes);
            round_crowns(&mut boxes);
            assert_eq!(boxes.len(), shapes.len());
        }
    }
}
