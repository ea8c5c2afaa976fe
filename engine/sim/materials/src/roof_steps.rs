//! Which boxes of a building are steps of a pitched roof: they are drawn as slopes.

use crate::parts::SceneBox;
use crate::roof_step::{FaceLook, RoofPitch, RoofStep, TopSlope};
use cosfly_domain::ObstacleKind;
use cosfly_frames::DVec2;
use std::collections::BTreeMap;

/// Highest step, metres: readers of maps make steps of 0.75 and 1 m.
pub const HIGHEST_M: f64 = 1.05;
/// A box that begins this close to another's upper face stands on it, metres.
pub(crate) const CLOSE_M: f64 = 0.03;
/// A face that stands back by less continues the wall below, metres.
pub(crate) const FLUSH_M: f64 = 0.05;
/// Flattest slope, run over rise.
const FLATTEST: f64 = 4.0;
/// Steps beside a strip of a roof are at most so many times their height away.
const BESIDE: f64 = 2.0;

/// A rectangle along the axes of a box, from its middle, metres.
#[derive(Clone, Copy, Debug)]
struct Rectangle {
    low: DVec2,
    high: DVec2,
}

impl Rectangle {
    fn of_box(b: &SceneBox) -> Self {
        let half = half_m(b);
        Self { low: -half, high: half }
    }

    /// Another box along the axes of `frame`.
    fn seen_from(frame: &SceneBox, other: &SceneBox) -> Self {
        let away = (other.center_in_world - frame.center_in_world).truncate();
        let [x, y] = frame.axes_in_world.map(|axis| axis.truncate());
        let middle = DVec2::new(away.dot(x), away.dot(y));
        let [u, v] = other.axes_in_world.map(|axis| axis.truncate());
        let size = half_m(other);
        let reach = |axis: DVec2| size.x * axis.dot(u).abs() + size.y * axis.dot(v).abs();
        let half = DVec2::new(reach(x), reach(y));
        Self { low: middle - half, high: middle + half }
    }

    /// Whether another is at most so far away along both axes; a negative distance is an overlap.
    fn is_within(&self, other: &Self, distance_m: f64) -> bool {
        (self.low - distance_m).cmplt(other.high).all() && (other.low - distance_m).cmplt(self.high).all()
    }

