//! Slanted walls that boxes follow in steps, cut to straight walls within the boxes.
//!
//! Where a box stands out over its neighbour on one side, and the neighbour on the other side reaches as far or farther, the corner that
//! stands out moves back to the neighbour's end: several steps in a row become one wall, with one row of windows.

use crate::parts::{BOX_FACES, SceneBox};
use crate::roof_steps::{ends_m, half_m};
use crate::slanted_wall::SlantedWall;
use cosfly_domain::ObstacleKind;
use cosfly_frames::{DVec2, DVec3};
use std::collections::{BTreeMap, BTreeSet};

/// Steps of slanted walls, metres: less is level, more is a corner of the house.
const STEP_M: [f64; 2] = [0.01, 0.8];
/// Half the width of the widest boxes that follow a slanted wall, metres.
const MOST_HALF_M: f64 = 1.6;
/// How far beside a box its neighbour is looked for, metres: boxes overlap, or leave cracks.
const BESIDE_M: f64 = 0.05;
/// Share of a box's height that its neighbour must stand beside.
const BESIDE_SHARE: f64 = 0.6;
/// Length of a box that is left in any case, metres.
const LEAST_M: f64 = 0.05;
/// How much steps of one wall may differ.
const ALIKE: f64 = 4.0;

/// One end of a box, as its neighbours see it.
#[derive(Clone, Copy)]
struct End {
    index: usize,
    /// The upright face there.
    face: usize,
    /// How far it stands out over the neighbour at its low and at its high side, metres, and that neighbour's end; none where no
    /// neighbour is.
    over: [Option<(f64, usize)>; 2],
}

/// Cuts the boxes of all buildings; those whose roof is steps of rectangles stay.
pub fn cut_slanted_walls(boxes: &mut [SceneBox]) {
    let mut buildings: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    let is_plain = |b: &SceneBox| b.roof.as_deref().is_none_or(|roof| roof.pieces.is_some() || roof.top.is_none());
    for (index, b) in boxes.iter().enumerate() {
        if b.kind == ObstacleKind::Building && is_plain(b) {
            buildings.entry(b.instance).or_default().push(index);
        }
    }
    for members in buildings.values().filter(|members| members.len() > 2) {
        let ends = ends_of(boxes, members);
        let cuts = cuts_of(&ends);
        join_walls(boxes, &ends, &cuts);
        for (end, side) in ends.iter().zip(&cuts) {
            if let Some((side, step_m)) = side {
                cut(&mut boxes[end.index], end.face, *side, *step_m);
            }
        }
    }
}

/// The ends of boxes that may follow a slanted wall.
fn ends_of(boxes: &[SceneBox], members: &[usize]) -> Vec<End> {
    // Along x, so that only neighbours are compared.
    let low = |index: usize| boxes[index].center_in_world.x - boxes[index].half_bounds_m.x - BESIDE_M;
    let high = |index: usize| boxes[index].center_in_world.x + boxes[index].half_bounds_m.x + BESIDE_M;
    let mut order = members.to_vec();
    order.sort_by(|a, b| low(*a).total_cmp(&low(*b)).then(a.cmp(b)));
    let mut near: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (place, &a) in order.iter().enumerate() {
        for &b in order[place + 1..].iter().take_while(|b| low(**b) <= high(a)) {
            near.entry(a).or_default().push(b);
            near.entry(b).or_default().push(a);
        }
    }
    let mut ends = Vec::new();
    let mut number = BTreeMap::new();
    for &index in &order {
        let half = half_m(&boxes[index]);
        for face in (0..4).filter(|face| half[1 - BOX_FACES[*face].0] <= MOST_HALF_M) {
            number.insert((index, face), ends.len());
            ends.push(End { index, face, over: [None; 2] });
        }
    }
    for end in &mut ends {
        let End { index, face, .. } = *end;
        let others = near.get(&index).map_or(&[][..], Vec::as_slice);
        end.over = [-1.0, 1.0].map(|side| {
            let beside = others.iter().filter_map(|other| over(&boxes[index], face, side, &boxes[*other], *other));
            let (step_m, other, there) = beside.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))?;
            Some((step_m, number.get(&(other, there)).copied().unwrap_or(usize::MAX)))
        });
    }
    ends
}

