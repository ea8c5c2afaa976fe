//! A textbook BVH for the paper's baseline: binary, surface-area heuristic, one ray at a time.
//!
//! It is kept so that "A* with a BVH" does not change while the engine's own tree gets faster. For the visibility of a
//! body from drones around it, it is as fast as the trees of parry and obvhs. Nodes are `f32`, rounded outward; leaves
//! test the exact `f64` boxes; nearer children come first.

use cosfly_domain::OrientedBox;
use cosfly_frames::DVec3;
use cosfly_planner::baselines::sight::StaticSight;
use cosfly_surroundings::solid::Solid;
use glam::Vec3A;

/// Most boxes in a leaf.
const LEAF_SIZE: usize = 1;
/// Entries of the traversal stack; deeper trees are limited by median splits.
const STACK: usize = 64;
/// Depth beyond which ranges are split at the median, which bounds the depth by the stack.
const SAH_DEPTH: usize = 28;

#[derive(Clone, Copy)]
struct Node {
    low: Vec3A,
    high: Vec3A,
    /// First child of an inner node (the second follows it), or first box of a leaf.
    first: u32,
    /// Number of boxes of a leaf; 0 marks an inner node.
    count: u32,
}

/// A binary BVH over boxes.
pub struct PlainBvh {
    nodes: Vec<Node>,
    solids: Vec<Solid>,
}

impl PlainBvh {
    /// Builds the tree; deterministic. Boxes with numbers that are not finite are skipped.
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

    /// Whether a box lies between two points.
    pub fn blocked(&self, from: DVec3, to: DVec3) -> bool {
        self.blocker(from, to).is_some()
    }

    /// Whether each of `points` is hidden from `camera`. The occluder of the last point is tested first.
    pub fn hide(&self, camera: DVec3, points: &[DVec3], hidden: &mut [bool]) {
        let mut last: Option<&Solid> = None;
        for (&point, hidden) in points.iter().zip(hidden) {
            if !last.is_some_and(|solid| solid.meets_segment(camera, point)) {
                last = self.blocker(camera, point).or(last);
            }
            *hidden = last.is_some_and(|solid| solid.meets_segment(camera, point));
        }
    }

    /// A box that meets the segment, if any.
    fn blocker(&self, from: DVec3, to: DVec3) -> Option<&Solid> {
        let ray = NodeRay::new(from, to);
        let mut stack = [0_u32; STACK];
        let mut height = 0;
        let mut at = 0;
        if !self.nodes.first().is_some_and(|root| ray.entry(root) <= 1.0) {
            return None;
        }
        loop {
            let node = &self.nodes[at as usize];
            if node.count > 0 {
                let leaf = &self.solids[node.first as usize..(node.first + node.count) as usize];
                if let Some(found) = leaf.iter().find(|solid| solid.meets_segment(from, to)) {
                    return Some(found);
                }
            } else {
                let children = &self.nodes[node.first as usize..node.first as usize + 2];
                let (left, right) = (ray.entry(&children[0]), ray.entry(&children[1]));
                let (near, far) = if left <= right { (0, 1) } else { (1, 0) };
                if far_of(left, right) <= 1.0 {
                    stack[height] = node.first + far;
                    height += 1;
                }
                if near_of(left, right) <= 1.0 {
                    at = node.first + near;
                    continue;
                }
            }
            if height == 0 {
                return None;
            }
            height -= 1;
            at = stack[height];
        }
    }

    /// Signed distance to the nearest box, metres, capped at `within_m`.
    pub fn nearest_m(&self, point: DVec3, within_m: f64) -> f64 {
        let (low, high) = (rounded_down(point), rounded_up(point));
        let mut best = within_m;
        // Inside one box another may be deeper: nodes that contain the point (gap 0) are always visited.
        self.walk(
            within_m,
            |node| gap_m(node, low, high),
            |solid| {
                best = best.min(solid.signed_distance(point).0);
                best.max(0.0)
            },
        );
        best
    }

    /// Smallest distance of the segment to a box, metres, capped at `within_m`; 0 or less when they touch.
    pub fn segment_clearance_m(&self, from: DVec3, to: DVec3, within_m: f64) -> f64 {
        let (low, high) = (from.min(to), from.max(to));
        let (node_low, node_high) = (rounded_down(low), rounded_up(high));
        let mut best = within_m;
        self.walk(
            within_m,
            |node| gap_m(node, node_low, node_high),
            |solid| {
                if solid.bounds_gap_m(low, high) < best {
                    best = best.min(solid.approach(from, to).distance_m);
                }
                best.max(0.0)
            },
        );
        best
    }

