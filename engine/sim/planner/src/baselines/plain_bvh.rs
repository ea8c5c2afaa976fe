//! The textbook tree that the paper's baseline is given: binary, surface-area heuristic, one ray at a time.
//!
//! It is here so that "A* with a BVH" keeps meaning the same thing while the engine's own tree gets faster. Nodes
//! are 32 bytes in `f32`, rounded outward; leaves ask the exact `f64` boxes; nearer children come first.

use crate::obstacles::solid::Solid;
use cosfly_frames::DVec3;
use cosfly_geometry::OrientedBox;

/// Most boxes in a leaf.
const LEAF_SIZE: usize = 2;
/// Entries of the traversal stack; deeper trees than this are cut short by halving.
const STACK: usize = 64;
/// Depth beyond which ranges are halved by count, which keeps the tree within the stack.
const SAH_DEPTH: usize = 28;

#[derive(Clone, Copy)]
struct Node {
    low: [f32; 3],
    high: [f32; 3],
    /// First child of an inner node (the second follows it), first box of a leaf.
    first: u32,
    /// Boxes of a leaf; 0 marks an inner node.
    count: u32,
}

/// Boxes under a binary tree.
pub struct PlainBvh {
    nodes: Vec<Node>,
    solids: Vec<Solid>,
}

impl PlainBvh {
    /// Builds the tree; deterministic. Boxes that are not finite are left out.
    pub fn build(boxes: &[OrientedBox]) -> Self {
        let finite = |shape: &&OrientedBox| {
            shape.center_in_world.is_finite() && shape.half_extents_m.is_finite() && shape.yaw_rad.is_finite()
        };
        let mut solids: Vec<Solid> = boxes.iter().filter(finite).map(Solid::new).collect();
        let mut nodes = Vec::with_capacity(2 * solids.len());
        if !solids.is_empty() {
            nodes.push(node_around(&solids, 0));
            let mut open = vec![(0_usize, 0_usize, solids.len(), 0_usize)];
            while let Some((at, first, count, depth)) = open.pop() {
                if count <= LEAF_SIZE {
                    (nodes[at].first, nodes[at].count) = (first as u32, count as u32);
                    continue;
                }
                let left = split(&mut solids[first..first + count], depth);
                let child = nodes.len();
                nodes[at].first = child as u32;
                nodes.push(node_around(&solids[first..first + left], 0));
                nodes.push(node_around(&solids[first + left..first + count], 0));
                open.push((child + 1, first + left, count - left, depth + 1));
                open.push((child, first, left, depth + 1));
            }
        }
        Self { nodes, solids }
    }

    /// Whether anything stands between two points.
    pub fn blocked(&self, from: DVec3, to: DVec3) -> bool {
        let step = to - from;
        let one_over = |d: f64| if d.abs() < 1e-30 { 1e30_f32 } else { (1.0 / d) as f32 };
        let inverse = [one_over(step.x), one_over(step.y), one_over(step.z)];
        let origin = [from.x as f32, from.y as f32, from.z as f32];
        // A hair is added for what `f32` loses at these coordinates.
        let slack_m = 4.0 * f32::EPSILON * (from.abs().max_element().max(to.abs().max_element()) as f32 + 1.0);
        let entry = |node: &Node| {
            let (mut enter, mut leave) = (0.0_f32, 1.0_f32);
            for k in 0..3 {
                let t0 = (node.low[k] - slack_m - origin[k]) * inverse[k];
                let t1 = (node.high[k] + slack_m - origin[k]) * inverse[k];
                enter = enter.max(t0.min(t1));
                leave = leave.min(t0.max(t1));
            }
            (enter <= leave * (1.0 + 4.0 * f32::EPSILON)).then_some(enter)
        };
        let mut found = false;
        self.walk(entry, |solid, _| {
            found |= solid.meets_segment(from, to);
            if found { f32::NEG_INFINITY } else { f32::INFINITY }
        });
        found
    }

    /// Signed distance to the nearest box, capped at `within_m`.
    pub fn nearest_m(&self, point: DVec3, within_m: f64) -> f64 {
        let mut best = within_m;
        self.walk(
            |node| Some(gap_m(node, point, point)),
            |solid, _| {
                best = best.min(solid.signed_distance(point).0);
                // Inside one box another may be deeper: nodes that hold the point (gap 0) still count.
                next_up(best.max(0.0))
            },
        );
        best
    }

    /// Smallest distance of the segment to a box, capped at `within_m`; 0 or less when they touch.
    pub fn segment_clearance_m(&self, from: DVec3, to: DVec3, within_m: f64) -> f64 {
        let (low, high) = (from.min(to), from.max(to));
        let mut best = within_m;
        self.walk(
            |node| Some(gap_m(node, low, high)),
            |solid, limit| {
                if solid.bounds_gap_m(low, high) < best {
                    best = best.min(solid.approach(from, to).distance_m);
                }
                limit.min(next_up(best.max(0.0)))
            },
        );
        best
    }

