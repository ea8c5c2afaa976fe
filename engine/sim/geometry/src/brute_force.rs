//! [`SpatialQuery`] by testing every shape: the oracle of the tests, and suitable for a handful of shapes.

use crate::bounds::Bounds;
use crate::shape::Shape;
use crate::triangle::Triangle;
use crate::turned_box::TurnedBox;
use crate::{Hit, Nearest, SpatialQuery};
use cosfly_frames::DVec3;

/// Brute-force queries over shapes.
#[derive(Clone, Debug)]
pub struct ShapeBruteForce<S: Shape> {
    /// Prepared shapes; `None` where a number is not finite.
    shapes: Vec<Option<S>>,
}

/// Brute-force queries over boxes.
pub type BruteForce = ShapeBruteForce<TurnedBox>;

/// Brute-force queries over triangles.
pub type TriangleBruteForce = ShapeBruteForce<Triangle>;

impl<S: Shape> ShapeBruteForce<S> {
    /// Prepares the given shapes.
    pub fn new(given: &[S::Given]) -> Self {
        Self { shapes: given.iter().map(S::prepare).collect() }
    }

    fn usable(&self) -> impl Iterator<Item = (u32, &S)> {
        self.shapes.iter().enumerate().filter_map(|(i, shape)| Some((i as u32, shape.as_ref()?)))
    }
}

impl<S: Shape> SpatialQuery for ShapeBruteForce<S> {
    fn len(&self) -> usize {
        self.shapes.len()
    }

    fn closest_hit(&self, origin_in_world: DVec3, direction_in_world: DVec3, max_t: f64) -> Option<Hit> {
        if !origin_in_world.is_finite() || !direction_in_world.is_finite() || max_t.is_nan() {
            return None;
        }
        let hits = self.usable().filter_map(|(primitive, shape)| {
            let t = shape.ray_entry(origin_in_world, direction_in_world, max_t)?;
            Some(Hit { t, primitive })
        });
        hits.reduce(|best, one| if one.t < best.t { one } else { best })
    }

    fn blocked(&self, from_in_world: DVec3, to_in_world: DVec3) -> bool {
        !(from_in_world.is_finite() && to_in_world.is_finite())
            || self.usable().any(|(_, s)| s.ray_entry(from_in_world, to_in_world - from_in_world, 1.0).is_some())
    }

    fn nearest(&self, point_in_world: DVec3, within_m: f64) -> Option<Nearest> {
        if !point_in_world.is_finite() {
            return None;
        }
        let all = self.usable().map(|(primitive, shape)| {
            let (distance_m, away_in_world) = shape.signed_distance(point_in_world);
            Nearest { distance_m, away_in_world, primitive }
        });
        let best = all.reduce(|best, one| if one.distance_m < best.distance_m { one } else { best })?;
        (best.distance_m < within_m).then_some(best)
    }

    fn segment_clearance(&self, from_in_world: DVec3, to_in_world: DVec3, within_m: f64) -> f64 {
        if !from_in_world.is_finite() || !to_in_world.is_finite() {
            return 0.0;
        }
        let distances = self.usable().filter_map(|(_, s)| s.segment_distance(from_in_world, to_in_world, within_m));
        distances.fold(within_m, f64::min)
    }

    fn within(&self, min_in_world: DVec3, max_in_world: DVec3, visit: &mut dyn FnMut(u32)) {
        let asked = Bounds { min_in_world, max_in_world };
        self.usable().filter(|(_, shape)| shape.bounds().meets(&asked)).for_each(|(primitive, _)| visit(primitive));
    }
}
