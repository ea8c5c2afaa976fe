//! Things beside the road into solid boxes: buildings, trees, poles, lamps, walls, furniture.

use super::network::{Corner, Outline, Repeat, Road, RoadObject};
use super::object_kind::{ObjectKind, kind_of};
use cosfly_domain::{Obstacle, ObstacleKind, OrientedBox};
use cosfly_frames::{DVec2, DVec3, real};
use cosfly_town::crown::crown_boxes;
use cosfly_town::solids::{CoarseThings, Footprint, Roof, building_boxes};
use cosfly_town::world::WorldFromMap;

/// Most boxes of one file.
pub(super) const MOST_OBSTACLES: usize = 500_000;
/// Thickness of walls and fences whose file gives none, metres.
const DEFAULT_THICKNESS_M: f64 = 0.15;
/// Objects lower than this are paint or plates in the ground.
const LOWEST_M: f64 = 0.05;
/// Longest straight piece of a continuous wall, metres, in a curve; straight ones are not cut.
const WALL_CHORD_M: f64 = 0.1;
/// Pitch of a guessed roof, degrees.
pub(super) const ROOF_PITCH_DEG: f64 = 45.0;
/// Highest rise of a guessed roof, metres.
const HIGHEST_ROOF_M: f64 = 8.0;
/// Lowest buildings that get a guessed roof, metres.
const LOWEST_EAVES_M: f64 = 2.5;
/// Widths of buildings that get a guessed roof, metres.
const ROOF_WIDTHS_M: core::ops::RangeInclusive<f64> = 4.0..=20.0;

/// The growing list of obstacles of a file.
#[derive(Debug, Default)]
pub(super) struct ObstacleBuilder {
    pub(super) obstacles: Vec<Obstacle>,
    next_object_id: u32,
    /// Whether buildings get a roof that the file does not have.
    pub(super) guess_roofs: bool,
    /// Buildings that got one.
    pub(super) guessed_roofs: usize,
    /// Things whose boxes are coarser than they should be.
    pub(super) coarse: CoarseThings,
    /// Trees whose crown is our assumption.
    pub(super) assumed_crowns: usize,
    /// Signs whose plate and pole are our assumption.
    pub(super) bare_signs: usize,
    /// Objects that gave no usable size.
    pub(super) without_size: usize,
    /// Copies of repeated objects, with or without a box.
    copies: usize,
    /// Boxes or copies beyond [`MOST_OBSTACLES`].
    pub(super) left_out: usize,
}

/// A solid before it becomes a box: foot and top of a footprint, map frame.
#[derive(Clone, Copy, Debug)]
struct Block {
    center_in_map: DVec2,
    half_extents_m: DVec2,
    heading_rad: f64,
    bottom_m: f64,
    top_m: f64,
}

impl ObstacleBuilder {
    /// A new thing; all boxes until the next call belong to it.
    pub(super) fn begin_object(&mut self) {
        self.next_object_id += 1;
    }

    fn push(&mut self, kind: ObstacleKind, block: Block, world: &WorldFromMap) {
        let height_m = (block.top_m - block.bottom_m).max(0.0);
        let center = world.point(block.center_in_map.extend(0.5 * (block.top_m + block.bottom_m)));
        let half_extents_m = block.half_extents_m.abs().extend(0.5 * height_m);
        if center.is_finite() && half_extents_m.is_finite() {
            let yaw_rad = world.yaw_rad(block.heading_rad);
            self.push_shape(kind, OrientedBox { center_in_world: center, half_extents_m, yaw_rad });
        }
    }

    fn push_shape(&mut self, kind: ObstacleKind, shape: OrientedBox) {
        if self.obstacles.len() >= MOST_OBSTACLES {
            self.left_out += 1;
            return;
        }
        let object_id = self.next_object_id;
        let one = |shape| Obstacle { shape, kind, object_id, synthetic: false };
        if kind == ObstacleKind::TreeCrown {
            self.obstacles.extend(crown_boxes(&shape, object_id).map(one));
        } else {
            self.obstacles.push(one(shape));
        }
    }

