//! Shadows: heights of what first catches the sun's light, over ground sheared along the light.
//!
//! A point (x, y, z) and every point on its ray towards the sun fall on the same place of the map,
//! `(x, y) - (z - reference) * sun.xy / sun.z`; it is in shadow when the map's height there is above z.

use crate::eye::Eye;
use crate::frame::TARGET_INSTANCE;
use crate::people::People;
use crate::scene::Scene;
use crate::scene_parts::BOX_FACES;
use crate::shade::lanes::Block;
use crate::shade::pattern::{NoiseTexture, fixed_size};
use crate::shade::shadow_frame::Frame;
use crate::shade::shadow_region::{Region, for_seen_points};
use crate::shade::sunlight::{
    FIGURE_SIDE, FigureShadow, LEAVES, LOWEST_M, Packed, Places, SIDE, SOLID, figure_shadow, measure_tiles, pack,
    town_sunlight,
};
use crate::shade::vector::Vec3;
use crate::visibility::{PlaneOnScreen, Screen, Visibility};
use cosfly_figures::figure::FigureTriangle;
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec2, DVec3};
use cosfly_maps::ObstacleKind;

/// Size of its texels across the sun's direction, metres; along it they grow as the sun sinks.
const TEXEL_M: f64 = 0.2;
/// The town's map moves in steps of this many texels, so that it depends on the frame alone and still is mostly reused.
const STEP_TEXELS: f64 = 128.0;
/// People less high than this on the screen throw no shadow, pixels.
const LEAST_FIGURE_PX: f64 = 4.0;
/// Texels along a side of the maps of other people, by their least height on the screen, pixels.
const SIDES_BY_HEIGHT: [(f64, usize); 3] = [(48.0, FIGURE_SIDE), (20.0, 48), (LEAST_FIGURE_PX, 24)];
/// Posts thinner than this cast the shadow of a post this thick, half width in metres: the map would tear them.
const LEAST_HALF_WIDTH_M: f64 = 0.13;

/// Places this near what the view shows are drawn, too, metres: shading moves points a little.
const MARGIN_M: f64 = 3.0;

/// The town's shadows and the figures'.
pub struct Shadows {
    town: Visibility,
    /// The scene and the place of the map that is drawn, and which part of it.
    town_drawn: Option<(u64, Frame, Region)>,
    /// A scene and the height of its lowest place, metres.
    lowest_m: Option<(u64, f64)>,
    figure: Visibility,
    packed: Packed,
}

impl Shadows {
    /// Empty maps.
    pub fn new() -> Self {
        Self {
            town: Visibility::new(SIDE, SIDE),
            town_drawn: None,
            lowest_m: None,
            figure: Visibility::new(FIGURE_SIDE, FIGURE_SIDE),
            packed: Packed {
                town: fixed_size(vec![]),
                tiles: fixed_size(vec![]),
                figures: Vec::new(),
                places: Places::default(),
            },
        }
    }

