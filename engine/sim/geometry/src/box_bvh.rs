//! [`SpatialQuery`] over solid boxes: f32 decides clear hits and misses, f64 all others.

use crate::bounds::Bounds;
use crate::shape::Shape;
use crate::turned_box::TurnedBox;
use crate::wide::near::{self, most_square};
use crate::wide::tree::{REACH_M, WideTree};
use crate::wide::{ray, shaft};
use crate::{Hit, Nearest, SpatialQuery};
use cosfly_domain::OrientedBox;
use cosfly_frames::DVec3;
use cosfly_frames::simd::Level;

/// A wide BVH (sixteen children) over solid boxes, rotated around z. Boxes with a number that is not finite are counted
/// but never hit. Answers are equal to those of [`crate::BruteForce`], bit for bit, on every processor; queries do not
/// allocate.
#[derive(Clone, Debug)]
pub struct BoxBvh {
    given: Vec<OrientedBox>,
    /// Boxes prepared for exact queries: those of the tree in its order, then those too far away for f32.
    slots: Vec<TurnedBox>,
    /// Index in `given` of each slot.
    primitives: Vec<u32>,
    tree: WideTree,
    bounds: Option<Bounds>,
    has_wild: bool,
    level: Level,
}

impl BoxBvh {
    /// Builds the tree; deterministic.
    pub fn build(boxes: Vec<OrientedBox>) -> Self {
        let (mut usable, mut shapes) = (Vec::with_capacity(boxes.len()), Vec::with_capacity(boxes.len()));
        for (index, one) in boxes.iter().enumerate() {
            if let Some(shape) = TurnedBox::prepare(one) {
                usable.push(index as u32);
                shapes.push(shape);
            }
        }
        let each: Vec<Bounds> = shapes.iter().map(TurnedBox::bounds).collect();
        let (tree, wild) = crate::wide::build::build(&shapes, &each);
        let order = || tree.order.iter().chain(&wild).map(|&i| i as usize);
        let slots = order().map(|i| shapes[i]).collect();
        let primitives = order().map(|i| usable[i]).collect();
        let bounds = (!each.is_empty()).then(|| each.iter().fold(Bounds::EMPTY, |sum, one| sum.union(one)));
        Self { given: boxes, slots, primitives, bounds, has_wild: !wild.is_empty(), tree, level: Level::best() }
    }

    /// The same tree, queried with the instructions of a level; answers do not change.
    pub fn at_level(self, level: Level) -> Self {
        Self { level, ..self }
    }

    /// Boxes in the order given.
    pub fn boxes(&self) -> &[OrientedBox] {
        &self.given
    }

    /// Bounds of all boxes; `None` when there are none.
    pub fn bounds(&self) -> Option<&Bounds> {
        self.bounds.as_ref()
    }

    /// Checks the tree.
    ///
    /// # Panics
    /// When a box is missing or exceeds the bounds of its block.
    pub fn assert_well_formed(&self) {
        let mut bounds = vec![Bounds::EMPTY; self.slots.len()];
        for (shape, &original) in self.slots.iter().zip(&self.tree.order) {
            bounds[original as usize] = shape.bounds();
        }
        self.tree.assert_well_formed(&bounds);
    }

    /// Slots too far away for f32.
    #[inline]
    fn wild(&self) -> std::ops::Range<usize> {
        self.tree.order.len()..self.slots.len()
    }

    /// Point relative to the tree's origin; `None` when it is too far away for f32.
    #[inline(always)]
    fn local(&self, point_in_world: DVec3) -> Option<DVec3> {
        let local = point_in_world - self.tree.origin_in_world;
        (local.abs().max_element() <= REACH_M).then_some(local)
    }

    /// Whether one of the slots lies between two points, exactly.
    #[cold]
    fn blocked_by(&self, mut slots: std::ops::Range<usize>, from_in_world: DVec3, to_in_world: DVec3) -> bool {
        let step = to_in_world - from_in_world;
        slots.any(|slot| self.slots[slot].ray_entry(from_in_world, step, 1.0).is_some())
    }

    #[inline(always)]
    fn blocked_eight(&self, from_in_world: DVec3, ends: &[DVec3; shaft::RAYS], out: &mut [bool; shaft::RAYS]) {
        match shaft::blocked(self.level, &self.tree, &self.slots, from_in_world, ends) {
            Some(mask) => *out = core::array::from_fn(|ray| mask >> ray & 1 == 1),
            None => return *out = ends.map(|end| self.blocked(from_in_world, end)),
        }
        if self.has_wild {
            for (&end, out) in ends.iter().zip(out) {
                *out = *out || self.blocked_by(self.wild(), from_in_world, end);
            }
        }
    }

    /// Calls `visit` with every slot.
    fn visit_all(&self, mut visit: impl FnMut(usize)) {
        (0..self.slots.len()).for_each(&mut visit);
    }
}

impl SpatialQuery for BoxBvh {
    fn len(&self) -> usize {
        self.given.len()
    }

