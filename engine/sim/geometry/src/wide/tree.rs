//! The wide tree: blocks of sixteen bounds, each the parent of blocks or of boxes.

use super::turned_lanes::TurnedLanes;
use crate::bounds::Bounds;
use crate::lanes::{LANES, Lane};
use cosfly_frames::DVec3;
use glam::Vec3A;

/// Levels of the largest tree: eight by surface area, and 2^32 boxes split into eighths.
pub const MAX_DEPTH: usize = 20;
/// Largest distance from the local origin at which f32 is applicable, metres.
pub const REACH_M: f64 = 4e6;

/// Relative rounding error of coordinates in f32.
const F32_SHARE: f32 = 16.0 / 16_777_216.0;

/// Sixteen bounds relative to the local origin, and their children. Lanes beyond `valid` are empty.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub struct Block {
    /// Lower and upper faces for each axis, metres.
    pub faces: [[Lane; 2]; 3],
    /// First child block, or first slot of a leaf; lane i is number `first + i`.
    pub first: u32,
    /// Mask of lanes in use.
    pub valid: u32,
    /// Mask of lanes with rotated boxes, whose bounds are loose.
    pub turned: u32,
    /// Index into [`WideTree::turned`], if any lane is rotated.
    pub turned_lanes: u32,
    /// Whether the lanes are boxes.
    pub is_leaf: bool,
}

impl Block {
    /// Block without lanes.
    pub fn empty(is_leaf: bool) -> Self {
        let faces = [[[f32::INFINITY; LANES], [f32::NEG_INFINITY; LANES]]; 3];
        Self { faces, first: 0, valid: 0, turned: 0, turned_lanes: 0, is_leaf }
    }

    /// Faces of an axis, the lower ones first when `first` is 0, the upper ones first when it is 1.
    #[inline(always)]
    pub fn near_and_far(&self, axis: usize, first: usize) -> (&Lane, &Lane) {
        let faces = &self.faces[axis];
        (&faces[first & 1], &faces[first & 1 ^ 1])
    }
}

/// Sixteen-way tree over bounds; the root is block 0.
#[derive(Clone, Debug)]
pub struct WideTree {
    /// All blocks; children of a block are contiguous.
    pub blocks: Vec<Block>,
    /// Own axes of the boxes of leaves with rotated boxes.
    pub turned: Vec<TurnedLanes>,
    /// Place of the local origin.
    pub origin_in_world: DVec3,
    /// Number of levels of blocks.
    pub depth: usize,
    /// Constant part of [`WideTree::margin`], metres.
    pub least_margin: f32,
    /// Reach of queries near the boxes, metres: twice that of the boxes.
    pub home: f32,
    /// Margin of queries within `home`, metres.
    pub home_margin: f32,
    /// Original index of each slot.
    pub order: Vec<u32>,
}

impl WideTree {
    /// Largest coordinate of two points relative to the local origin; `None` when f32 is not applicable to them.
    #[inline(always)]
    pub fn reach_of(a: Vec3A, b: Vec3A) -> Option<f32> {
        let (a, b, most) = (a.abs(), b.abs(), Vec3A::splat(REACH_M as f32));
        // Numbers that are not finite fail the comparison.
        (a.cmple(most) & b.cmple(most)).all().then(|| a.max(b).max_element())
    }

    /// Largest effect of rounding on a face or a point of a query within `reach` of the local origin, metres.
    ///
    /// A face, a point, its sum with the margin, the inverse direction and its products with them are each off by at
    /// most half a unit in the last place, 2^-24 of the coordinates: at most ten in all. The bound is 16. World
    /// coordinates are rounded in f64 on both sides, which `least_margin` covers.
    #[inline(always)]
    pub fn margin(&self, reach: f32) -> f32 {
        // Near the boxes the margin is a constant, which does not depend on the reach.
        if reach <= self.home { self.home_margin } else { self.least_margin + F32_SHARE * reach }
    }

    /// Margin of queries that stay within the boxes, metres.
    pub fn least_margin_of(size_m: f64, origin_in_world: DVec3) -> f32 {
        (f64::from(F32_SHARE) * (1e-3 + size_m) + 1e-14 * origin_in_world.abs().max_element()) as f32
    }

    /// Checks the tree against the bounds it was built from.
    ///
    /// # Panics
    /// When a box is missing or duplicated, exceeds its lane by more than the margin, a child exceeds its parent's
    /// lane, a block is unreachable, or the tree is deeper than `depth`.
    pub fn assert_well_formed(&self, bounds: &[Bounds]) {
        let mut seen = vec![false; bounds.len()];
        let mut open: Vec<(usize, usize, Option<Bounds>)> = vec![(0, 1, None)];
        let (mut reached, mut deepest) = (0, 0);
        if self.blocks.is_empty() {
            open.clear();
        }
        while let Some((at, depth, parent)) = open.pop() {
            reached += 1;
            deepest = deepest.max(depth);
            let block = &self.blocks[at];
            for lane in (0..LANES).filter(|lane| block.valid >> lane & 1 == 1) {
                let corner = |side: usize| DVec3::from_array(block.faces.map(|axis| f64::from(axis[side][lane])));
                let around = Bounds { min_in_world: corner(0), max_in_world: corner(1) };
                assert!(parent.is_none_or(|p| p.contains(&around)), "lane {lane} of block {at} sticks out");
                let child = block.first as usize + lane;
                if !block.is_leaf {
                    open.push((child, depth + 1, Some(around)));
                    continue;
                }
                let original = self.order[child] as usize;
                assert!(!seen[original], "box {original} is in two lanes");
                seen[original] = true;
                let shift = |corner: DVec3| corner + self.origin_in_world;
                let in_world =
                    Bounds { min_in_world: shift(around.min_in_world), max_in_world: shift(around.max_in_world) };
                let grown = in_world.grown(f64::from(self.least_margin));
                assert!(grown.contains(&bounds[original]), "box {original} sticks out of its lane");
            }
        }
        assert_eq!(reached, self.blocks.len(), "unreachable blocks");
        assert!(deepest == self.depth && deepest <= MAX_DEPTH, "{deepest} levels, told {}", self.depth);
        assert!(self.order.iter().all(|&original| seen[original as usize]), "a box is in no leaf");
    }
}
