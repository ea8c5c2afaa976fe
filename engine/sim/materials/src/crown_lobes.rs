//! Crowns of boxes within each other, drawn as lobes: clumps of leaves at the ends of boughs, with gaps between them.
//!
//! Each lobe, tier and bough lies within one of the crown's boxes. What a tree looks like follows from its boxes and its id:
//! broad, oval or columnar after the crown's height and width, and some of the high ones are conifers.

use crate::parts::{Lobe, SceneBox};
use crate::pattern::draw;
use cosfly_domain::ObstacleKind;
use cosfly_frames::{DVec2, DVec3, real};

/// Crowns less wide than this on either side of the trunk stay as they are, metres.
const LEAST_M: f64 = 0.45;
/// Lobes of a crown as high as it is wide; how many more for each width that it is higher; at least and at most.
const LOBES: f64 = 6.0;
const LOBES_PER_WIDTH: f64 = 2.0;
const LOBES_WITHIN: [f64; 2] = [6.0, 8.0];
/// Half width of a lobe as a share of the crown's, and its spread.
const LOBE_SHARE: f64 = 0.47;
const LOBE_SPREAD: f64 = 0.25;
/// Height of a lobe as a share of its width.
const FLAT: f64 = 0.75;
/// Golden angle, radians: lobes one above the other lie on all sides.
const AROUND_RAD: f64 = 2.399_963_229_728_653;
/// Crowns higher than this many widths may be conifers, and the share of those that are.
const CONIFER_WIDTHS: f64 = 1.2;
const CONIFERS: f32 = 0.3;
/// Tiers of a conifer, and how far each reaches into the one above.
const TIERS: usize = 5;
const TIER_HEIGHT: f64 = 1.7;
/// Half width of a trunk that the map does not have, as a share of the crown's.
const TRUNK: f64 = 0.05;
/// Half widths of a bough and its end, as shares of the trunk's.
const BOUGH: [f64; 2] = [0.55, 0.25];
/// Lobes farther out than this share of the crown's half width have a bough.
const FAR_OUT: f64 = 0.65;
/// Size of the round lobe as a share of the half widths of its box.
const ROUND: f64 = 1.02;

/// The crown that boxes within each other make.
struct Nest<'a> {
    boxes: &'a [&'a SceneBox],
    /// The box as high as the whole crown.
    core: &'a SceneBox,
    /// Half the width of the crown, metres; its foot and top above the reference.
    wide_m: f64,
    low_m: f64,
    high_m: f64,
    /// Half the width of the trunk below, metres.
    trunk_m: f64,
}

/// What is drawn of a crown whose boxes lie within each other, above its trunk; `None` for other ones, and for those too small for
/// lobes.
pub fn lobes(boxes: &[&SceneBox], trunk: Option<&SceneBox>) -> Option<Vec<SceneBox>> {
    let nest = Nest::of(boxes, trunk)?;
    let is_conifer =
        nest.high_m - nest.low_m > CONIFER_WIDTHS * 2.0 * nest.wide_m && nest.draw(40) < f64::from(CONIFERS);
    Some(if is_conifer { nest.tiers() } else { nest.broad() })
}

/// Foot and top of a box, metres.
fn ends_m(b: &SceneBox) -> [f64; 2] {
    [-1.0, 1.0].map(|side| b.center_in_world.z + side * b.half_bounds_m.z)
}

