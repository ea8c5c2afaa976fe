//! Bounds of eight boxes at a time on the screen.

use crate::canvas::{Canvas, Part, Parts};
use crate::eye::{Eye, NEAR_M};
use crate::hidden::Hidden;
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec3, simd_kernel};

/// Boxes side by side.
pub const LANES: usize = 8;

/// A box turned around the vertical axis.
#[derive(Clone, Copy)]
pub struct Bounds {
    pub center_in_world: DVec3,
    pub half_m: DVec3,
    /// Unit vector of its x axis.
    pub axis: [f64; 2],
}

impl Bounds {
    /// An upright box between two corners.
    pub fn between(low: DVec3, high: DVec3) -> Self {
        Self { center_in_world: 0.5 * (low + high), half_m: 0.5 * (high - low), axis: [1.0, 0.0] }
    }

    /// Lowest and highest corner.
    pub fn ends(&self) -> [DVec3; 2] {
        let [cos, sin] = self.axis.map(f64::abs);
        let half = self.half_m;
        let reach = DVec3::new(cos * half.x + sin * half.y, sin * half.x + cos * half.y, half.z);
        [self.center_in_world - reach, self.center_in_world + reach]
    }

    /// Around others.
    pub fn around(others: impl Iterator<Item = Self>) -> Self {
        let (low, high) = others.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), other| {
            let [from, to] = other.ends();
            (low.min(from), high.max(to))
        });
        Self::between(low, high)
    }
}

/// Neighbouring boxes, eight side by side.
pub struct BoxLanes {
    origin_in_world: DVec3,
    count: usize,
    eights: Vec<Eight>,
}

/// Eight boxes from the origin.
struct Eight {
    center_m: [[f32; LANES]; 3],
    half_m: [[f32; LANES]; 3],
    axis: [[f32; LANES]; 2],
}

/// Eight boxes on the screen.
#[derive(Default)]
struct Projected {
    parts: Parts<LANES>,
    nearest_m: [f32; LANES],
}

/// A box that may be seen.
#[derive(Clone, Copy)]
pub struct LaneCandidate {
    /// Its number among its neighbours.
    pub index: u32,
    /// The part of the canvas that it may cover.
    pub part: Part,
    /// Greatest inverse depth that it may have, 1/m.
    pub nearest: f32,
}

impl BoxLanes {
    pub fn of(boxes: &[Bounds]) -> Self {
        let origin_in_world = Bounds::around(boxes.iter().copied()).center_in_world;
        let eight = |members: &[Bounds]| {
            let lane = |value: &dyn Fn(&Bounds) -> f64| {
                core::array::from_fn(|k| members.get(k).or(members.last()).map_or(0.0, value) as f32)
            };
            Eight {
                center_m: [0, 1, 2].map(|axis| lane(&|b| (b.center_in_world - origin_in_world)[axis])),
                half_m: [0, 1, 2].map(|axis| lane(&|b| b.half_m[axis])),
                axis: [0, 1].map(|axis| lane(&|b| b.axis[axis])),
            }
        };
        Self { origin_in_world, count: boxes.len(), eights: boxes.chunks(LANES).map(eight).collect() }
    }

    /// Appends the boxes that cover a pixel centre of the canvas and are not hidden.
    pub fn gather(&self, level: Level, eye: &Eye, canvas: &Canvas, hidden: &Hidden, found: &mut Vec<LaneCandidate>) {
        let origin = eye.pixels_ahead(eye.see(self.origin_in_world)).as_vec3().to_array();
        let mut projected = Projected::default();
        for (number, eight) in self.eights.iter().enumerate() {
            project(level, eight, origin, &eye.turn_to_pixels, canvas.size(), &mut projected);
            for k in 0..LANES.min(self.count - LANES * number) {
                let Some(part) = projected.parts.get(k) else { continue };
                let nearest = 1.0 / projected.nearest_m[k].max(NEAR_M as f32);
                if !hidden.hides(canvas, part, nearest) {
                    found.push(LaneCandidate { index: (LANES * number + k) as u32, part, nearest });
                }
            }
        }
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&*self.eights)
    }
}

/// Eight boxes along one axis of the eye: their centres, and half of each of their sides.
struct Way {
    center: [f32; LANES],
    reach: [[f32; LANES]; 3],
}

