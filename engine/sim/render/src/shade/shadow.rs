//! Shadows: heights of what first catches the sun's light, over ground sheared along the light.
//!
//! A point (x, y, z) and every point on its ray towards the sun fall on the same place of the map,
//! `(x, y) - (z - reference) * sun.xy / sun.z`; it is in shadow when the map's height there is above z.

use crate::people::People;
use crate::scene::Scene;
use crate::shade::body_shadow::{HEIGHTS, Heights, draw_person};
use crate::shade::sun_map::draw;
use crate::shade::sun_tiles::Sun;
use crate::shade::sun_window::Window;
use crate::shade::sunlight::{
    COVERED, FIGURE_SIDE, FigureShadow, Places, SOLID, figure_shadow, pack_figure, town_sunlight,
};
use cosfly_domain::TARGET_INSTANCE;
use cosfly_figures::{BodyShape, FigureParts, FigureTriangle};
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec2, DVec3, real};
use cosfly_materials::lanes::Block;
use cosfly_materials::pattern::{NoiseTexture, fixed_size};
use cosfly_materials::vector::Vec3;
use cosfly_raster::eye::Eye;
use cosfly_raster::seen_region::SeenRegion;
use cosfly_raster::shadow_frame::ShadowFrame;
use cosfly_raster::visibility::{Screen, VisibilityBuffer};

/// People less high than this on the screen throw no shadow, pixels.
const LEAST_FIGURE_PX: f64 = 4.0;
/// Texels along a side of a body's map, by its least size on the screen, pixels.
const SIDES_BY_SIZE: [(f64, usize); 4] = [(90.0, FIGURE_SIDE), (48.0, 96), (20.0, 48), (LEAST_FIGURE_PX, 24)];
/// Least size of the target on the screen that counts, pixels: texels of its map are always small.
const LEAST_TARGET_PX: f64 = 48.0;

/// The town's shadows and the figures'.
pub struct Shadows {
    window: Window,
    places: Places,
    /// A scene and the heights of its lowest and highest places, metres.
    heights_m: Option<(u64, [f64; 2])>,
    figure: VisibilityBuffer,
    heights: Box<Heights>,
    /// One for each of a frame's people, and some that wait to be used again.
    figures: Vec<FigureShadow>,
}

impl Shadows {
    /// Empty maps.
    pub fn new() -> Self {
        Self {
            window: Window::new(),
            places: Places::default(),
            heights_m: None,
            figure: VisibilityBuffer::new(FIGURE_SIDE, FIGURE_SIDE),
            heights: Box::new([0.0; HEIGHTS]),
            figures: Vec::new(),
        }
    }

    /// Makes the maps right for a frame: brings tiles of the town's that the view needs, draws the figures'.
    pub(crate) fn prepare(
        &mut self,
        level: Level,
        scene: &Scene,
        (eye, screen): (&Eye, &Screen),
        to_sun: Vec3,
        (people, target): (&People, Option<DVec3>),
        drawn: &VisibilityBuffer,
    ) {
        let heights_m = match self.heights_m {
            Some((id, heights_m)) if id == scene.identity => heights_m,
            _ => heights_m(scene),
        };
        self.heights_m = Some((scene.identity, heights_m));
        let sun = Sun::new(to_sun, heights_m);
        self.places = self.window.prepare(level, (scene, &sun), (eye, screen), (target, heights_m[0]), drawn);
        let lattice = sun.lattice(0);
        for (position, person) in people.members.iter().enumerate() {
            if self.figures.len() <= position {
                self.figures.push(FigureShadow { map: fixed_size(vec![]), side: 0, rows: None });
            }
            let size_px = match person.figure.body {
                _ if person.height_px < LEAST_FIGURE_PX => 0.0,
                BodyShape::Person { .. } => person.height_px,
                BodyShape::Vehicle { size_m, .. } => person.height_px * size_m.max_element() / size_m.z,
            };
            let is_target = person.instance == TARGET_INSTANCE;
            let size_px = if is_target { size_px.max(LEAST_TARGET_PX) } else { size_px };
            let side = SIDES_BY_SIZE.iter().find(|(least_px, _)| size_px >= *least_px).map_or(0, |(_, side)| *side);
            let is_person = person.figure.body.is_person();
            let drawn = match side {
                0 => None,
                _ if is_person => {
                    let parts = FigureParts::of(&person.figure, &person.clothes);
                    draw_person(level, &lattice, (&person.figure, &parts), side, &mut self.heights)
                }
                _ => {
                    let triangles = &people.triangles[person.triangles.clone()];
                    let frame = figure_frame(&lattice, person.figure.state.heading_rad, triangles, side);
                    frame.inspect(|frame| self.draw_figure(frame, to_sun, triangles, side))
                }
            };
            let heights = if is_person { self.heights.as_slice() } else { self.figure.inverse_depth.as_slice() };
            let figure = &mut self.figures[position];
            (figure.side, figure.rows) = (side, drawn.map(|frame| frame.rows()));
            if figure.rows.is_some() {
                pack_figure(level, heights, side, &mut figure.map);
            }
        }
    }

