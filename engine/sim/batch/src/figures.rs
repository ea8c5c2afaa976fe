//! People and other figures as triangles.

use crate::canvas::{Part, Parts, WIDE};
use crate::eye::{Eye, NEAR_M};
use cosfly_figures::{BodyFigure, FigurePart, SIDES};
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec3, real, simd_kernel};

/// A box around something on the screen: bounds in pixels from the image's centre, and the nearest depth.
pub struct Around {
    pub low: [f32; 2],
    pub high: [f32; 2],
    pub nearest_m: f64,
}

impl Around {
    /// Around points of the world.
    pub fn new(eye: &Eye, points_in_world: impl Iterator<Item = DVec3>) -> Self {
        let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
        let mut nearest_m = f64::INFINITY;
        // How far points reach within the sides of the view.
        let mut within = [f64::NEG_INFINITY; 4];
        for point in points_in_world {
            let seen = eye.see(point);
            nearest_m = nearest_m.min(seen.x);
            let [wide, tall] = eye.half_px.map(|half| half / eye.focal_px * seen.x);
            let reach = [wide + seen.y, wide - seen.y, tall + seen.z, tall - seen.z];
            within.iter_mut().zip(reach).for_each(|(within, reach)| *within = within.max(reach));
            let at = [eye.focal_px * seen.y / seen.x, -eye.focal_px * seen.z / seen.x].map(|part| part as f32);
            for axis in 0..2 {
                low[axis] = low[axis].min(at[axis]);
                high[axis] = high[axis].max(at[axis]);
            }
        }
        if nearest_m < NEAR_M {
            (low, high) = ([f32::NEG_INFINITY; 2], [f32::INFINITY; 2]);
        }
        if within.iter().any(|within| *within < 0.0) {
            (low, high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
        }
        Self { low, high, nearest_m }
    }

    /// Around an upright box.
    pub fn of_box(eye: &Eye, low_in_world: DVec3, high_in_world: DVec3) -> Self {
        let ends = [low_in_world, high_in_world];
        Self::new(eye, (0..8).map(|k: usize| DVec3::new(ends[k & 1].x, ends[k >> 1 & 1].y, ends[k >> 2].z)))
    }
}

/// Corners of the two rings of a part of a body on the screen: metres ahead, pixels from the image's centre.
#[derive(Default)]
pub struct SeenPart {
    /// Corners in body axes of the camera, metres: x ahead, y right, z up; ring by ring.
    points: [[[f32; WIDE]; 3]; 2],
    /// Right and down.
    pixels: [[[f32; WIDE]; 2]; 2],
    /// The pixels that each side's two triangles may cover.
    sides: [Parts<WIDE>; 2],
    /// Twice the areas of each side's two triangles, positive where they are seen from outside.
    areas: [[f32; WIDE]; 2],
    /// Twice the areas of both ends, positive where they are seen from outside.
    ends: [f32; 2],
    pub low: [f32; 2],
    pub high: [f32; 2],
    pub nearest_m: f32,
}

/// A person's axes in body axes of the camera, as long as the body is high.
pub struct Stance {
    feet: DVec3,
    axes: [DVec3; 3],
    height_m: f64,
    focal_px: f32,
    size_px: [f32; 2],
    /// Feet and axes in the world.
    feet_in_world: DVec3,
    axes_in_world: [DVec3; 3],
}

/// Eight rings side by side: their centres in body heights ahead of, right of and above the feet, and how far corners are from them.
#[derive(Clone, Copy, Default)]
struct Rings {
    center: [[f32; WIDE]; 3],
    reach_m: [f32; WIDE],
}

/// Directions of the corners of a ring; the last two repeat the first, to fill eight lanes.
const COS: [f32; WIDE] = [1.0, 0.5, -0.5, -1.0, -0.5, 0.5, 1.0, 0.5];
const SIN: [f32; WIDE] = {
    const HIGH: f32 = 0.866_025_4;
    [0.0, HIGH, HIGH, 0.0, -HIGH, -HIGH, 0.0, HIGH]
};

impl Stance {
    /// The stance of a person whose lowest ring is `lowest` body heights above the feet.
    pub fn new(eye: &Eye, figure: &BodyFigure, lowest: f64) -> Self {
        let (sin, cos) = real::sin_cos(figure.state.heading_rad);
        let axes = [DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0), DVec3::Z];
        let sunk = figure.state.feet_in_world - DVec3::Z * (lowest * figure.height_m);
        Self {
            feet: eye.see(sunk),
            axes: axes.map(|axis| eye.body_from_world * axis * figure.height_m),
            height_m: figure.height_m,
            focal_px: eye.focal_px as f32,
            size_px: eye.half_px.map(|half| 2.0 * half as f32),
            feet_in_world: sunk,
            axes_in_world: axes.map(|axis| axis * figure.height_m),
        }
    }

