//! Eight rays from one point at once: their hull is traced through the tree, then eight exact answers per box.

use super::ray::{PARAMETER_SHARE, inverse};
use super::tree::{Block, MAX_DEPTH, REACH_M, WideTree};
use super::turned::{self, Motion};
use crate::lanes::{LANES, Lane, Lanes, at_level, larger, smaller, take_lane};
use crate::turned_box::TurnedBox;
use cosfly_frames::DVec3;
use glam::Vec3A;

/// Number of rays of a shaft.
pub const RAYS: usize = 8;
/// Mask of all rays of a shaft.
const ALL: u32 = (1 << RAYS) - 1;
/// Direction component below which a ray is parallel to a slab, as in the exact test.
const PARALLEL: f64 = 1e-250;

/// One number per ray.
type PerRay = [f64; RAYS];

/// Eight rays from one point, axis by axis.
#[derive(Clone, Copy)]
pub struct Shaft {
    from_in_world: DVec3,
    step: [PerRay; 3],
    inverse: [PerRay; 3],
    /// Whether a ray is parallel to an axis's slabs.
    has_parallel: bool,
}

/// Smallest and largest of eight numbers.
#[inline(always)]
fn extremes(a: &PerRay) -> (f64, f64) {
    let (mut low, mut high) = ([0.0; 4], [0.0; 4]);
    for i in 0..4 {
        low[i] = smaller(a[i], a[i + 4]);
        high[i] = larger(a[i], a[i + 4]);
    }
    let low = smaller(smaller(low[0], low[2]), smaller(low[1], low[3]));
    (low, larger(larger(high[0], high[2]), larger(high[1], high[3])))
}

/// Hull of a shaft, prepared for blocks. At the parameter t it is a box between `from + t * low` and `from + t * high`;
/// it meets bounds where `t * high >= min - from` and `t * low <= max - from`, two crossings per axis, each a beginning
/// or an end depending on the sign of its step. The hull crosses a face at `x * scale + offset`.
struct Hull {
    near_scale: [f32; 3],
    near_offset: [f32; 3],
    far_scale: [f32; 3],
    far_offset: [f32; 3],
    /// Infinite where an axis's second face is a beginning as well; less than any parameter elsewhere.
    spreads: [f32; 3],
    /// Number of the face of each axis that comes first.
    first: [usize; 3],
    motion: Motion,
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
        let (middle, half) = ((0.5 * (low + high)).to_array(), (0.5 * (high - low) + 2.0 * margins).to_array());
        let spreads = Vec3A::select(begins_low & begins_high, Vec3A::INFINITY, Vec3A::NEG_INFINITY);
        let (from, mask) = (from.to_array(), begins_low.bitmask() as usize ^ 7);
        Self {
            near_scale: Vec3A::select(begins_low, scale_low, scale_high).to_array(),
            near_offset: Vec3A::select(begins_low, offset_low, offset_high).to_array(),
            far_scale: Vec3A::select(begins_low, scale_high, scale_low).to_array(),
            far_offset: Vec3A::select(begins_low, offset_high, offset_low).to_array(),
            spreads: spreads.to_array(),
            first: [mask & 1, mask >> 1 & 1, mask >> 2 & 1],
            motion: Motion { from: [from[0], from[1]], step: [middle[0], middle[1]], reach: [half[0], half[1]] },
        }
    }

    /// Mask and parameters of the lanes whose bounds the hull may meet.
    #[inline(always)]
    fn met(&self, lanes: impl Lanes, block: &Block) -> (u32, Lane, Lane) {
        let (mut enter, mut leave) = ([0.0; LANES], [1.0 + PARAMETER_SHARE; LANES]);
        for axis in 0..3 {
            let (near, far) = block.near_and_far(axis, self.first[axis]);
            for i in 0..LANES {
                let t_near = lanes.multiply_add(near[i], self.near_scale[axis], self.near_offset[axis]);
                let t_far = lanes.multiply_add(far[i], self.far_scale[axis], self.far_offset[axis]);
                enter[i] = larger(t_near, larger(smaller(t_far, self.spreads[axis]), enter[i]));
                leave[i] = smaller(larger(t_far, self.spreads[axis]), leave[i]);
            }
        }
        (lanes.at_most(&enter, &leave) & block.valid, enter, leave)
    }
}

