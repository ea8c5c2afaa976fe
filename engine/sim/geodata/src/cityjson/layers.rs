//! The solid under faces as stacked boxes: each layer covers what reaches above its foot.

use super::faces::{Face, plan_of};
use cosfly_domain::OrientedBox;
use cosfly_frames::DVec2;
use cosfly_town::cover::{COVER_TOLERANCE_M, Coarse, Cover, CoverPlan, LOOSE_TOLERANCE_M, MOST, TurnedRectangle};
use cosfly_town::solids::SolidBoxes;
use std::collections::BTreeMap;

/// How finely a solid becomes boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Steps {
    /// Highest layer where the upper side slopes, metres.
    pub(super) height_m: f64,
    /// Boxes of the lowest layer that are not yet many: with more it may stand over its faces by up to half a metre.
    pub(super) most_of_foot: usize,
    /// Boxes of each other layer that are not yet many.
    pub(super) most_of_layer: usize,
}

/// Steps of buildings and their roofs.
pub(super) const BUILDING: Steps = Steps { height_m: 1.0, most_of_foot: MOST, most_of_layer: 48 };
/// Heights of corners that are closer make one layer, metres.
const CLOSE_M: f64 = 0.25;
/// Most layers of one solid.
const MOST_LAYERS: usize = 24;
/// Most corners times layers of one solid; monsters get fewer layers.
const MOST_WORK: usize = 400_000;

/// Boxes of everything between `base_m`, or the lowest corner, and the upper faces. `ground` faces give the plan up to the lowest corner of the
/// upper ones; without them the upper faces do.
pub(super) fn layered(ground: &[Face], upper: &[Face], base_m: f64, steps: Steps) -> SolidBoxes {
    let Levels { mut levels_m, is_coarse } = levels(upper, steps.height_m);
    let Some(&eaves_m) = levels_m.first() else { return SolidBoxes::default() };
    let whole = |faces: &[Face]| -> Vec<Vec<Vec<DVec2>>> {
        faces.iter().map(|face| face.plan_above(f64::NEG_INFINITY)).collect()
    };
    let plan_of_rings = |rings: &[Vec<Vec<DVec2>>]| {
        let (outer, holes) = plan_of(rings);
        CoverPlan::of(&outer, &holes)
    };
    let foot = if ground.is_empty() { whole(upper) } else { whole(ground) };
    let Some(foot) = plan_of_rings(&foot) else { return SolidBoxes::default() };
    let angles: Vec<f64> = foot.angles_rad().iter().copied().take(2).collect();
    levels_m.insert(0, base_m.min(eaves_m));
    let mut layers: Vec<Layer> = Vec::new();
    let mut coarsest: Option<Coarse> = None;
    for (index, pair) in levels_m.windows(2).enumerate() {
        let Cover { rectangles, coarse } = if index == 0 {
            foot.cover(COVER_TOLERANCE_M, steps.most_of_foot)
        } else {
            let reach_above = upper.iter().filter(|face| face.highest_m() > pair[0] + 1e-3);
            let rings: Vec<_> = reach_above.map(|face| face.plan_above(pair[0])).collect();
            plan_of_rings(&rings)
                .map(|plan| plan.along(&angles).cover(LOOSE_TOLERANCE_M, steps.most_of_layer))
                .unwrap_or_default()
        };
        let gained_m2 = |coarse: &Option<Coarse>| coarse.map_or(-1.0, |coarse| coarse.gained_m2);
        coarsest = if gained_m2(&coarse) > gained_m2(&coarsest) { coarse } else { coarsest };
        match layers.last_mut().filter(|below| below.is_alike(&rectangles)) {
            Some(below) => below.top_m = pair[1],
            None => layers.push(Layer { foot_m: pair[0], top_m: pair[1], rectangles }),
        }
    }
    SolidBoxes { boxes: layers.iter().flat_map(Layer::boxes).collect(), coarse: coarsest, is_roof_coarse: is_coarse }
}

/// Faces by the squares of a grid that their middles lie in: long and bent things become boxes piece by piece, each
/// along its own sides.
pub(super) fn pieces(faces: &[Face], square_m: f64) -> Vec<Vec<Face>> {
    let mut squares: BTreeMap<[i64; 2], Vec<Face>> = BTreeMap::new();
    for face in faces {
        let count = face.corners().count().max(1) as f64;
        let middle = face.corners().map(|corner| corner.truncate()).sum::<DVec2>() / count;
        let square = (middle / square_m).floor().to_array().map(|cell| cell as i64);
        squares.entry(square).or_default().push(face.clone());
    }
    squares.into_values().collect()
}

struct Layer {
    foot_m: f64,
    top_m: f64,
    rectangles: Vec<TurnedRectangle>,
}

impl Layer {
    /// Whether other rectangles are the same but for a few decimetres.
    fn is_alike(&self, others: &[TurnedRectangle]) -> bool {
        const SAME_M: f64 = 0.2;
        self.rectangles.len() == others.len()
            && self.rectangles.iter().zip(others).all(|(a, b)| {
                a.center.distance(b.center) < SAME_M
                    && (a.half_extents_m - b.half_extents_m).abs().max_element() < SAME_M
                    && (a.yaw_rad - b.yaw_rad).abs() < 0.02
            })
    }