    /// Draws a vehicle's shadow into the first `side` rows and columns of the scratch map, which lie there.
    fn draw_figure(&mut self, frame: &ShadowFrame, to_sun: Vec3, triangles: &[FigureTriangle], side: usize) {
        self.figure.clear_part([0; 2], [side; 2]);
        let whole = SeenRegion { first: [0; 2], end: [side; 2] };
        let to_sun = DVec3::new(f64::from(to_sun.x), f64::from(to_sun.y), f64::from(to_sun.z));
        for triangle in triangles.iter().filter(|triangle| triangle.normal_in_world.dot(to_sun) > 1e-6) {
            draw(&mut self.figure, (frame, whole), to_sun, triangle.normal_in_world, &triangle.corners_in_world, SOLID);
        }
    }

    /// Fills in which share of the sun's light reaches each pixel's place. On flat surfaces, the pixels between the ends
    /// of a four that are lit alike are lit like them. Of people, only those numbered in `near` count.
    pub fn sunlight(
        &self,
        level: Level,
        blocks: &mut [Block],
        [flat, in_map]: [bool; 2],
        noise: &NoiseTexture,
        near: &[u32],
    ) {
        let places = Places { hidden_by: if in_map { 0 } else { COVERED }, ..self.places };
        let Window { map, summary, .. } = &self.window;
        town_sunlight(level, blocks, map, summary, &places, flat, noise);
        for figure in near.iter().filter_map(|person| self.figures.get(*person as usize)) {
            if let Some(rows) = &figure.rows {
                figure_shadow(level, blocks, &figure.map, figure.side, self.places.base_m, rows);
            }
        }
    }
}

/// Where the map of a vehicle's shadow lies: along the vehicle or along the light, whichever needs less room. Long edges then
/// follow the texels and do not turn into stairs.
fn figure_frame(
    lattice: &ShadowFrame,
    heading_rad: f64,
    triangles: &[FigureTriangle],
    side: usize,
) -> Option<ShadowFrame> {
    let (sin, cos) = real::sin_cos(heading_rad);
    let turned = ShadowFrame { axes: [DVec2::new(-sin, cos), DVec2::new(cos, sin)], ..*lattice };
    let fitted = |frame: &ShadowFrame| {
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for corner in triangles.iter().flat_map(|triangle| triangle.corners_in_world) {
            let at = frame.sheared(corner);
            (low, high) = (low.min(at), high.max(at));
        }
        let size = high - low;
        let fits = size.is_finite() && size.min_element() > 0.0 && size.max_element() <= 100.0;
        let texels_m = size / (side as f64 - 4.0);
        fits.then(|| ShadowFrame { corner: low / texels_m - 2.0, texels_m, ..*frame })
    };
    let room = |frame: &ShadowFrame| frame.texels_m.x * frame.texels_m.y;
    let [along, lit] = [fitted(&turned)?, fitted(lattice)?];
    Some(if room(&along) <= room(&lit) { along } else { lit })
}

/// Least and greatest height of boxes, ground, models and a lit mesh.
fn heights_m(scene: &Scene) -> [f64; 2] {
    let boxes = scene.boxes.iter().map(|b| (b.center_in_world, b.half_bounds_m));
    let ground = scene.clusters.iter().map(|cluster| (cluster.center_in_world, cluster.half_bounds_m));
    let props = scene.props.props.iter().map(|prop| (prop.center_in_world, prop.half_bounds_m));
    let mesh = scene.lit_mesh().map_or(&[][..], |mesh| &mesh.clusters);
    let mesh = mesh.iter().map(|cluster| (cluster.center_in_world, cluster.half_bounds_m));
    let around = [f64::INFINITY, f64::NEG_INFINITY];
    boxes
        .chain(ground)
        .chain(props)
        .chain(mesh)
        .fold(around, |[low, high], (center, half)| [low.min(center.z - half.z), high.max(center.z + half.z)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::BodyKind;
    use cosfly_figures::{BodyFigure, Clothes, add_figure};
    use cosfly_frames::{Seed, TargetState};

    #[test]
    fn maps_of_vehicles_lie_along_them_under_a_high_sun_and_along_the_light_of_a_low_one() {
        let heading_rad = 0.7;
        let car = BodyFigure {
            state: TargetState { feet_in_world: DVec3::new(30.0, -8.0, 1.0), heading_rad, speed_mps: 0.0 },
            height_m: 1.5,
            radius_m: 1.0,
            clothes_seed: Seed([3; 32]),
            gait_phase_rad: 0.0,
            body: BodyShape::Vehicle { kind: BodyKind::Car, size_m: DVec3::new(4.4, 1.8, 1.5) },
        };
        let mut triangles = vec![];
        add_figure(&car, &Clothes::draw(&car.clothes_seed), 0, &mut triangles);
        let (sin, cos) = real::sin_cos(heading_rad);
        for (to_sun, is_along) in [(Vec3::new(0.1, 0.2, 1.0), true), (Vec3::new(1.0, 0.0, 0.1), false)] {
            let lattice = Sun::new(to_sun.unit(), [0.0; 2]).lattice(0);
            let frame = figure_frame(&lattice, heading_rad, &triangles, 96).expect("a shadow");
            assert_eq!(frame.axes[1] == DVec2::new(cos, sin), is_along);
            for corner in triangles.iter().flat_map(|triangle| triangle.corners_in_world) {
                assert!(frame.place(corner).iter().all(|at| (1.9..94.1).contains(at)));
            }
        }
    }
}
