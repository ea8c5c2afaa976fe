//! Which buildings have a measured roof, and what is drawn of their boxes.

use super::pieces::Cutter;
use super::planes::Planes;
use super::terraces::Terraces;
use crate::parts::SceneBox;
use crate::roof_step::{FaceLook, RoofPiece, RoofStep, TopSlope};
use crate::roof_steps::{CLOSE_M, ends_m, half_m};
use cosfly_domain::ObstacleKind;
use cosfly_frames::{DVec2, DVec3};
use std::collections::BTreeMap;

/// Walls that are lower are no part of their own, metres.
const LEAST_WALL_M: f64 = 1e-3;
/// Level parts of a measured roof that are smaller are of tiles, square metres.
const SMALL_M2: f64 = 30.0;
/// Pieces within a roof go down so far below it, metres: their neighbours hide what is below.
const DEEP_M: f64 = 0.2;
/// Share of a roof's area that must have slopes for that.
const MOSTLY: f64 = 0.6;
/// Rows of tiles on level parts fall along x.
const LEVEL_FALLS: [f32; 2] = [1.0, 0.0];
/// Faces of boxes at the sides of pieces, from each corner to the next.
const SIDES: [usize; 4] = [2, 1, 3, 0];

/// Puts the places of boxes in measured roofs in the place of their steps.
pub fn measured_roofs(boxes: &[SceneBox], steps: &mut [Option<RoofStep>]) {
    let mut buildings: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (index, b) in boxes.iter().enumerate().filter(|(_, b)| b.kind == ObstacleKind::Building) {
        buildings.entry(b.instance).or_default().push(index);
    }
    for members in buildings.values().filter(|members| members.len() > 2 && !are_nested(boxes, members)) {
        let Some(terraces) = Terraces::of(boxes, members).filter(Terraces::have_steps) else { continue };
        let planes = Planes::below(&terraces, boxes, members);
        if planes.planes.is_empty() {
            continue;
        }
        let cutter = Cutter { terraces: &terraces, planes: &planes };
        let foot_m = members.iter().map(|index| ends_m(&boxes[*index])[0]).fold(f64::INFINITY, f64::min);
        let area = |index: usize| half_m(&boxes[index]).element_product();
        let mut members = members.clone();
        members.sort_by(|a, b| area(*b).total_cmp(&area(*a)).then(a.cmp(b)));
        let mut slopes: Vec<Slopes<'_>> = Vec::new();
        for index in members {
            steps[index] = step_of(&boxes[index], &cutter, foot_m, &mut slopes);
        }
    }
}

/// A box all over which the planes of its roof go on.
struct Slopes<'a> {
    b: &'a SceneBox,
    planes: Vec<u16>,
}

impl Slopes<'_> {
    /// Whether its slopes are those of another box, too.
    fn hold(&self, other: &SceneBox, planes: &[u16]) -> bool {
        let half = half_m(self.b) + 1e-6;
        let axes = self.b.axes_in_world.map(|axis| axis.truncate());
        let is_in = |corner: &DVec3| {
            let away = (*corner - self.b.center_in_world).truncate();
            away.dot(axes[0]).abs() <= half.x && away.dot(axes[1]).abs() <= half.y
        };
        let is_open = ends_m(other)[1] >= ends_m(self.b)[1];
        is_open
            && !planes.is_empty()
            && planes.iter().all(|plane| self.planes.contains(plane))
            && other.corners_in_world[..4].iter().all(is_in)
    }
}

