//! Eight rays from one point at once: the hull of all of them through the tree, then eight exact answers per box.

use super::ray::inverse;
use super::tree::{Block, MAX_DEPTH, WideTree};
use crate::lanes::{LANES, Lane, Lanes, at_level, larger, smaller, take_lane};
use crate::turned_box::TurnedBox;
use cosfly_frames::DVec3;

/// Rays of a shaft.
pub const RAYS: usize = 8;
const PARAMETER_SHARE: f32 = 8.0 / 16_777_216.0;
/// A direction component below this never leaves a slab: the exact test's own limit.
const PARALLEL: f64 = 1e-250;

/// Eight rays from one point: directions axis by axis.
pub struct Shaft {
    from_in_world: DVec3,
    step: [[f64; RAYS]; 3],
    inverse: [[f64; RAYS]; 3],
    /// Whether some ray does not move along an axis.
    has_parallel: bool,
    /// Smallest and largest step per axis.
    low: [f64; 3],
    high: [f64; 3],
}

impl Shaft {
    /// The rays from one point to eight.
    #[inline(always)]
    pub fn new(from_in_world: DVec3, to_in_world: &[DVec3; RAYS]) -> Self {
        let step: [[f64; RAYS]; 3] =
            core::array::from_fn(|axis| core::array::from_fn(|ray| to_in_world[ray][axis] - from_in_world[axis]));
        let inverse = step.map(|axis| axis.map(|d| 1.0 / d));
        let low = step.map(|axis| axis.into_iter().fold(f64::INFINITY, smaller));
        let high = step.map(|axis| axis.into_iter().fold(f64::NEG_INFINITY, larger));
        let has_parallel = step.iter().flatten().fold(false, |any, d| any | (d.abs() < PARALLEL));
        Self { from_in_world, step, inverse, has_parallel, low, high }
    }

    /// Whether the rays stay close enough together for their hull to say much of them.
    #[inline(always)]
    pub fn is_slender(&self) -> bool {
        /// Largest distance of two ends along an axis, metres.
        const WIDTH_M: f64 = 4.0;
        /// The same per metre of length, beyond half a metre.
        const SLOPE: f64 = 0.3;
        let width = (0..3).map(|axis| self.high[axis] - self.low[axis]).fold(0.0, larger);
        let length = (0..3).map(|axis| larger(self.high[axis], -self.low[axis])).fold(0.0, larger);
        width <= WIDTH_M && width <= 0.5 + SLOPE * length
    }
}

/// The hull of a shaft made ready for blocks. At the parameter t it is a box between `from + t * low` and
/// `from + t * high`; it meets bounds where `t * high >= min - from` and `t * low <= max - from`, two crossings per
/// axis, each a beginning or an end after the sign of its step.
struct Hull {
    axes: [HullAxis; 3],
    from: [f32; 3],
    middle: [f32; 3],
    reach: [f32; 2],
}

#[derive(Clone, Copy, Default)]
struct HullAxis {
    scale: [f32; 2],
    offset: [f32; 2],
    /// Which of the two faces comes first.
    first: bool,
    /// Whether both crossings are beginnings.
    spreads: bool,
}

impl Hull {
    #[inline(always)]
    fn new(shaft: &Shaft, from: DVec3, margin_m: f64) -> Self {
        let mut axes = [HullAxis::default(); 3];
        for axis in 0..3 {
            let (high, low) = (inverse(shaft.high[axis] as f32), inverse(shaft.low[axis] as f32));
            let (begins_low, begins_high) = (high > 0.0, low < 0.0);
            let widened =
                |scale: f32, begins: bool| scale * (1.0 + if begins { -PARAMETER_SHARE } else { PARAMETER_SHARE });
            let scale = [widened(high, begins_low), widened(low, begins_high)];
            let offset = [-((from[axis] + margin_m) as f32 * scale[0]), -((from[axis] - margin_m) as f32 * scale[1])];
            axes[axis] = HullAxis { scale, offset, first: begins_low, spreads: begins_low && begins_high };
        }
        let middle = core::array::from_fn(|axis| (0.5 * (shaft.low[axis] + shaft.high[axis])) as f32);
        let reach = core::array::from_fn(|axis| (0.5 * (shaft.high[axis] - shaft.low[axis]) + 2.0 * margin_m) as f32);
        Self { axes, from: from.as_vec3().to_array(), middle, reach }
    }

    /// Bits of the lanes whose bounds the hull may meet, and where.
    #[inline(always)]
    fn met(&self, lanes: impl Lanes, block: &Block) -> (u32, Lane, Lane) {
        let (mut enter, mut leave) = ([0.0; LANES], [1.0 + PARAMETER_SHARE; LANES]);
        for (axis, faces) in self.axes.iter().zip(&block.faces) {
            let (near, far) = if axis.first { (0, 1) } else { (1, 0) };
            let (near_faces, far_faces) = if axis.first { (&faces[0], &faces[1]) } else { (&faces[1], &faces[0]) };
            for i in 0..LANES {
                enter[i] = larger(lanes.multiply_add(near_faces[i], axis.scale[near], axis.offset[near]), enter[i]);
            }
            if axis.spreads {
                for i in 0..LANES {
                    enter[i] = larger(lanes.multiply_add(far_faces[i], axis.scale[far], axis.offset[far]), enter[i]);
                }
            } else {
                for i in 0..LANES {
                    leave[i] = smaller(lanes.multiply_add(far_faces[i], axis.scale[far], axis.offset[far]), leave[i]);
                }
            }
        }
        (lanes.at_most(&enter, &leave) & block.valid, enter, leave)
    }

