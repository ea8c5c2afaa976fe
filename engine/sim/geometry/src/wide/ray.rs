//! Rays through the tree: occlusion and first hits.

use super::tree::{Block, MAX_DEPTH, WideTree};
use super::turned::{self, Motion};
use crate::lanes::{LANES, Lane, Lanes, at_level, larger, smaller, take_lane};
use crate::shape::Shape;
use crate::turned_box::TurnedBox;
use cosfly_frames::DVec3;
use glam::Vec3A;

/// Relative widening of parameters: a direction, its inverse, the widening itself and the crossing are each rounded
/// once, by 2^-24.
pub const PARAMETER_SHARE: f32 = 8.0 / 16_777_216.0;
/// Inverse of a direction component that is 0: finite when multiplied by coordinates within reach.
const STANDING: f32 = 1e30;
/// Smallest direction component that moves in f32.
const LEAST_STEP: f32 = 1e-30;

/// Inverse of a direction, axis by axis.
#[inline(always)]
pub fn inverse(step: Vec3A) -> Vec3A {
    Vec3A::select(step.abs().cmplt(Vec3A::splat(LEAST_STEP)), Vec3A::splat(STANDING), step.recip())
}

/// A ray prepared for blocks: it crosses a face at `x` at the parameter `x * scale + offset`. Near and far faces are
/// moved outwards by the margin.
#[derive(Clone, Copy)]
struct WideRay {
    near_scale: [f32; 3],
    near_offset: [f32; 3],
    far_scale: [f32; 3],
    far_offset: [f32; 3],
    /// Delay after which the ray is surely behind a near face.
    doubt: [f32; 3],
    /// Number of the face of each axis that comes first.
    first: [usize; 3],
    motion: Motion,
}

impl WideRay {
    /// Creates the ray `from + t * step` in local coordinates.
    #[inline(always)]
    fn new(from: Vec3A, step: Vec3A, margin: f32) -> Self {
        let inverse = inverse(step);
        let backwards = inverse.cmplt(Vec3A::ZERO);
        let outwards = Vec3A::select(backwards, Vec3A::splat(margin), Vec3A::splat(-margin));
        let (less, more) = (1.0 - PARAMETER_SHARE, 1.0 + PARAMETER_SHARE);
        // Twice the margin, and the widening on both sides of parameters up to 1.
        let doubt = inverse.abs() * (2.0001 * margin) + Vec3A::splat(64.0 / 16_777_216.0);
        let mask = backwards.bitmask() as usize;
        let (from_array, step_array) = (from.to_array(), step.to_array());
        Self {
            near_scale: (inverse * less).to_array(),
            near_offset: ((outwards - from) * less * inverse).to_array(),
            far_scale: (inverse * more).to_array(),
            far_offset: ((-outwards - from) * more * inverse).to_array(),
            doubt: doubt.to_array(),
            first: [mask & 1, mask >> 1 & 1, mask >> 2 & 1],
            motion: Motion {
                from: [from_array[0], from_array[1]],
                step: [step_array[0], step_array[1]],
                reach: [2.0 * margin; 2],
            },
        }
    }

    /// Masks and parameters of the lanes whose bounds the ray may meet at a parameter of at most `max_t`, and the mask
    /// of those that it certainly meets.
    #[inline(always)]
    fn met<const SURELY: bool>(&self, lanes: impl Lanes, block: &Block, max_t: f32) -> Met {
        let (mut enter, mut leave) = ([0.0; LANES], [max_t; LANES]);
        let (mut sure_enter, mut sure_leave) = ([0.0; LANES], [1.0 - PARAMETER_SHARE; LANES]);
        for axis in 0..3 {
            let (near, far) = block.near_and_far(axis, self.first[axis]);
            for i in 0..LANES {
                let t_near = lanes.multiply_add(near[i], self.near_scale[axis], self.near_offset[axis]);
                let t_far = lanes.multiply_add(far[i], self.far_scale[axis], self.far_offset[axis]);
                enter[i] = larger(t_near, enter[i]);
                leave[i] = smaller(t_far, leave[i]);
                if SURELY {
                    sure_enter[i] = larger(t_near + self.doubt[axis], sure_enter[i]);
                    sure_leave[i] = smaller(t_far - self.doubt[axis], sure_leave[i]);
                }
            }
        }
        let surely = if SURELY { lanes.at_most(&sure_enter, &sure_leave) & block.valid } else { 0 };
        Met { maybe: lanes.at_most(&enter, &leave) & block.valid, surely, enter, leave }
    }
}

/// Lanes met by a ray.
struct Met {
    maybe: u32,
    surely: u32,
    enter: Lane,
    leave: Lane,
}

