//! Builds the tree: sets of boxes are split by the surface-area heuristic until each fits one block of sixteen.
//!
//! A block costs the same however many lanes it uses, so the cost of a set is the area of its bounds times the number
//! of blocks that it needs, and spare lanes go to splits that reduce the areas most.

use super::tree::{Block, MAX_DEPTH, REACH_M, WideTree};
use super::turned_lanes::TurnedLanes;
use crate::bounds::Bounds;
use crate::lanes::LANES;
use crate::turned_box::TurnedBox;
use cosfly_frames::DVec3;
use glam::Vec3A;
use std::ops::Range;

/// Bins per axis of the surface-area heuristic.
const BINS: usize = 12;
/// Level below which sets are split at the median, which bounds the depth of the whole tree.
const SAH_LEVELS: usize = 8;
/// Least share of its area by which a split must reduce a set that fits into one block.
const WORTHWHILE: f32 = 0.15;

/// Bounds in f32 relative to the local origin.
#[derive(Clone, Copy)]
struct Around {
    min: Vec3A,
    max: Vec3A,
}

impl Around {
    const EMPTY: Self = Self { min: Vec3A::INFINITY, max: Vec3A::NEG_INFINITY };

    #[inline(always)]
    fn with(self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    #[inline(always)]
    fn half_area(&self) -> f32 {
        let size = (self.max - self.min).max(Vec3A::ZERO);
        (size * Vec3A::new(size.y, size.z, size.x)).element_sum()
    }

    /// Twice the centre.
    #[inline(always)]
    fn twice_center(&self) -> Vec3A {
        self.min + self.max
    }
}

#[derive(Clone, Copy)]
struct Item {
    around: Around,
    original: u32,
}

/// A range of items and its best split.
struct Set {
    items: Range<usize>,
    around: Around,
    split: Option<Split>,
}

#[derive(Clone, Copy)]
struct Split {
    axis: usize,
    last_left_bin: usize,
    low: Vec3A,
    scale: Vec3A,
    /// Sum over both sides of area times number of blocks.
    cost: f32,
}

/// Builds the tree over boxes, and lists the indices of boxes too far from the others for f32; deterministic. Slot i of
/// the tree is box `order[i]`.
pub fn build(boxes: &[TurnedBox], bounds: &[Bounds]) -> (WideTree, Vec<u32>) {
    let origin = origin_of(bounds);
    let (mut items, mut wild, mut size_m) = (Vec::with_capacity(boxes.len()), Vec::new(), 0.0_f64);
    for (index, one) in bounds.iter().enumerate() {
        let (min, max) = (one.min_in_world - origin, one.max_in_world - origin);
        let reach_m = min.abs().max(max.abs()).max_element();
        if reach_m <= REACH_M {
            size_m = size_m.max(reach_m);
            let around = Around { min: min.as_vec3a(), max: max.as_vec3a() };
            items.push(Item { around, original: index as u32 });
        } else {
            wild.push(index as u32);
        }
    }
    let blocks = Vec::with_capacity(items.len() / 8 + 1);
    let least_margin = WideTree::least_margin_of(size_m, origin);
    let home = 2.0 * size_m as f32 + 100.0;
    let home_margin = WideTree::least_margin_of(size_m + f64::from(home), origin);
    let (turned, order) = (Vec::new(), Vec::new());
    let mut tree =
        WideTree { blocks, turned, origin_in_world: origin, depth: 0, least_margin, home, home_margin, order };
    if !items.is_empty() {
        tree.blocks.push(Block::empty(true));
        let mut open = vec![(0_usize, 0..items.len(), 1_usize)];
        while let Some((at, range, depth)) = open.pop() {
            tree.depth = tree.depth.max(depth);
            if range.len() <= LANES {
                tree.blocks[at] = leaf(&items[range.clone()], range.start);
                continue;
            }
            let sets = part(&mut items, range, depth);
            let first = tree.blocks.len();
            tree.blocks[at] = parent(&sets, first);
            for (lane, set) in sets.into_iter().enumerate() {
                tree.blocks.push(Block::empty(true));
                open.push((first + lane, set.items, depth + 1));
            }
        }
    }
    debug_assert!(tree.depth <= MAX_DEPTH);
    tree.order = items.iter().map(|item| item.original).collect();
    add_turned(&mut tree, boxes);
    (tree, wild)
}

/// Local origin: the centre of all boxes, or of most of them where some are extremely far away.
fn origin_of(bounds: &[Bounds]) -> DVec3 {
    let all = bounds.iter().fold(Bounds::EMPTY, |sum, one| sum.union(one));
    let middle = all.center_in_world();
    if bounds.is_empty() {
        return DVec3::ZERO;
    }
    if (all.max_in_world - middle).max_element() <= REACH_M {
        return middle;
    }
    DVec3::from_array(core::array::from_fn(|axis| {
        let mut centers: Vec<f64> = bounds.iter().map(|one| one.center_in_world()[axis]).collect();
        let middle = centers.len() / 2;
        *centers.select_nth_unstable_by(middle, f64::total_cmp).1
    }))
}

fn leaf(items: &[Item], first: usize) -> Block {
    let mut block = Block::empty(true);
    items.iter().enumerate().for_each(|(lane, item)| fill_lane(&mut block, lane, &item.around));
    block.first = first as u32;
    block
}

fn parent(sets: &[Set], first: usize) -> Block {
    let mut block = Block::empty(false);
    sets.iter().enumerate().for_each(|(lane, set)| fill_lane(&mut block, lane, &set.around));
    block.first = first as u32;
    block
}

fn fill_lane(block: &mut Block, lane: usize, around: &Around) {
    for axis in 0..3 {
        block.faces[axis][0][lane] = around.min[axis];
        block.faces[axis][1][lane] = around.max[axis];
    }
    block.valid |= 1 << lane;
}

/// Adds the own axes of rotated boxes to every leaf that has any.
fn add_turned(tree: &mut WideTree, boxes: &[TurnedBox]) {
    for block in tree.blocks.iter_mut().filter(|block| block.is_leaf) {
        let of_lane = |lane: usize| &boxes[tree.order[block.first as usize + lane] as usize];
        let valid = block.valid;
        let lanes = (0..LANES).filter(|lane| valid >> lane & 1 == 1);
        block.turned =
            lanes.clone().filter(|&lane| !of_lane(lane).is_along_axes()).fold(0, |mask, lane| mask | 1 << lane);
        if block.turned != 0 {
            block.turned_lanes = tree.turned.len() as u32;
            let mut turned = TurnedLanes::EMPTY;
            lanes.for_each(|lane| turned.set(lane, of_lane(lane), tree.origin_in_world));
            tree.turned.push(turned);
        }
    }
}

/// Partitions more than [`LANES`] items into 2 to [`LANES`] sets, reordering them so that each set is a range.
fn part(items: &mut [Item], range: Range<usize>, depth: usize) -> Vec<Set> {
    let by_area = depth < SAH_LEVELS;
    let mut sets = Vec::with_capacity(LANES);
    sets.push(set(items, range, by_area));
    while sets.len() < LANES {
        let Some(at) = next_to_split(&sets, by_area) else { break };
        let Set { items: range, split, around } = sets.swap_remove(at);
        let middle = range.start + divide(&mut items[range.clone()], split, &around);
        sets.push(set(items, range.start..middle, by_area));
        sets.push(set(items, middle..range.end, by_area));
    }
    sets.sort_by_key(|set| set.items.start);
    sets
}

fn set(items: &[Item], range: Range<usize>, by_area: bool) -> Set {
    let own = &items[range.clone()];
    let around = own.iter().fold(Around::EMPTY, |sum, item| sum.with(&item.around));
    let split = if by_area && own.len() > 1 { best_split(own) } else { None };
    Set { items: range, around, split }
}

fn blocks_of(count: usize) -> f32 {
    count.div_ceil(LANES) as f32
}

/// Set to split next: sets too large for a block first, the largest by area and blocks; then the set whose split saves
/// most.
fn next_to_split(sets: &[Set], by_area: bool) -> Option<usize> {
    let mut best: Option<(usize, (bool, f32))> = None;
    for (at, set) in sets.iter().enumerate() {
        let (count, area) = (set.items.len(), set.around.half_area());
        let key = if count > LANES {
            (true, if by_area { area * blocks_of(count) } else { count as f32 })
        } else {
            let Some(split) = set.split else { continue };
            let saved = area * (1.0 - WORTHWHILE) - split.cost;
            if saved.is_nan() || saved <= 0.0 {
                continue;
            }
            (false, saved)
        };
        if best.is_none_or(|(_, b)| (key.0 && !b.0) || (key.0 == b.0 && key.1 > b.1)) {
            best = Some((at, key));
        }
    }
    best.map(|(at, _)| at)
}

/// Bin of a centre along every axis.
#[inline(always)]
fn bins_of(center: Vec3A, low: Vec3A, scale: Vec3A) -> [usize; 3] {
    let at = ((center - low) * scale).to_array();
    [0, 1, 2].map(|axis| (at[axis] as usize).min(BINS - 1))
}

/// Reorders the items into a left and a right part and returns the left part's length, neither 0 nor all.
fn divide(items: &mut [Item], split: Option<Split>, around: &Around) -> usize {
    let mut left = 0;
    if let Some(Split { axis, last_left_bin, low, scale, .. }) = split {
        for at in 0..items.len() {
            if bins_of(items[at].around.twice_center(), low, scale)[axis] <= last_left_bin {
                items.swap(at, left);
                left += 1;
            }
        }
    }
    if left > 0 && left < items.len() {
        return left;
    }
    let size = |axis: usize| around.max[axis] - around.min[axis];
    let axis = (1..3).fold(0, |best, axis| if size(axis) > size(best) { axis } else { best });
    let middle = items.len() / 2;
    items.select_nth_unstable_by(middle, |a, b| {
        let centers = (a.around.twice_center()[axis], b.around.twice_center()[axis]);
        centers.0.total_cmp(&centers.1).then(a.original.cmp(&b.original))
    });
    middle
}

fn best_split(items: &[Item]) -> Option<Split> {
    let mut centers = Around::EMPTY;
    for item in items {
        let center = item.around.twice_center();
        centers = centers.with(&Around { min: center, max: center });
    }
    let (low, size) = (centers.min, centers.max - centers.min);
    let scale = Vec3A::splat(BINS as f32) / size;
    // Along an axis without extent all items fall into one bin, which is not a split.
    let scale = Vec3A::select(size.cmpgt(Vec3A::ZERO) & scale.cmplt(Vec3A::INFINITY), scale, Vec3A::ZERO);
    let mut bins = [[(Around::EMPTY, 0_u32); BINS]; 3];
    for item in items {
        let at = bins_of(item.around.twice_center(), low, scale);
        for axis in 0..3 {
            let bin = &mut bins[axis][at[axis]];
            *bin = (bin.0.with(&item.around), bin.1 + 1);
        }
    }
    let mut best: Option<Split> = None;
    for (axis, bins) in bins.iter().enumerate() {
        let mut right_costs = [0.0_f32; BINS];
        let (mut around, mut count) = (Around::EMPTY, 0);
        for at in (1..BINS).rev() {
            (around, count) = (around.with(&bins[at].0), count + bins[at].1 as usize);
            right_costs[at] = blocks_of(count) * around.half_area();
        }
        (around, count) = (Around::EMPTY, 0);
        for at in 0..BINS - 1 {
            (around, count) = (around.with(&bins[at].0), count + bins[at].1 as usize);
            let cost = blocks_of(count) * around.half_area() + right_costs[at + 1];
            if count > 0 && count < items.len() && best.is_none_or(|b| cost < b.cost) {
                best = Some(Split { axis, last_left_bin: at, low, scale, cost });
            }
        }
    }
    best
}
