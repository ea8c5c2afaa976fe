//! One triangle: exact ray, point and segment kernels, all two-sided and safe for triangles without area.

use crate::bounds::Bounds;
use crate::shape::Shape;
use cosfly_frames::DVec3;

/// A triangle in the world, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// Corners, metres.
    pub corners_in_world: [DVec3; 3],
}

impl Triangle {
    /// Unit normal; up when the triangle has no area.
    pub fn unit_normal(&self) -> DVec3 {
        let [a, b, c] = self.corners_in_world;
        (b - a).cross(c - a).try_normalize().unwrap_or(DVec3::Z)
    }

    /// The point of the triangle closest to a point (Ericson, Real-Time Collision Detection, 5.1.5).
    #[inline]
    pub fn closest_point(&self, point_in_world: DVec3) -> DVec3 {
        let [a, b, c] = self.corners_in_world;
        let (ab, ac) = (b - a, c - a);
        let normal = ab.cross(ac);
        // Inside the prism over the triangle the foot of the perpendicular counts, else the nearest edge.
        let inside = |from: DVec3, edge: DVec3| normal.dot(edge.cross(point_in_world - from)) >= 0.0;
        let area_squared = normal.length_squared();
        if area_squared > 0.0 && inside(a, ab) && inside(b, c - b) && inside(c, a - c) {
            return point_in_world - normal * (normal.dot(point_in_world - a) / area_squared);
        }
        [(a, b), (b, c), (c, a)]
            .map(|(from, to)| from + (to - from) * parameter_on_segment(point_in_world, from, to))
            .into_iter()
            .reduce(|best, one| {
                let closer = one.distance_squared(point_in_world) < best.distance_squared(point_in_world);
                if closer { one } else { best }
            })
            .unwrap_or(a)
    }

    /// Exact distance between the segment and the triangle; 0 when they touch.
    fn distance_to_segment(&self, from_in_world: DVec3, to_in_world: DVec3) -> f64 {
        let step = to_in_world - from_in_world;
        if self.ray_entry(from_in_world, step, 1.0).is_some() {
            return 0.0;
        }
        let mut best = from_in_world.distance_squared(self.closest_point(from_in_world));
        best = best.min(to_in_world.distance_squared(self.closest_point(to_in_world)));
        let [a, b, c] = self.corners_in_world;
        for (edge_from, edge_to) in [(a, b), (b, c), (c, a)] {
            best = best.min(segments_distance_squared(from_in_world, to_in_world, edge_from, edge_to));
        }
        best.sqrt()
    }
}

impl Shape for Triangle {
    type Given = Self;

    fn prepare(given: &Self) -> Option<Self> {
        given.corners_in_world.iter().all(|corner| corner.is_finite()).then_some(*given)
    }

    #[inline]
    fn bounds(&self) -> Bounds {
        self.corners_in_world.iter().fold(Bounds::EMPTY, |sum, &corner| sum.with_point(corner))
    }

    /// From either side (Moeller and Trumbore). A ray in the triangle's plane does not cross it. Edges belong to both neighbours.
    #[inline]
    fn ray_entry(&self, origin_in_world: DVec3, direction_in_world: DVec3, max_t: f64) -> Option<f64> {
        /// Barycentric slack, so that a ray through a shared edge never slips between two triangles.
        const SLACK: f64 = 1e-12;
        let [a, b, c] = self.corners_in_world;
        let (ab, ac) = (b - a, c - a);
        let p = direction_in_world.cross(ac);
        let determinant = ab.dot(p);
        if determinant == 0.0 {
            return None;
        }
        let inverse = 1.0 / determinant;
        let from_a = origin_in_world - a;
        let u = from_a.dot(p) * inverse;
        if !(-SLACK..=1.0 + SLACK).contains(&u) {
            return None;
        }
        let q = from_a.cross(ab);
        let v = direction_in_world.dot(q) * inverse;
        if v < -SLACK || u + v > 1.0 + SLACK {
            return None;
        }
        let t = ac.dot(q) * inverse;
        (t >= 0.0 && t <= max_t).then_some(t)
    }

    /// On the triangle itself its normal points away.
    #[inline]
    fn signed_distance(&self, point_in_world: DVec3) -> (f64, DVec3) {
        let gap = point_in_world - self.closest_point(point_in_world);
        let distance_m = gap.length();
        (distance_m, if distance_m > 0.0 { gap / distance_m } else { self.unit_normal() })
    }

    #[inline]
    fn segment_distance(&self, from_in_world: DVec3, to_in_world: DVec3, within_m: f64) -> Option<f64> {
        let distance = self.distance_to_segment(from_in_world, to_in_world);
        (distance < within_m).then_some(distance)
    }
}

/// Parameter in 0..=1 of the point of the segment closest to a point.
#[inline]
fn parameter_on_segment(point: DVec3, from: DVec3, to: DVec3) -> f64 {
    let step = to - from;
    let squared = step.length_squared();
    if squared > 0.0 { ((point - from).dot(step) / squared).clamp(0.0, 1.0) } else { 0.0 }
}

/// Squared distance of two segments: the four ends against the other segment, and the interior solution where there
/// is one. The ends alone are right for parallel and for zero-length segments.
fn segments_distance_squared(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    let point_to = |point: DVec3, from: DVec3, to: DVec3| {
        point.distance_squared(from + (to - from) * parameter_on_segment(point, from, to))
    };
    let ends = point_to(a, c, d).min(point_to(b, c, d)).min(point_to(c, a, b)).min(point_to(d, a, b));
    let (u, v, w) = (b - a, d - c, a - c);
    let (uu, uv, vv, uw, vw) = (u.dot(u), u.dot(v), v.dot(v), u.dot(w), v.dot(w));
    let determinant = uu * vv - uv * uv;
    if determinant <= 1e-14 * uu * vv || determinant <= 0.0 {
        return ends;
    }
    let (s, t) = ((uv * vw - vv * uw) / determinant, (uu * vw - uv * uw) / determinant);
    if !(0.0..=1.0).contains(&s) || !(0.0..=1.0).contains(&t) {
        return ends;
    }
    ends.min((w + s * u - t * v).length_squared())
}