    /// The ends of a part's middle line.
    pub fn middle_in_world(&self, part: &FigurePart) -> [DVec3; 2] {
        let [forward, right, up] = self.axes_in_world;
        [part.low, part.high]
            .map(|ring| self.feet_in_world + forward * ring.forward + right * ring.right + up * ring.up.max(0.0))
    }

    /// The pixels that each of up to eight parts of the body may cover, roughly.
    pub fn parts(&self, level: Level, parts: &[FigurePart]) -> Parts<WIDE> {
        let mut rings = [Rings::default(); 2];
        for (k, part) in parts.iter().enumerate().take(WIDE) {
            for (rings, ring) in rings.iter_mut().zip([part.low, part.high]) {
                rings.center[0][k] = ring.forward as f32;
                rings.center[1][k] = ring.right as f32;
                rings.center[2][k] = ring.up.max(0.0) as f32;
                // Corners lie on an ellipse around the centre.
                rings.reach_m[k] = (ring.half_forward.max(ring.half_side) * self.height_m) as f32;
            }
        }
        let axes = [self.feet, self.axes[0], self.axes[1], self.axes[2]].map(|axis| axis.as_vec3().to_array());
        let mut found = Parts::default();
        find_parts(level, &rings, &axes, self.focal_px, self.size_px, &mut found);
        found
    }

    /// A part of the body on the screen.
    pub fn see(&self, level: Level, part: &FigurePart, seen: &mut SeenPart) {
        let [forward, right, up] = self.axes;
        let rings = [part.low, part.high].map(|ring| {
            let center = self.feet + forward * ring.forward + right * ring.right + up * ring.up.max(0.0);
            [center, forward * ring.half_forward, right * ring.half_side].map(|vector| vector.as_vec3().to_array())
        });
        let turned = if part.high.up < part.low.up { -1.0 } else { 1.0 };
        project(level, &rings, self.focal_px, self.size_px, turned, seen);
    }
}

simd_kernel! {
    fn find_parts(
        rings: &[Rings; 2],
        axes: &[[f32; 3]; 4],
        focal_px: f32,
        size_px: [f32; 2],
        found: &mut Parts<WIDE>,
    ) {
        let (mut low, mut high) = ([[f32::INFINITY; WIDE]; 2], [[f32::NEG_INFINITY; WIDE]; 2]);
        let [feet, forward, right, up] = axes;
        for Rings { center, reach_m } in rings {
            for k in 0..WIDE {
                let [a, b, c] = [center[0][k], center[1][k], center[2][k]];
                let ahead = feet[0] + (forward[0] * a + right[0] * b + up[0] * c);
                let nearest_m = ahead - reach_m[k];
                let (scale, widest) = (1.0 / ahead, reach_m[k] / nearest_m);
                let is_near = nearest_m < 2.0 * NEAR_M as f32;
                for axis in 0..2 {
                    // Body axes have y to the right and z up, the screen has its second axis down.
                    let way = feet[axis + 1] + (forward[axis + 1] * a + right[axis + 1] * b + up[axis + 1] * c);
                    let at = if axis == 0 { way * scale } else { 0.0 - way * scale };
                    let spread = widest * (1.0 + at.abs());
                    let from = if is_near { f32::NEG_INFINITY } else { focal_px * (at - spread) };
                    let to = if is_near { f32::INFINITY } else { focal_px * (at + spread) };
                    low[axis][k] = if from < low[axis][k] { from } else { low[axis][k] };
                    high[axis][k] = if to > high[axis][k] { to } else { high[axis][k] };
                }
            }
        }
        found.find(size_px, &low, &high);
    }
}