    /// Visits leaves by rising key while the key is not above the limit that the last visit returned.
    #[inline(always)]
    fn walk(&self, key: impl Fn(&Node) -> Option<f32>, mut visit: impl FnMut(&Solid, f32) -> f32) {
        let Some(root) = self.nodes.first() else { return };
        let Some(root_key) = key(root) else { return };
        let mut stack = [(0_u32, 0.0_f32); STACK];
        stack[0] = (0, root_key);
        let (mut height, mut limit) = (1, f32::INFINITY);
        while height > 0 {
            height -= 1;
            let (at, at_key) = stack[height];
            if at_key > limit {
                continue;
            }
            let node = &self.nodes[at as usize];
            if node.count > 0 {
                for solid in &self.solids[node.first as usize..(node.first + node.count) as usize] {
                    limit = visit(solid, limit);
                }
                continue;
            }
            let child = |offset: u32| (node.first + offset, key(&self.nodes[(node.first + offset) as usize]));
            let (mut near, mut far) = (child(0), child(1));
            if far.1.is_some_and(|f| near.1.is_none_or(|n| f < n)) {
                (near, far) = (far, near);
            }
            for (index, key) in [far, near] {
                if let Some(key) = key.filter(|&key| key <= limit) {
                    stack[height] = (index, key);
                    height += 1;
                }
            }
        }
    }
}

/// The next `f32` that is not below a distance.
fn next_up(value_m: f64) -> f32 {
    (value_m as f32).next_up()
}

/// A lower bound of the distance between a node and an axis-aligned box, metres.
#[inline(always)]
fn gap_m(node: &Node, low: DVec3, high: DVec3) -> f32 {
    let (low, high) = (low.to_array(), high.to_array());
    let mut squared = 0.0_f64;
    for k in 0..3 {
        let gap = (f64::from(node.low[k]) - high[k]).max(low[k] - f64::from(node.high[k])).max(0.0);
        squared += gap * gap;
    }
    ((squared.sqrt() * (1.0 - 1e-6)) as f32).max(0.0)
}

fn node_around(solids: &[Solid], first: u32) -> Node {
    let low = solids.iter().fold(DVec3::INFINITY, |low, solid| low.min(solid.min));
    let high = solids.iter().fold(DVec3::NEG_INFINITY, |high, solid| high.max(solid.max));
    Node {
        low: low.to_array().map(|value| (value as f32).next_down()),
        high: high.to_array().map(|value| (value as f32).next_up()),
        first,
        count: 0,
    }
}

fn half_area_m2(low: DVec3, high: DVec3) -> f64 {
    let size = (high - low).max(DVec3::ZERO);
    size.x * size.y + size.y * size.z + size.z * size.x
}

/// Sorts the boxes so that the first `n` are the left child and returns `n`, by the surface-area heuristic.
fn split(solids: &mut [Solid], depth: usize) -> usize {
    let sort = |solids: &mut [Solid], axis: usize| {
        solids.sort_by(|a, b| (a.min[axis] + a.max[axis]).total_cmp(&(b.min[axis] + b.max[axis])));
    };
    let count = solids.len();
    let mut best = (f64::INFINITY, 0, count / 2);
    for axis in 0..if depth < SAH_DEPTH { 3 } else { 0 } {
        sort(solids, axis);
        let mut right_areas = vec![0.0; count];
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for i in (1..count).rev() {
            (low, high) = (low.min(solids[i].min), high.max(solids[i].max));
            right_areas[i] = half_area_m2(low, high);
        }
        (low, high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for left in 1..count {
            (low, high) = (low.min(solids[left - 1].min), high.max(solids[left - 1].max));
            let cost = left as f64 * half_area_m2(low, high) + (count - left) as f64 * right_areas[left];
            if cost < best.0 {
                best = (cost, axis, left);
            }
        }
    }
    sort(solids, best.1);
    best.2
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes::{Scene, SceneKind};
    use cosfly_frames::Seed;

    #[test]
    fn answers_are_those_of_every_box_in_turn() {
        let mut boxes = Scene::generate(SceneKind::Leafy, 1).boxes;
        boxes.iter_mut().step_by(3).for_each(|shape| shape.yaw_rad = 0.7);
        let tree = PlainBvh::build(&boxes);
        let solids: Vec<Solid> = boxes.iter().map(Solid::new).collect();
        let mut stream = Seed::of_item(2, "plain", "bvh").stream("queries");
        for _ in 0..300 {
            let mut point =
                || DVec3::new(stream.uniform(-250.0, 250.0), stream.uniform(-250.0, 250.0), stream.uniform(0.0, 30.0));
            let (a, b) = (point(), point());
            let near = a + (b - a).clamp_length_max(20.0);
            assert_eq!(tree.blocked(a, near), solids.iter().any(|solid| solid.meets_segment(a, near)));
            let nearest = solids.iter().map(|solid| solid.signed_distance(a).0).fold(8.0, f64::min);
            assert_eq!(tree.nearest_m(a, 8.0), nearest);
            let swept = solids.iter().map(|solid| solid.approach(a, near).distance_m).fold(8.0, f64::min);
            let found = tree.segment_clearance_m(a, near, 8.0);
            assert!(found == swept || (found <= 0.0 && swept <= 0.0), "{found} {swept}");
        }
        assert!(!PlainBvh::build(&[]).blocked(DVec3::ZERO, DVec3::X));
    }
}
