//! A binary bounding volume hierarchy (BVH) built by the surface-area heuristic.

use crate::bounds::Bounds;

/// Largest leaf, primitives, that the heuristic may leave unsplit.
const LEAF_SIZE: usize = 4;
/// Bins per axis of the surface-area heuristic.
const BINS: usize = 12;
/// Depth below which nodes are split at the median, which bounds the depth of the whole tree.
const SAH_DEPTH: usize = 24;
/// Entries of the traversal stack: `SAH_DEPTH` plus 32 median splits of at most 2^32 primitives, and the root.
const STACK: usize = 64;

/// A node: an inner node has its two children at `first` and `first + 1`, a leaf holds `count` primitives.
#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Bounds,
    first: u32,
    count: u32,
}

/// A BVH over the bounds of primitives. It stores the primitives' order in leaves ([`Bvh::order`]); owners store their
/// primitives in that order, and a [`Visitor`] gets slots.
#[derive(Clone, Debug)]
pub struct Bvh {
    nodes: Vec<Node>,
    order: Vec<u32>,
}

/// Decisions of a query during traversal.
pub trait Visitor {
    /// Lower bound of the keys of everything inside the bounds; `None` to skip them.
    fn key(&mut self, bounds: &Bounds) -> Option<f64>;
    /// Whether a node with this key is still relevant; called again when the node is popped.
    fn matters(&self, key: f64) -> bool;
    /// Tests the primitive in `slot` (an index into [`Bvh::order`]); true ends the query.
    fn visit(&mut self, slot: usize) -> bool;
}

impl Bvh {
    /// Builds the tree; deterministic. Bounds are enlarged by a billionth of the scene's size, so that rounding in a
    /// primitive's own arithmetic never exceeds them.
    pub fn build(bounds: &[Bounds]) -> Self {
        let mut tree = Self { nodes: Vec::new(), order: (0..bounds.len() as u32).collect() };
        if bounds.is_empty() {
            return tree;
        }
        let all = bounds.iter().fold(Bounds::EMPTY, |sum, one| sum.union(one));
        let size = all.min_in_world.abs().max(all.max_in_world.abs()).max_element();
        let margin_m = 1e-10 * (1.0 + size);
        tree.nodes.push(Node { bounds: all.grown(margin_m), first: 0, count: bounds.len() as u32 });
        let mut open = vec![(0_usize, 0_usize)];
        while let Some((at, depth)) = open.pop() {
            let (first, count) = (tree.nodes[at].first as usize, tree.nodes[at].count as usize);
            let slots = &mut tree.order[first..first + count];
            let Some(left_count) = split(bounds, slots, depth) else { continue };
            let child = tree.nodes.len() as u32;
            for (from, to) in [(first, first + left_count), (first + left_count, first + count)] {
                let around = tree.order[from..to].iter().fold(Bounds::EMPTY, |sum, &i| sum.union(&bounds[i as usize]));
                tree.nodes.push(Node { bounds: around.grown(margin_m), first: from as u32, count: (to - from) as u32 });
            }
            tree.nodes[at].first = child;
            tree.nodes[at].count = 0;
            open.push((child as usize + 1, depth + 1));
            open.push((child as usize, depth + 1));
        }
        tree
    }

    /// Original primitive index of each slot.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// Bounds of all primitives; `None` when there are none.
    pub fn bounds(&self) -> Option<&Bounds> {
        self.nodes.first().map(|root| &root.bounds)
    }

    /// Traverses the tree, smaller keys first, without allocation or recursion.
    #[inline]
    pub fn traverse(&self, visitor: &mut impl Visitor) {
        let Some(root) = self.nodes.first() else { return };
        let Some(root_key) = visitor.key(&root.bounds) else { return };
        let mut stack = [(0_u32, 0.0_f64); STACK];
        let mut height = 1;
        stack[0] = (0, root_key);
        while height > 0 {
            height -= 1;
            let (mut at, mut key) = stack[height];
            // Descend into the nearer child and push the farther one onto the stack.
            loop {
                if !visitor.matters(key) {
                    break;
                }
                let node = &self.nodes[at as usize];
                if node.count > 0 {
                    for slot in node.first..node.first + node.count {
                        if visitor.visit(slot as usize) {
                            return;
                        }
                    }
                    break;
                }
                let (left, right) = (node.first, node.first + 1);
                let left_key = visitor.key(&self.nodes[left as usize].bounds);
                let right_key = visitor.key(&self.nodes[right as usize].bounds);
                (at, key) = match (left_key, right_key) {
                    (None, None) => break,
                    (Some(l), None) => (left, l),
                    (None, Some(r)) => (right, r),
                    (Some(l), Some(r)) => {
                        let (near, far) = if l <= r { ((left, l), (right, r)) } else { ((right, r), (left, l)) };
                        stack[height] = far;
                        height += 1;
                        near
                    }
                };
            }
        }
    }

