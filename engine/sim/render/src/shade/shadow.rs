//! Shadows: heights of what first catches the sun's light, over ground sheared along the light.
//!
//! A point (x, y, z) and every point on its ray towards the sun fall on the same place of the map,
//! `(x, y) - (z - reference) * sun.xy / sun.z`; it is in shadow when the map's height there is above z.

use crate::figure::FigureTriangle;
use crate::renderer::Eye;
use crate::scene::{BOX_FACES, Scene};
use crate::shade::pattern::{NoiseTexture, floor_int, smoothstep};
use crate::visibility::{NO_FACE, PlaneOnScreen, Visibility};
use cosfly_frames::{DVec2, DVec3};
use cosfly_maps::ObstacleKind;
use glam::{DVec4, Vec2, Vec3A as Vec3, Vec4};

/// Texels along a side of the town's map.
const SIDE: usize = 1536;
/// Size of its texels across the sun's direction, metres; along it they grow as the sun sinks.
const TEXEL_M: f64 = 0.2;
/// The town's map moves in steps of this many texels, so that it depends on the frame alone and still is mostly reused.
const STEP_TEXELS: f64 = 128.0;
/// Texels along a side of the figure's own map.
const FIGURE_SIDE: usize = 96;
/// Heights in the maps are above this level below the reference, so that all are positive.
const DEPTH_M: f64 = 1000.0;
/// Posts thinner than this cast the shadow of a post this thick, half width in metres: the map would tear them.
const LEAST_HALF_WIDTH_M: f64 = 0.13;

/// What stands in a texel of the town's map.
const SOLID: u32 = 0;
const LEAVES: u32 = 1;

/// Where a map lies. Its v axis runs along the sun's direction over the ground, so that upright edges,
/// whose shadows run that way, follow the texels and do not turn into stairs.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Frame {
    /// Sheared ground coordinates of texel (0, 0), along `axes`, metres.
    corner_m: DVec2,
    reference_m: f64,
    shear: DVec2,
    axes: [DVec2; 2],
    texels_m: DVec2,
}

impl Frame {
    /// Sheared ground coordinates along the axes, metres.
    fn sheared(&self, point: DVec3) -> DVec2 {
        let at = point.truncate() - (point.z - self.reference_m) * self.shear;
        DVec2::new(at.dot(self.axes[0]), at.dot(self.axes[1]))
    }

    fn place(&self, point: DVec3) -> [f64; 2] {
        ((self.sheared(point) - self.corner_m) / self.texels_m).to_array()
    }

    fn height(&self, point: DVec3) -> f64 {
        point.z - self.reference_m + DEPTH_M
    }

    /// `place` as an affine map in f32: rows of (x, y, z, 1).
    fn rows(&self) -> [Vec4; 2] {
        [0, 1].map(|k| {
            let axis = self.axes[k] / self.texels_m[k];
            let slope = -self.shear.dot(axis);
            let constant = -slope * self.reference_m - self.corner_m[k] / self.texels_m[k];
            DVec4::new(axis.x, axis.y, slope, constant).as_vec4()
        })
    }
}

/// The town's shadows and the figure's.
pub struct Shadows {
    town: Visibility,
    town_frame: Option<(u64, Frame)>,
    figure: Visibility,
    fast: Fast,
}

/// The frames as lookups need them.
#[derive(Clone, Copy, Default)]
struct Fast {
    town_rows: [Vec4; 2],
    figure_rows: Option<[Vec4; 2]>,
    base_m: f32,
    texels_m: Vec2,
    corner_m: Vec2,
}

impl Shadows {
    /// Empty maps.
    pub fn new() -> Self {
        Self {
            town: Visibility::new(SIDE, SIDE),
            town_frame: None,
            figure: Visibility::new(FIGURE_SIDE, FIGURE_SIDE),
            fast: Fast::default(),
        }
    }

    /// Makes the maps right for a frame; draws the town's only when the view or the sun moved enough.
    pub(crate) fn prepare(&mut self, scene: &Scene, eye: &Eye, to_sun: Vec3, figure: &[FigureTriangle]) {
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
        if self.town_frame != Some((scene.identity, frame)) {
            self.town_frame = Some((scene.identity, frame));
            self.draw_town(scene, &frame, to_sun);
        }
        let figure_frame = self.draw_figure(&frame, to_sun, figure);
        self.fast = Fast {
            town_rows: frame.rows(),
            figure_rows: figure_frame.map(|frame| frame.rows()),
            base_m: (DEPTH_M - reference_m) as f32,
            texels_m: texels_m.as_vec2(),
            corner_m: frame.corner_m.as_vec2(),
        };
    }

    fn draw_town(&mut self, scene: &Scene, frame: &Frame, to_sun: Vec3) {
        self.town.clear();
        let to_sun = to_sun.as_dvec3();
        for b in &scene.boxes {
            let class = if b.kind == ObstacleKind::TreeCrown { LEAVES } else { SOLID };
            let thin = f64::from(b.half_extents_m.x.min(b.half_extents_m.y));
            let grow = (LEAST_HALF_WIDTH_M / thin.max(0.01)).clamp(1.0, 8.0);
            let upright = b.half_extents_m.z > b.half_extents_m.x.max(b.half_extents_m.y);
            let wide = if upright { DVec3::new(grow, grow, 1.0) } else { DVec3::ONE };
            for (face, (_, _, around)) in BOX_FACES.iter().enumerate() {
                let normal = b.normal_in_world(face);
                if normal.dot(to_sun) > 1e-6 {
                    let corners = around
                        .map(|corner| b.center_in_world + wide * (b.corners_in_world[corner] - b.center_in_world));
                    draw(&mut self.town, frame, to_sun, normal, &corners, class);
                }
            }
        }
    }