    /// Makes the maps right for a frame; draws the town's only when the view or the sun moved enough.
    pub(crate) fn prepare(
        &mut self,
        level: Level,
        scene: &Scene,
        (eye, screen): (&Eye, &Screen),
        to_sun: Vec3,
        people: &People,
    ) {
        let flat = DVec2::new(f64::from(to_sun.x), f64::from(to_sun.y));
        let shear = flat / f64::from(to_sun.z);
        let along = if flat.length() > 1e-6 { flat.normalize() } else { DVec2::Y };
        let axes = [DVec2::new(-along.y, along.x), along];
        let texels_m = TEXEL_M * DVec2::new(1.0, shear.length().clamp(1.0, 3.0));
        let ahead = eye.position_in_world + 90.0 * eye.world_from_body.x_axis;
        let ground = f64::from(scene.grid.sample(ahead.x as f32, ahead.y as f32).ground_m);
        let reference_m = (ground / 8.0).round() * 8.0;
        let mut frame = Frame { corner_m: DVec2::ZERO, reference_m, shear, axes, texels_m };
        let middle = frame.sheared(DVec3::new(ahead.x, ahead.y, reference_m));
        let step = STEP_TEXELS * texels_m;
        frame.corner_m = (middle / step).round() * step - 0.5 * SIDE as f64 * texels_m;
        let region = self.region_seen(scene, eye, screen, &frame);
        let drawn = self.town_drawn.filter(|(id, drawn, _)| (*id, *drawn) == (scene.identity, frame));
        let wanted = drawn.map_or(region, |(.., drawn)| drawn.with(region));
        if drawn.is_none_or(|(.., drawn)| drawn != wanted) {
            self.town_drawn = Some((scene.identity, frame, wanted));
            self.draw_town(level, scene, &frame, to_sun, wanted);
        }
        for (position, person) in people.members.iter().enumerate() {
            if self.packed.figures.len() <= position {
                self.packed.figures.push(FigureShadow { map: fixed_size(vec![]), side: 0, rows: None });
            }
            let by_height = SIDES_BY_HEIGHT.iter().find(|(least_px, _)| person.height_px >= *least_px);
            let side = match person.instance {
                TARGET_INSTANCE => FIGURE_SIDE,
                _ => by_height.map_or(0, |(_, side)| *side),
            };
            let triangles = &people.triangles[person.triangles.clone()];
            let drawn = if side > 0 { self.draw_figure(&frame, to_sun, triangles, side) } else { None };
            let figure = &mut self.packed.figures[position];
            (figure.side, figure.rows) = (side, drawn.map(|frame| frame.rows()));
            if figure.rows.is_some() {
                let (heights, classes) = (&self.figure.inverse_depth, &self.figure.face);
                let whole = Region { first: [0; 2], end: [side; 2] };
                pack(level, heights, classes, FIGURE_SIDE, &whole, &mut *figure.map);
            }
        }
        self.packed.places = Places {
            rows: frame.rows(),
            base_m: (LOWEST_M - reference_m) as f32,
            texels_m: texels_m.as_vec2().to_array(),
            corner_m: frame.corner_m.as_vec2().to_array(),
            low: region.first.map(|texel| texel as f32 + 0.5),
            high: region.end.map(|texel| texel as f32 - 2.0),
        };
    }

    /// The part of the town's map that a view may need, in whole steps: it depends on the frame alone.
    fn region_seen(&mut self, scene: &Scene, eye: &Eye, screen: &Screen, frame: &Frame) -> Region {
        let lowest_m = match self.lowest_m {
            Some((id, lowest_m)) if id == scene.identity => lowest_m,
            _ => lowest_place_m(scene),
        };
        self.lowest_m = Some((scene.identity, lowest_m));
        let margin = MARGIN_M / frame.texels_m;
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for_seen_points(eye, screen, lowest_m, |point| {
            let place = DVec2::from_array(frame.place(point));
            low = low.min(place - margin);
            high = high.max(place + margin);
        });
        Region::around(low, high, SIDE, STEP_TEXELS as usize)
    }

    fn draw_town(&mut self, level: Level, scene: &Scene, frame: &Frame, to_sun: Vec3, part: Region) {
        self.town.clear_part(part.first, part.end);
        let to_sun = DVec3::new(f64::from(to_sun.x), f64::from(to_sun.y), f64::from(to_sun.z));
        for b in &scene.boxes {
            let class = if b.kind == ObstacleKind::TreeCrown { LEAVES } else { SOLID };
            let thin = f64::from(b.half_extents_m.x.min(b.half_extents_m.y));
            let grow = (LEAST_HALF_WIDTH_M / thin.max(0.01)).clamp(1.0, 8.0);
            let upright = b.half_extents_m.z > b.half_extents_m.x.max(b.half_extents_m.y);
            let wide = if upright { DVec3::new(grow, grow, 1.0) } else { DVec3::ONE };
            if frame.misses(&part, b.center_in_world, wide * b.half_bounds_m) {
                continue;
            }
            for (face, (_, _, around)) in BOX_FACES.iter().enumerate() {
                let normal = b.normal_in_world(face);
                if normal.dot(to_sun) > 1e-6 {
                    let corners = around
                        .map(|corner| b.center_in_world + wide * (b.corners_in_world[corner] - b.center_in_world));
                    draw(&mut self.town, (frame, part), to_sun, normal, &corners, class);
                }
            }
        }
        self.draw_props(scene, frame, to_sun, part);
        pack(level, &self.town.inverse_depth, &self.town.face, SIDE, &part, &mut *self.packed.town);
        measure_tiles(level, &self.packed.town, &part, &mut self.packed.tiles);
    }

