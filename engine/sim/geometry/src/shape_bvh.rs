//! [`SpatialQuery`] with a binary BVH, for every [`Shape`]; [`TriangleBvh`] over ground.

use crate::bounds::{Bounds, SlabRay};
use crate::bvh::{Bvh, Visitor};
use crate::shape::Shape;
use crate::triangle::Triangle;
use crate::{Hit, Nearest, SpatialQuery};
use cosfly_frames::DVec3;

/// BVH over two-sided triangles without thickness: distances are unsigned, rays hit both sides.
pub type TriangleBvh = ShapeBvh<Triangle>;

/// BVH over shapes. Shapes with a number that is not finite are counted but never hit. Queries neither allocate nor
/// recurse.
#[derive(Clone, Debug)]
pub struct ShapeBvh<S: Shape> {
    given: Vec<S::Given>,
    /// Shapes prepared for queries, in the tree's leaf order.
    slots: Vec<S>,
    /// Index in `given` of each slot.
    primitives: Vec<u32>,
    tree: Bvh,
}

impl TriangleBvh {
    /// Builds the tree over an indexed mesh; a triangle with an index out of range is never hit.
    pub fn build(vertices_in_world: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let corner = |index: u32| vertices_in_world.get(index as usize).copied().unwrap_or(DVec3::NAN);
        Self::over(triangles.iter().map(|corners| Triangle { corners_in_world: corners.map(corner) }).collect())
    }

    /// Triangles in the order given.
    pub fn triangles(&self) -> &[Triangle] {
        &self.given
    }
}

impl<S: Shape> ShapeBvh<S> {
    fn over(given: Vec<S::Given>) -> Self {
        let (mut usable, mut shapes) = (Vec::new(), Vec::new());
        for (index, one) in given.iter().enumerate() {
            if let Some(shape) = S::prepare(one) {
                usable.push(index as u32);
                shapes.push(shape);
            }
        }
        let bounds: Vec<Bounds> = shapes.iter().map(S::bounds).collect();
        let tree = Bvh::build(&bounds);
        let slots = tree.order().iter().map(|&i| shapes[i as usize]).collect();
        let primitives = tree.order().iter().map(|&i| usable[i as usize]).collect();
        Self { given, slots, primitives, tree }
    }

    /// Bounds of all shapes, slightly enlarged; `None` when there are none.
    pub fn bounds(&self) -> Option<&Bounds> {
        self.tree.bounds()
    }

    /// Checks the tree.
    ///
    /// # Panics
    /// When a shape is missing or exceeds its node.
    pub fn assert_well_formed(&self) {
        let mut bounds = vec![Bounds::EMPTY; self.slots.len()];
        for (shape, &original) in self.slots.iter().zip(self.tree.order()) {
            bounds[original as usize] = shape.bounds();
        }
        self.tree.assert_well_formed(&bounds);
    }

    /// Slot of a shape that meets the segment, if any.
    #[inline]
    fn any_blocker(&self, from: DVec3, to: DVec3) -> Option<usize> {
        let step = to - from;
        let mut search = Blocker { slots: &self.slots, ray: SlabRay::new(from, step), from, step, found: None };
        self.tree.traverse(&mut search);
        search.found
    }
}

impl<S: Shape> SpatialQuery for ShapeBvh<S> {
    fn len(&self) -> usize {
        self.given.len()
    }

    fn closest_hit(&self, origin_in_world: DVec3, direction_in_world: DVec3, max_t: f64) -> Option<Hit> {
        if !origin_in_world.is_finite() || !direction_in_world.is_finite() || max_t.is_nan() {
            return None;
        }
        let mut search = ClosestHit {
            of: self,
            ray: SlabRay::new(origin_in_world, direction_in_world),
            origin: origin_in_world,
            direction: direction_in_world,
            best: Hit { t: max_t, primitive: u32::MAX },
        };
        self.tree.traverse(&mut search);
        (search.best.primitive != u32::MAX).then_some(search.best)
    }

    fn blocked(&self, from_in_world: DVec3, to_in_world: DVec3) -> bool {
        !(from_in_world.is_finite() && to_in_world.is_finite())
            || self.any_blocker(from_in_world, to_in_world).is_some()
    }

    fn nearest(&self, point_in_world: DVec3, within_m: f64) -> Option<Nearest> {
        if !point_in_world.is_finite() {
            return None;
        }
        let mut search = NearestShape {
            of: self,
            point: point_in_world,
            best: Nearest { distance_m: within_m, away_in_world: DVec3::ZERO, primitive: u32::MAX },
        };
        self.tree.traverse(&mut search);
        (search.best.primitive != u32::MAX).then_some(search.best)
    }

    fn segment_clearance(&self, from_in_world: DVec3, to_in_world: DVec3, within_m: f64) -> f64 {
        if !from_in_world.is_finite() || !to_in_world.is_finite() {
            return 0.0;
        }
        let mut search = SegmentClearance {
            slots: &self.slots,
            ray: SlabRay::new(from_in_world, to_in_world - from_in_world),
            from: from_in_world,
            to: to_in_world,
            middle: 0.5 * (from_in_world + to_in_world),
            best: within_m,
        };
        self.tree.traverse(&mut search);
        search.best
    }

