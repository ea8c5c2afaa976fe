//! Shadows of people: the frustums of a figure as the sun sees them, in a small map of heights.
//!
//! The rings of a figure are level, so over ground sheared along the light each is an ellipse of one height: a part is the
//! band of triangles between two of them that faces the sun, and its upper ring.

use super::sunlight::FIGURE_SIDE;
use cosfly_figures::{BodyFigure, FigureParts, MOST_PARTS, Ring, SIDES};
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec2, DVec3, real, simd_kernel};
use cosfly_materials::pattern::{floor_int, least, most, share};
use cosfly_raster::shadow_frame::ShadowFrame;
use glam::Vec2;

/// Texels that are compared at a time.
const WIDE: usize = 16;
/// Corners of a ring, and the first of them again.
const CORNERS: usize = SIDES + 1;
/// Texels this near beyond an edge, in areas of texels, count as inside: no gap opens between triangles.
const SEAM: f32 = 1e-3;

/// Heights over a map's lowest place, rows of [`FIGURE_SIDE`] texels, with room for writing beyond the last; 0: nothing.
pub(super) type Heights = [f32; HEIGHTS];
pub(super) const HEIGHTS: usize = FIGURE_SIDE * FIGURE_SIDE + WIDE;
/// A ring over the sheared ground.
#[derive(Clone, Copy)]
struct SeenRing {
    corners: [[f32; 2]; CORNERS],
    height_m: f32,
}

const NO_RING: SeenRing = SeenRing { corners: [[0.0; 2]; CORNERS], height_m: 0.0 };

/// Draws the shadow of a person into the first `side` rows and columns of a map; says where they lie.
pub(super) fn draw_person(
    level: Level,
    lattice: &ShadowFrame,
    (figure, parts): (&BodyFigure, &FigureParts),
    side: usize,
    heights: &mut Heights,
) -> Option<ShadowFrame> {
    let stance = Stance::new(lattice, figure, parts);
    let mut rings = [NO_RING; 2 * MOST_PARTS];
    let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
    let mut count = 0;
    for (part, pair) in parts.all().iter().zip(rings.as_chunks_mut::<2>().0) {
        count += 1;
        for (seen, ring) in pair.iter_mut().zip([&part.low, &part.high]) {
            *seen = stance.see(ring);
            for corner in &seen.corners {
                for axis in 0..2 {
                    low[axis] = least(low[axis], corner[axis]);
                    high[axis] = most(high[axis], corner[axis]);
                }
            }
        }
    }
    let (low_m, high_m) = (Vec2::from_array(low).as_dvec2(), Vec2::from_array(high).as_dvec2());
    let size = high_m - low_m;
    if !size.is_finite() || size.min_element() <= 0.0 || size.max_element() > 100.0 {
        return None;
    }
    let texels_m = size / (side as f64 - 4.0);
    let frame = ShadowFrame { corner: (stance.feet + low_m) / texels_m - 2.0, texels_m, ..*lattice };
    heights[..FIGURE_SIDE * side].fill(0.0);
    let per_m = [(1.0 / texels_m.x) as f32, (1.0 / texels_m.y) as f32];
    draw_parts(level, &mut rings[..2 * count], low, per_m, side, heights);
    Some(frame)
}

/// A person's feet and axes over the sheared ground, metres; the axes are as long as the body is high.
struct Stance {
    feet: DVec2,
    axes: [DVec2; 3],
    foot_height_m: f64,
    height_m: f64,
    around: [(f64, f64); SIDES],
}