    /// Both sides of a model's triangles throw shadows.
    fn draw_props(&mut self, scene: &Scene, frame: &Frame, to_sun: DVec3, part: Region) {
        for prop in &scene.props.props {
            if frame.misses(&part, prop.center_in_world, prop.half_bounds_m) {
                continue;
            }
            let class = if prop.is_leafy { LEAVES } else { SOLID };
            for triangle in &scene.props.triangles[prop.triangles.clone()] {
                let facing = triangle.normal_in_world.dot(to_sun);
                if facing.abs() > 1e-6 {
                    let normal = triangle.normal_in_world * facing.signum();
                    draw(&mut self.town, (frame, part), to_sun, normal, &triangle.corners_in_world, class);
                }
            }
        }
    }

    /// Draws a figure's shadow into the first `side` rows and columns of the scratch map; says where they lie.
    fn draw_figure(
        &mut self,
        town_frame: &Frame,
        to_sun: Vec3,
        triangles: &[FigureTriangle],
        side: usize,
    ) -> Option<Frame> {
        self.figure.clear_part([0; 2], [side; 2]);
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for corner in triangles.iter().flat_map(|triangle| triangle.corners_in_world) {
            let at = town_frame.sheared(corner);
            low = low.min(at);
            high = high.max(at);
        }
        let size = high - low;
        if !size.is_finite() || size.min_element() <= 0.0 || size.max_element() > 100.0 {
            return None;
        }
        let texels_m = size / (side as f64 - 4.0);
        let whole = Region { first: [0; 2], end: [side; 2] };
        let frame = Frame { corner_m: low - 2.0 * texels_m, texels_m, ..*town_frame };
        let to_sun = DVec3::new(f64::from(to_sun.x), f64::from(to_sun.y), f64::from(to_sun.z));
        for triangle in triangles.iter().filter(|triangle| triangle.normal_in_world.dot(to_sun) > 1e-6) {
            let normal = triangle.normal_in_world;
            draw(&mut self.figure, (&frame, whole), to_sun, normal, &triangle.corners_in_world, SOLID);
        }
        Some(frame)
    }

    /// Fills in which share of the sun's light reaches each pixel's place. On flat surfaces, the pixels between the ends
    /// of a four that are lit alike are lit like them. Of people, only those numbered in `near` count.
    pub fn sunlight(&self, level: Level, blocks: &mut [Block], flat: bool, noise: &NoiseTexture, near: &[u32]) {
        let Packed { town, tiles, places, .. } = &self.packed;
        town_sunlight(level, blocks, town, tiles, places, flat, noise);
        for figure in near.iter().filter_map(|person| self.packed.figures.get(*person as usize)) {
            if let Some(rows) = &figure.rows {
                figure_shadow(level, blocks, &figure.map, figure.side, self.packed.places.base_m, rows);
            }
        }
    }
}

/// Height of the lowest box or ground.
fn lowest_place_m(scene: &Scene) -> f64 {
    let boxes = scene.boxes.iter().map(|b| b.center_in_world.z - b.half_bounds_m.z);
    let ground = scene.clusters.iter().map(|cluster| cluster.center_in_world.z - cluster.half_bounds_m.z);
    boxes.chain(ground).fold(f64::INFINITY, f64::min)
}

/// Draws a face that the sun shines on, where a part of the map needs it: its height is affine over the sheared ground.
fn draw(
    map: &mut Visibility,
    (frame, part): (&Frame, Region),
    to_sun: DVec3,
    normal: DVec3,
    corners: &[DVec3],
    class: u32,
) {
    let mut points = [[0.0; 2]; 4];
    for (point, corner) in points.iter_mut().zip(corners) {
        *point = frame.place(*corner);
    }
    let points = &points[..corners.len().min(4)];
    let Some(rows) = map.rows_within(points, part.first, part.end) else { return };
    // Along the map's x axis the face's point moves by (1, 0, 0) + slope * sun / sun.z with no way along the normal.
    let facing = normal.dot(to_sun) / to_sun.z;
    let slope = -normal.truncate() / facing;
    let across = slope.dot(frame.axes[0]) * frame.texels_m.x;
    let down = slope.dot(frame.axes[1]) * frame.texels_m.y;
    let constant = frame.height(corners[0]) - across * points[0][0] - down * points[0][1];
    map.draw_rows(points, rows, &PlaneOnScreen { constant, across, down }, class);
}
