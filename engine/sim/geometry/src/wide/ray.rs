//! Rays through the tree: whether anything stands in the way, and what comes first.

use super::tree::{Block, MAX_DEPTH, WideTree};
use crate::lanes::{LANES, Lane, Lanes, at_level, larger, smaller, take_lane};
use cosfly_frames::DVec3;

/// Share by which parameters are widened: a direction, its inverse, a product and a sum are each rounded once.
const PARAMETER_SHARE: f32 = 8.0 / 16_777_216.0;
/// Stands for one over a direction that does not move along an axis: with faces within reach it still is finite.
const STANDING: f32 = 1e30;
/// Directions below this move nowhere in f32.
const LEAST_STEP: f32 = 1e-30;

/// One over a direction.
#[inline(always)]
pub fn inverse(direction: f32) -> f32 {
    if direction.abs() < LEAST_STEP { STANDING } else { 1.0 / direction }
}

/// A ray made ready for blocks: where it crosses a face at `x` is `x * scale + offset`.
#[derive(Clone, Copy)]
pub struct WideRay {
    near: [Crossing; 3],
    far: [Crossing; 3],
    inner_near: [Crossing; 3],
    inner_far: [Crossing; 3],
    backwards: [bool; 3],
    from: [f32; 3],
    step: [f32; 3],
    margin: f32,
}

#[derive(Clone, Copy)]
struct Crossing {
    scale: f32,
    offset: f32,
}

impl Crossing {
    /// Of the faces moved by `shift` with the ray that starts at `origin`.
    #[inline(always)]
    fn new(origin: f64, shift: f64, scale: f32) -> Self {
        Self { scale, offset: -((origin - shift) as f32 * scale) }
    }
}

impl WideRay {
    /// For the ray `from + t * step` in local coordinates.
    #[inline(always)]
    pub fn new(from: DVec3, step: DVec3, margin_m: f64) -> Self {
        let nothing = Crossing { scale: 0.0, offset: 0.0 };
        let mut ray = Self {
            near: [nothing; 3],
            far: [nothing; 3],
            inner_near: [nothing; 3],
            inner_far: [nothing; 3],
            backwards: [false; 3],
            from: from.as_vec3().to_array(),
            step: step.as_vec3().to_array(),
            margin: margin_m as f32,
        };
        for axis in 0..3 {
            let scale = inverse(ray.step[axis]);
            let backwards = scale < 0.0;
            let outwards = if backwards { margin_m } else { -margin_m };
            let (small, large) = (scale * (1.0 - PARAMETER_SHARE), scale * (1.0 + PARAMETER_SHARE));
            ray.backwards[axis] = backwards;
            ray.near[axis] = Crossing::new(from[axis], outwards, small);
            ray.far[axis] = Crossing::new(from[axis], -outwards, large);
            ray.inner_near[axis] = Crossing::new(from[axis], -outwards, large);
            ray.inner_far[axis] = Crossing::new(from[axis], outwards, small);
        }
        ray
    }

    /// Bits of the lanes whose bounds the ray may meet at a parameter of at most `max_t`, and where.
    #[inline(always)]
    fn met(&self, lanes: impl Lanes, block: &Block, max_t: f32) -> (u32, Lane, Lane) {
        self.crossed(lanes, block, (&self.near, &self.far), max_t)
    }

    /// Bits of the lanes whose bounds the ray meets beyond doubt between 0 and 1.
    #[inline(always)]
    fn surely_met(&self, lanes: impl Lanes, block: &Block) -> u32 {
        self.crossed(lanes, block, (&self.inner_near, &self.inner_far), 1.0 - PARAMETER_SHARE).0
    }

    #[inline(always)]
    fn crossed(
        &self,
        lanes: impl Lanes,
        block: &Block,
        (near, far): (&[Crossing; 3], &[Crossing; 3]),
        max_t: f32,
    ) -> (u32, Lane, Lane) {
        let (mut enter, mut leave) = ([0.0; LANES], [max_t; LANES]);
        for axis in 0..3 {
            let faces = &block.faces[axis];
            let (first, last) = if self.backwards[axis] { (&faces[1], &faces[0]) } else { (&faces[0], &faces[1]) };
            for i in 0..LANES {
                let t_near = lanes.multiply_add(first[i], near[axis].scale, near[axis].offset);
                let t_far = lanes.multiply_add(last[i], far[axis].scale, far[axis].offset);
                enter[i] = larger(t_near, enter[i]);
                leave[i] = smaller(t_far, leave[i]);
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
        let reach = [2.0 * self.margin; 2];
        let [from, step] = [self.from, self.step].map(|v| [v[0], v[1]]);
        met & (!block.turned | turned.met(lanes, from, step, reach, ways.0, ways.1))
    }
}

at_level! {
    /// Whether a box stands on the ray between 0 and 1. `exact` says so of a slot that f32 cannot decide.
    pub fn blocked(tree: &WideTree, ray: &WideRay, exact: &mut dyn FnMut(usize) -> bool) -> bool = blocked_kernel;
}

#[inline(always)]
fn blocked_kernel(lanes: impl Lanes, tree: &WideTree, ray: &WideRay, exact: &mut dyn FnMut(usize) -> bool) -> bool {
    let mut open = [(0_u32, 0_u32); MAX_DEPTH];
    let (mut height, mut at) = (0, 0_usize);
    if tree.blocks.is_empty() {
        return false;
    }
    loop {
        let block = &tree.blocks[at];
        let (met, enter, leave) = ray.met(lanes, block, 1.0 + PARAMETER_SHARE);
        if block.is_leaf {
            if ray.surely_met(lanes, block) & !block.turned != 0 {
                return true;
            }
            if met != 0 {
                let mut met = ray.without_missed_turned(lanes, tree, block, met, (&enter, &leave));
                while met != 0 {
                    let lane = take_lane(&mut met);
                    if exact(block.first as usize + lane) {
                        return true;
                    }
                }
            }
        } else if met != 0 {
            open[height] = (block.first, met);
            height += 1;
        }
        if height == 0 {
            return false;
        }
        let top = &mut open[height - 1];
        at = top.0 as usize + take_lane(&mut top.1);
        height -= usize::from(top.1 == 0);
    }
}

/// Blocks that wait with the parameter or distance at which they begin.
pub const WAITING: usize = (MAX_DEPTH + 1) * LANES;

at_level! {
    /// Calls `exact` with the slots that the ray may meet, roughly in order, up to the parameter that it last gave,
    /// at first `max_t`.
    pub fn along(tree: &WideTree, ray: &WideRay, max_t: f32, exact: &mut dyn FnMut(usize) -> f32) -> () = along_kernel;
}

#[inline(always)]
fn along_kernel(lanes: impl Lanes, tree: &WideTree, ray: &WideRay, max_t: f32, exact: &mut dyn FnMut(usize) -> f32) {
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
        let (mut met, enter, leave) = ray.met(lanes, block, best);
        if !block.is_leaf {
            height = push_nearest_last(&mut waiting, height, block.first, met, &enter);
            continue;
        }
        met = ray.without_missed_turned(lanes, tree, block, met, (&enter, &leave));
        while met != 0 {
            let lane = take_lane(&mut met);
            if enter[lane] <= best {
                best = exact(block.first as usize + lane);
            }
        }
    }
}

/// Adds children to the waiting blocks such that those with smaller keys come off first.
#[inline(always)]
pub fn push_nearest_last(
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