/// Whether each box but the lowest stands within the one below: slopes between such rectangles need no measuring.
fn are_nested(boxes: &[SceneBox], members: &[usize]) -> bool {
    let mut order = members.to_vec();
    order.sort_by(|a, b| ends_m(&boxes[*a])[0].total_cmp(&ends_m(&boxes[*b])[0]).then(a.cmp(b)));
    order.windows(2).all(|pair| {
        let [lower, upper] = [&boxes[pair[0]], &boxes[pair[1]]];
        let is_on = (ends_m(upper)[0] - ends_m(lower)[1]).abs() <= CLOSE_M;
        let is_turned = upper.axes_in_world[0].dot(lower.axes_in_world[0]).abs() < 0.999;
        let away = (upper.center_in_world - lower.center_in_world).truncate();
        let away = DVec2::new(
            away.dot(lower.axes_in_world[0].truncate()).abs(),
            away.dot(lower.axes_in_world[1].truncate()).abs(),
        );
        is_on && !is_turned && (away + half_m(upper)).cmple(half_m(lower) + CLOSE_M).all()
    })
}

/// The place of a box; `slopes` are those of larger boxes, which hold the slopes of smaller ones.
fn step_of<'a>(
    b: &'a SceneBox,
    cutter: &Cutter<'_>,
    foot_of_house_m: f64,
    slopes: &mut Vec<Slopes<'a>>,
) -> Option<RoofStep> {
    let [foot_m, top_m] = ends_m(b);
    let wall_m = |eaves_m: f64| [foot_of_house_m, (eaves_m - foot_of_house_m).max(0.0)];
    let step = |top: Option<TopSlope>, wall_m: [f64; 2], slope_m: f64, pieces: Option<Vec<RoofPiece>>| RoofStep {
        sides: [FaceLook::Wall; 4],
        top,
        wall_m,
        slope_m,
        pieces,
    };
    let Some((mut pieces, planes, goes_on)) = cutter.pieces(b) else {
        let level = TopSlope { above_m: [0.0; 4], pitch: [0.0, 1.0], falls: Some(LEVEL_FALLS) };
        let is_small = cutter.planes.share > MOSTLY && 4.0 * half_m(b).element_product() < SMALL_M2;
        return Some(step(Some(level).filter(|_| is_small), wall_m(top_m), 0.0, None));
    };
    let corners = pieces.iter().flat_map(|piece| piece.corners_in_world);
    let low_m = corners.map(|corner| corner.z).fold(top_m, f64::min);
    let eaves_m = cutter.eaves_m(b);
    let wall_top_m = low_m.min(eaves_m.max(foot_m));
    if slopes.iter().any(|one| one.hold(b, &planes)) {
        pieces.clear();
    } else if goes_on {
        slopes.push(Slopes { b, planes });
    }
    Some(step(None, wall_m(eaves_m), top_m - wall_top_m, Some(pieces)))
}