    fn blocked_batch(&self, from_in_world: DVec3, to_in_world: &[DVec3], blocked: &mut [bool]) {
        // The occluder of the last point often hides the next one as well.
        let mut last: Option<usize> = None;
        for (&to, out) in to_in_world.iter().zip(blocked) {
            if !from_in_world.is_finite() || !to.is_finite() {
                *out = true;
                continue;
            }
            let step = to - from_in_world;
            *out = last.is_some_and(|slot| self.slots[slot].ray_entry(from_in_world, step, 1.0).is_some());
            if !*out && let Some(slot) = self.any_blocker(from_in_world, to) {
                (*out, last) = (true, Some(slot));
            }
        }
    }

    fn within(&self, min_in_world: DVec3, max_in_world: DVec3, visit: &mut dyn FnMut(u32)) {
        let asked = Bounds { min_in_world, max_in_world };
        self.tree.traverse(&mut Within { of: self, asked, visit });
    }
}

struct ClosestHit<'a, S: Shape> {
    of: &'a ShapeBvh<S>,
    ray: SlabRay,
    origin: DVec3,
    direction: DVec3,
    best: Hit,
}

impl<S: Shape> Visitor for ClosestHit<'_, S> {
    #[inline]
    fn key(&mut self, bounds: &Bounds) -> Option<f64> {
        self.ray.entry(bounds, 0.0, self.best.t)
    }
    #[inline]
    fn matters(&self, key: f64) -> bool {
        key <= self.best.t
    }
    #[inline]
    fn visit(&mut self, slot: usize) -> bool {
        if let Some(t) = self.of.slots[slot].ray_entry(self.origin, self.direction, self.best.t) {
            let primitive = self.of.primitives[slot];
            if t < self.best.t || primitive < self.best.primitive {
                self.best = Hit { t, primitive };
            }
        }
        false
    }
}

struct Blocker<'a, S: Shape> {
    slots: &'a [S],
    ray: SlabRay,
    from: DVec3,
    step: DVec3,
    found: Option<usize>,
}

impl<S: Shape> Visitor for Blocker<'_, S> {
    #[inline]
    fn key(&mut self, bounds: &Bounds) -> Option<f64> {
        self.ray.entry(bounds, 0.0, 1.0)
    }
    #[inline]
    fn matters(&self, _: f64) -> bool {
        true
    }
    #[inline]
    fn visit(&mut self, slot: usize) -> bool {
        let met = self.slots[slot].ray_entry(self.from, self.step, 1.0).is_some();
        if met {
            self.found = Some(slot);
        }
        met
    }
}

struct NearestShape<'a, S: Shape> {
    of: &'a ShapeBvh<S>,
    point: DVec3,
    best: Nearest,
}

impl<S: Shape> Visitor for NearestShape<'_, S> {
    #[inline]
    fn key(&mut self, bounds: &Bounds) -> Option<f64> {
        let squared = bounds.distance_squared_m2(self.point);
        self.matters(squared).then_some(squared)
    }
    #[inline]
    fn matters(&self, key: f64) -> bool {
        let best = self.best.distance_m;
        // Key 0: the point is inside the bounds, where it may be deep inside a solid.
        key == 0.0 || (best > 0.0 && key <= best * best)
    }
    #[inline]
    fn visit(&mut self, slot: usize) -> bool {
        let (distance_m, away_in_world) = self.of.slots[slot].signed_distance(self.point);
        let primitive = self.of.primitives[slot];
        let tied = distance_m == self.best.distance_m && self.best.primitive != u32::MAX;
        if distance_m < self.best.distance_m || (tied && primitive < self.best.primitive) {
            self.best = Nearest { distance_m, away_in_world, primitive };
        }
        false
    }
}

struct SegmentClearance<'a, S: Shape> {
    slots: &'a [S],
    ray: SlabRay,
    from: DVec3,
    to: DVec3,
    middle: DVec3,
    best: f64,
}

impl<S: Shape> Visitor for SegmentClearance<'_, S> {
    #[inline]
    fn key(&mut self, bounds: &Bounds) -> Option<f64> {
        // Bounds enlarged by the best distance contain every closer point: a segment that misses them is farther away.
        self.ray.entry(bounds, self.best, 1.0)?;
        Some(bounds.distance_squared_m2(self.middle))
    }
    #[inline]
    fn matters(&self, _: f64) -> bool {
        true
    }
    #[inline]
    fn visit(&mut self, slot: usize) -> bool {
        if let Some(distance) = self.slots[slot].segment_distance(self.from, self.to, self.best) {
            self.best = distance;
        }
        self.best <= 0.0
    }
}

struct Within<'a, 'v, S: Shape> {
    of: &'a ShapeBvh<S>,
    asked: Bounds,
    visit: &'v mut dyn FnMut(u32),
}

impl<S: Shape> Visitor for Within<'_, '_, S> {
    fn key(&mut self, bounds: &Bounds) -> Option<f64> {
        bounds.meets(&self.asked).then_some(0.0)
    }
    fn matters(&self, _: f64) -> bool {
        true
    }
    fn visit(&mut self, slot: usize) -> bool {
        if self.of.slots[slot].bounds().meets(&self.asked) {
            (self.visit)(self.of.primitives[slot]);
        }
        false
    }
}
