//! One obstacle box with its turn worked out: rays, distances, separating planes, and the shadow it casts.

use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec3, real};

/// A box prepared for many queries. All points in the world frame, metres.
#[derive(Clone, Copy, Debug)]
pub struct Solid {
    center: DVec3,
    half: DVec3,
    sin: f64,
    cos: f64,
    /// Smallest corner of its axis-aligned bounds.
    pub min: DVec3,
    /// Largest corner of its axis-aligned bounds.
    pub max: DVec3,
}

/// The half-space `normal . x >= offset_m` (unit normal).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    /// Points to the allowed side.
    pub normal: DVec3,
    /// Signed distance of the boundary from the origin, metres.
    pub offset_m: f64,
}

impl HalfSpace {
    /// Positive inside, metres.
    pub fn slack_m(&self, point: DVec3) -> f64 {
        self.normal.dot(point) - self.offset_m
    }
}

/// The closest approach of a segment and a box.
#[derive(Clone, Copy, Debug)]
pub struct Approach {
    /// Distance, metres; 0 or less when they touch.
    pub distance_m: f64,
    /// A plane through the box's closest point: the whole box lies on its negative side.
    pub separation: HalfSpace,
}

impl Solid {
    /// Prepares `shape`.
    pub fn new(shape: &OrientedBox) -> Self {
        let (sin, cos) = real::sin_cos(shape.yaw_rad);
        Self::turned(shape.center_in_world, shape.half_extents_m, (sin, cos))
    }

    fn turned(center: DVec3, half: DVec3, (sin, cos): (f64, f64)) -> Self {
        let reach =
            DVec3::new(cos.abs() * half.x + sin.abs() * half.y, sin.abs() * half.x + cos.abs() * half.y, half.z);
        Self { center, half, sin, cos, min: center - reach, max: center + reach }
    }

    /// The box with half extents larger by so much along its own axes.
    pub fn grown(&self, by_m: DVec3) -> Self {
        Self::turned(self.center, self.half + by_m, (self.sin, self.cos))
    }

    /// The smallest box with the same turn around it and around itself moved by `way`.
    pub fn stretched(&self, way: DVec3) -> Self {
        let half = self.half + 0.5 * self.turn_to_local(way).abs();
        Self::turned(self.center + 0.5 * way, half, (self.sin, self.cos))
    }

    /// Sine and cosine of its turn.
    pub fn turn(&self) -> (f64, f64) {
        (self.sin, self.cos)
    }

    /// Half of its size along its own axes, metres.
    pub fn half_extents_m(&self) -> DVec3 {
        self.half
    }

    fn to_local(self, point: DVec3) -> DVec3 {
        self.turn_to_local(point - self.center)
    }

    fn turn_to_local(self, v: DVec3) -> DVec3 {
        DVec3::new(self.cos * v.x + self.sin * v.y, self.cos * v.y - self.sin * v.x, v.z)
    }

    fn turn_to_world(self, v: DVec3) -> DVec3 {
        DVec3::new(self.cos * v.x - self.sin * v.y, self.sin * v.x + self.cos * v.y, v.z)
    }

    /// Whether the closed segment meets the closed box.
    pub fn meets_segment(&self, from: DVec3, to: DVec3) -> bool {
        let a = self.to_local(from);
        let d = self.turn_to_local(to - from);
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        for k in 0..3 {
            if d[k].abs() < 1e-12 {
                if a[k].abs() > self.half[k] {
                    return false;
                }
                continue;
            }
            let inverse = 1.0 / d[k];
            let (t0, t1) = ((-self.half[k] - a[k]) * inverse, (self.half[k] - a[k]) * inverse);
            enter = enter.max(t0.min(t1));
            leave = leave.min(t0.max(t1));
        }
        enter <= leave
    }

    /// Signed distance to the surface (negative inside) and the unit vector in which it grows fastest.
    pub fn signed_distance(&self, point: DVec3) -> (f64, DVec3) {
        let p = self.to_local(point);
        let excess = p.abs() - self.half;
        let outside = excess.max(DVec3::ZERO);
        let distance = outside.length();
        let sign = DVec3::new(1.0_f64.copysign(p.x), 1.0_f64.copysign(p.y), 1.0_f64.copysign(p.z));
        if distance > 0.0 {
            return (distance, self.turn_to_world(outside * sign / distance));
        }
        let axis = if excess.x >= excess.y && excess.x >= excess.z {
            DVec3::X
        } else if excess.y >= excess.z {
            DVec3::Y
        } else {
            DVec3::Z
        };
        (excess.max_element(), self.turn_to_world(axis * sign))
    }