/// A box that is the part of `b` between a height and a piece of its roof.
pub fn box_of(b: &SceneBox, piece: &RoofPiece, foot_m: f64, wall_m: [f64; 2]) -> SceneBox {
    let mut part = b.clone();
    let low_m = piece.corners_in_world.iter().map(|corner| corner.z).fold(f64::INFINITY, f64::min);
    let foot_m = if piece.goes_on == [true; 4] { foot_m.max(low_m - DEEP_M) } else { foot_m };
    // Corners 0, 1, 3, 2 lie in order around.
    for (number, place) in [(0, 0), (1, 1), (3, 2), (2, 3)] {
        let corner = piece.corners_in_world[place];
        part.corners_in_world[number] = corner.truncate().extend(foot_m.min(corner.z));
        part.corners_in_world[number + 4] = corner;
    }
    let low = part.corners_in_world.into_iter().fold(DVec3::INFINITY, DVec3::min);
    let high = part.corners_in_world.into_iter().fold(DVec3::NEG_INFINITY, DVec3::max);
    part.center_in_world = 0.5 * (low + high);
    part.half_bounds_m = 0.5 * (high - low);
    let reach = |axis: DVec3| {
        part.corners_in_world.iter().map(|corner| (*corner - part.center_in_world).dot(axis).abs()).fold(0.0, f64::max)
    };
    let half = DVec2::new(reach(part.axes_in_world[0]), reach(part.axes_in_world[1]));
    part.half_extents_m = half.extend(part.half_bounds_m.z.min(half.max_element())).as_vec3a();
    let around = [(2, [0, 1]), (1, [1, 3]), (3, [3, 2]), (0, [2, 0])];
    let outs = around.map(|(_, [from, to])| {
        let along = (part.corners_in_world[to] - part.corners_in_world[from]).truncate();
        DVec2::new(along.y, -along.x).normalize_or_zero()
    });
    for (at, (face, _)) in around.into_iter().enumerate() {
        // A side without a length looks between those beside it: its plane touches the part, and cuts nothing off.
        let between = outs[(at + 1) % 4] + outs[(at + 3) % 4];
        let out = if outs[at] == DVec2::ZERO { between.normalize_or(DVec2::X) } else { outs[at] };
        part.sides_in_world[face] = out.extend(0.0);
    }
    part.top_in_world = piece.normal_in_world;
    let is_level = piece.falls == [0.0; 2];
    let falls = Some(if is_level { LEVEL_FALLS } else { piece.falls });
    let top = TopSlope { above_m: [0.0; 4], pitch: piece.pitch, falls };
    let is_wide = is_level && 4.0 * half.element_product() > SMALL_M2;
    let mut sides = [FaceLook::Gable; 4];
    for (face, _) in SIDES.into_iter().zip(piece.goes_on).filter(|(_, goes_on)| *goes_on) {
        sides[face] = FaceLook::Slope(piece.pitch);
    }
    let top = Some(top).filter(|_| !is_wide);
    part.roof = Some(Box::new(RoofStep { sides, top, wall_m, slope_m: 0.0, pieces: None }));
    part.roof_goes_on = [true; 4];
    part
}