    /// An upright box with a square or given footprint.
    pub(super) fn push_upright(
        &mut self,
        kind: ObstacleKind,
        foot_in_map: DVec3,
        half_extents_m: DVec2,
        heading_rad: f64,
        height_m: f64,
        world: &WorldFromMap,
    ) {
        let (bottom_m, top_m) = (foot_in_map.z, foot_in_map.z + height_m);
        let block = Block { center_in_map: foot_in_map.truncate(), half_extents_m, heading_rad, bottom_m, top_m };
        self.push(kind, block, world);
    }

    /// Adds one `<object>`; flat and painted things give nothing.
    pub(super) fn add(&mut self, road: &Road, object: &RoadObject, world: &WorldFromMap) {
        let ObjectKind::Solid(kind) = kind_of(object) else { return };
        if self.left_out > 0 {
            return;
        }
        self.begin_object();
        let before = self.obstacles.len();
        if !object.repeats.is_empty() {
            for repeat in &object.repeats {
                self.add_repeat(road, object, kind, repeat, world);
            }
        } else if object.outlines.iter().any(|outline| outline.corners.len() >= 2) {
            self.add_outlines(road, object, kind, world);
        } else {
            let foot = road.point(object.at.s_m, object.at.t_m, object.at.z_offset_m);
            let heading_rad = road.plan_point(object.at.s_m).heading_rad + object.heading_rad;
            let footprint = DVec2::new(object.size.length_m, object.size.width_m);
            self.add_single(object, kind, foot, heading_rad, footprint, object.size.height_m, world);
        }
        if self.obstacles.len() == before {
            self.without_size += 1;
        }
    }

    /// A thing at one place, from its sizes.
    #[expect(clippy::too_many_arguments, reason = "a repeat overrides place and sizes of its object one by one")]
    fn add_single(
        &mut self,
        object: &RoadObject,
        kind: ObstacleKind,
        foot: DVec3,
        heading_rad: f64,
        footprint_m: DVec2,
        height_m: f64,
        world: &WorldFromMap,
    ) {
        if kind == ObstacleKind::TreeTrunk {
            return self.add_tree(object, foot, heading_rad, footprint_m, height_m, world);
        }
        if kind == ObstacleKind::TrafficSign && height_m < LOWEST_M {
            return self.add_bare_sign(foot, heading_rad, world);
        }
        let radius_m = object.size.radius_m;
        let half = if radius_m > 0.0 { DVec2::splat(radius_m) } else { 0.5 * footprint_m };
        let thin = matches!(kind, ObstacleKind::Pole | ObstacleKind::Lamp | ObstacleKind::TrafficLight);
        let half = if half.min_element() > 0.0 {
            half
        } else if thin {
            DVec2::splat(0.06)
        } else {
            half.max(DVec2::splat(0.5 * DEFAULT_THICKNESS_M))
        };
        let flat = !thin && radius_m <= 0.0 && footprint_m.max_element() <= 0.0;
        if height_m >= LOWEST_M && !flat {
            self.push_upright(kind, foot, half, heading_rad, height_m, world);
        }
    }

    /// A sign whose file gives only its foot: a plate of usual size on a pole.
    fn add_bare_sign(&mut self, foot: DVec3, heading_rad: f64, world: &WorldFromMap) {
        const LOWER_END_M: f64 = 2.3;
        const PLATE_M: f64 = 0.6;
        self.bare_signs += 1;
        self.push_upright(ObstacleKind::Pole, foot, DVec2::splat(0.05), heading_rad, LOWER_END_M, world);
        let half = DVec2::new(0.025, 0.5 * PLATE_M);
        self.push_upright(ObstacleKind::TrafficSign, foot + LOWER_END_M * DVec3::Z, half, heading_rad, PLATE_M, world);
    }