    fn draw_figure(&mut self, town_frame: &Frame, to_sun: Vec3, triangles: &[FigureTriangle]) -> Option<Frame> {
        self.figure.clear();
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
        let texels_m = size / (FIGURE_SIDE as f64 - 4.0);
        let frame = Frame { corner_m: low - 2.0 * texels_m, texels_m, ..*town_frame };
        let to_sun = to_sun.as_dvec3();
        for triangle in triangles.iter().filter(|triangle| triangle.normal_in_world.dot(to_sun) > 1e-6) {
            let normal = triangle.normal_in_world;
            draw(&mut self.figure, &frame, to_sun, normal, &triangle.corners_in_world, SOLID);
        }
        Some(frame)
    }

    /// Share of the sun's light that reaches a point on a surface, 0..=1.
    #[inline(always)]
    pub fn sunlight(&self, point: Vec3, normal: Vec3, noise: &NoiseTexture) -> f32 {
        // Off the surface, so that a face does not shade itself where the map is coarse.
        let lift = 0.05 + 0.30 * (1.0 - normal.z.max(0.0));
        let point = (point + normal * lift).extend(1.0);
        let height = point.z + self.fast.base_m + 0.05;
        let [row_u, row_v] = self.fast.town_rows;
        let mut dark = self.town_share(row_u.dot(point), row_v.dot(point), height, noise);
        if let Some([row_u, row_v]) = self.fast.figure_rows {
            let (u, v) = (row_u.dot(point), row_v.dot(point));
            let limit = FIGURE_SIDE as f32;
            if u > 0.0 && v > 0.0 && u < limit && v < limit {
                dark = dark.max(self.figure_share(u, v, height));
            }
        }
        1.0 - dark
    }

    #[inline(always)]
    fn town_share(&self, u: f32, v: f32, height: f32, noise: &NoiseTexture) -> f32 {
        let (u, v) = (u - 0.5, v - 0.5);
        let limit = (SIDE - 2) as f32;
        if !(u >= 0.0 && v >= 0.0 && u < limit && v < limit) {
            return 0.0;
        }
        let (column, row) = (floor_int(u).max(0) as usize, floor_int(v).max(0) as usize);
        let (fx, fy) = (u - column as i32 as f32, v - row as i32 as f32);
        let at = row * SIDE + column;
        let upper = &self.town.inverse_depth[at..at + 2];
        let lower = &self.town.inverse_depth[at + SIDE..at + SIDE + 2];
        let above = |top: f32| if top > height { 1.0f32 } else { 0.0 };
        let upper = above(upper[0]) + (above(upper[1]) - above(upper[0])) * fx;
        let lower = above(lower[0]) + (above(lower[1]) - above(lower[0])) * fx;
        let dark = upper + (lower - upper) * fy;
        if dark > 0.0 && self.town.face[at] == LEAVES {
            // Sun flecks: gaps between the leaves.
            let place = Vec2::new(u, v) * self.fast.texels_m + self.fast.corner_m;
            let gap = smoothstep(0.52, 0.70, noise.clumps(place.x * 18.0, place.y * 18.0, 1.5));
            return dark * (1.0 - 0.75 * gap);
        }
        dark
    }

    #[inline(always)]
    fn figure_share(&self, u: f32, v: f32, height: f32) -> f32 {
        let (u, v) = (u - 0.5, v - 0.5);
        let limit = (FIGURE_SIDE - 2) as f32;
        if !(u >= 0.0 && v >= 0.0 && u < limit && v < limit) {
            return 0.0;
        }
        let (column, row) = (floor_int(u).max(0) as usize, floor_int(v).max(0) as usize);
        let (fx, fy) = (u - column as i32 as f32, v - row as i32 as f32);
        let at = row * FIGURE_SIDE + column;
        let tap = |index: usize| {
            let above = self.figure.inverse_depth[index] > height + 0.04 && self.figure.face[index] != NO_FACE;
            f32::from(u8::from(above))
        };
        let upper = tap(at) + (tap(at + 1) - tap(at)) * fx;
        let lower = tap(at + FIGURE_SIDE) + (tap(at + FIGURE_SIDE + 1) - tap(at + FIGURE_SIDE)) * fx;
        upper + (lower - upper) * fy
    }
}

/// Draws a face that the sun shines on: its height is affine over the sheared ground.
fn draw(map: &mut Visibility, frame: &Frame, to_sun: DVec3, normal: DVec3, corners: &[DVec3], class: u32) {
    let mut points = [[0.0; 2]; 4];
    for (point, corner) in points.iter_mut().zip(corners) {
        *point = frame.place(*corner);
    }
    // Along the map's x axis the face's point moves by (1, 0, 0) + slope * sun / sun.z with no way along the normal.
    let facing = normal.dot(to_sun) / to_sun.z;
    let slope = -normal.truncate() / facing;
    let across = slope.dot(frame.axes[0]) * frame.texels_m.x;
    let down = slope.dot(frame.axes[1]) * frame.texels_m.y;
    let constant = frame.height(corners[0]) - across * points[0][0] - down * points[0][1];
    map.draw_projected(&points[..corners.len().min(4)], &PlaneOnScreen { constant, across, down }, class);
}