/// Whether the wall below a slope is a part of its own.
pub fn has_wall(foot_m: f64, foot_of_slope_m: f64) -> bool {
    foot_of_slope_m > foot_m + LEAST_WALL_M
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parts::boxes_of;
    use crate::roof_slopes::cut_to_slopes;
    use crate::roof_steps::roof_steps;
    use cosfly_domain::{Obstacle, OrientedBox, Town};
    use cosfly_town::solids::{Footprint, Roof, building_boxes};

    fn whole_and_drawn(shapes: &[OrientedBox]) -> [Vec<SceneBox>; 2] {
        let obstacle = |shape: &OrientedBox| Obstacle {
            shape: *shape,
            kind: ObstacleKind::Building,
            object_id: 1,
            synthetic: false,
        };
        let town = Town { obstacles: shapes.iter().map(obstacle).collect(), ..Town::default() };
        let whole = boxes_of(&town, 1);
        let mut steps = roof_steps(&whole);
        measured_roofs(&whole, &mut steps);
        let mut drawn = whole.clone();
        drawn.iter_mut().zip(steps).for_each(|(b, step)| b.roof = step.map(Box::new));
        cut_to_slopes(&mut drawn);
        [whole, drawn]
    }

    /// Height of the upper faces at a place.
    fn height_m(boxes: &[SceneBox], at: DVec2) -> f64 {
        let height = |b: &SceneBox| {
            let around = [4, 5, 7, 6].map(|corner| b.corners_in_world[corner]);
            let is_in = (0..4).all(|k| {
                let [from, to] = [around[k].truncate(), around[(k + 1) % 4].truncate()];
                (to - from).perp_dot(at - from) >= -1e-9
            });
            let normal = b.top_in_world;
            is_in.then(|| around[0].z - normal.truncate().dot(at - around[0].truncate()) / normal.z)
        };
        boxes.iter().filter_map(height).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Distances of the drawn roof from the true one, and its largest jump between places a decimetre apart, over places where `inner`
    /// holds.
    fn errors_m(shapes: &[OrientedBox], truth: impl Fn(DVec2) -> Option<f64>) -> [f64; 3] {
        let [whole, drawn] = whole_and_drawn(shapes);
        let [mut worst_m, mut sum_m, mut jump_m, mut count] = [0.0_f64; 4];
        for place in 0..160 * 160 {
            let at = 0.1 * DVec2::new(f64::from(place % 160) - 80.0, f64::from(place / 160) - 80.0) + 0.013;
            let Some(true_m) = truth(at) else { continue };
            let drawn_m = height_m(&drawn, at);
            assert!(drawn_m <= height_m(&whole, at) + 1e-6, "{at}: {drawn_m} stands out of the boxes");
            let off_m = (drawn_m - true_m).abs();
            (worst_m, sum_m, count) = (worst_m.max(off_m), sum_m + off_m, count + 1.0);
            for beside in [DVec2::X, DVec2::Y].map(|way| at + 0.1 * way) {
                if truth(beside).is_some() {
                    jump_m = jump_m.max((height_m(&drawn, beside) - drawn_m).abs());
                }
            }
        }
        assert!(count > 1000.0);
        [worst_m, sum_m / count, jump_m]
    }

    #[test]
    fn roof_over_slanted_gable_walls_is_whole() {
        let outer = [(-7.0, -4.0), (6.0, -4.0), (7.5, 4.0), (-6.0, 4.0)].map(|(x, y)| DVec2::new(x, y)).to_vec();
        let roof = Roof::Gabled { rise_m: 4.0, ridge_yaw_rad: Some(0.0) };
        let shapes = building_boxes(&Footprint { outer, holes: vec![] }, 0.0, 6.0, roof).boxes;
        assert!(shapes.len() > 8, "{}", shapes.len());
        let truth = |at: DVec2| {
            let west_m = -7.0 + 0.125 * (at.y + 4.0);
            let is_in = at.y.abs() < 3.8 && at.x > west_m + 0.2 && at.x < west_m + 12.8;
            is_in.then(|| 10.0 - at.y.abs())
        };
        let [worst_m, mean_m, jump_m] = errors_m(&shapes, truth);
        assert!(worst_m < 0.4 && mean_m < 0.15 && jump_m < 0.3, "{worst_m} {mean_m} {jump_m}");
    }

    /// Columns of a scan: strips of one metre along the ridge down to the ground, each as high as the roof below it.
    #[test]
    fn a_gable_of_strips_down_to_the_ground_is_whole() {
        let strip = |number: i32| {
            let (low_m, high_m) = (f64::from(number), f64::from(number + 1));
            let top_m = 7.0 - 0.5 * if number < 0 { -high_m } else { low_m };
            OrientedBox {
                center_in_world: DVec3::new(0.0, 0.5 * (low_m + high_m), 0.5 * top_m),
                half_extents_m: DVec3::new(6.0, 0.5, 0.5 * top_m),
                yaw_rad: 0.0,
            }
        };
        let shapes: Vec<OrientedBox> = (-5..5).map(strip).collect();
        let truth = |at: DVec2| (at.y.abs() < 4.9 && at.x.abs() < 5.9).then(|| 7.0 - 0.5 * at.y.abs());
        let [worst_m, mean_m, jump_m] = errors_m(&shapes, truth);
        assert!(worst_m < 0.15 && mean_m < 0.08 && jump_m < 0.12, "{worst_m} {mean_m} {jump_m}");
    }

    #[test]
    fn terraces_that_are_no_slope_stay_level() {
        let block = |x: f64, half_x: f64, top_m: f64| OrientedBox {
            center_in_world: DVec3::new(x, 0.0, 0.5 * top_m),
            half_extents_m: DVec3::new(half_x, 8.0, 0.5 * top_m),
            yaw_rad: 0.0,
        };
        let [whole, drawn] = whole_and_drawn(&[block(-12.0, 8.0, 9.0), block(4.0, 8.0, 10.0), block(20.0, 8.0, 11.0)]);
        assert_eq!(drawn.len(), whole.len());
        assert!(drawn.iter().zip(&whole).all(|(a, b)| a.corners_in_world == b.corners_in_world));
    }
}