    fn around(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Distances to the sides of a rectangle around it: low x, high x, low y, high y.
    fn gaps_m(&self, around: &Self) -> [f64; 4] {
        let (low, high) = (self.low - around.low, around.high - self.high);
        [low.x, high.x, low.y, high.y]
    }
}

pub(crate) fn half_m(b: &SceneBox) -> DVec2 {
    b.half_extents_m.truncate().as_dvec2()
}

pub(crate) fn ends_m(b: &SceneBox) -> [f64; 2] {
    let half = f64::from(b.half_extents_m.z);
    [b.center_in_world.z - half, b.center_in_world.z + half]
}

pub(crate) fn pitch(rise_m: f64, run_m: f64) -> RoofPitch {
    let run_m = run_m.clamp(0.3 * rise_m, FLATTEST * rise_m).max(1e-3);
    let length_m = cosfly_frames::real::hypot(rise_m, run_m).max(1e-3);
    [(rise_m / length_m) as f32, (run_m / length_m) as f32]
}

/// The places of all boxes in pitched roofs; none for most.
pub fn roof_steps(boxes: &[SceneBox]) -> Vec<Option<RoofStep>> {
    let mut bases: BTreeMap<(u32, i64), Vec<usize>> = BTreeMap::new();
    let level = |height_m: f64| (height_m / CLOSE_M).floor() as i64;
    let is_building = |b: &SceneBox| b.kind == ObstacleKind::Building;
    let is_low = |b: &SceneBox| ends_m(b)[1] - ends_m(b)[0] <= HIGHEST_M;
    for (index, b) in boxes.iter().enumerate().filter(|(_, b)| is_building(b) && is_low(b)) {
        bases.entry((b.instance, level(ends_m(b)[0]))).or_default().push(index);
    }
    let mut steps: Vec<Option<RoofStep>> = vec![None; boxes.len()];
    if bases.is_empty() {
        return steps;
    }
    let mut order: Vec<usize> = (0..boxes.len()).filter(|index| is_building(&boxes[*index])).collect();
    order.sort_by(|a, b| ends_m(&boxes[*a])[0].total_cmp(&ends_m(&boxes[*b])[0]).then(a.cmp(b)));
    // Boxes below each step, as they are met on the way up.
    let mut below: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for index in order {
        let b = &boxes[index];
        let top_m = ends_m(b)[1];
        let near = (-1..=1).filter_map(|side| bases.get(&(b.instance, level(top_m) + side))).flatten().copied();
        let on_it: Vec<usize> = near.filter(|other| (ends_m(&boxes[*other])[0] - top_m).abs() <= CLOSE_M).collect();
        let own = Rectangle::of_box(b);
        let rise_m = on_it.iter().map(|other| ends_m(&boxes[*other])[1] - top_m).fold(0.0, f64::max);
        let within = |distance_m: f64| -> Vec<usize> {
            let is_within = |other: &usize| Rectangle::seen_from(b, &boxes[*other]).is_within(&own, distance_m);
            on_it.iter().copied().filter(is_within).collect()
        };
        // A strip that no step stands on falls from the steps beside it.
        let over = within(-CLOSE_M);
        let over = if over.is_empty() { within(BESIDE * rise_m) } else { over };
        let run_m = over_run_m(boxes, index, &over);
        let slope = top_slope(boxes, index, &over, rise_m);
        if run_m <= FLATTEST * rise_m + FLUSH_M {
            within(2.0 * CLOSE_M).into_iter().for_each(|other| below.entry(other).or_default().push(index));
        }
        steps[index] = match below.get(&index) {
            Some(lower) => {
                let step = step(boxes, index, lower, slope, &steps);
                let slope_m = if slope.is_some() || over.is_empty() { step.slope_m } else { 0.0 };
                Some(RoofStep { slope_m, ..step })
            }
            None => slope.map(|slope| {
                let [foot_m, top_m] = ends_m(b);
                let slope_m = rise_m.min(top_m - foot_m);
                let wall_m = [foot_m, top_m - slope_m - foot_m];
                RoofStep { sides: [FaceLook::Wall; 4], top: Some(slope), wall_m, slope_m, pieces: None }
            }),
        };
    }
    steps
}

/// The rectangle around the steps over a box, along its axes.
fn around(boxes: &[SceneBox], index: usize, over: &[usize]) -> Option<Rectangle> {
    over.iter().map(|other| Rectangle::seen_from(&boxes[index], &boxes[*other])).reduce(Rectangle::around)
}

/// Largest distance from the steps over a box to one of its sides, metres.
fn over_run_m(boxes: &[SceneBox], index: usize, over: &[usize]) -> f64 {
    let own = Rectangle::of_box(&boxes[index]);
    around(boxes, index, over).map_or(f64::INFINITY, |all| all.gaps_m(&own).into_iter().fold(0.0, f64::max))
}

/// The slope from the steps over a box down to its sides; none where its upper face is level.
fn top_slope(boxes: &[SceneBox], index: usize, over: &[usize], rise_m: f64) -> Option<TopSlope> {
    let all = around(boxes, index, over)?;
    let run_m = over_run_m(boxes, index, over);
    let is_slope = run_m > FLUSH_M && run_m <= FLATTEST * rise_m + FLUSH_M;
    let (middle, half) = (0.5 * (all.low + all.high), 0.5 * (all.high - all.low));
    is_slope.then(|| TopSlope {
        above_m: [middle.x, middle.y, half.x, half.y].map(|value| value as f32),
        pitch: pitch(rise_m, run_m),
        falls: None,
    })
}

/// A step on `lower` boxes.
fn step(
    boxes: &[SceneBox],
    index: usize,
    lower: &[usize],
    slope: Option<TopSlope>,
    steps: &[Option<RoofStep>],
) -> RoofStep {
    let b = &boxes[index];
    let [foot_m, top_m] = ends_m(b);
    let rise_m = top_m - foot_m;
    let own = Rectangle::of_box(b);
    let under = lower.iter().map(|other| Rectangle::seen_from(b, &boxes[*other])).reduce(Rectangle::around);
    let gaps_m = own.gaps_m(&under.unwrap_or(own));
    let sides = gaps_m.map(|gap| if gap < FLUSH_M { FaceLook::Gable } else { FaceLook::Slope(pitch(rise_m, gap)) });
    let wall = lower.iter().filter_map(|other| steps[*other].as_ref()).map(|step| step.wall_m).next();
    let run_m = gaps_m.into_iter().filter(|gap| *gap >= FLUSH_M).fold(f64::INFINITY, f64::min);
    let top = slope.or_else(|| run_m.is_finite().then(|| ridge(half_m(b), &sides, pitch(rise_m, run_m))));
    RoofStep { sides, top, wall_m: wall.unwrap_or([foot_m, rise_m]), slope_m: rise_m, pieces: None }
}

/// The last step falls to both sides of a ridge: between gables, else along the longer side.
fn ridge(half_m: DVec2, sides: &[FaceLook; 4], pitch: RoofPitch) -> TopSlope {
    let is_gable = |first: usize| sides[first] == FaceLook::Gable && sides[first + 1] == FaceLook::Gable;
    let is_along_x = if is_gable(0) == is_gable(2) { half_m.x >= half_m.y } else { is_gable(0) };
    let [x, y] = if is_along_x { [half_m.x as f32, 0.0] } else { [0.0, half_m.y as f32] };
    TopSlope { above_m: [0.0, 0.0, x, y], pitch, falls: None }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parts::boxes_of;
    use cosfly_domain::{Obstacle, OrientedBox, Town};
    use cosfly_frames::DVec3;
    use cosfly_town::solids::{Footprint, Roof, building_boxes};

    fn steps_of(shapes: Vec<OrientedBox>) -> Vec<Option<RoofStep>> {
        let obstacle = |shape| Obstacle { shape, kind: ObstacleKind::Building, object_id: 1, synthetic: false };
        let town = Town { obstacles: shapes.into_iter().map(obstacle).collect(), ..Town::default() };
        roof_steps(&boxes_of(&town, 1))
    }

    fn house(roof: Roof) -> Vec<OrientedBox> {
        let outer = [(0.0, 0.0), (16.0, 0.0), (16.0, 8.0), (0.0, 8.0)].map(|(x, y)| DVec2::new(x, y)).to_vec();
        building_boxes(&Footprint { outer, holes: Vec::new() }, 0.0, 6.0, roof).boxes
    }

    #[test]
    fn steps_of_a_gable_slope_to_two_sides_and_end_in_the_wall() {
        let steps = steps_of(house(Roof::Gabled { rise_m: 4.0, ridge_yaw_rad: None }));
        assert!(steps.len() > 4);
        let wall = steps[0].as_ref().unwrap();
        assert_eq!(wall.sides, [FaceLook::Wall; 4]);
        for (index, step) in steps.iter().enumerate().skip(1) {
            let step = step.as_ref().unwrap();
            let count = |wanted: fn(&FaceLook) -> bool| step.sides.iter().filter(|side| wanted(side)).count();
            assert_eq!(count(|side| matches!(side, FaceLook::Gable)), 2, "{index}: {step:?}");
            assert_eq!(count(|side| matches!(side, FaceLook::Slope(_))), 2, "{index}: {step:?}");
            assert!(step.wall_m[0].abs() < 1e-6);
            let [sine, cosine] = step.top.unwrap().pitch;
            assert!((sine - cosine).abs() < 0.2, "a roof of 45 degrees: {step:?}");
        }
    }

    #[test]
    fn hips_slope_to_all_sides_and_level_roofs_do_not() {
        let hips = steps_of(house(Roof::Hipped { rise_m: 3.0 }));
        assert!(
            hips.iter()
                .skip(1)
                .all(|step| { step.as_ref().unwrap().sides.iter().all(|side| matches!(side, FaceLook::Slope(_))) })
        );
        assert_eq!(steps_of(house(Roof::Flat)), [None]);
        // The house of a lift on a wide roof, a tower on a podium, and two houses of one height side by side.
        let shape = |center: [f64; 3], half: [f64; 3]| OrientedBox {
            center_in_world: DVec3::from_array(center),
            half_extents_m: DVec3::from_array(half),
            yaw_rad: 0.3,
        };
        let podium = shape([0.0, 0.0, 4.0], [20.0, 20.0, 4.0]);
        for upper in [shape([0.0, 0.0, 8.5], [2.0, 2.0, 0.5]), shape([0.0, 0.0, 30.0], [18.0, 18.0, 22.0])] {
            assert_eq!(steps_of(vec![podium, upper]), [None, None]);
        }
    }
}