    /// Lower bound of the distance from the axis-aligned box (`low`, `high`), metres.
    pub fn bounds_gap_m(&self, low: DVec3, high: DVec3) -> f64 {
        (self.min - high).max(low - self.max).max(DVec3::ZERO).length()
    }

    /// Exact closest approach of the segment. The squared distance along it is convex and piecewise
    /// quadratic, so its minimum is found between two of at most six break points.
    pub fn approach(&self, from: DVec3, to: DVec3) -> Approach {
        let a = self.to_local(from);
        let d = self.turn_to_local(to - from);
        let t = self.closest_parameter(a, d);
        let (distance_m, normal) = self.signed_distance(from + t * (to - from));
        let on_box = from + t * (to - from) - distance_m * normal;
        Approach { distance_m, separation: HalfSpace { normal, offset_m: normal.dot(on_box) } }
    }

    fn closest_parameter(&self, a: DVec3, d: DVec3) -> f64 {
        let slope = |t: f64| {
            let p = a + t * d;
            (p - p.clamp(-self.half, self.half)).dot(d)
        };
        if slope(0.0) >= 0.0 {
            return 0.0;
        }
        if slope(1.0) <= 0.0 {
            return 1.0;
        }
        let mut breaks = [0.0_f64; 8];
        let mut count = 1;
        for k in 0..3 {
            for face in [-self.half[k], self.half[k]] {
                let t = (face - a[k]) / d[k];
                if t > 0.0 && t < 1.0 {
                    breaks[count] = t;
                    count += 1;
                }
            }
        }
        breaks[count] = 1.0;
        count += 1;
        breaks[..count].sort_by(f64::total_cmp);
        let (mut low, mut low_slope) = (0.0, slope(0.0));
        for &high in &breaks[1..count] {
            let high_slope = slope(high);
            if high_slope >= 0.0 {
                let span = high_slope - low_slope;
                return if span > 0.0 { low - low_slope * (high - low) / span } else { low };
            }
            (low, low_slope) = (high, high_slope);
        }
        1.0
    }

    /// The plane of this box's shadow (as cast by a lamp at `eye`) that `point` is furthest beyond, or least
    /// inside of: the shadow is convex, so every point of the returned half-space is lit. The slack of
    /// `point` is a lower bound of its distance from the shadow, or inside it minus the shortest way out.
    /// `None` when the eye is inside the box, where everything is shadow.
    ///
    /// The shadow is the cone over the silhouette, behind the faces that the eye sees; every silhouette
    /// edge of a box is parallel to one of its axes, so at most three faces and six edges bound it.
    pub fn lit_side(&self, eye: DVec3, point: DVec3) -> Option<(f64, HalfSpace)> {
        self.lit_side_below(eye, point, f64::INFINITY)
    }

    /// [`Self::lit_side`] if its slack is below `limit_m`, sooner done when it is not.
    pub fn lit_side_below(&self, eye: DVec3, point: DVec3, limit_m: f64) -> Option<(f64, HalfSpace)> {
        let e = self.to_local(eye);
        let p = self.to_local(point);
        let outside = [e.x.abs() > self.half.x, e.y.abs() > self.half.y, e.z.abs() > self.half.z];
        let mut best: Option<(f64, DVec3, f64)> = None;
        for k in 0..3 {
            if outside[k] {
                let slack = e[k].signum() * p[k] - self.half[k];
                if slack >= limit_m {
                    return None;
                }
                if best.is_none_or(|(s, _, _)| slack > s) {
                    let mut normal = DVec3::ZERO;
                    normal[k] = e[k].signum();
                    best = Some((slack, normal, self.half[k]));
                }
            }
        }
        for m in 0..3 {
            let (k, l) = ((m + 1) % 3, (m + 2) % 3);
            for corner in self.tangent_corners(e, (k, outside[k]), (l, outside[l])).into_iter().flatten() {
                let (dk, dl) = (corner.0 - e[k], corner.1 - e[l]);
                let length = (dk * dk + dl * dl).sqrt();
                if length < 1e-9 {
                    continue;
                }
                // Perpendicular to the tangent, away from the box's middle.
                let side = if dk * e[l] - dl * e[k] >= 0.0 { 1.0 / length } else { -1.0 / length };
                let (nk, nl) = (-dl * side, dk * side);
                let slack = nk * (p[k] - e[k]) + nl * (p[l] - e[l]);
                if slack >= limit_m {
                    return None;
                }
                if best.is_none_or(|(s, _, _)| slack > s) {
                    let mut normal = DVec3::ZERO;
                    (normal[k], normal[l]) = (nk, nl);
                    best = Some((slack, normal, normal.dot(e)));
                }
            }
        }
        best.map(|(slack, normal, offset)| {
            let normal = self.turn_to_world(normal);
            (slack, HalfSpace { normal, offset_m: offset + normal.dot(self.center) })
        })
    }