    /// Trunk and crown. A radius below 0.6 m is the trunk's (as surveys give it), a larger one the crown's. Where
    /// the file has no crown: radius 0.2 of the height within 1 to 4.5 m, from 0.35 of the height upwards.
    fn add_tree(
        &mut self,
        object: &RoadObject,
        foot: DVec3,
        heading_rad: f64,
        footprint_m: DVec2,
        height_m: f64,
        world: &WorldFromMap,
    ) {
        let height_m = if height_m > 0.0 { height_m } else { 7.0 };
        let stated_m = if object.size.radius_m > 0.0 { object.size.radius_m } else { 0.5 * footprint_m.max_element() };
        let stated_crown_m = object.crown.radius_m.or((stated_m >= 0.6).then_some(stated_m));
        let trunk_m = if stated_m > 0.0 && stated_m < 0.6 { stated_m } else { (0.015 * height_m).clamp(0.08, 0.4) };
        let crown_m = stated_crown_m.unwrap_or((0.2 * height_m).clamp(1.0, 4.5)).max(0.0);
        let base_m = object.crown.base_m.unwrap_or(0.35 * height_m).clamp(0.0, height_m);
        if stated_crown_m.is_none() || object.crown.base_m.is_none() {
            self.assumed_crowns += 1;
        }
        self.push_upright(ObstacleKind::TreeTrunk, foot, DVec2::splat(trunk_m), heading_rad, base_m, world);
        let crown_foot = foot + base_m * DVec3::Z;
        self.push_upright(
            ObstacleKind::TreeCrown,
            crown_foot,
            DVec2::splat(crown_m),
            heading_rad,
            height_m - base_m,
            world,
        );
    }

    fn add_repeat(
        &mut self,
        road: &Road,
        object: &RoadObject,
        kind: ObstacleKind,
        repeat: &Repeat,
        world: &WorldFromMap,
    ) {
        let [start_s_m, end_s_m] = repeat.s_m;
        let length_m = end_s_m - start_s_m;
        let at = |share: f64| {
            let s_m = (start_s_m + share * length_m).clamp(0.0, road.length_m);
            let mix = |pair: [f64; 2]| pair[0] + share * (pair[1] - pair[0]);
            (s_m, road.point(s_m, mix(repeat.t_m), mix(repeat.z_offset_m)), mix(repeat.width_m), mix(repeat.height_m))
        };
        if repeat.distance_m > 0.0 {
            let copies = (length_m / repeat.distance_m + 1e-9).floor().min(MOST_OBSTACLES as f64) as usize;
            for copy in 0..=copies {
                let share = if length_m > 0.0 { (copy as f64 * repeat.distance_m / length_m).min(1.0) } else { 0.0 };
                let (s_m, foot, width_m, height_m) = at(share);
                let heading_rad = road.plan_point(s_m).heading_rad + object.heading_rad;
                if copy > 0 {
                    self.begin_object();
                }
                self.copies += 1;
                self.left_out += usize::from(self.copies > MOST_OBSTACLES);
                self.add_single(
                    object,
                    kind,
                    foot,
                    heading_rad,
                    DVec2::new(object.size.length_m, width_m),
                    height_m,
                    world,
                );
                if self.left_out > 0 {
                    return;
                }
            }
            return;
        }
        let mut pieces = 1_usize;
        while pieces < 256 && (0..pieces).any(|i| sagitta_m(&at, i, pieces) > WALL_CHORD_M) {
            pieces *= 2;
        }
        for piece in 0..pieces {
            let (low, high) = (at(piece as f64 / pieces as f64), at((piece + 1) as f64 / pieces as f64));
            self.add_wall(kind, [low.1, high.1], [low.3, high.3], low.2.max(high.2), world);
        }
    }

    /// A straight piece of wall between two feet; it covers the higher of both ends.
    fn add_wall(
        &mut self,
        kind: ObstacleKind,
        feet: [DVec3; 2],
        heights_m: [f64; 2],
        thickness_m: f64,
        world: &WorldFromMap,
    ) {
        let along = feet[1].truncate() - feet[0].truncate();
        let top_m = (feet[0].z + heights_m[0]).max(feet[1].z + heights_m[1]);
        let bottom_m = feet[0].z.min(feet[1].z);
        let thickness_m = if thickness_m > 0.0 { thickness_m } else { DEFAULT_THICKNESS_M };
        if heights_m[0].max(heights_m[1]) < LOWEST_M {
            return;
        }
        let block = Block {
            center_in_map: 0.5 * (feet[0] + feet[1]).truncate(),
            half_extents_m: DVec2::new(0.5 * along.length(), 0.5 * thickness_m),
            heading_rad: real::atan2(along.y, along.x),
            bottom_m,
            top_m,
        };
        self.push(kind, block, world);
    }