    fn closest_hit(&self, origin_in_world: DVec3, direction_in_world: DVec3, max_t: f64) -> Option<Hit> {
        if !origin_in_world.is_finite() || !direction_in_world.is_finite() || max_t.is_nan() {
            return None;
        }
        let mut best = Hit { t: max_t, primitive: u32::MAX };
        let mut exact = |slot: usize| {
            if let Some(t) = self.slots[slot].ray_entry(origin_in_world, direction_in_world, best.t) {
                let primitive = self.primitives[slot];
                if t < best.t || primitive < best.primitive {
                    best = Hit { t, primitive };
                }
            }
            best.t
        };
        if self.local(origin_in_world).is_none() {
            self.visit_all(|slot| _ = exact(slot));
            return (best.primitive != u32::MAX).then_some(best);
        }
        // The tree's ray moves one metre along its fastest axis per unit of its parameter. Components that the exact
        // kernels treat as 0 are 0 here, too.
        let step = DVec3::from_array(direction_in_world.to_array().map(|d| if d.abs() < 1e-250 { 0.0 } else { d }));
        let speed = step.abs().max_element();
        let (unit, speed) = if speed > 0.0 { (step / speed, speed) } else { (DVec3::ZERO, 1.0) };
        let widened = |t: f64| (t * speed) as f32 * (1.0 + 1e-6);
        let first = widened(self.wild().fold(max_t, |_, slot| exact(slot)));
        let from = (origin_in_world - self.tree.origin_in_world).as_vec3a();
        ray::along(self.level, &self.tree, from, unit.as_vec3a(), first, &mut |slot| widened(exact(slot)));
        (best.primitive != u32::MAX).then_some(best)
    }

    fn blocked(&self, from_in_world: DVec3, to_in_world: DVec3) -> bool {
        if let Some(hidden) = ray::blocked(self.level, &self.tree, &self.slots, from_in_world, to_in_world) {
            return hidden || (self.has_wild && self.blocked_by(self.wild(), from_in_world, to_in_world));
        }
        let all_finite = from_in_world.is_finite() && to_in_world.is_finite();
        !all_finite || self.blocked_by(0..self.slots.len(), from_in_world, to_in_world)
    }

    fn nearest(&self, point_in_world: DVec3, within_m: f64) -> Option<Nearest> {
        if !point_in_world.is_finite() || within_m.is_nan() {
            return None;
        }
        let mut best = Nearest { distance_m: within_m, away_in_world: DVec3::ZERO, primitive: u32::MAX };
        let mut exact = |slot: usize| {
            let (distance_m, away_in_world) = self.slots[slot].signed_distance(point_in_world);
            let primitive = self.primitives[slot];
            let tied = distance_m == best.distance_m && best.primitive != u32::MAX;
            if distance_m < best.distance_m || (tied && primitive < best.primitive) {
                best = Nearest { distance_m, away_in_world, primitive };
            }
            best.distance_m
        };
        self.around(point_in_world, point_in_world, within_m, &mut exact);
        (best.primitive != u32::MAX).then_some(best)
    }

    fn segment_clearance(&self, from_in_world: DVec3, to_in_world: DVec3, within_m: f64) -> f64 {
        if !from_in_world.is_finite() || !to_in_world.is_finite() {
            return 0.0;
        }
        if within_m.is_nan() || within_m <= 0.0 {
            return within_m;
        }
        let mut best = within_m;
        let mut exact = |slot: usize| {
            if let Some(distance_m) = self.slots[slot].segment_distance(from_in_world, to_in_world, best) {
                best = distance_m;
            }
            best
        };
        self.around(from_in_world, to_in_world, within_m, &mut exact);
        best
    }

    fn blocked_batch(&self, from_in_world: DVec3, to_in_world: &[DVec3], blocked: &mut [bool]) {
        let count = to_in_world.len().min(blocked.len());
        let (eights, ends) = to_in_world[..count].as_chunks();
        let (out_eights, out) = blocked[..count].as_chunks_mut();
        for (eight, out_eight) in eights.iter().zip(out_eights) {
            self.blocked_eight(from_in_world, eight, out_eight);
        }
        let count = ends.len();
        if count > 2 {
            let (mut eight, mut out_eight) = ([ends[0]; shaft::RAYS], [false; shaft::RAYS]);
            eight[..count].copy_from_slice(ends);
            self.blocked_eight(from_in_world, &eight, &mut out_eight);
            out.copy_from_slice(&out_eight[..count]);
        } else {
            ends.iter().zip(out).for_each(|(&end, out)| *out = self.blocked(from_in_world, end));
        }
    }

    fn within(&self, min_in_world: DVec3, max_in_world: DVec3, visit: &mut dyn FnMut(u32)) {
        let asked = Bounds { min_in_world, max_in_world };
        let mut exact = |slot: usize| {
            if self.slots[slot].bounds().meets(&asked) {
                visit(self.primitives[slot]);
            }
        };
        let reach = DVec3::splat(REACH_M);
        let clamped = |corner: DVec3| (corner - self.tree.origin_in_world).clamp(-reach, reach);
        let (low, high) = (clamped(min_in_world), clamped(max_in_world));
        if !low.is_finite() || !high.is_finite() {
            return self.visit_all(exact);
        }
        self.wild().for_each(&mut exact);
        near::meeting(self.level, &self.tree, low, high, &mut exact);
    }
}

impl BoxBvh {
    /// Calls `exact` with at least the slots nearer to the segment than the last distance that it returned, at first
    /// `within_m`.
    #[inline]
    fn around(&self, from_in_world: DVec3, to_in_world: DVec3, within_m: f64, exact: &mut dyn FnMut(usize) -> f64) {
        let within_m = if self.has_wild { self.wild().fold(within_m, |_, slot| exact(slot)) } else { within_m };
        let mut exact_square = |slot: usize| most_square(exact(slot));
        let within = most_square(within_m);
        if !near::around(self.level, &self.tree, from_in_world, to_in_world, within, &mut exact_square) {
            self.visit_all(|slot| _ = exact_square(slot));
        }
    }
}