at_level! {
    /// Mask of the rays from one point to eight that a box blocks. `None` when f32 is not applicable or the rays are
    /// too far apart; `slots` are the boxes in the tree's order.
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
    let (mut step, mut inverse, mut size) = ([[0.0; RAYS]; 3], [[0.0; RAYS]; 3], [[0.0; RAYS]; 3]);
    for ray in 0..RAYS {
        step[0][ray] = to_in_world[ray].x - from_in_world.x;
        step[1][ray] = to_in_world[ray].y - from_in_world.y;
        step[2][ray] = to_in_world[ray].z - from_in_world.z;
    }
    let (mut low, mut high) = ([0.0; 3], [0.0; 3]);
    let (mut moving, mut within) = (ALL, ALL);
    for axis in 0..3 {
        for ray in 0..RAYS {
            inverse[axis][ray] = 1.0 / step[axis][ray];
            size[axis][ray] = step[axis][ray].abs();
        }
        moving &= lanes.at_most_f64(&[PARALLEL; RAYS], &size[axis]);
        // Numbers that are not finite fail this test as well.
        within &= lanes.at_most_f64(&size[axis], &[REACH_M; RAYS]);
        (low[axis], high[axis]) = extremes(&step[axis]);
    }
    let (low, high) = (DVec3::from_array(low).as_vec3a(), DVec3::from_array(high).as_vec3a());
    let from = (from_in_world - tree.origin_in_world).as_vec3a();
    let reach = WideTree::reach_of(from, (from + low).abs().max((from + high).abs()))?;
    if within != ALL || !is_slender(low, high) {
        return None;
    }
    let shaft = Shaft { from_in_world, step, inverse, has_parallel: moving != ALL };
    let hull = Hull::new(from, low, high, tree.margin(reach));
    let mut open = [(0_u32, 0_u32); MAX_DEPTH];
    let (mut height, mut at, mut hidden) = (0, 0_usize, 0);
    while let Some(block) = tree.blocks.get(at) {
        let (mut met, enter, leave) = hull.met(lanes, block);
        if block.is_leaf {
            if met & block.turned != 0 {
                met &= turned::met(lanes.level(), tree, block, &hull.motion, &enter, &leave);
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

/// Whether rays are close enough together for their hull to be selective.
#[inline(always)]
fn is_slender(low: Vec3A, high: Vec3A) -> bool {
    /// Largest distance of two ends along an axis, metres.
    const WIDTH_M: f32 = 4.0;
    /// Largest distance of two ends per metre of length, beyond half a metre.
    const SLOPE: f32 = 0.3;
    let (width, length) = ((high - low).max_element(), high.max(-low).max_element());
    width <= WIDTH_M && width <= 0.5 + SLOPE * length
}

at_level! {
    /// Mask of the rays that meet a box, rotated or not.
    fn rays_through_turned(shaft: &Shaft, shape: &TurnedBox) -> u32 = rays_through_turned_kernel;
}

/// Operations of [`crate::shape::Shape::ray_entry`], the same for every ray.
#[inline(always)]
fn rays_through_turned_kernel(lanes: impl Lanes, shaft: &Shaft, shape: &TurnedBox) -> u32 {
    let origin = shape.local_from_world_vector(shaft.from_in_world - shape.center_in_world());
    let (sin, cos) = shape.sin_cos();
    let (mut step, mut inverse) = (shaft.step, shaft.inverse);
    #[expect(clippy::needless_range_loop, reason = "eight lanes of several arrays")]
    for ray in 0..RAYS {
        let (x, y) = (shaft.step[0][ray], shaft.step[1][ray]);
        step[0][ray] = cos * x + sin * y;
        step[1][ray] = cos * y - sin * x;
    }
    for axis in 0..2 {
        for ray in 0..RAYS {
            inverse[axis][ray] = 1.0 / step[axis][ray];
        }
    }
    slabs::<true>(lanes, origin, &step, &inverse, shape)
}

/// Slab test of [`crate::shape::Shape::ray_entry`] for eight rays, whose origin and steps are in the box's axes.
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