at_level! {
    /// Whether a box lies between two points; `None` when f32 is not applicable. `slots` are the boxes in the tree's
    /// order.
    pub fn blocked(tree: &WideTree, slots: &[TurnedBox], from_in_world: DVec3, to_in_world: DVec3) -> Option<bool> = blocked_kernel;
}

#[inline(always)]
fn blocked_kernel(
    lanes: impl Lanes,
    tree: &WideTree,
    slots: &[TurnedBox],
    from_in_world: DVec3,
    to_in_world: DVec3,
) -> Option<bool> {
    let from = (from_in_world - tree.origin_in_world).as_vec3a();
    let step_in_world = to_in_world - from_in_world;
    let step = step_in_world.as_vec3a();
    let reach = WideTree::reach_of(from, from + step)?;
    let ray = WideRay::new(from, step, tree.margin(reach));
    let mut open = [(0_u32, 0_u32); MAX_DEPTH];
    let (mut height, mut at) = (0, 0_usize);
    while let Some(block) = tree.blocks.get(at) {
        // Most rays meet two or three blocks: broadcasting the ray to lanes before the loop costs more than it saves.
        let ray = core::hint::black_box(&ray);
        if block.is_leaf {
            let mut met = ray.met::<true>(lanes, block, 1.0 + PARAMETER_SHARE);
            if met.surely & !block.turned != 0 {
                return Some(true);
            }
            if met.maybe & block.turned != 0 {
                let (enter, leave, doubt) = (&met.enter, &met.leave, ray.doubt[2]);
                let (maybe, surely) =
                    turned::maybe_and_surely::<true>(lanes, tree, block, &ray.motion, enter, leave, doubt);
                if met.maybe & surely != 0 {
                    return Some(true);
                }
                met.maybe &= maybe;
            }
            while met.maybe != 0 {
                let slot = block.first as usize + take_lane(&mut met.maybe);
                if slots[slot].ray_entry(from_in_world, step_in_world, 1.0).is_some() {
                    return Some(true);
                }
            }
        } else {
            let met = ray.met::<false>(lanes, block, 1.0 + PARAMETER_SHARE);
            if met.maybe != 0 {
                open[height] = (block.first, met.maybe);
                height += 1;
            }
        }
        if height == 0 {
            break;
        }
        let top = &mut open[height - 1];
        at = top.0 as usize + take_lane(&mut top.1);
        height -= usize::from(top.1 == 0);
    }
    Some(false)
}

/// Most waiting blocks, each with the parameter or distance at which it begins.
const WAITING: usize = (MAX_DEPTH + 1) * LANES;

at_level! {
    /// Calls `exact` with the slots that the ray `from + t * step`, in local coordinates, may meet, approximately in
    /// order, up to the parameter that it last returned, at first `max_t`.
    pub fn along(tree: &WideTree, from: Vec3A, step: Vec3A, max_t: f32, exact: &mut dyn FnMut(usize) -> f32) -> () = along_kernel;
}

#[inline(always)]
fn along_kernel(
    lanes: impl Lanes,
    tree: &WideTree,
    from: Vec3A,
    step: Vec3A,
    max_t: f32,
    exact: &mut dyn FnMut(usize) -> f32,
) {
    let ray = WideRay::new(from, step, tree.margin(from.abs().max_element()));
    let mut best = max_t;
    let mut waiting = [(0_u32, 0.0_f32); WAITING];
    let mut height = usize::from(!tree.blocks.is_empty());
    while height > 0 {
        height -= 1;
        let (at, begin) = waiting[height];
        if begin > best {
            continue;
        }
        let block = &tree.blocks[at as usize];
        let mut met = ray.met::<false>(lanes, block, best);
        if !block.is_leaf {
            height = push_nearest_last(&mut waiting, height, block.first, met.maybe, &met.enter);
            continue;
        }
        if met.maybe & block.turned != 0 {
            met.maybe &= turned::met(lanes.level(), tree, block, &ray.motion, &met.enter, &met.leave);
        }
        while met.maybe != 0 {
            let lane = take_lane(&mut met.maybe);
            if met.enter[lane] <= best {
                best = exact(block.first as usize + lane);
            }
        }
    }
}

/// Pushes children onto the waiting blocks such that those with smaller keys are popped first.
#[inline(always)]
fn push_nearest_last(
    waiting: &mut [(u32, f32); WAITING],
    height: usize,
    first: u32,
    mut met: u32,
    keys: &Lane,
) -> usize {
    let mut top = height;
    while met != 0 {
        let lane = take_lane(&mut met);
        let key = keys[lane];
        let mut place = top;
        while place > height && waiting[place - 1].1 < key {
            waiting[place] = waiting[place - 1];
            place -= 1;
        }
        waiting[place] = (first + lane as u32, key);
        top += 1;
    }
    top
}