    /// The places where the two tangents from `e` touch the rectangle in the axes `k` and `l`; `outside` says for each axis
    /// whether `e` is beyond the faces across it.
    fn tangent_corners(&self, e: DVec3, k: (usize, bool), l: (usize, bool)) -> [Option<(f64, f64)>; 2] {
        let (hk, hl) = (self.half[k.0], self.half[l.0]);
        let (ek, el) = (hk.copysign(e[k.0]), hl.copysign(e[l.0]));
        match (k.1, l.1) {
            (false, false) => [None, None],
            (true, true) => [Some((ek, -el)), Some((-ek, el))],
            (true, false) => [Some((ek, hl)), Some((ek, -hl))],
            (false, true) => [Some((hk, el)), Some((-hk, el))],
        }
    }

    /// Centre and bounding radius seen from above.
    pub fn disc_from_above(&self) -> (DVec3, f64) {
        (self.center, real::hypot(self.half.x, self.half.y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_random::Seed;

    fn random_solid(stream: &mut cosfly_random::RandomStream) -> Solid {
        let mut v = |low: f64, high: f64| stream.uniform(low, high);
        Solid::new(&OrientedBox {
            center_in_world: DVec3::new(v(-5.0, 5.0), v(-5.0, 5.0), v(-5.0, 5.0)),
            half_extents_m: DVec3::new(v(0.0, 3.0), v(0.0, 3.0), v(0.0, 3.0)),
            yaw_rad: v(-4.0, 4.0),
        })
    }

    fn random_point(stream: &mut cosfly_random::RandomStream) -> DVec3 {
        DVec3::new(stream.uniform(-12.0, 12.0), stream.uniform(-12.0, 12.0), stream.uniform(-12.0, 12.0))
    }

    #[test]
    fn an_approach_is_the_smallest_sampled_distance_and_its_plane_separates() {
        let mut stream = Seed::of_item(1, "solid", "approach").stream("t");
        for _ in 0..500 {
            let solid = random_solid(&mut stream);
            let (a, b) = (random_point(&mut stream), random_point(&mut stream));
            let found = solid.approach(a, b);
            let sampled =
                (0..=2000).map(|i| solid.signed_distance(a + (b - a) * (f64::from(i) / 2000.0)).0).fold(1e9, f64::min);
            if solid.meets_segment(a, b) {
                assert!(found.distance_m <= 1e-9, "{}", found.distance_m);
            } else {
                assert!(found.distance_m <= sampled + 1e-9 && found.distance_m > sampled - 0.05);
                assert!(found.separation.slack_m(a) > found.distance_m - 1e-9);
                assert!(found.separation.slack_m(b) > found.distance_m - 1e-9);
            }
        }
    }

    #[test]
    fn a_point_is_lit_exactly_when_the_segment_from_the_eye_misses_the_box() {
        let mut stream = Seed::of_item(1, "solid", "lit").stream("t");
        let mut shadows = 0;
        for _ in 0..20_000 {
            let solid = random_solid(&mut stream);
            let (eye, point) = (random_point(&mut stream), random_point(&mut stream));
            let Some((slack, plane)) = solid.lit_side(eye, point) else { continue };
            assert!((plane.slack_m(point) - slack).abs() < 1e-9);
            assert!((plane.normal.length() - 1.0).abs() < 1e-9);
            if slack.abs() > 1e-7 {
                assert_eq!(slack < 0.0, solid.meets_segment(eye, point), "{solid:?} {eye} {point} {slack}");
                shadows += usize::from(slack < 0.0);
            }
        }
        assert!(shadows > 100);
    }
}