impl Stance {
    fn new(lattice: &ShadowFrame, figure: &BodyFigure, parts: &FigureParts) -> Self {
        let (sin, cos) = real::sin_cos(figure.state.heading_rad);
        let sunk = figure.state.feet_in_world - DVec3::Z * (parts.lowest() * figure.height_m);
        let axes = [DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0), DVec3::Z];
        Self {
            feet: lattice.sheared(sunk),
            axes: axes.map(|axis| figure.height_m * lattice.turned(axis)),
            foot_height_m: lattice.height(sunk),
            height_m: figure.height_m,
            around: core::array::from_fn(|k| real::sin_cos(real::TAU * k as f64 / SIDES as f64)),
        }
    }

    /// Corner `k` of a ring from the feet on, metres.
    fn corner(&self, ring: &Ring, k: usize) -> DVec2 {
        let [forward, right, up] = self.axes;
        let (sin, cos) = self.around[k];
        forward * (ring.forward + ring.half_forward * cos)
            + right * (ring.right + ring.half_side * sin)
            + up * ring.up.max(0.0)
    }

    /// A ring from the feet on, metres.
    fn see(&self, ring: &Ring) -> SeenRing {
        let height_m = (self.foot_height_m + self.height_m * ring.up.max(0.0)) as f32;
        let mut seen = SeenRing { corners: [[0.0; 2]; CORNERS], height_m };
        for k in 0..CORNERS {
            let corner = self.corner(ring, k % SIDES);
            seen.corners[k] = [corner.x as f32, corner.y as f32];
        }
        seen
    }
}

simd_kernel! {
    /// Draws parts, each between two rings in metres, which are turned into texels from a margin of two before `low_m` on.
    fn draw_parts(
        rings: &mut [SeenRing],
        low_m: [f32; 2],
        texels_per_m: [f32; 2],
        side: usize,
        heights: &mut Heights,
    ) {
        for ring in rings.iter_mut() {
            for corner in &mut ring.corners {
                for axis in 0..2 {
                    corner[axis] = (corner[axis] - low_m[axis]) * texels_per_m[axis] + 2.0;
                }
            }
        }
        for [low, high] in rings.as_chunks::<2>().0 {
            let rise_m = high.height_m - low.height_m;
            let turned = if rise_m < 0.0 { -1.0 } else { 1.0 };
            for k in 0..SIDES {
                let (a, b) = (low.corners[k], low.corners[k + 1]);
                let (c, d) = (high.corners[k], high.corners[k + 1]);
                draw_triangle([a, b, c], turned, low.height_m, rise_m, side, heights);
                draw_triangle([d, c, b], turned, high.height_m, -rise_m, side, heights);
            }
            let upper = if rise_m < 0.0 { low } else { high };
            let [first, rest @ ..] = &upper.corners;
            for k in 0..SIDES - 2 {
                draw_triangle([*first, rest[k], rest[k + 1]], 1.0, upper.height_m, 0.0, side, heights);
            }
        }
    }
}