    /// Visits leaves, nearer ones first, while their distance is at most the limit that the last visit returned.
    #[inline(always)]
    fn walk(&self, limit: f64, gap_m: impl Fn(&Node) -> f32, mut visit: impl FnMut(&Solid) -> f64) {
        let mut limit = next_up(limit);
        let mut stack = [(0_u32, 0.0_f32); STACK];
        let mut height = usize::from(!self.nodes.is_empty());
        while height > 0 {
            height -= 1;
            let (mut at, mut at_gap) = stack[height];
            while at_gap <= limit {
                let node = &self.nodes[at as usize];
                if node.count > 0 {
                    for solid in &self.solids[node.first as usize..(node.first + node.count) as usize] {
                        limit = next_up(visit(solid));
                    }
                    break;
                }
                let children = &self.nodes[node.first as usize..node.first as usize + 2];
                let (left, right) = (gap_m(&children[0]), gap_m(&children[1]));
                let (near, far) = if left <= right { (0, 1) } else { (1, 0) };
                if far_of(left, right) <= limit {
                    stack[height] = (node.first + far, far_of(left, right));
                    height += 1;
                }
                (at, at_gap) = (node.first + near, near_of(left, right));
            }
        }
    }
}

/// A segment prepared for the nodes' boxes.
struct NodeRay {
    /// Origin, shifted to cover the `f32` rounding of these coordinates: up for lower faces, down for upper ones.
    above: Vec3A,
    below: Vec3A,
    inverse: Vec3A,
}

impl NodeRay {
    fn new(from: DVec3, to: DVec3) -> Self {
        let (origin, step) = (from.as_vec3a(), (to - from).as_vec3a());
        let slack_m = 4.0 * f32::EPSILON * (from.abs().max(to.abs()).max_element() as f32 + 1.0);
        let still = step.abs().cmplt(Vec3A::splat(1e-30));
        let inverse = Vec3A::select(still, Vec3A::splat(1e30), step.recip());
        Self { above: origin + slack_m, below: origin - slack_m, inverse }
    }

    /// Parameter where the segment enters the node's box, as a share of its length; beyond 1 when it does not.
    #[inline(always)]
    fn entry(&self, node: &Node) -> f32 {
        let low = (node.low - self.above) * self.inverse;
        let high = (node.high - self.below) * self.inverse;
        let crossed = low.cmpgt(high);
        let (near, far) = (Vec3A::select(crossed, high, low), Vec3A::select(crossed, low, high));
        let enter = far_of(far_of(near.x, near.y), far_of(near.z, 0.0));
        let leave = near_of(near_of(far.x, far.y), near_of(far.z, 1.0));
        if enter <= leave * (1.0 + 8.0 * f32::EPSILON) { near_of(enter, 1.0) } else { 2.0 }
    }
}

/// Smaller number, in one instruction; neither number is NaN.
#[inline(always)]
fn near_of(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// Larger number.
#[inline(always)]
fn far_of(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// Next `f32` that is not below a distance.
fn next_up(value_m: f64) -> f32 {
    (value_m as f32).next_up()
}

/// Lower bound of the distance between a node and an axis-aligned box, metres.
#[inline(always)]
fn gap_m(node: &Node, low: Vec3A, high: Vec3A) -> f32 {
    (node.low - high).max(low - node.high).max(Vec3A::ZERO).length() * (1.0 - 1e-5)
}

fn rounded_down(point: DVec3) -> Vec3A {
    Vec3A::from_array(point.to_array().map(|value| (value as f32).next_down()))
}

fn rounded_up(point: DVec3) -> Vec3A {
    Vec3A::from_array(point.to_array().map(|value| (value as f32).next_up()))
}

fn node_around(solids: &[Solid], first: u32) -> Node {
    let low = solids.iter().fold(DVec3::INFINITY, |low, solid| low.min(solid.min));
    let high = solids.iter().fold(DVec3::NEG_INFINITY, |high, solid| high.max(solid.max));
    Node { low: rounded_down(low), high: rounded_up(high), first, count: 0 }
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

impl StaticSight for PlainBvh {
    fn hide(&self, camera: DVec3, body: &[DVec3], hidden: &mut [bool]) {
        PlainBvh::hide(self, camera, body, hidden);
    }

    fn distance_m(&self, point: DVec3, within_m: f64) -> f64 {
        self.nearest_m(point, within_m)
    }

    fn segment_clearance_m(&self, from: DVec3, to: DVec3, within_m: f64) -> f64 {
        PlainBvh::segment_clearance_m(self, from, to, within_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_random::Seed;
    use cosfly_scenes::{SceneKind, SeededScene};

    #[test]
    fn answers_are_those_of_every_box_in_turn() {
        let mut boxes = SeededScene::generate(SceneKind::Leafy, 1).boxes;
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
