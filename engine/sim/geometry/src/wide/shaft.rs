//! Eight rays from one point at once: the hull of all of them through the tree, then eight exact answers per box.

use super::ray::{PARAMETER_SHARE, inverse};
use super::tree::{Block, MAX_DEPTH, REACH_M, WideTree};
use super::turned::{self, Way};
use crate::lanes::{LANES, Lane, Lanes, at_level, larger, smaller, take_lane};
use crate::turned_box::TurnedBox;
use cosfly_frames::DVec3;
use glam::Vec3A;

/// Rays of a shaft.
pub const RAYS: usize = 8;
/// All rays of a shaft.
const ALL: u32 = (1 << RAYS) - 1;
/// A direction component below this never leaves a slab: the exact test's own limit.
const PARALLEL: f64 = 1e-250;

/// A number for each ray.
type PerRay = [f64; RAYS];

/// Eight rays from one point, axis by axis.
#[derive(Clone, Copy)]
pub struct Shaft {
    from_in_world: DVec3,
    step: [PerRay; 3],
    inverse: [PerRay; 3],
    /// Whether some ray does not move along an axis.
    has_parallel: bool,
}

/// The smallest of eight.
#[inline(always)]
fn smallest(a: &PerRay) -> f64 {
    let four: [f64; 4] = core::array::from_fn(|i| smaller(a[i], a[i + 4]));
    smaller(smaller(four[0], four[2]), smaller(four[1], four[3]))
}

/// The hull of a shaft made ready for blocks. At the parameter t it is a box between `from + t * low` and
/// `from + t * high`; it meets bounds where `t * high >= min - from` and `t * low <= max - from`, two crossings per
/// axis, each a beginning or an end after the sign of its step.
struct Hull {
    /// For each face, lower and upper: the hull's side crosses it at `x * scale + offset`.
    scale: [[f32; 3]; 2],
    offset: [[f32; 3]; 2],
    /// Which of an axis's two faces comes first.
    first: [usize; 3],
    /// Whether both faces are beginnings.
    spreads: [bool; 3],
    way: Way,
}

impl Hull {
    #[inline(always)]
    fn new(from: Vec3A, low: Vec3A, high: Vec3A, margin: f32) -> Self {
        let (by_high, by_low) = (inverse(high), inverse(low));
        let (begins_low, begins_high) = (by_high.cmpgt(Vec3A::ZERO), by_low.cmplt(Vec3A::ZERO));
        let (less, more) = (Vec3A::splat(1.0 - PARAMETER_SHARE), Vec3A::splat(1.0 + PARAMETER_SHARE));
        let scale_low = by_high * Vec3A::select(begins_low, less, more);
        let scale_high = by_low * Vec3A::select(begins_high, less, more);
        let margins = Vec3A::splat(margin);
        let offset_low = (-margins - from) * scale_low;
        let offset_high = (margins - from) * scale_high;
        let (begins_low, begins_high) = (begins_low.bitmask(), begins_high.bitmask());
        let (middle, half) = ((0.5 * (low + high)).to_array(), (0.5 * (high - low) + 2.0 * margins).to_array());
        let from = from.to_array();
        Self {
            scale: [scale_low.to_array(), scale_high.to_array()],
            offset: [offset_low.to_array(), offset_high.to_array()],
            first: core::array::from_fn(|axis| (!begins_low >> axis & 1) as usize),
            spreads: core::array::from_fn(|axis| (begins_low & begins_high) >> axis & 1 == 1),
            way: Way { from: [from[0], from[1]], step: [middle[0], middle[1]], reach: [half[0], half[1]] },
        }
    }

    /// Bits of the lanes whose bounds the hull may meet, and where.
    #[inline(always)]
    fn met(&self, lanes: impl Lanes, block: &Block) -> (u32, Lane, Lane) {
        let (mut enter, mut leave) = ([0.0; LANES], [1.0 + PARAMETER_SHARE; LANES]);
        for axis in 0..3 {
            let [low, high] = &block.faces[axis];
            let [scale_low, scale_high] = [self.scale[0][axis], self.scale[1][axis]];
            let [offset_low, offset_high] = [self.offset[0][axis], self.offset[1][axis]];
            let (near, near_scale, near_offset, far, far_scale, far_offset) = if self.first[axis] == 0 {
                (low, scale_low, offset_low, high, scale_high, offset_high)
            } else {
                (high, scale_high, offset_high, low, scale_low, offset_low)
            };
            for i in 0..LANES {
                enter[i] = larger(lanes.multiply_add(near[i], near_scale, near_offset), enter[i]);
            }
            if self.spreads[axis] {
                for i in 0..LANES {
                    enter[i] = larger(lanes.multiply_add(far[i], far_scale, far_offset), enter[i]);
                }
            } else {
                for i in 0..LANES {
                    leave[i] = smaller(lanes.multiply_add(far[i], far_scale, far_offset), leave[i]);
                }
            }
        }
        (lanes.at_most(&enter, &leave) & block.valid, enter, leave)
    }
}

at_level! {
    /// Bit per ray from one point to eight that a box stands in the way of. `None` when f32 cannot be asked or the
    /// rays are too far apart; `slots` are the boxes in the tree's order.
    pub fn blocked(tree: &WideTree, slots: &[TurnedBox], from_in_world: DVec3, to_in_world: &[DVec3; RAYS]) -> Option<u32> = blocked_kernel;
}