/// Twice the area of a triangle.
#[inline(always)]
fn doubled_area([a, b, c]: [[f32; 2]; 3]) -> f32 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Draws a triangle that faces the sun: its first two corners are `base_m` high, the third one `rise_m` more. Rings that
/// run around upwards run around the sheared ground the other way: its axes are a left hand's.
#[inline(always)]
fn draw_triangle(corners: [[f32; 2]; 3], turned: f32, base_m: f32, rise_m: f32, side: usize, heights: &mut Heights) {
    let area = doubled_area(corners);
    if area * turned >= -1e-6 {
        return;
    }
    let [a, b, c] = corners;
    let limit = side as u32 as f32;
    let mut range = [[0i32; 2]; 2];
    for axis in 0..2 {
        let low = least(least(a[axis], b[axis]), c[axis]);
        let high = most(most(a[axis], b[axis]), c[axis]);
        // Centres from the first at or after `low` to the last at or before `high`.
        let from = most(low - 0.5, 0.0);
        let to = least(high - 0.5, limit - 1.0);
        range[axis] = [floor_int(-from).wrapping_neg(), floor_int(to)];
    }
    let [[left, right], [top, bottom]] = range;
    if left > right || top > bottom {
        return;
    }
    // Positive inside: the way from each edge, in areas, as a linear function of the place.
    let sign = if area < 0.0 { -1.0 } else { 1.0 };
    let mut edges = [[0.0f32; 3]; 3];
    for (edge, (from, to)) in edges.iter_mut().zip([(a, b), (b, c), (c, a)]) {
        let step = [sign * (to[0] - from[0]), sign * (to[1] - from[1])];
        *edge = [step[1] * from[0] - step[0] * from[1] + SEAM, -step[1], step[0]];
    }
    let per_area = 1.0 / (sign * area);
    let mut row = top;
    while row <= bottom {
        let y = row as f32 + 0.5;
        let mut column = left;
        while column <= right {
            let at = (row as u32 as usize).wrapping_mul(FIGURE_SIDE).wrapping_add(column as u32 as usize);
            let Some(texels) = heights.get_mut(at..).and_then(|rest| rest.first_chunk_mut::<WIDE>()) else { return };
            let x = column as f32 + 0.5;
            // Written out: `map` of arrays is a call.
            let [[e0, ex, ey], [f0, fx, fy], [g0, gx, gy]] = edges;
            let (from, second, third) = (e0 + ex * x + ey * y, f0 + fx * x + fy * y, g0 + gx * x + gy * y);
            for (k, texel) in texels.iter_mut().enumerate() {
                let aside = k as i32 as f32;
                let (e, f, g) = (from + ex * aside, second + fx * aside, third + gx * aside);
                let inside = (e >= 0.0) & (f >= 0.0) & (g >= 0.0) & (x + aside < limit);
                let height_m = base_m + rise_m * share((e - SEAM) * per_area);
                // A choice between the two would become masked stores, which are slow on many processors.
                *texel += most(if inside { height_m } else { 0.0 } - *texel, 0.0);
            }
            column = column.wrapping_add(WIDE as i32);
        }
        row = row.wrapping_add(1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shade::sun_tiles::Sun;
    use cosfly_figures::{BodyShape, Clothes, figure_triangles};
    use cosfly_frames::{Seed, TargetState};
    use cosfly_materials::vector::Vec3;

    /// Greatest height of a triangle above a place of a map, metres.
    fn height_at(frame: &ShadowFrame, corners: &[DVec3; 3], at: DVec2) -> Option<f64> {
        let points = corners.map(|corner| DVec2::from_array(frame.place(corner)));
        let cross = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a);
        let area = cross(points[0], points[1], points[2]);
        let shares: Vec<f64> = (0..3).map(|k| cross(points[(k + 1) % 3], points[(k + 2) % 3], at) / area).collect();
        let height = (0..3).map(|k| shares[k] * frame.height(corners[k])).sum();
        (area.abs() > 1e-9 && shares.iter().all(|share| *share >= 0.0)).then_some(height)
    }

    #[test]
    fn a_shadow_is_as_high_as_the_highest_triangle_of_the_figure() {
        for (number, side) in [24, 48, FIGURE_SIDE].into_iter().enumerate() {
            let figure = BodyFigure {
                state: TargetState { feet_in_world: DVec3::new(40.0, -9.0, 2.0), heading_rad: 0.8, speed_mps: 1.5 },
                height_m: 1.8,
                radius_m: 0.3,
                clothes_seed: Seed([number as u8; 32]),
                gait_phase_rad: 0.9,
                body: BodyShape::default(),
            };
            let clothes = Clothes::draw(&figure.clothes_seed);
            let lattice = Sun::new(Vec3::new(0.5, -0.4, 0.6).unit(), [0.0; 2]).lattice(0);
            let mut heights = [0.0; HEIGHTS];
            let parts = FigureParts::of(&figure, &clothes);
            let frame = draw_person(Level::best(), &lattice, (&figure, &parts), side, &mut heights).expect("a shadow");
            let triangles = figure_triangles(&figure);
            let mut wrong = 0;
            for (row, column) in (0..side).flat_map(|row| (0..side).map(move |column| (row, column))) {
                let at = DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
                let exact = triangles.iter().filter_map(|triangle| height_at(&frame, triangle, at)).fold(0.0, f64::max);
                wrong += usize::from((exact - f64::from(heights[FIGURE_SIDE * row + column])).abs() > 2e-3);
            }
            // A rounding decides at edges.
            assert!(wrong <= side * side / 500, "{side}: {wrong}");
            assert!(heights[..FIGURE_SIDE * side].iter().filter(|height| **height > 0.0).count() > side * side / 20);
        }
    }
}
