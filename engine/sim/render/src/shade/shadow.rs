//! Shadows: heights of what first catches the sun's light, over ground sheared along the light.
//!
//! A point (x, y, z) and every point on its ray towards the sun fall on the same place of the map,
//! `(x, y) - (z - reference) * sun.xy / sun.z`; it is in shadow when the map's height there is above z.

use crate::figure::FigureTriangle;
use crate::renderer::Eye;
use crate::scene::{BOX_FACES, Scene};
use crate::shade::pattern::{NoiseTexture, smoothstep};
use crate::visibility::{NO_FACE, PlaneOnScreen, Visibility};
use cosfly_frames::{DVec2, DVec3};
use cosfly_maps::ObstacleKind;
use glam::Vec3;

/// Texels along a side of the town's map, and their size on the ground.
const SIDE: usize = 1536;
const TEXEL_M: f64 = 0.25;
/// The town's map moves in steps of this size, so that it depends on the frame alone and still is mostly reused.
const STEP_M: f64 = 32.0;
/// Texels along a side of the figure's own map.
const FIGURE_SIDE: usize = 96;
/// Heights in the maps are above this level below the reference, so that all are positive.
const DEPTH_M: f64 = 1000.0;

/// What stands in a texel of the town's map.
const SOLID: u32 = 0;
const LEAVES: u32 = 1;

/// Where a map lies.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Frame {
    corner: DVec2,
    reference_m: f64,
    shear: DVec2,
    texel_m: f64,
}

impl Frame {
    fn place(&self, point: DVec3) -> [f64; 2] {
        let at = (point.truncate() - (point.z - self.reference_m) * self.shear - self.corner) / self.texel_m;
        [at.x, at.y]
    }

    fn height(&self, point: DVec3) -> f64 {
        point.z - self.reference_m + DEPTH_M
    }
}

/// The town's shadows and the figure's.
pub struct Shadows {
    town: Visibility,
    town_frame: Option<(u64, Frame)>,
    figure: Visibility,
    figure_frame: Option<Frame>,
    fast: Fast,
}

/// The frames in f32, relative to where shading happens.
#[derive(Clone, Copy, Default)]
struct Fast {
    shear: [f32; 2],
    reference_m: f32,
    town_corner: [f32; 2],
    figure_corner: [f32; 2],
    figure_texels_per_m: f32,
    figure_drawn: bool,
}

impl Shadows {
    /// Empty maps.
    pub fn new() -> Self {
        Self {
            town: Visibility::new(SIDE, SIDE),
            town_frame: None,
            figure: Visibility::new(FIGURE_SIDE, FIGURE_SIDE),
            figure_frame: None,
            fast: Fast::default(),
        }
    }

    /// Makes the maps right for a frame; draws the town's only when the view or the sun moved enough.
    pub(crate) fn prepare(&mut self, scene: &Scene, eye: &Eye, to_sun: Vec3, figure: &[FigureTriangle]) {
        let shear = DVec2::new(f64::from(to_sun.x), f64::from(to_sun.y)) / f64::from(to_sun.z);
        let ahead = eye.position_in_world + 90.0 * eye.world_from_body.x_axis;
        let middle = DVec2::new((ahead.x / STEP_M).round(), (ahead.y / STEP_M).round()) * STEP_M;
        let ground = f64::from(scene.grid.sample(middle.x as f32, middle.y as f32).ground_m);
        let reference_m = (ground / 4.0).round() * 4.0;
        let corner = middle - DVec2::splat(0.5 * SIDE as f64 * TEXEL_M);
        let frame = Frame { corner, reference_m, shear, texel_m: TEXEL_M };
        if self.town_frame != Some((scene.identity, frame)) {
            self.town_frame = Some((scene.identity, frame));
            self.draw_town(scene, &frame, to_sun);
        }
        self.draw_figure(&frame, to_sun, figure);
        let figure_frame = self.figure_frame.unwrap_or(frame);
        self.fast = Fast {
            shear: [shear.x as f32, shear.y as f32],
            reference_m: reference_m as f32,
            town_corner: [corner.x as f32, corner.y as f32],
            figure_corner: [figure_frame.corner.x as f32, figure_frame.corner.y as f32],
            figure_texels_per_m: (1.0 / figure_frame.texel_m) as f32,
            figure_drawn: self.figure_frame.is_some(),
        };
    }