#[inline(always)]
fn blocked_kernel(
    lanes: impl Lanes,
    tree: &WideTree,
    slots: &[TurnedBox],
    from_in_world: DVec3,
    to_in_world: &[DVec3; RAYS],
) -> Option<u32> {
    let mut step = [[0.0; RAYS]; 3];
    for ray in 0..RAYS {
        let [x, y, z] = (to_in_world[ray] - from_in_world).to_array();
        (step[0][ray], step[1][ray], step[2][ray]) = (x, y, z);
    }
    let inverse = step.map(|axis| axis.map(|d| 1.0 / d));
    // Numbers that are not finite fail the second comparison, large ones both.
    let sizes: [PerRay; 3] = step.map(|axis| axis.map(f64::abs));
    let parallel = sizes.iter().fold(0, |mask, size| mask | !lanes.at_most_f64(&[PARALLEL; RAYS], size) & ALL);
    let within = sizes.iter().fold(ALL, |mask, size| mask & lanes.at_most_f64(size, &[REACH_M; RAYS]));
    let low = DVec3::from_array([0, 1, 2].map(|axis| smallest(&step[axis]))).as_vec3a();
    let high = -DVec3::from_array([0, 1, 2].map(|axis| smallest(&step[axis].map(|d| -d)))).as_vec3a();
    let from = (from_in_world - tree.origin_in_world).as_vec3a();
    let reach = from.abs().max((from + low).abs()).max((from + high).abs()).max_element();
    if within != ALL || !(reach <= REACH_M as f32) || !is_slender(low, high) {
        return None;
    }
    let shaft = Shaft { from_in_world, step, inverse, has_parallel: parallel != 0 };
    let hull = Hull::new(from, low, high, tree.margin(reach));
    let mut open = [(0_u32, 0_u32); MAX_DEPTH];
    let (mut height, mut at, mut hidden) = (0, 0_usize, 0);
    while let Some(block) = tree.blocks.get(at) {
        let (mut met, enter, leave) = hull.met(lanes, block);
        if block.is_leaf {
            if met & block.turned != 0 {
                met &= turned::met(lanes.level(), tree, block, &hull.way, &enter, &leave);
            }
            while met != 0 {
                let shape = &slots[block.first as usize + take_lane(&mut met)];
                hidden |= if shape.is_axis_aligned() && !shaft.has_parallel {
                    slabs::<false>(
                        lanes,
                        shaft.from_in_world - shape.center_in_world(),
                        &shaft.step,
                        &shaft.inverse,
                        shape,
                    )
                } else {
                    rays_through_turned(lanes.level(), &shaft, shape)
                };
                if hidden == ALL {
                    return Some(ALL);
                }
            }
        } else if met != 0 {
            open[height] = (block.first, met);
            height += 1;
        }
        if height == 0 {
            break;
        }
        let top = &mut open[height - 1];
        at = top.0 as usize + take_lane(&mut top.1);
        height -= usize::from(top.1 == 0);
    }
    Some(hidden)
}

/// Whether rays stay close enough together for their hull to say much of them.
#[inline(always)]
fn is_slender(low: Vec3A, high: Vec3A) -> bool {
    /// Largest distance of two ends along an axis, metres.
    const WIDTH_M: f32 = 4.0;
    /// The same per metre of length, beyond half a metre.
    const SLOPE: f32 = 0.3;
    let (width, length) = ((high - low).max_element(), high.max(-low).max_element());
    width <= WIDTH_M && width <= 0.5 + SLOPE * length
}

at_level! {
    /// Bit per ray that meets a box, turned or not.
    fn rays_through_turned(shaft: &Shaft, shape: &TurnedBox) -> u32 = rays_through_turned_kernel;
}

/// The operations of [`crate::shape::Shape::ray_entry`], the same for every ray.
#[inline(always)]
fn rays_through_turned_kernel(lanes: impl Lanes, shaft: &Shaft, shape: &TurnedBox) -> u32 {
    let origin = shape.local_from_world_vector(shaft.from_in_world - shape.center_in_world());
    let (sin, cos) = shape.sin_cos();
    let (mut step, mut inverse) = (shaft.step, shaft.inverse);
    for ray in 0..RAYS {
        let (x, y) = (shaft.step[0][ray], shaft.step[1][ray]);
        step[0][ray] = cos * x + sin * y;
        step[1][ray] = cos * y - sin * x;
    }
    for axis in 0..2 {
        inverse[axis] = step[axis].map(|d| 1.0 / d);
    }
    slabs::<true>(lanes, origin, &step, &inverse, shape)
}

/// The slab test of [`crate::shape::Shape::ray_entry`] for eight rays, whose origin and steps are in the box's axes.
#[inline(always)]
fn slabs<const PARALLEL_RAYS: bool>(
    lanes: impl Lanes,
    origin: DVec3,
    step: &[PerRay; 3],
    inverse: &[PerRay; 3],
    shape: &TurnedBox,
) -> u32 {
    let (origin, half) = (origin.to_array(), shape.half_extents_m().to_array());
    let (mut enter, mut leave) = ([0.0; RAYS], [1.0; RAYS]);
    for axis in 0..3 {
        let (low, high) = (-half[axis] - origin[axis], half[axis] - origin[axis]);
        let outside = origin[axis].abs() > half[axis];
        let stay_near = if outside { f64::INFINITY } else { f64::NEG_INFINITY };
        for ray in 0..RAYS {
            let (near, far) = (low * inverse[axis][ray], high * inverse[axis][ray]);
            let (mut first, mut last) = (smaller(near, far), larger(near, far));
            if PARALLEL_RAYS {
                let stays = step[axis][ray].abs() < PARALLEL;
                first = if stays { stay_near } else { first };
                last = if stays { -stay_near } else { last };
            }
            enter[ray] = larger(first, enter[ray]);
            leave[ray] = smaller(last, leave[ray]);
        }
    }
    lanes.at_most_f64(&enter, &leave)
}