    fn boxes(&self) -> impl Iterator<Item = OrientedBox> {
        let half_height_m = 0.5 * (self.top_m - self.foot_m);
        let middle_m = self.foot_m + half_height_m;
        let rectangles = self.rectangles.iter().filter(move |_| half_height_m > 0.01);
        rectangles.map(move |rectangle| OrientedBox {
            center_in_world: rectangle.center.extend(middle_m),
            half_extents_m: rectangle.half_extents_m.extend(half_height_m),
            yaw_rad: rectangle.yaw_rad,
        })
    }
}

/// Heights at which layers end.
#[derive(Default)]
struct Levels {
    levels_m: Vec<f64>,
    /// Whether there are fewer than the slopes ask for.
    is_coarse: bool,
}

/// Levels at the faces' corners, and steps between them.
fn levels(faces: &[Face], step_m: f64) -> Levels {
    let mut corners_m: Vec<f64> = faces.iter().flat_map(Face::corners).map(|corner| corner.z).collect();
    corners_m.sort_by(f64::total_cmp);
    let (Some(&low_m), Some(&high_m)) = (corners_m.first(), corners_m.last()) else { return Levels::default() };
    let most = MOST_LAYERS.min(MOST_WORK / corners_m.len()).max(2);
    let (wanted_m, step_m) = (step_m, step_m.max((high_m - low_m) / most as f64));
    // Level roofs far apart need no steps between them.
    let is_steep = |face: &Face| !face.is_wall() && face.highest_m() - face.lowest_m() > 1.5 * wanted_m;
    let is_coarse = step_m > 1.5 * wanted_m && faces.iter().any(is_steep);
    let mut levels_m = vec![low_m];
    for (i, corner_m) in corners_m.iter().copied().enumerate() {
        let is_last_of_close = corners_m.get(i + 1).is_none_or(|next| next - corner_m > CLOSE_M);
        let below_m = levels_m[levels_m.len() - 1];
        // The lowest corners are the eaves, however close the next ones are.
        if !is_last_of_close && corner_m - below_m < step_m || corner_m - below_m < 1e-6 {
            continue;
        }
        if levels_m.len() == 1 && corner_m - low_m <= CLOSE_M {
            levels_m[0] = corner_m;
            continue;
        }
        let steps = ((corner_m - below_m) / step_m - 1e-9).ceil().max(1.0);
        let mut step = 1.0;
        while step <= steps {
            levels_m.push(below_m + (corner_m - below_m) * step / steps);
            step += 1.0;
        }
    }
    if levels_m.len() > 2 * most {
        let count = most as f64;
        levels_m = (0..=most).map(|i| low_m + (high_m - low_m) * i as f64 / count).collect();
        return Levels { levels_m, is_coarse: true };
    }
    Levels { levels_m, is_coarse }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::DVec3;

    fn face(corners: &[[f64; 3]]) -> Face {
        Face { rings: vec![corners.iter().map(|corner| DVec3::from_array(*corner)).collect()] }
    }

    fn gable() -> [Face; 2] {
        [
            face(&[[0.0, 0.0, 6.0], [12.0, 0.0, 6.0], [12.0, 4.0, 9.0], [0.0, 4.0, 9.0]]),
            face(&[[0.0, 4.0, 9.0], [12.0, 4.0, 9.0], [12.0, 8.0, 6.0], [0.0, 8.0, 6.0]]),
        ]
    }

    #[test]
    fn a_level_roof_is_one_box_up_to_the_roof() {
        let roof = face(&[[0.0, 0.0, 6.0], [12.0, 0.0, 6.1], [12.0, 8.0, 6.1], [0.0, 8.0, 6.0]]);
        let boxes = layered(&[], &[roof], 1.0, BUILDING).boxes;
        assert_eq!(boxes.len(), 1, "{boxes:?}");
        let top_m = boxes[0].center_in_world.z + boxes[0].half_extents_m.z;
        assert!((top_m - 6.1).abs() < 1e-9 && (top_m - 2.0 * boxes[0].half_extents_m.z - 1.0).abs() < 1e-9);
    }

    #[test]
    fn gables_shrink_towards_the_ridge() {
        let boxes = layered(&[], &gable(), 0.0, BUILDING).boxes;
        assert_eq!(boxes.len(), 3, "{boxes:?}");
        for (shape, (foot_m, top_m, width_m)) in
            boxes.iter().zip([(0.0, 7.0, 8.0), (7.0, 8.0, 16.0 / 3.0), (8.0, 9.0, 8.0 / 3.0)])
        {
            let middle_m = shape.center_in_world.z;
            assert!((middle_m - shape.half_extents_m.z - foot_m).abs() < 1e-9);
            assert!((middle_m + shape.half_extents_m.z - top_m).abs() < 1e-9);
            assert!((2.0 * shape.half_extents_m.truncate().min_element() - width_m).abs() < 1e-9, "{shape:?}");
        }
    }

    #[test]
    fn monsters_and_slivers_are_bounded() {
        let spikes: Vec<Face> = (0..4000)
            .map(f64::from)
            .map(|i| face(&[[i, 0.0, 0.01 * i], [i + 0.5, 0.0, i], [i, 1.0, 3.0 * i]]))
            .collect();
        let solid = layered(&[], &spikes, 0.0, BUILDING);
        assert!(solid.boxes.len() <= 64 * 2 * MOST_LAYERS && solid.is_roof_coarse, "{}", solid.boxes.len());
        assert!(layered(&[], &[face(&[[0.0; 3]; 3])], 0.0, BUILDING).boxes.len() <= 1);
        assert_eq!(layered(&[], &[], 0.0, BUILDING), SolidBoxes::default());
    }
}
