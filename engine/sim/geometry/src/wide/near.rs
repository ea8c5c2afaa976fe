//! What is close to a point or a segment, through the tree.

use super::tree::{Block, MAX_DEPTH, WideTree};
use crate::lanes::{LANES, Lane, Lanes, at_level, larger, smaller, take_lane};
use cosfly_frames::DVec3;

/// Share by which squared distances are lessened for their own rounding.
const SQUARE_SHARE: f32 = 8.0 / 16_777_216.0;

/// A segment made ready for blocks: its bounds grown by the margin.
pub struct WideSegment {
    from: [f32; 3],
    to: [f32; 3],
    low: [f32; 3],
    high: [f32; 3],
    margin: f32,
    /// Whether only its bounds count.
    is_window: bool,
}

impl WideSegment {
    /// Between two points in local coordinates, which may be the same.
    #[inline(always)]
    pub fn new(from: DVec3, to: DVec3, margin_m: f64) -> Self {
        let margin = DVec3::splat(margin_m);
        Self {
            from: from.as_vec3().to_array(),
            to: to.as_vec3().to_array(),
            low: (from.min(to) - margin).as_vec3().to_array(),
            high: (from.max(to) + margin).as_vec3().to_array(),
            margin: margin_m as f32,
            is_window: false,
        }
    }

    /// A box between two corners, which is at distance 0 from what it meets.
    #[inline(always)]
    pub fn window(min: DVec3, max: DVec3, margin_m: f64) -> Self {
        let margin = DVec3::splat(margin_m);
        let (low, high) = ((min - margin).as_vec3().to_array(), (max + margin).as_vec3().to_array());
        Self { from: low, to: high, low, high, margin: margin_m as f32, is_window: true }
    }

    /// For each lane a squared distance that is no larger than the true one.
    #[inline(always)]
    fn least_squares(&self, lanes: impl Lanes, tree: &WideTree, block: &Block) -> Lane {
        let mut squares = [0.0; LANES];
        let mut vertical = [0.0; LANES];
        for axis in 0..3 {
            let [min, max] = &block.faces[axis];
            for i in 0..LANES {
                let gap = larger(larger(min[i] - self.high[axis], self.low[axis] - max[i]), 0.0);
                squares[i] = lanes.multiply_add(gap, gap, squares[i]);
                vertical[i] = gap;
            }
        }
        if block.turned != 0 && !self.is_window {
            let turned = &tree.turned[block.turned_lanes as usize];
            let [from, to] = [self.from, self.to].map(|v| [v[0], v[1]]);
            let [along, across] = turned.gaps(lanes, from, to);
            for i in 0..LANES {
                let along = larger(along[i] - 2.0 * self.margin, 0.0);
                let across = larger(across[i] - 2.0 * self.margin, 0.0);
                let turned =
                    lanes.multiply_add(along, along, lanes.multiply_add(across, across, vertical[i] * vertical[i]));
                squares[i] = larger(turned, squares[i]);
            }
        }
        squares.map(|square| square * (1.0 - SQUARE_SHARE))
    }
}

/// A squared distance in f32 that is no smaller; 0 for negative distances.
#[inline(always)]
pub fn most_square(distance_m: f64) -> f32 {
    let distance = larger(distance_m, 0.0);
    let square = smaller(distance * distance, f64::from(f32::MAX)) as f32;
    if distance == f64::INFINITY { f32::INFINITY } else { square * (1.0 + SQUARE_SHARE) }
}

/// Marks a waiting slot, so that it is no block.
const SLOT: u32 = 1 << 31;

/// Blocks that wait with the parameter or distance at which they begin.
const WAITING: usize = (MAX_DEPTH + 1) * LANES;

at_level! {
    /// Calls `exact` with the slots that may be nearer than the square root of what it last gave, at first of
    /// `within`, roughly the nearest first.
    pub fn around(tree: &WideTree, segment: &WideSegment, within: f32, exact: &mut dyn FnMut(usize) -> f32) -> () = around_kernel;
}

#[inline(always)]
fn around_kernel(
    lanes: impl Lanes,
    tree: &WideTree,
    segment: &WideSegment,
    within: f32,
    exact: &mut dyn FnMut(usize) -> f32,
) {
    let mut best = within;
    let mut waiting = [(0_u32, 0.0_f32); WAITING];
    let mut height = usize::from(!tree.blocks.is_empty());
    while height > 0 {
        height -= 1;
        let (at, key) = waiting[height];
        if key > best {
            continue;
        }
        if at & SLOT != 0 {
            best = exact((at & !SLOT) as usize);
            continue;
        }
        let block = &tree.blocks[at as usize];
        let squares = segment.least_squares(lanes, tree, block);
        let met = lanes.at_most(&squares, &[best; LANES]) & block.valid;
        let first = if block.is_leaf { block.first | SLOT } else { block.first };
        height = push_nearest_last(&mut waiting, height, first, met, &squares);
    }
}

/// Adds children to the waiting blocks such that those with smaller keys come off first.
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
