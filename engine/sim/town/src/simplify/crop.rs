//! Crop: boxes far from all walkable ground never matter to a drone that follows a walker.

use super::candidate::BoxCandidate;
use cosfly_domain::WalkablePolygon;
use cosfly_frames::DVec3;
use cosfly_geometry::Bounds;
use cosfly_geometry::{Bvh, Visitor};

/// Drops the boxes whose bounds are farther than `radius_m` (seen from above) from the bounds of every polygon. Bounds
/// make it keep a little more than it must, never less. Without walkable ground nothing is dropped.
pub fn drop_far_from(boxes: &mut Vec<BoxCandidate>, walkable: &[WalkablePolygon], radius_m: f64) {
    let grounds: Vec<Bounds> = walkable
        .iter()
        .map(|area| area.outline_in_world.iter().fold(Bounds::EMPTY, |sum, at| sum.with_point(at.with_z(0.0))))
        .filter(|ground| ground.min_in_world.is_finite() && ground.max_in_world.is_finite())
        .collect();
    if grounds.is_empty() {
        return;
    }
    let tree = Bvh::build(&grounds);
    boxes.retain(|one| {
        let (low, high) = one.shape.bounds_in_world();
        let flat = Bounds { min_in_world: low.with_z(0.0), max_in_world: high.with_z(0.0) };
        let mut search = AnyNear { grounds: &grounds, order: tree.order(), flat, radius_m, found: false };
        tree.traverse(&mut search);
        search.found
    });
}

struct AnyNear<'a> {
    grounds: &'a [Bounds],
    order: &'a [u32],
    flat: Bounds,
    radius_m: f64,
    found: bool,
}

impl AnyNear<'_> {
    fn is_near(&self, ground: &Bounds) -> bool {
        let gap = (ground.min_in_world - self.flat.max_in_world)
            .max(self.flat.min_in_world - ground.max_in_world)
            .max(DVec3::ZERO);
        gap.length_squared() <= self.radius_m * self.radius_m
    }
}

impl Visitor for AnyNear<'_> {
    fn key(&mut self, bounds: &Bounds) -> Option<f64> {
        self.is_near(bounds).then_some(0.0)
    }
    fn matters(&self, _: f64) -> bool {
        true
    }
    fn visit(&mut self, slot: usize) -> bool {
        self.found = self.is_near(&self.grounds[self.order[slot] as usize]);
        self.found
    }
}