impl<'a> Nest<'a> {
    fn of(boxes: &'a [&'a SceneBox], trunk: Option<&SceneBox>) -> Option<Self> {
        let core = *boxes.iter().max_by(|a, b| a.half_bounds_m.z.total_cmp(&b.half_bounds_m.z))?;
        let [low_m, high_m] = ends_m(core);
        let is_within = |b: &&SceneBox| {
            let ([low, high], own) = (ends_m(b), inside(b, core.center_in_world.truncate()));
            low >= low_m - 1e-6 && high <= high_m + 1e-6 && own.abs().cmplt(half_of(b)).all()
        };
        let wide_m = boxes.iter().map(|b| half_of(b).min_element()).fold(0.0, f64::max);
        let is_nest = boxes.len() > 1 && core.kind == ObstacleKind::TreeCrown && boxes.iter().all(is_within);
        let trunk_m = trunk.map_or(TRUNK * wide_m, |trunk| half_of(trunk).min_element()).min(0.45 * wide_m);
        (is_nest && wide_m > LEAST_M).then_some(Self { boxes, core, wide_m, trunk_m, low_m, high_m })
    }

    fn draw(&self, index: u32) -> f64 {
        f64::from(draw(self.core.instance, index))
    }

    /// Where a place lies from the middle of the crown, as a share of half its size; at most 1.
    fn aside(&self, place: DVec3) -> DVec3 {
        let half_m = DVec2::splat(0.6 * self.wide_m).extend(0.5 * (self.high_m - self.low_m));
        ((place - self.core.center_in_world) / half_m).clamp_length_max(1.0)
    }

    fn axis(&self) -> DVec2 {
        self.core.center_in_world.truncate()
    }

    /// The box in which a square along its own axes may lie farthest from the crown's axis in a direction, among those that hold
    /// a range of heights; and how far.
    fn farthest(&self, ends: [f64; 2], along: DVec2, half_m: f64) -> Option<(&'a SceneBox, f64)> {
        let holds = |b: &&&SceneBox| ends_m(b)[0] <= ends[0] + 1e-9 && ends_m(b)[1] >= ends[1] - 1e-9;
        let reach = |b: &&'a SceneBox| {
            let (from, way) = (inside(b, self.axis()), turned(b, along));
            let side = |axis: usize| {
                let room_m = half_of(b)[axis] - half_m - from[axis] * way[axis].signum();
                if way[axis].abs() < 1e-9 { f64::INFINITY } else { room_m / way[axis].abs() }
            };
            let is_clear = (half_of(b) - from.abs()).min_element() >= half_m;
            is_clear.then_some((*b, side(0).min(side(1))))
        };
        self.boxes.iter().filter(holds).filter_map(reach).max_by(|one, other| one.1.total_cmp(&other.1))
    }

    /// Lobes around the axis from the foot to the top, a trunk among them and boughs to some.
    fn broad(&self) -> Vec<SceneBox> {
        let height_m = self.high_m - self.low_m;
        let slender = height_m / (2.0 * self.wide_m);
        let count = (LOBES + LOBES_PER_WIDTH * (slender - 1.0)).round().clamp(LOBES_WITHIN[0], LOBES_WITHIN[1]);
        let turn = core::f64::consts::TAU * self.draw(41);
        let mut drawn = vec![];
        for number in 0..count as u32 {
            let share = (f64::from(number) + 0.5) / count;
            let size = 1.0 + LOBE_SPREAD * (2.0 * self.draw(50 + number) - 1.0);
            let angle_rad = turn + AROUND_RAD * f64::from(number) + 0.5 * (self.draw(70 + number) - 0.5);
            let (sin, cos) = real::sin_cos(angle_rad);
            let along = DVec2::new(cos, sin);
            let wide_m = LOBE_SHARE * size * self.wide_m;
            let half_m = (FLAT * wide_m).min(0.2 * height_m);
            let is_top = number + 1 == count as u32;
            let middle_m = self.low_m + half_m + if is_top { 1.0 } else { share } * (height_m - 2.0 * half_m);
            let ends = [middle_m - half_m, middle_m + half_m];
            // Near the ends of the crown there is less room.
            let sizes = [1.0, 0.85, 0.7].map(|less| less * wide_m);
            let Some((wide_m, (b, reach_m))) =
                sizes.into_iter().find_map(|wide_m| Some((wide_m, self.farthest(ends, along, wide_m)?)))
            else {
                continue;
            };
            let reach_m = if is_top { 0.3 * reach_m } else { reach_m };
            let place = (self.axis() + reach_m * along).extend(middle_m);
            drawn.push(lobe(b, place, [wide_m, half_m], share, self.aside(place)));
            if (number == 1 || reach_m > FAR_OUT * self.wide_m) && !is_top {
                drawn.extend(self.bough(place, ends[0]));
            }
        }
        drawn.extend(self.trunk(0.7));
        drawn
    }

    /// The trunk within the crown, up to a share of its height.
    fn trunk(&self, to: f64) -> Option<SceneBox> {
        let ends = [self.low_m, self.low_m + to * (self.high_m - self.low_m)];
        let rings = [0.95, 0.35].map(|thin| (self.axis(), thin * self.trunk_m));
        let mut trunk = prism(self.core, rings, ends);
        trunk.kind = ObstacleKind::TreeTrunk;
        Some(trunk)
    }

    /// A bough from the trunk to a lobe.
    fn bough(&self, to: DVec3, from_m: f64) -> Option<SceneBox> {
        let ends = [from_m, to.z];
        let [root_m, end_m] = BOUGH.map(|share| share * self.trunk_m);
        let away = to.truncate() - self.axis();
        let (_, reach_m) = self.farthest(ends, away.normalize_or(DVec2::X), root_m)?;
        (reach_m >= away.length()).then(|| {
            let mut bough = prism(self.core, [(self.axis(), root_m), (to.truncate(), end_m)], ends);
            bough.kind = ObstacleKind::TreeTrunk;
            bough
        })
    }

    /// Tiers of a conifer, each wide below.
    fn tiers(&self) -> Vec<SceneBox> {
        let height_m = self.high_m - self.low_m;
        let tier = |number: usize| {
            let step = 1.0 / TIERS as f64;
            let low = if number == 0 { 0.02 } else { 0.09 + 0.91 * step * number as f64 };
            let high = (low + step * TIER_HEIGHT).min(1.0);
            let ends = [low, high].map(|share| self.low_m + share * height_m);
            let wanted_m = self.wide_m * (1.12 - 0.98 * low) * (0.92 + 0.16 * self.draw(50 + number as u32));
            let sizes = (0..40).map(|less| wanted_m * (1.0 - 0.025 * f64::from(less)));
            let (b, disc_m) = sizes.into_iter().find_map(|m| Some((self.farthest(ends, DVec2::X, m)?.0, m)))?;
            let top = if number + 1 == TIERS { 0.06 } else { 0.34 };
            let mut b = prism(b, [1.0, top].map(|width| (self.axis(), width * disc_m)), ends);
            let middle = self.axis().extend(0.55 * ends[0] + 0.45 * ends[1]);
            let half = DVec3::new(disc_m, disc_m, 0.5 * (ends[1] - ends[0])) * ROUND;
            let (middle, half, aside) = (middle.as_vec3a(), half.as_vec3a(), (0.5 * DVec3::Z).as_vec3a());
            b.lobe = Some(Lobe { middle, half, aside, light: light(low), is_conifer: true });
            Some(b)
        };
        (0..TIERS).filter_map(tier).chain(self.trunk(0.3)).collect()
    }
}