#[inline(always)]
fn along(eight: &Eight, origin: f32, turn: [f32; 3]) -> Way {
    let mut way = Way { center: [0.0; LANES], reach: [[0.0; LANES]; 3] };
    for k in 0..LANES {
        let [x, y, z] = [eight.center_m[0][k], eight.center_m[1][k], eight.center_m[2][k]];
        way.center[k] = origin + (x * turn[0] + y * turn[1] + z * turn[2]);
        let [cos, sin] = [eight.axis[0][k], eight.axis[1][k]];
        way.reach[0][k] = eight.half_m[0][k] * (cos * turn[0] + sin * turn[1]);
        way.reach[1][k] = eight.half_m[1][k] * (cos * turn[1] - sin * turn[0]);
        way.reach[2][k] = eight.half_m[2][k] * turn[2];
    }
    way
}

simd_kernel! {
    /// Bounds of the corners of eight boxes on the screen; those that reach behind the camera may be everywhere.
    fn project(eight: &Eight, origin: [f32; 3], turn: &[[f32; 3]; 3], size: [f32; 2], projected: &mut Projected) {
        // One axis of the eye after the other: over all three at once, compilers take three lanes for eight.
        let ways = [
            along(eight, origin[0], [turn[0][0], turn[1][0], turn[2][0]]),
            along(eight, origin[1], [turn[0][1], turn[1][1], turn[2][1]]),
            along(eight, origin[2], [turn[0][2], turn[1][2], turn[2][2]]),
        ];
        // How far corners reach: ahead, behind, and within the sides of the view.
        let (mut nearest, mut farthest) = (ways[0].center, ways[0].center);
        let half = [0.5 * size[0], 0.5 * size[1]];
        let mut within = [[0.0f32; LANES]; 4];
        for (axis, [low, high]) in within.as_chunks_mut::<2>().0.iter_mut().enumerate() {
            for k in 0..LANES {
                let (ahead, aside) = (half[axis] * ways[0].center[k], ways[axis + 1].center[k]);
                (low[k], high[k]) = (ahead + aside, ahead - aside);
            }
        }
        for side in 0..3 {
            for k in 0..LANES {
                nearest[k] -= ways[0].reach[side][k].abs();
                farthest[k] += ways[0].reach[side][k].abs();
            }
            for (axis, [low, high]) in within.as_chunks_mut::<2>().0.iter_mut().enumerate() {
                for k in 0..LANES {
                    let (ahead, aside) = (half[axis] * ways[0].reach[side][k], ways[axis + 1].reach[side][k]);
                    low[k] += (ahead + aside).abs();
                    high[k] += (ahead - aside).abs();
                }
            }
        }
        let (mut low_u, mut low_v) = ([f32::INFINITY; LANES], [f32::INFINITY; LANES]);
        let (mut high_u, mut high_v) = ([f32::NEG_INFINITY; LANES], [f32::NEG_INFINITY; LANES]);
        for corner in 0..8 {
            let sign = [0, 1, 2].map(|axis| if corner >> axis & 1 == 0 { -1.0f32 } else { 1.0 });
            for k in 0..LANES {
                let at = |way: &Way| {
                    let across = sign[0] * way.reach[0][k] + sign[1] * way.reach[1][k];
                    way.center[k] + across + sign[2] * way.reach[2][k]
                };
                let (x, right, down) = (at(&ways[0]), at(&ways[1]), at(&ways[2]));
                let scale = 1.0 / x;
                let (u, v) = (right * scale, down * scale);
                low_u[k] = if u < low_u[k] { u } else { low_u[k] };
                low_v[k] = if v < low_v[k] { v } else { low_v[k] };
                high_u[k] = if u > high_u[k] { u } else { high_u[k] };
                high_v[k] = if v > high_v[k] { v } else { high_v[k] };
            }
        }
        let (low, high) = ([low_u, low_v], [high_u, high_v]);
        let mut from = [[0.0f32; LANES]; 2];
        let mut to = [[0.0f32; LANES]; 2];
        for axis in 0..2 {
            for k in 0..LANES {
                // Anywhere, where it reaches behind the camera; nothing of what lies behind or beside the view.
                from[axis][k] = if nearest[k] >= NEAR_M as f32 { low[axis][k] } else { f32::NEG_INFINITY };
                let end = if nearest[k] >= NEAR_M as f32 { high[axis][k] } else { f32::INFINITY };
                let end = if farthest[k] >= NEAR_M as f32 { end } else { f32::NEG_INFINITY };
                let end = if within[2 * axis][k] >= -1.0 { end } else { f32::NEG_INFINITY };
                to[axis][k] = if within[2 * axis + 1][k] >= -1.0 { end } else { f32::NEG_INFINITY };
            }
        }
        projected.parts.find(size, &from, &to);
        projected.nearest_m = nearest;
    }
}
