//! Steps of pitched roofs, cut to the slopes that they stand for: gables and eaves are straight lines.
//!
//! Each step keeps its foot, and its upper face shrinks to the foot of the steps over it. What is drawn lies within the
//! boxes.

use crate::measured::roofs::{box_of, has_wall};
use crate::parts::{BOX_FACES, SceneBox};
use crate::roof_step::{FaceLook, RoofStep};
use crate::roof_steps::{FLUSH_M, ends_m, half_m, pitch};
use cosfly_frames::{DVec2, DVec3};

/// Walls below a roof that are lower are no part of their own, metres.
const LEAST_WALL_M: f64 = 1e-3;

/// Cuts all boxes of pitched roofs; walls below get a box of their own, behind all others.
pub fn cut_to_slopes(boxes: &mut Vec<SceneBox>) {
    cut_to_pieces(boxes);
    let mut eaves = Vec::new();
    for b in boxes.iter_mut() {
        let Some(roof) = b.roof.as_deref().filter(|roof| roof.slope_m > 0.0 && roof.top.is_some()) else { continue };
        let [foot_m, top_m] = ends_m(b);
        let foot_of_slope_m = top_m - roof.slope_m;
        if foot_of_slope_m > foot_m + LEAST_WALL_M {
            let mut upper = b.clone();
            set_ends(&mut upper, [foot_of_slope_m, top_m]);
            cut(&mut upper);
            eaves.push(upper);
            set_ends(b, [foot_m, foot_of_slope_m]);
            if let Some(roof) = b.roof.as_deref_mut() {
                roof.top = None;
            }
        } else {
            cut(b);
        }
    }
    boxes.append(&mut eaves);
}

/// Cuts the boxes of measured roofs: pieces of the roof get boxes of their own, behind all others.
fn cut_to_pieces(boxes: &mut Vec<SceneBox>) {
    let mut parts = Vec::new();
    boxes.retain_mut(|b| {
        let Some(roof) = b.roof.as_deref_mut() else { return true };
        let Some(pieces) = roof.pieces.take() else { return true };
        let (slope_m, wall_m) = (roof.slope_m, roof.wall_m);
        let [foot_m, top_m] = ends_m(b);
        let foot_of_slope_m = top_m - slope_m;
        parts.extend(pieces.iter().map(|piece| box_of(b, piece, foot_of_slope_m.max(foot_m), wall_m)));
        let has_wall = has_wall(foot_m, foot_of_slope_m);
        if has_wall {
            set_ends(b, [foot_m, foot_of_slope_m]);
        }
        has_wall
    });
    boxes.append(&mut parts);
}

fn set_ends(b: &mut SceneBox, [low_m, high_m]: [f64; 2]) {
    b.center_in_world.z = 0.5 * (low_m + high_m);
    b.half_bounds_m.z = 0.5 * (high_m - low_m);
    b.half_extents_m.z = b.half_bounds_m.z as f32;
    for (number, corner) in b.corners_in_world.iter_mut().enumerate() {
        corner.z = if number & 4 == 0 { low_m } else { high_m };
    }
}

/// Moves the upper corners in to what stands on the box, and tells the faces how they look.
fn cut(b: &mut SceneBox) {
    let half = half_m(b);
    let rise_m = 2.0 * b.half_bounds_m.z;
    let Some(RoofStep { sides, top: Some(top), wall_m, .. }) = b.roof.as_deref_mut() else { return };
    let [x, y, half_x, half_y] = top.above_m.map(f64::from);
    let (middle, reach) = (DVec2::new(x, y), DVec2::new(half_x, half_y));
    let (low, high) = ((middle - reach).clamp(-half, half), (middle + reach).clamp(-half, half));
    for number in 4..8 {
        let x = if number & 1 == 0 { low.x + half.x } else { high.x - half.x };
        let y = if number & 2 == 0 { low.y + half.y } else { high.y - half.y };
        b.corners_in_world[number] += x * b.axes_in_world[0] + y * b.axes_in_world[1];
    }
    let gaps_m = [low.x + half.x, half.x - high.x, low.y + half.y, half.y - high.y];
    for (face, gap_m) in gaps_m.into_iter().enumerate() {
        let (axis, sign, _) = BOX_FACES[face];
        b.sides_in_world[face] = (rise_m * sign * b.axes_in_world[axis] + gap_m * DVec3::Z).normalize_or(DVec3::Z);
        let is_flush = gap_m < FLUSH_M;
        sides[face] = match sides[face] {
            _ if !is_flush => FaceLook::Slope(pitch(rise_m, gap_m)),
            FaceLook::Slope(_) | FaceLook::Wall if wall_m[1] > LEAST_WALL_M => FaceLook::Gable,
            look => look,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parts::boxes_of;
    use crate::roof_steps::roof_steps;
    use cosfly_domain::{Obstacle, ObstacleKind, Town};
    use cosfly_town::solids::{Footprint, Roof, building_boxes};

    #[test]
    fn gables_and_eaves_of_a_turned_house_are_straight() {
        let turn = DVec2::from_angle(0.4);
        let outer = [(-8.0, -4.0), (8.0, -4.0), (8.0, 4.0), (-8.0, 4.0)].map(|(x, y)| turn.rotate(DVec2::new(x, y)));
        let roof = Roof::Gabled { rise_m: 4.0, ridge_yaw_rad: None };
        let shapes = building_boxes(&Footprint { outer: outer.to_vec(), holes: vec![] }, 0.0, 6.0, roof).boxes;
        let obstacle = |shape| Obstacle { shape, kind: ObstacleKind::Building, object_id: 1, synthetic: false };
        let town = Town { obstacles: shapes.into_iter().map(obstacle).collect(), ..Town::default() };
        let mut boxes = boxes_of(&town, 1);
        let steps = roof_steps(&boxes);
        boxes.iter_mut().zip(steps).for_each(|(b, step)| b.roof = step.map(Box::new));
        let before = boxes.len();
        cut_to_slopes(&mut boxes);
        assert_eq!(boxes.len(), before + 1);
        for b in &boxes {
            for corner in b.corners_in_world {
                let across_m = turn.perp_dot(corner.truncate()).abs();
                let roof_m = 10.0 - across_m;
                let is_wall = corner.z <= 6.0 + 1e-3 && (across_m - 4.0).abs() < 1e-3;
                assert!(is_wall || (corner.z - roof_m).abs() < 2e-2, "{corner} stands off the roof at {roof_m}");
            }
            for (face, (_, _, around)) in BOX_FACES.iter().enumerate() {
                let [from, normal] = [b.corners_in_world[around[0]], b.normal_in_world(face)];
                let off = around.map(|corner| (b.corners_in_world[corner] - from).dot(normal).abs());
                assert!(off.into_iter().all(|off_m| off_m < 1e-5), "{face}: {off:?}");
            }
        }
    }
}
