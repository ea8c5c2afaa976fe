//! Contenders of `cosfly-lab geometry`: the trees of cosfly, parry and obvhs, and a brute-force loop.
//!
//! Trees of other libraries hold bounds; at their leaves all test the same f32 box, with the precomputed inverse of the
//! direction. Their inlined traversals are compiled for the vector instructions of this processor as well.

use cosfly_domain::OrientedBox;
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec3, simd_kernel};
use cosfly_geometry::{BoxBvh, BruteForce, SpatialQuery};
use glam::Vec3A;
use obvhs::bvh2::Bvh2;
use obvhs::cwbvh::CwBvh;
use parry3d::math::Vector;
use parry3d::partitioning::{Bvh, BvhBuildStrategy, TraversalAction};
use std::time::Duration;

/// A box in the leaves of other libraries' trees.
#[derive(Clone, Copy)]
pub struct PlainBox {
    center: Vec3A,
    half: Vec3A,
    sin: f32,
    cos: f32,
    min: Vec3A,
    max: Vec3A,
}

impl PlainBox {
    fn new(shape: &OrientedBox) -> Self {
        let (sin, cos) = cosfly_frames::real::sin_cos(shape.yaw_rad);
        let (min, max) = shape.bounds_in_world();
        Self {
            center: shape.center_in_world.as_vec3a(),
            half: shape.half_extents_m.as_vec3a(),
            sin: sin as f32,
            cos: cos as f32,
            min: min.as_vec3a(),
            max: max.as_vec3a(),
        }
    }

    #[inline(always)]
    fn in_own_axes(&self, v: Vec3A) -> Vec3A {
        Vec3A::new(self.cos * v.x + self.sin * v.y, self.cos * v.y - self.sin * v.x, v.z)
    }

    /// Parameter between 0 and 1 where the ray enters; infinity when it does not.
    #[inline(always)]
    fn entry(&self, ray: &PlainRay) -> f32 {
        if self.sin == 0.0 {
            return slab(self.min - ray.origin, self.max - ray.origin, ray.inverse);
        }
        let origin = self.in_own_axes(ray.origin - self.center);
        slab(-self.half - origin, self.half - origin, inverse(self.in_own_axes(ray.direction)))
    }

    #[inline(always)]
    fn signed_distance(&self, point: Vec3A) -> f32 {
        let beyond = self.in_own_axes(point - self.center).abs() - self.half;
        beyond.max(Vec3A::ZERO).length() + beyond.max_element().min(0.0)
    }
}

#[inline(always)]
fn slab(low: Vec3A, high: Vec3A, inverse: Vec3A) -> f32 {
    let (a, b) = (low * inverse, high * inverse);
    let (enter, leave) = (a.min(b).max_element().max(0.0), a.max(b).min_element().min(1.0));
    if enter <= leave { enter } else { f32::INFINITY }
}

/// Inverse of a direction, without infinities.
#[inline(always)]
fn inverse(direction: Vec3A) -> Vec3A {
    direction.signum() / direction.abs().max(Vec3A::splat(1e-20))
}

/// A ray from `origin` to `origin + direction`, in f32.
#[derive(Clone, Copy)]
pub struct PlainRay {
    origin: Vec3A,
    direction: Vec3A,
    inverse: Vec3A,
}

impl PlainRay {
    #[inline(always)]
    fn new(from: DVec3, to: DVec3) -> Self {
        let direction = (to - from).as_vec3a();
        Self { origin: from.as_vec3a(), direction, inverse: inverse(direction) }
    }
}

/// Queries of the benchmark.
pub trait Contender {
    /// Whether a box lies between two points.
    fn blocked(&self, from: DVec3, to: DVec3) -> bool;
    /// Signed distance to the nearest box within 50 m, metres; `None` where the library has no such query.
    fn distance_m(&self, point: DVec3) -> Option<f64>;
}