/// How far a face of a box stands out over another box beside it, which of the other's faces looks the same way, metres.
fn over(b: &SceneBox, face: usize, side: f64, other: &SceneBox, number: usize) -> Option<(f64, usize, usize)> {
    let (axis, sign, _) = BOX_FACES[face];
    let [out, across] = [axis, 1 - axis].map(|axis| b.axes_in_world[axis].truncate());
    let out = out * sign;
    let facing = (0..4).find(|there| {
        let (axis, sign, _) = BOX_FACES[*there];
        out.dot(other.axes_in_world[axis].truncate()) * sign > 0.99999
    })?;
    let (half, other_half) = (half_m(b), half_m(other));
    let other_axis = BOX_FACES[facing].0;
    let away = (other.center_in_world - b.center_in_world).truncate();
    let beside_m = side * (half[1 - axis] + BESIDE_M) - away.dot(across);
    let ([foot_m, top_m], [other_foot_m, other_top_m]) = (ends_m(b), ends_m(other));
    let common_m = top_m.min(other_top_m) - foot_m.max(other_foot_m);
    let is_beside = beside_m.abs() <= other_half[1 - other_axis] && common_m >= BESIDE_SHARE * (top_m - foot_m);
    let step_m = half[axis] - (away.dot(out) + other_half[other_axis]);
    (is_beside && step_m < 2.0 * half[axis] - LEAST_M).then_some((step_m, number, facing))
}

/// The side at which each end is cut, and by how much, metres.
fn cuts_of(ends: &[End]) -> Vec<Option<(usize, f64)>> {
    let is_step = |step_m: f64| (STEP_M[0]..=STEP_M[1]).contains(&step_m);
    let cut = |end: &End| {
        (0..2).find_map(|side| {
            let (step_m, next) = end.over[side]?;
            let (before_m, _) = end.over[1 - side]?;
            if !is_step(step_m) || before_m > STEP_M[0] {
                return None;
            }
            // One step is a corner; a wall has several in a row, about as large.
            let is_like = |other_m: f64| is_step(other_m) && other_m < ALIKE * step_m && step_m < ALIKE * other_m;
            let next_m = ends.get(next).and_then(|next| {
                let ahead = next.over.iter().flatten().map(|(step_m, _)| *step_m);
                ahead.fold(None, |most: Option<f64>, step_m| Some(most.map_or(step_m, |most| most.max(step_m))))
            });
            (is_like(-before_m) || next_m.is_some_and(is_like)).then_some((side, step_m))
        })
    };
    // A corner moves one way.
    let mut moved = BTreeSet::new();
    let once = |end: &End| cut(end).filter(|(side, _)| moved.insert((end.index, foot_of(end.face)[*side])));
    ends.iter().map(once).collect()
}

/// Tells the faces that are parts of one wall so: its windows go on over all of them.
fn join_walls(boxes: &mut [SceneBox], ends: &[End], cuts: &[Option<(usize, f64)>]) {
    let next = |at: usize| -> Option<usize> {
        let (side, _) = cuts[at]?;
        let (_, next) = ends[at].over[side]?;
        let goes_on = cuts.get(next)?.is_some();
        (goes_on && next != at).then_some(next)
    };
    let mut is_first: Vec<bool> = cuts.iter().map(Option::is_some).collect();
    (0..ends.len()).filter_map(next).for_each(|next| is_first[next] = false);
    for first in (0..ends.len()).filter(|at| is_first[*at]) {
        let mut wall = vec![first];
        while let Some(next) = wall.last().and_then(|last| next(*last)).filter(|next| !wall.contains(next)) {
            wall.push(next);
        }
        let line =
            |at: usize| cuts[at].map(|(side, step_m)| line_of(&boxes[ends[at].index], ends[at].face, side, step_m));
        let (Some([from, _]), Some([_, to])) = (line(wall[0]), line(wall[wall.len() - 1])) else { continue };
        let along = (to - from).normalize_or(DVec2::X);
        let slanted = SlantedWall {
            along: along.extend(0.0).into(),
            edge_m: from.dot(along) as f32,
            half_width_m: 0.5 * (to - from).length() as f32,
        };
        let at_street = wall.iter().filter(|at| boxes[ends[**at].index].is_at_street[ends[**at].face]).count();
        for at in &wall {
            let End { index, face, .. } = ends[*at];
            boxes[index].is_at_street[face] = 2 * at_street > wall.len();
            boxes[index].slants.get_or_insert_default()[face] = Some(slanted);
        }
    }
}

/// Corner numbers at the foot of a face: at its low and at its high side.
fn foot_of(face: usize) -> [usize; 2] {
    let [low, high, ..] = BOX_FACES[face].2;
    [low, high]
}

/// Where the cut wall begins and ends, seen from above.
fn line_of(b: &SceneBox, face: usize, side: usize, step_m: f64) -> [DVec2; 2] {
    let (axis, sign, _) = BOX_FACES[face];
    let foot = foot_of(face).map(|corner| b.corners_in_world[corner].truncate());
    [foot[1 - side], foot[side] - b.axes_in_world[axis].truncate() * (sign * step_m)]
}