    /// Open outlines are walls; closed ones are areas, less those that are courtyards.
    fn add_outlines(&mut self, road: &Road, object: &RoadObject, kind: ObstacleKind, world: &WorldFromMap) {
        let plan = |corners: &[(DVec3, f64)]| -> Vec<DVec2> {
            corners.iter().map(|(foot, _)| world.point(*foot).truncate()).collect()
        };
        let holes = object.outlines.iter().filter(|outline| outline.closed && outline.is_hole);
        let holes: Vec<Vec<DVec2>> = holes.map(|hole| plan(&outline_in_map(road, object, hole))).collect();
        for outline in object.outlines.iter().filter(|outline| !(outline.closed && outline.is_hole)) {
            let corners = outline_in_map(road, object, outline);
            if outline.closed {
                let footprint = Footprint { outer: plan(&corners), holes: holes.clone() };
                self.add_area((kind, object.roof), &footprint, &corners, world);
            } else {
                for pair in corners.windows(2) {
                    self.add_wall(kind, [pair[0].0, pair[1].0], [pair[0].1, pair[1].1], object.size.width_m, world);
                }
            }
        }
    }

    fn add_area(
        &mut self,
        (kind, stated): (ObstacleKind, Roof),
        footprint: &Footprint,
        corners: &[(DVec3, f64)],
        world: &WorldFromMap,
    ) {
        let tallest_m = corners.iter().map(|(_, height_m)| *height_m).fold(0.0, f64::max);
        if tallest_m < LOWEST_M || corners.len() < 2 {
            return;
        }
        let bottom_m = corners.iter().map(|(foot, _)| foot.z).fold(f64::INFINITY, f64::min) - world.offset_m.z;
        let top_m = corners.iter().map(|(foot, height_m)| foot.z + height_m).fold(f64::NEG_INFINITY, f64::max)
            - world.offset_m.z;
        let is_guessed = self.guess_roofs && kind == ObstacleKind::Building && stated == Roof::Flat;
        let roof = if is_guessed { guessed_roof(footprint, top_m - bottom_m) } else { stated };
        self.guessed_roofs += usize::from(is_guessed && roof != Roof::Flat);
        let solid = building_boxes(footprint, bottom_m, top_m, roof);
        self.coarse.add(&solid);
        for shape in solid.boxes {
            self.push_shape(kind, shape);
        }
    }
}

/// See [`super::options::Roofs::Pitched`].
fn guessed_roof(footprint: &Footprint, eaves_m: f64) -> Roof {
    let width_m = footprint.wing_width_m();
    if eaves_m < LOWEST_EAVES_M || !ROOF_WIDTHS_M.contains(&width_m) {
        return Roof::Flat;
    }
    let rise_m = (0.5 * width_m * real::tan(ROOF_PITCH_DEG.to_radians())).min(HIGHEST_ROOF_M);
    Roof::Gabled { rise_m, ridge_yaw_rad: None }
}

fn sagitta_m(at: &impl Fn(f64) -> (f64, DVec3, f64, f64), piece: usize, pieces: usize) -> f64 {
    let point = |part: f64| at((piece as f64 + part) / pieces as f64).1;
    point(0.0).lerp(point(1.0), 0.5).distance(point(0.5))
}

/// Corners of an outline (foot in the map, height of the object there), a repeated first corner dropped.
pub(super) fn outline_in_map(road: &Road, object: &RoadObject, outline: &Outline) -> Vec<(DVec3, f64)> {
    let origin = road.point(object.at.s_m, object.at.t_m, object.at.z_offset_m);
    let heading_rad = road.plan_point(object.at.s_m).heading_rad + object.heading_rad;
    let (sin, cos) = real::sin_cos(heading_rad);
    let mut corners: Vec<(DVec3, f64)> = outline
        .corners
        .iter()
        .map(|corner| match *corner {
            Corner::Road { at, height_m } => (road.point(at.s_m, at.t_m, at.z_offset_m), height_m),
            Corner::Local { u_m, v_m, z_m, height_m } => {
                (origin + DVec3::new(cos * u_m - sin * v_m, sin * u_m + cos * v_m, z_m), height_m)
            }
        })
        .collect();
    while outline.closed && corners.len() > 1 && corners[0].0.distance(corners[corners.len() - 1].0) < 1e-3 {
        corners.pop();
    }
    corners
}
