//! Boxes near a point or a segment, and boxes that meet a window, found with the tree.

use super::closest::{SQUARE_SHARE, Segment};
use super::tree::{MAX_DEPTH, WideTree};
use crate::lanes::{LANES, Lane, Lanes, at_level, larger, smaller, take_lane};
use cosfly_frames::DVec3;

/// Upper bound in f32 of a squared distance; 0 for negative distances.
#[inline(always)]
pub fn most_square(distance_m: f64) -> f32 {
    let distance = larger(distance_m, 0.0);
    let square = smaller(distance * distance, f64::from(f32::MAX)) as f32;
    if distance == f64::INFINITY { f32::INFINITY } else { square * (1.0 + SQUARE_SHARE) }
}

/// Children of a block that remain to be tested.
#[derive(Clone, Copy)]
struct Open {
    first: u32,
    lanes: u32,
    /// Lower bounds of squared distances.
    squares: Lane,
}

/// Boxes that may be the nearest one, with lower bounds of squared distances.
struct Candidates {
    slots: [(u32, f32); Self::MOST],
    count: usize,
}

impl Candidates {
    const MOST: usize = 48;

    /// Calls `exact` for candidates that may be nearer than `best`, the nearest lower bound first.
    #[inline(always)]
    fn settle(&mut self, mut best: f32, exact: &mut dyn FnMut(usize) -> f32) -> f32 {
        let own = &mut self.slots[..self.count];
        let first = (1..own.len()).fold(0, |least, i| if own[i].1 < own[least].1 { i } else { least });
        if !own.is_empty() {
            own.swap(0, first);
        }
        for &mut (slot, square) in own {
            if square <= best {
                best = smaller(exact(slot as usize), best);
            }
        }
        self.count = 0;
        best
    }
}

at_level! {
    /// Calls `exact` with at least the slots whose squared distance from the segment is at most the value that it last
    /// returned, at first `within`; false when f32 is not applicable. Both ends may be equal.
    pub fn around(tree: &WideTree, from_in_world: DVec3, to_in_world: DVec3, within: f32, exact: &mut dyn FnMut(usize) -> f32) -> bool = around_kernel;
}

#[inline(always)]
fn around_kernel(
    lanes: impl Lanes,
    tree: &WideTree,
    from_in_world: DVec3,
    to_in_world: DVec3,
    within: f32,
    exact: &mut dyn FnMut(usize) -> f32,
) -> bool {
    let from = (from_in_world - tree.origin_in_world).as_vec3a();
    let to = (to_in_world - tree.origin_in_world).as_vec3a();
    let Some(reach) = WideTree::reach_of(from, to) else { return false };
    let segment = Segment::new(from, to, tree.margin(reach));
    let mut open = [Open { first: 0, lanes: 0, squares: [0.0; LANES] }; MAX_DEPTH];
    let mut candidates = Candidates { slots: [(0, 0.0); Candidates::MOST], count: 0 };
    let (mut height, mut at, mut best) = (0, 0_usize, within);
    while let Some(block) = tree.blocks.get(at) {
        let squares = segment.least_squares(lanes, block);
        let mut met = lanes.at_most(&squares, &[best; LANES]) & block.valid;
        if met != 0 && block.is_leaf {
            let mut least = squares;
            if met & met.wrapping_sub(1) != 0 || met & block.turned != 0 {
                let bracket = segment.bracket(lanes, tree, block, &squares);
                (least, best) = (bracket.least, smaller(smallest(&bracket.most), best));
                met &= lanes.at_most(&least, &[best; LANES]);
            }
            if candidates.count > Candidates::MOST - LANES {
                best = candidates.settle(best, exact);
            }
            while met != 0 {
                let lane = take_lane(&mut met);
                candidates.slots[candidates.count] = (block.first + lane as u32, least[lane]);
                candidates.count += 1;
            }
        } else if met != 0 {
            // The nearest child first; most others will be too far away after that.
            let mut nearest = met & lanes.at_most(&squares, &[smallest(&squares); LANES]);
            let lane = take_lane(&mut nearest);
            open[height] = Open { first: block.first, lanes: met & !(1 << lane), squares };
            height += 1;
            at = block.first as usize + lane;
            continue;
        }
        let Some(next) = next_open(lanes, &mut open, &mut height, best) else { break };
        at = next;
    }
    candidates.settle(best, exact);
    true
}

/// Removes a child within `best` from the topmost block that has one.
#[inline(always)]
fn next_open(lanes: impl Lanes, open: &mut [Open; MAX_DEPTH], height: &mut usize, best: f32) -> Option<usize> {
    while *height > 0 {
        let top = &mut open[*height - 1];
        top.lanes &= lanes.at_most(&top.squares, &[best; LANES]);
        if top.lanes != 0 {
            return Some(top.first as usize + take_lane(&mut top.lanes));
        }
        *height -= 1;
    }
    None
}

/// Smallest lane. Empty lanes are infinite.
#[inline(always)]
fn smallest(numbers: &Lane) -> f32 {
    let (mut eight, mut four) = ([0.0; 8], [0.0; 4]);
    for i in 0..8 {
        eight[i] = smaller(numbers[i], numbers[i + 8]);
    }
    for i in 0..4 {
        four[i] = smaller(eight[i], eight[i + 4]);
    }
    smaller(smaller(four[0], four[2]), smaller(four[1], four[3]))
}

at_level! {
    /// Calls `exact` with at least the slots whose bounds meet the window between two corners in local coordinates.
    pub fn meeting(tree: &WideTree, min: DVec3, max: DVec3, exact: &mut dyn FnMut(usize)) -> () = meeting_kernel;
}

#[inline(always)]
fn meeting_kernel(lanes: impl Lanes, tree: &WideTree, min: DVec3, max: DVec3, exact: &mut dyn FnMut(usize)) {
    let reach = min.abs().max(max.abs()).max_element() as f32;
    let window = Segment::window(min.as_vec3a(), max.as_vec3a(), tree.margin(reach));
    let mut open = [(0_u32, 0_u32); MAX_DEPTH];
    let (mut height, mut at) = (0, 0_usize);
    while let Some(block) = tree.blocks.get(at) {
        let squares = window.least_squares(lanes, block);
        let mut met = lanes.at_most(&squares, &[0.0; LANES]) & block.valid;
        if block.is_leaf {
            while met != 0 {
                exact(block.first as usize + take_lane(&mut met));
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
}