/// Largest distance of distance queries, metres.
const WITHIN_M: f64 = 50.0;

impl Contender for BoxBvh {
    #[inline(always)]
    fn blocked(&self, from: DVec3, to: DVec3) -> bool {
        SpatialQuery::blocked(self, from, to)
    }
    #[inline(always)]
    fn distance_m(&self, point: DVec3) -> Option<f64> {
        Some(self.nearest(point, WITHIN_M).map_or(WITHIN_M, |near| near.distance_m))
    }
}

impl Contender for BruteForce {
    fn blocked(&self, from: DVec3, to: DVec3) -> bool {
        SpatialQuery::blocked(self, from, to)
    }
    fn distance_m(&self, point: DVec3) -> Option<f64> {
        Some(self.nearest(point, WITHIN_M).map_or(WITHIN_M, |near| near.distance_m))
    }
}

#[inline(always)]
fn in_parry(v: Vec3A) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

#[inline(always)]
fn from_parry(v: Vector) -> Vec3A {
    Vec3A::new(v.x, v.y, v.z)
}

/// parry's tree with its own closest-hit query.
pub struct Parry {
    tree: Bvh,
    boxes: Vec<PlainBox>,
    level: Level,
}

impl Parry {
    /// Builds the tree with the default strategy.
    pub fn build(boxes: &[OrientedBox]) -> Self {
        let boxes: Vec<PlainBox> = boxes.iter().map(PlainBox::new).collect();
        let bounds: Vec<parry3d::bounding_volume::Aabb> =
            boxes.iter().map(|one| parry3d::bounding_volume::Aabb::new(in_parry(one.min), in_parry(one.max))).collect();
        Self { tree: Bvh::from_leaves(BvhBuildStrategy::default(), &bounds), boxes, level: Level::best() }
    }
}

simd_kernel! {
    fn parry_blocked(of: &Parry, ray: &PlainRay) -> bool {
        let asked = parry3d::query::Ray::new(in_parry(ray.origin), in_parry(ray.direction));
        let entry = |index: u32, _: f32| {
            let t = of.boxes[index as usize].entry(ray);
            t.is_finite().then_some(t)
        };
        of.tree.cast_ray(&asked, 1.0 + f32::EPSILON, entry).is_some()
    }
}

simd_kernel! {
    fn parry_distance(of: &Parry, point: Vec3A) -> f32 {
        let own = |node: &parry3d::partitioning::BvhNode, _: f32| {
            let (min, max) = (from_parry(node.mins()), from_parry(node.maxs()));
            let gap = (min - point).max(point - max);
            // Inside the bounds, a solid may contain the point at any depth.
            if gap.max_element() <= 0.0 { f32::MIN } else { gap.max(Vec3A::ZERO).length() }
        };
        let found = of.tree.find_best(WITHIN_M as f32, own, |index, _| Some(of.boxes[index as usize].signed_distance(point)));
        found.map_or(WITHIN_M as f32, |(_, distance)| distance)
    }
}

impl Contender for Parry {
    #[inline(always)]
    fn blocked(&self, from: DVec3, to: DVec3) -> bool {
        parry_blocked(self.level, self, &PlainRay::new(from, to))
    }
    #[inline(always)]
    fn distance_m(&self, point: DVec3) -> Option<f64> {
        Some(f64::from(parry_distance(self.level, self, point.as_vec3a())))
    }
}

/// parry's tree, traversed until the first hit.
pub struct ParryWalk(pub Parry);

simd_kernel! {
    fn parry_walk(of: &Parry, ray: &PlainRay) -> bool {
        let mut hit = false;
        of.tree.traverse(|node| {
            let (min, max) = (from_parry(node.mins()), from_parry(node.maxs()));
            if slab(min - ray.origin, max - ray.origin, ray.inverse) > 1.0 {
                return TraversalAction::Prune;
            }
            if let Some(index) = node.leaf_data()
                && of.boxes[index as usize].entry(ray) <= 1.0
            {
                hit = true;
                return TraversalAction::EarlyExit;
            }
            TraversalAction::Continue
        });
        hit
    }
}