    /// Takes the turned boxes that are missed after all out of `met`.
    #[inline(always)]
    fn without_missed_turned(
        &self,
        lanes: impl Lanes,
        tree: &WideTree,
        block: &Block,
        met: u32,
        ways: (&Lane, &Lane),
    ) -> u32 {
        if met & block.turned == 0 {
            return met;
        }
        let turned = &tree.turned[block.turned_lanes as usize];
        let [from, step] = [self.from, self.middle].map(|v| [v[0], v[1]]);
        met & (!block.turned | turned.met(lanes, from, step, self.reach, ways.0, ways.1))
    }
}

at_level! {
    /// Bit per ray between two of the given points that a box stands in the way of. `None` when f32 cannot be asked
    /// or the rays are too far apart; `slots` are the boxes in the tree's order.
    pub fn blocked_rays(tree: &WideTree, slots: &[TurnedBox], from_in_world: DVec3, to_in_world: &[DVec3; RAYS]) -> Option<u32> = blocked_rays_kernel;
}

#[inline(always)]
fn blocked_rays_kernel(
    lanes: impl Lanes,
    tree: &WideTree,
    slots: &[TurnedBox],
    from_in_world: DVec3,
    to_in_world: &[DVec3; RAYS],
) -> Option<u32> {
    const ALL: u32 = (1 << RAYS) - 1;
    if tree.blocks.is_empty() {
        return Some(0);
    }
    let shaft = Shaft::new(from_in_world, to_in_world);
    let from = tree.local(from_in_world)?;
    let (low, high) = (DVec3::from_array(shaft.low), DVec3::from_array(shaft.high));
    let (low_end, high_end) = (tree.local(from_in_world + low)?, tree.local(from_in_world + high)?);
    if !shaft.is_slender() {
        return None;
    }
    let reach_m = from.abs().max(low_end.abs()).max(high_end.abs()).max_element();
    let hull = Hull::new(&shaft, from, tree.margin_m(reach_m));
    let mut open = [(0_u32, 0_u32); MAX_DEPTH];
    let (mut height, mut at, mut hidden) = (0, 0_usize, 0);
    loop {
        let block = &tree.blocks[at];
        let (mut met, enter, leave) = hull.met(lanes, block);
        if block.is_leaf {
            met = hull.without_missed_turned(lanes, tree, block, met, (&enter, &leave));
            while met != 0 {
                let lane = take_lane(&mut met);
                hidden |= met_by(lanes, &shaft, &slots[block.first as usize + lane]);
                if hidden == ALL {
                    return Some(ALL);
                }
            }
        } else if met != 0 {
            open[height] = (block.first, met);
            height += 1;
        }
        if height == 0 {
            return Some(hidden);
        }
        let top = &mut open[height - 1];
        at = top.0 as usize + take_lane(&mut top.1);
        height -= usize::from(top.1 == 0);
    }
}

/// Bit per ray that meets the box: the operations of [`crate::shape::Shape::ray_entry`], ray by ray the same.
#[inline(always)]
fn met_by(lanes: impl Lanes, shaft: &Shaft, shape: &TurnedBox) -> u32 {
    let origin = shape.local_from_world_vector(shaft.from_in_world - shape.center_in_world()).to_array();
    let half = shape.half_extents_m().to_array();
    let (sin, cos) = shape.sin_cos();
    if sin == 0.0 && cos == 1.0 {
        return if shaft.has_parallel {
            eight_slabs::<true>(lanes, origin, &shaft.step, &shaft.inverse, half)
        } else {
            eight_slabs::<false>(lanes, origin, &shaft.step, &shaft.inverse, half)
        };
    }
    let (mut step, mut inverse) = (shaft.step, shaft.inverse);
    for ray in 0..RAYS {
        let (x, y) = (shaft.step[0][ray], shaft.step[1][ray]);
        step[0][ray] = cos * x + sin * y;
        step[1][ray] = cos * y - sin * x;
    }
    for axis in 0..2 {
        inverse[axis] = step[axis].map(|d| 1.0 / d);
    }
    eight_slabs::<true>(lanes, origin, &step, &inverse, half)
}

#[inline(always)]
fn eight_slabs<const PARALLEL_RAYS: bool>(
    lanes: impl Lanes,
    origin: [f64; 3],
    step: &[[f64; RAYS]; 3],
    inverse: &[[f64; RAYS]; 3],
    half: [f64; 3],
) -> u32 {
    let (mut enter, mut leave) = ([0.0; RAYS], [1.0; RAYS]);
    for axis in 0..3 {
        let (low, high) = (-half[axis] - origin[axis], half[axis] - origin[axis]);
        let outside = origin[axis].abs() > half[axis];
        let (stay_near, stay_far) =
            if outside { (f64::INFINITY, f64::NEG_INFINITY) } else { (f64::NEG_INFINITY, f64::INFINITY) };
        for ray in 0..RAYS {
            let (near, far) = (low * inverse[axis][ray], high * inverse[axis][ray]);
            let (mut first, mut last) = (smaller(near, far), larger(near, far));
            if PARALLEL_RAYS {
                let stays = step[axis][ray].abs() < PARALLEL;
                first = if stays { stay_near } else { first };
                last = if stays { stay_far } else { last };
            }
            enter[ray] = larger(first, enter[ray]);
            leave[ray] = smaller(last, leave[ray]);
        }
    }
    lanes.at_most_f64(&enter, &leave)
}