/// Moves the corners at one side of a face back.
fn cut(b: &mut SceneBox, face: usize, side: usize, step_m: f64) {
    let (axis, sign, _) = BOX_FACES[face];
    let back = b.axes_in_world[axis] * (-sign * step_m);
    let corner = foot_of(face)[side];
    for corner in [corner, corner + 4] {
        b.corners_in_world[corner] += back;
    }
    let [from, to] = foot_of(face).map(|corner| b.corners_in_world[corner]);
    let along = to - from;
    let out = DVec3::new(along.y, -along.x, 0.0).normalize_or(b.sides_in_world[face]);
    b.sides_in_world[face] = if out.dot(b.sides_in_world[face]) < 0.0 { -out } else { out };
    // Along the wall of several boxes stands no parapet of each.
    b.roof_goes_on[face] = true;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parts::boxes_of;
    use cosfly_domain::{Obstacle, OrientedBox, Town};

    /// A building of strips along x, each as wide as `width_m`, that end at these places.
    fn strips(width_m: f64, ends_m: &[f64], yaw_rad: f64) -> Vec<SceneBox> {
        let turn = DVec2::from_angle(yaw_rad);
        let strip = |(number, end_m): (usize, &f64)| {
            let middle = turn.rotate(DVec2::new(0.5 * (end_m - 8.0), (number as f64 + 0.5) * width_m));
            let half_extents_m = DVec3::new(0.5 * (end_m + 8.0), 0.5 * width_m, 3.0);
            let shape = OrientedBox { center_in_world: middle.extend(3.0), half_extents_m, yaw_rad };
            Obstacle { shape, kind: ObstacleKind::Building, object_id: 1, synthetic: false }
        };
        let obstacles = ends_m.iter().enumerate().map(strip).collect();
        boxes_of(&Town { obstacles, ..Town::default() }, 1)
    }

    #[test]
    fn a_slanted_wall_is_straight_within_its_boxes_and_has_one_row_of_windows() {
        for yaw_rad in [0.0, 0.7, -2.4] {
            let ends_m: Vec<f64> = (0..12).map(|k| 5.0 - 0.4 * f64::from(k)).collect();
            let whole = strips(0.5, &ends_m, yaw_rad);
            let mut boxes = whole.clone();
            cut_slanted_walls(&mut boxes);
            let (sin, cos) = cosfly_frames::real::sin_cos(yaw_rad);
            let own = |corner: DVec3| DVec2::new(cos * corner.x + sin * corner.y, cos * corner.y - sin * corner.x);
            // All but the first and the last one are cut to the line through the inner corners.
            for (number, b) in boxes.iter().enumerate().take(11).skip(1) {
                for corner in [1, 3, 5, 7] {
                    let place = own(b.corners_in_world[corner]);
                    assert!((place.x - (5.0 - 0.8 * place.y)).abs() < 1e-5, "{number}: {place}");
                }
                assert_eq!(b.slants, boxes[1].slants);
            }
            let width_m = boxes[1].slants.as_deref().and_then(|walls| walls[1]).map(|wall| 2.0 * wall.half_width_m);
            assert!(width_m.is_some_and(|width_m| (width_m - 10.0 * 0.41f32.sqrt()).abs() < 0.02), "{width_m:?}");
            for (b, whole) in boxes.iter().zip(&whole) {
                for (face, (_, _, around)) in BOX_FACES.iter().enumerate() {
                    let [from, normal] = [b.corners_in_world[around[0]], b.normal_in_world(face)];
                    let off = around.map(|corner| (b.corners_in_world[corner] - from).dot(normal).abs());
                    assert!(off.into_iter().all(|off_m| off_m < 1e-6), "{face}: {off:?}");
                    assert!(whole.normal_in_world(face).dot(normal) > 0.5);
                }
                for corner in b.corners_in_world {
                    let away = own(corner) - own(whole.center_in_world);
                    assert!(away.abs().cmple(half_m(whole) + 1e-5).all());
                }
            }
        }
    }

    #[test]
    fn corners_bays_and_rows_of_houses_stay() {
        for ends_m in [vec![5.0, 4.6, 4.6, 4.6], vec![4.0, 4.0, 4.5, 4.0, 4.0], vec![5.0, 3.0, 1.0, -1.0]] {
            let mut boxes = strips(0.5, &ends_m, 0.3);
            let before: Vec<_> = boxes.iter().map(|b| b.corners_in_world).collect();
            cut_slanted_walls(&mut boxes);
            assert!(boxes.iter().zip(before).all(|(b, before)| b.corners_in_world == before), "{ends_m:?}");
        }
        let mut houses = strips(6.0, &[5.0, 4.6, 4.2, 3.8], 0.0);
        cut_slanted_walls(&mut houses);
        assert!(houses.iter().all(|house| house.slants.is_none()));
    }
}