impl Contender for ParryWalk {
    #[inline(always)]
    fn blocked(&self, from: DVec3, to: DVec3) -> bool {
        parry_walk(self.0.level, &self.0, &PlainRay::new(from, to))
    }
    fn distance_m(&self, _: DVec3) -> Option<f64> {
        None
    }
}

struct BoundedBox<'a>(&'a PlainBox);

impl obvhs::Boundable for BoundedBox<'_> {
    fn aabb(&self) -> obvhs::aabb::Aabb {
        obvhs::aabb::Aabb::new(self.0.min, self.0.max)
    }
}

fn in_order(boxes: &[PlainBox], order: &[u32]) -> Vec<PlainBox> {
    order.iter().map(|&index| boxes[index as usize]).collect()
}

/// obvhs's binary tree.
pub struct Obvhs2 {
    tree: Bvh2,
    boxes: Vec<PlainBox>,
    level: Level,
}

impl Obvhs2 {
    /// Builds the tree with medium settings.
    pub fn build(boxes: &[OrientedBox]) -> Self {
        let boxes: Vec<PlainBox> = boxes.iter().map(PlainBox::new).collect();
        let bounded: Vec<BoundedBox<'_>> = boxes.iter().map(BoundedBox).collect();
        let settings = obvhs::BvhBuildParams::medium_build();
        let tree = obvhs::bvh2::builder::build_bvh2(&bounded, settings, &mut Duration::default());
        let boxes = in_order(&boxes, &tree.primitive_indices);
        Self { tree, boxes, level: Level::best() }
    }
}

simd_kernel! {
    fn obvhs2_blocked(of: &Obvhs2, ray: &PlainRay) -> bool {
        let asked = obvhs::ray::Ray::new(ray.origin, ray.direction, 0.0, 1.0 + f32::EPSILON);
        !of.tree.ray_traverse_miss(asked, |_, index| of.boxes[index].entry(ray))
    }
}

impl Contender for Obvhs2 {
    #[inline(always)]
    fn blocked(&self, from: DVec3, to: DVec3) -> bool {
        obvhs2_blocked(self.level, self, &PlainRay::new(from, to))
    }
    fn distance_m(&self, _: DVec3) -> Option<f64> {
        None
    }
}

/// obvhs's compressed wide BVH (eight children).
pub struct ObvhsCw {
    tree: CwBvh,
    boxes: Vec<PlainBox>,
    level: Level,
}

impl ObvhsCw {
    /// Builds the tree with medium settings.
    pub fn build(boxes: &[OrientedBox]) -> Self {
        let boxes: Vec<PlainBox> = boxes.iter().map(PlainBox::new).collect();
        let bounded: Vec<BoundedBox<'_>> = boxes.iter().map(BoundedBox).collect();
        let settings = obvhs::BvhBuildParams::medium_build();
        let tree = obvhs::cwbvh::builder::build_cwbvh(&bounded, settings, &mut Duration::default());
        let boxes = in_order(&boxes, &tree.primitive_indices);
        Self { tree, boxes, level: Level::best() }
    }
}

simd_kernel! {
    fn obvhs_cw_blocked(of: &ObvhsCw, ray: &PlainRay) -> bool {
        let asked = obvhs::ray::Ray::new(ray.origin, ray.direction, 0.0, 1.0 + f32::EPSILON);
        !of.tree.ray_traverse_miss(asked, |_, index| of.boxes[index].entry(ray))
    }
}

impl Contender for ObvhsCw {
    #[inline(always)]
    fn blocked(&self, from: DVec3, to: DVec3) -> bool {
        obvhs_cw_blocked(self.level, self, &PlainRay::new(from, to))
    }
    fn distance_m(&self, _: DVec3) -> Option<f64> {
        None
    }
}