/// A lobe along the axes of a box, at a share of the crown's height: wide below in its upper half, above in its lower one.
fn lobe(like: &SceneBox, place: DVec3, [wide_m, half_m]: [f64; 2], share: f64, aside: DVec3) -> SceneBox {
    let widths = if share > 0.4 { [1.0, 0.62] } else { [0.66, 1.0] };
    let rings = widths.map(|width| (place.truncate(), width * wide_m));
    let mut lobe = prism(like, rings, [place.z - half_m, place.z + half_m]);
    let half = DVec3::new(ROUND * wide_m, ROUND * wide_m, half_m).as_vec3a();
    let (middle, aside) = (place.as_vec3a(), aside.as_vec3a());
    lobe.lobe = Some(Lobe { middle, half, aside, light: light(share), is_conifer: false });
    lobe
}

/// Light at a share of the crown's height.
fn light(share: f64) -> f32 {
    (0.74 + 0.42 * share) as f32
}

/// A place in plan in a box's own axes, from its middle.
fn inside(b: &SceneBox, place: DVec2) -> DVec2 {
    turned(b, place - b.center_in_world.truncate())
}

fn turned(b: &SceneBox, way: DVec2) -> DVec2 {
    DVec2::new(way.dot(b.axes_in_world[0].truncate()), way.dot(b.axes_in_world[1].truncate()))
}

fn half_of(b: &SceneBox) -> DVec2 {
    b.half_extents_m.truncate().as_dvec2()
}