    /// Checks the tree against the bounds it was built from.
    ///
    /// # Panics
    /// When a primitive is missing or duplicated, exceeds its node, a child exceeds its parent, or the tree is deeper
    /// than the traversal stack.
    pub fn assert_well_formed(&self, bounds: &[Bounds]) {
        let mut seen = vec![false; bounds.len()];
        let mut open = Vec::new();
        if !self.nodes.is_empty() {
            open.push((0_usize, 0_usize));
        }
        let mut reached = 0;
        while let Some((at, depth)) = open.pop() {
            reached += 1;
            assert!(depth < STACK, "node {at} lies at depth {depth}");
            let node = &self.nodes[at];
            if node.count == 0 {
                for child in [node.first as usize, node.first as usize + 1] {
                    assert!(child > at, "node {at} has a child before it");
                    assert!(node.bounds.contains(&self.nodes[child].bounds), "child {child} sticks out of {at}");
                    open.push((child, depth + 1));
                }
                continue;
            }
            for slot in node.first..node.first + node.count {
                let primitive = self.order[slot as usize] as usize;
                assert!(!seen[primitive], "primitive {primitive} is in two leaves");
                seen[primitive] = true;
                assert!(node.bounds.contains(&bounds[primitive]), "primitive {primitive} sticks out of leaf {at}");
            }
        }
        assert_eq!(reached, self.nodes.len(), "unreachable nodes");
        assert!(seen.iter().all(|&s| s), "a primitive is in no leaf");
    }
}

/// Reorders `slots` into a left and a right part and returns the left part's length; `None` to keep a leaf.
fn split(bounds: &[Bounds], slots: &mut [u32], depth: usize) -> Option<usize> {
    let count = slots.len();
    if count <= 1 {
        return None;
    }
    let centers = slots.iter().fold(Bounds::EMPTY, |sum, &i| sum.with_point(bounds[i as usize].center_in_world()));
    let size = centers.max_in_world - centers.min_in_world;
    let spread = size.max_element();
    if spread.is_nan() || spread <= 0.0 || depth >= SAH_DEPTH {
        return (count > LEAF_SIZE).then(|| halve(bounds, slots, size));
    }
    let best = best_bin_split(bounds, slots, &centers)?;
    let around = slots.iter().fold(Bounds::EMPTY, |sum, &i| sum.union(&bounds[i as usize]));
    // Cost of a leaf: one test per primitive; of a split: one more node step and the children by area.
    let split_cost = 1.0 + best.cost / around.half_area_m2().max(f64::MIN_POSITIVE);
    if count <= LEAF_SIZE && split_cost >= count as f64 {
        return None;
    }
    let axis = best.axis;
    let low = centers.min_in_world[axis];
    let scale = BINS as f64 / size[axis];
    let mut left = 0;
    for at in 0..count {
        let center = bounds[slots[at] as usize].center_in_world()[axis];
        if bin_of(center, low, scale) <= best.last_left_bin {
            slots.swap(at, left);
            left += 1;
        }
    }
    Some(if left == 0 || left == count { halve(bounds, slots, size) } else { left })
}

/// Median split along the widest axis.
fn halve(bounds: &[Bounds], slots: &mut [u32], size: cosfly_frames::DVec3) -> usize {
    let axis = (0..3).fold(0, |best, axis| if size[axis] > size[best] { axis } else { best });
    let middle = slots.len() / 2;
    slots.select_nth_unstable_by(middle, |&a, &b| {
        let (ca, cb) = (bounds[a as usize].center_in_world()[axis], bounds[b as usize].center_in_world()[axis]);
        ca.total_cmp(&cb).then(a.cmp(&b))
    });
    middle
}

struct BinSplit {
    axis: usize,
    last_left_bin: usize,
    /// Sum over both sides of count times half area, square metres.
    cost: f64,
}

fn bin_of(center: f64, low: f64, scale: f64) -> usize {
    (((center - low) * scale) as usize).min(BINS - 1)
}

fn best_bin_split(bounds: &[Bounds], slots: &[u32], centers: &Bounds) -> Option<BinSplit> {
    let mut best: Option<BinSplit> = None;
    for axis in 0..3 {
        let low = centers.min_in_world[axis];
        let size = centers.max_in_world[axis] - low;
        let scale = BINS as f64 / size;
        if size <= 0.0 || !scale.is_finite() {
            continue;
        }
        let mut bins = [(Bounds::EMPTY, 0_usize); BINS];
        for &slot in slots {
            let one = &bounds[slot as usize];
            let bin = &mut bins[bin_of(one.center_in_world()[axis], low, scale)];
            *bin = (bin.0.union(one), bin.1 + 1);
        }
        let mut right_costs = [0.0; BINS];
        let (mut around, mut count) = (Bounds::EMPTY, 0);
        for at in (1..BINS).rev() {
            (around, count) = (around.union(&bins[at].0), count + bins[at].1);
            right_costs[at] = count as f64 * around.half_area_m2();
        }
        (around, count) = (Bounds::EMPTY, 0);
        for at in 0..BINS - 1 {
            (around, count) = (around.union(&bins[at].0), count + bins[at].1);
            if count == 0 || count == slots.len() {
                continue;
            }
            let cost = count as f64 * around.half_area_m2() + right_costs[at + 1];
            if best.as_ref().is_none_or(|b| cost < b.cost) {
                best = Some(BinSplit { axis, last_left_bin: at, cost });
            }
        }
    }
    best
}