    fn draw_town(&mut self, scene: &Scene, frame: &Frame, to_sun: Vec3) {
        self.town.clear();
        let to_sun = to_sun.as_dvec3();
        for b in &scene.boxes {
            let class = if b.kind == ObstacleKind::TreeCrown { LEAVES } else { SOLID };
            for (face, (_, _, around)) in BOX_FACES.iter().enumerate() {
                let normal = b.normal_in_world(face);
                if normal.dot(to_sun) > 1e-6 {
                    let corners = around.map(|corner| b.corners_in_world[corner]);
                    draw(&mut self.town, frame, to_sun, normal, &corners, class);
                }
            }
        }
    }

    fn draw_figure(&mut self, town_frame: &Frame, to_sun: Vec3, triangles: &[FigureTriangle]) {
        self.figure.clear();
        self.figure_frame = None;
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for corner in triangles.iter().flat_map(|triangle| triangle.corners_in_world) {
            let at = corner.truncate() - (corner.z - town_frame.reference_m) * town_frame.shear;
            low = low.min(at);
            high = high.max(at);
        }
        let size = (high - low).max_element();
        if !size.is_finite() || size <= 0.0 || size > 100.0 {
            return;
        }
        let texel_m = size / (FIGURE_SIDE as f64 - 4.0);
        let frame = Frame { corner: low - DVec2::splat(2.0 * texel_m), texel_m, ..*town_frame };
        self.figure_frame = Some(frame);
        let to_sun = to_sun.as_dvec3();
        for triangle in triangles.iter().filter(|triangle| triangle.normal_in_world.dot(to_sun) > 1e-6) {
            let normal = triangle.normal_in_world;
            draw(&mut self.figure, &frame, to_sun, normal, &triangle.corners_in_world, SOLID);
        }
    }

    /// Share of the sun's light that reaches a point on a surface, 0..=1.
    #[inline(always)]
    pub fn sunlight(&self, point: Vec3, normal: Vec3, noise: &NoiseTexture) -> f32 {
        // Off the surface, so that a face does not shade itself where the map is coarse.
        let lift = 0.05 + 0.35 * (1.0 - normal.z.max(0.0));
        let point = point + normal * lift;
        let over = point.z - self.fast.reference_m;
        let (x, y) = (point.x - over * self.fast.shear[0], point.y - over * self.fast.shear[1]);
        let height = over + DEPTH_M as f32 + 0.05;
        let texels_per_m = 1.0 / TEXEL_M as f32;
        let (u, v) = ((x - self.fast.town_corner[0]) * texels_per_m, (y - self.fast.town_corner[1]) * texels_per_m);
        let mut dark = self.town_share(u, v, x, y, height, noise);
        if self.fast.figure_drawn && dark < 1.0 {
            let scale = self.fast.figure_texels_per_m;
            let (u, v) = ((x - self.fast.figure_corner[0]) * scale, (y - self.fast.figure_corner[1]) * scale);
            dark = dark.max(self.figure_share(u, v, height));
        }
        1.0 - dark
    }

    #[inline(always)]
    fn town_share(&self, u: f32, v: f32, x: f32, y: f32, height: f32, noise: &NoiseTexture) -> f32 {
        let (u, v) = (u - 0.5, v - 0.5);
        let limit = (SIDE - 2) as f32;
        if !(u >= 0.0 && v >= 0.0 && u < limit && v < limit) {
            return 0.0;
        }
        let (column, row) = (u as usize, v as usize);
        let (fx, fy) = (u - column as f32, v - row as f32);
        let at = row * SIDE + column;
        let tap = |index: usize| {
            let above = self.town.inverse_depth[index] > height;
            (f32::from(u8::from(above)), f32::from(u8::from(above && self.town.face[index] == LEAVES)))
        };
        let (a, b, c, d) = (tap(at), tap(at + 1), tap(at + SIDE), tap(at + SIDE + 1));
        let blend = |a: f32, b: f32, c: f32, d: f32| (a + (b - a) * fx) * (1.0 - fy) + (c + (d - c) * fx) * fy;
        let dark = blend(a.0, b.0, c.0, d.0);
        let leaves = blend(a.1, b.1, c.1, d.1);
        if leaves > 0.0 {
            // Sun flecks: gaps between the leaves.
            let gap = smoothstep(0.54, 0.72, noise.clumps(x * 18.0, y * 18.0, 1.5));
            return dark - 0.75 * leaves * gap;
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
        let (column, row) = (u as usize, v as usize);
        let (fx, fy) = (u - column as f32, v - row as f32);
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
    let across = -normal.x / facing * frame.texel_m;
    let down = -normal.y / facing * frame.texel_m;
    let constant = frame.height(corners[0]) - across * points[0][0] - down * points[0][1];
    map.draw_projected(&points[..corners.len().min(4)], &PlaneOnScreen { constant, across, down }, class);
}