/// A box with squares along the axes of another for its foot and top: their middles in plan and half widths, and the heights of both.
fn prism(like: &SceneBox, rings: [(DVec2, f64); 2], ends_m: [f64; 2]) -> SceneBox {
    let mut prism = like.clone();
    let axes = like.axes_in_world.map(|axis| axis.truncate());
    for (number, corner) in prism.corners_in_world.iter_mut().enumerate() {
        let (middle, half_m) = rings[number / 4];
        let side = |bit: usize| if number & bit == 0 { -half_m } else { half_m };
        *corner = (middle + side(1) * axes[0] + side(2) * axes[1]).extend(ends_m[number / 4]);
    }
    let half_m = rings[0].1.max(rings[1].1) as f32;
    (prism.half_extents_m.x, prism.half_extents_m.y) = (half_m, half_m);
    prism.fit_to_corners();
    prism
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parts::{BOX_FACES, boxes_of};
    use cosfly_domain::{Obstacle, OrientedBox, Town};
    use cosfly_town::crown::crown_boxes;

    /// A tree, its boxes and what is drawn of it.
    fn tree(object_id: u32, half_extents_m: DVec3) -> (Vec<OrientedBox>, Vec<SceneBox>) {
        let space = OrientedBox { center_in_world: DVec3::new(30.0, -8.0, 9.0), half_extents_m, yaw_rad: 0.7 };
        let shapes = crown_boxes(&space, object_id).to_vec();
        let one = |shape: &OrientedBox| Obstacle {
            shape: *shape,
            kind: ObstacleKind::TreeCrown,
            object_id,
            synthetic: false,
        };
        let boxes = boxes_of(&Town { obstacles: shapes.iter().map(one).collect(), ..Town::default() }, 1);
        let drawn = lobes(&boxes.iter().collect::<Vec<_>>(), None).expect("lobes");
        (shapes, drawn)
    }

    #[test]
    fn each_lobe_and_bough_lies_within_one_box_of_the_crown() {
        for id in 0..300 {
            let (shapes, drawn) = tree(id, DVec3::new(2.4, 2.4, 1.5 + 0.02 * f64::from(id)));
            let holds = |shape: &OrientedBox, b: &SceneBox| {
                b.corners_in_world.iter().all(|corner| {
                    let away = *corner - shape.center_in_world;
                    let own = DVec2::from_angle(-shape.yaw_rad).rotate(away.truncate()).extend(away.z);
                    (own.abs() - shape.half_extents_m).max_element() < 1e-6
                })
            };
            assert!(drawn.iter().all(|b| shapes.iter().any(|shape| holds(shape, b))), "{id}");
            for (b, (face, (_, _, around))) in
                drawn.iter().flat_map(|b| BOX_FACES.iter().enumerate().map(move |it| (b, it)))
            {
                let [from, normal] = [b.corners_in_world[around[0]], b.normal_in_world(face)];
                assert!(around.iter().all(|corner| (b.corners_in_world[*corner] - from).dot(normal).abs() < 1e-6));
            }
        }
    }

    #[test]
    fn crowns_have_several_lobes_that_fill_them_with_gaps_and_some_high_ones_are_conifers() {
        let mut conifers = 0;
        for id in 0..300 {
            let (shapes, drawn) = tree(id, DVec3::new(2.0, 2.0, 3.0));
            let lobes: Vec<&SceneBox> = drawn.iter().filter(|b| b.lobe.is_some()).collect();
            assert!((5..=9).contains(&lobes.len()), "{}", lobes.len());
            conifers += usize::from(lobes.iter().all(|b| b.lobe.is_some_and(|lobe| lobe.is_conifer)));
            let top_m = |all: &mut dyn Iterator<Item = f64>| all.fold(0.0, f64::max);
            let drawn_m = top_m(&mut lobes.iter().map(|b| b.center_in_world.z + b.half_bounds_m.z));
            let map_m = top_m(&mut shapes.iter().map(|it| it.center_in_world.z + it.half_extents_m.z));
            assert!((drawn_m - map_m).abs() < 1e-6, "the top stays");
        }
        assert!((60..120).contains(&conifers), "{conifers}");
        let flat = (0..100).flat_map(|id| tree(id, DVec3::new(3.0, 3.0, 2.0)).1);
        assert!(flat.filter_map(|b| b.lobe).all(|lobe| !lobe.is_conifer));
    }
}
