//! Rejects rotated boxes of which only the bounds are met, sixteen at a time.

use super::tree::{Block, WideTree};
use crate::lanes::{LANES, Lane, Lanes, at_level, larger, smaller};

/// Sweep of a rectangle in plan: the centre moves from `from` by `step`; half the extents are `reach`.
#[derive(Clone, Copy)]
pub struct Motion {
    /// Start of the centre.
    pub from: [f32; 2],
    /// Displacement of the centre while the parameter goes from 0 to 1.
    pub step: [f32; 2],
    /// Half the size, plus twice the margin.
    pub reach: [f32; 2],
}

at_level! {
    /// Mask of the lanes of a leaf with rotated boxes that may be met by a motion between the parameters `enter` and
    /// `leave`, and of all lanes that are not rotated.
    pub fn met(tree: &WideTree, block: &Block, motion: &Motion, enter: &Lane, leave: &Lane) -> u32 = met_kernel;
}

#[inline(always)]
fn met_kernel(lanes: impl Lanes, tree: &WideTree, block: &Block, motion: &Motion, enter: &Lane, leave: &Lane) -> u32 {
    maybe_and_surely::<false>(lanes, tree, block, motion, enter, leave, 0.0).0
}

/// Masks of [`met`] and, on request, of the lanes that are certainly met. The motion lasts from 0 to 1 and is certainly
/// between the bounds' upper and lower faces from `enter + doubt` to `leave - doubt`.
#[inline(always)]
pub fn maybe_and_surely<const SURELY: bool>(
    lanes: impl Lanes,
    tree: &WideTree,
    block: &Block,
    motion: &Motion,
    enter: &Lane,
    leave: &Lane,
    doubt: f32,
) -> (u32, u32) {
    let of = &tree.turned[block.turned_lanes as usize];
    let Motion { from, step, reach } = *motion;
    let (mut apart, mut surely_apart) = ([0.0; LANES], [0.0; LANES]);
    for i in 0..LANES {
        let (sin, cos) = (of.sin[i], of.cos[i]);
        let (x, y) = (from[0] - of.center[0][i], from[1] - of.center[1][i]);
        let start = [lanes.multiply_add(cos, x, sin * y), lanes.multiply_add(cos, y, -(sin * x))];
        let step_u = lanes.multiply_add(cos, step[0], sin * step[1]);
        let step_v = lanes.multiply_add(cos, step[1], -(sin * step[0]));
        let reach_u = lanes.multiply_add(cos.abs(), reach[0], sin.abs() * reach[1]);
        let reach_v = lanes.multiply_add(sin.abs(), reach[0], cos.abs() * reach[1]);
        let (half_u, half_v) = (of.half[0][i], of.half[1][i]);
        let grown = [half_u + reach_u, half_v + reach_v];
        apart[i] = gap(lanes, start, [step_u, step_v], [enter[i], leave[i]], grown);
        if SURELY {
            let shrunk = [half_u - reach_u, half_v - reach_v];
            let part = [enter[i] + doubt, leave[i] - doubt];
            let gap = gap(lanes, start, [step_u, step_v], part, shrunk);
            // Empty parts and boxes decide nothing.
            surely_apart[i] = larger(larger(gap, part[0] - part[1]), larger(-shrunk[0], -shrunk[1]));
        }
    }
    let surely = if SURELY { block.turned & lanes.at_most(&surely_apart, &[0.0; LANES]) } else { 0 };
    (!block.turned | lanes.at_most(&apart, &[0.0; LANES]), surely)
}

/// Positive when a segment misses a rectangle around the origin. Separating axes: those of the rectangle and the normal
/// of the segment. The test uses nothing but the segment's ends, so that its rounding error is that of the ends,
/// however short the segment.
#[inline(always)]
fn gap(lanes: impl Lanes, start: [f32; 2], step: [f32; 2], part: [f32; 2], half: [f32; 2]) -> f32 {
    let (u0, v0) = (lanes.multiply_add(part[0], step[0], start[0]), lanes.multiply_add(part[0], step[1], start[1]));
    let (u1, v1) = (lanes.multiply_add(part[1], step[0], start[0]), lanes.multiply_add(part[1], step[1], start[1]));
    let beyond_u = larger(smaller(u0, u1), -larger(u0, u1)) - half[0];
    let beyond_v = larger(smaller(v0, v1), -larger(v0, v1)) - half[1];
    let (along_u, along_v) = (u1 - u0, v1 - v0);
    let offset = lanes.multiply_add(u0, along_v, -(v0 * along_u)).abs();
    let width = lanes.multiply_add(half[0], along_v.abs(), half[1] * along_u.abs());
    larger(larger(beyond_u, beyond_v), offset - width)
}