simd_kernel! {
    fn project(
        rings: &[[[f32; 3]; 3]; 2],
        focal_px: f32,
        size_px: [f32; 2],
        turned: f32,
        seen: &mut SeenPart,
    ) {
        let mut low = [[f32::INFINITY; WIDE]; 2];
        let mut high = [[f32::NEG_INFINITY; WIDE]; 2];
        let mut nearest = [f32::INFINITY; WIDE];
        for (ring, [center, forward, side]) in rings.iter().enumerate() {
            for axis in 0..3 {
                for k in 0..WIDE {
                    seen.points[ring][axis][k] = center[axis] + (forward[axis] * COS[k] + side[axis] * SIN[k]);
                }
            }
            let points = &seen.points[ring];
            for k in 0..WIDE {
                let scale = focal_px / points[0][k];
                let (u, v) = (points[1][k] * scale, -points[2][k] * scale);
                (seen.pixels[ring][0][k], seen.pixels[ring][1][k]) = (u, v);
                low[0][k] = if u < low[0][k] { u } else { low[0][k] };
                low[1][k] = if v < low[1][k] { v } else { low[1][k] };
                high[0][k] = if u > high[0][k] { u } else { high[0][k] };
                high[1][k] = if v > high[1][k] { v } else { high[1][k] };
                nearest[k] = if points[0][k] < nearest[k] { points[0][k] } else { nearest[k] };
            }
        }
        for axis in 0..2 {
            let (mut least, mut most) = (low[axis][0], high[axis][0]);
            for k in 1..WIDE {
                least = if low[axis][k] < least { low[axis][k] } else { least };
                most = if high[axis][k] > most { high[axis][k] } else { most };
            }
            (seen.low[axis], seen.high[axis]) = (least, most);
        }
        seen.nearest_m = nearest.iter().fold(nearest[0], |least, ahead| if *ahead < least { *ahead } else { least });
        // Side `k` lies between the corners `k` and `k + 1` of both rings.
        let [[u, v], [high_u, high_v]] = &seen.pixels;
        for (half, found) in seen.sides.iter_mut().enumerate() {
            let mut low = [[0.0f32; WIDE]; 2];
            let mut high = [[0.0f32; WIDE]; 2];
            for axis in 0..2 {
                let (one, other) = (&seen.pixels[0][axis], &seen.pixels[1][axis]);
                for k in 0..WIDE - 1 {
                    // Corner `k + 1` of the first ring and `k` of the second are of both triangles.
                    let third = if half == 0 { one[k] } else { other[k + 1] };
                    let least = if one[k + 1] < other[k] { one[k + 1] } else { other[k] };
                    let most = if one[k + 1] > other[k] { one[k + 1] } else { other[k] };
                    low[axis][k] = if third < least { third } else { least };
                    high[axis][k] = if third > most { third } else { most };
                }
            }
            found.find(size_px, &low, &high);
        }
        for k in 0..WIDE - 1 {
            let (across, down) = (u[k + 1] - high_u[k], v[k + 1] - high_v[k]);
            let first = (u[k] - high_u[k]) * down - (v[k] - high_v[k]) * across;
            let second = across * (high_v[k + 1] - high_v[k]) - down * (high_u[k + 1] - high_u[k]);
            (seen.areas[0][k], seen.areas[1][k]) = (turned * first, turned * second);
        }
        for (ring, sign) in [(0, -turned), (1, turned)] {
            let [u, v] = &seen.pixels[ring];
            let mut area = 0.0;
            for k in 1..SIDES - 1 {
                area += (u[k] - u[0]) * (v[k + 1] - v[0]) - (v[k] - v[0]) * (u[k + 1] - u[0]);
            }
            seen.ends[ring] = sign * area;
        }
    }
}

impl SeenPart {
    /// Corner `k` of a ring in body axes, metres.
    #[inline]
    fn point(&self, ring: usize, k: usize) -> DVec3 {
        let [x, y, z] = &self.points[ring];
        DVec3::new(f64::from(x[k]), f64::from(y[k]), f64::from(z[k]))
    }

    /// The triangles of the sides that are seen from outside and may cover a pixel: the part of the canvas, corners in body
    /// axes and on the screen.
    pub fn sides(&self) -> impl Iterator<Item = (Part, [DVec3; 3], [[f32; 2]; 3])> {
        (0..SIDES).flat_map(|k| [(k, 0), (k, 1)]).filter_map(|(k, half)| {
            let is_seen = self.areas[half][k] > 0.0;
            let part = self.sides[half].get(k).filter(|_| is_seen)?;
            let corners = [[(0, k), (0, k + 1), (1, k)], [(1, k), (0, k + 1), (1, k + 1)]];
            // Written out: `map` of arrays is a call.
            let [(i, a), (j, b), (k, c)] = corners[half];
            let points = [self.point(i, a), self.point(j, b), self.point(k, c)];
            Some((part, points, [self.pixel(i, a), self.pixel(j, b), self.pixel(k, c)]))
        })
    }

    /// The flat ends that are seen from outside: three corners in body axes, all corners on the screen.
    pub fn ends(&self) -> impl Iterator<Item = ([DVec3; 3], [[f32; 2]; SIDES])> {
        (0..2).filter(|ring| self.ends[*ring] > 0.0).map(|ring| {
            let mut pixels = [[0.0; 2]; SIDES];
            for (k, pixel) in pixels.iter_mut().enumerate() {
                *pixel = self.pixel(ring, k);
            }
            ([self.point(ring, 0), self.point(ring, 2), self.point(ring, 4)], pixels)
        })
    }

    #[inline]
    fn pixel(&self, ring: usize, k: usize) -> [f32; 2] {
        [self.pixels[ring][0][k], self.pixels[ring][1][k]]
    }

    /// All triangles of its surface in body axes.
    pub fn triangles(&self) -> impl Iterator<Item = [DVec3; 3]> {
        let side = |k: usize| [[(0, k), (0, k + 1), (1, k)], [(1, k), (0, k + 1), (1, k + 1)]];
        let end = |k: usize| [[(0, 0), (0, k), (0, k + 1)], [(1, 0), (1, k), (1, k + 1)]];
        let all = (0..SIDES).flat_map(side).chain((1..SIDES - 1).flat_map(end));
        all.map(|corners| corners.map(|(ring, k)| self.point(ring, k)))
    }
}
