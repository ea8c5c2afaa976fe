//! Lines of sight from one camera to the eight body points against one box, eight lanes at a time.

use cosfly_frames::{DVec3, simd::Level, simd_kernel};
use cosfly_surroundings::solid::Solid;
use cosfly_surroundings::visibility::BODY_POINTS;

/// One coordinate of all body points.
type Lanes = [f64; BODY_POINTS];

/// All lines of sight are blocked.
const ALL: u8 = u8::MAX;

/// The body points of one frame, coordinate by coordinate (world frame, metres).
pub struct BodyLanes([Lanes; 3]);

impl BodyLanes {
    /// Of the points one by one.
    pub fn new(points_in_world: &[DVec3; BODY_POINTS]) -> Self {
        Self([0, 1, 2].map(|axis| points_in_world.map(|point| point[axis])))
    }
}

/// A box, prepared for lines of sight.
#[derive(Clone, Copy)]
pub struct RayBox {
    center: DVec3,
    half: DVec3,
    sin: f64,
    cos: f64,
}

impl RayBox {
    /// Of a planning box.
    pub fn new(solid: &Solid) -> Self {
        let (sin, cos) = solid.turn();
        let (center, _) = solid.disc_from_above();
        Self { center, half: solid.half_extents_m(), sin, cos }
    }
}

/// Bit i is set where the closed segment from body point i to `eye` meets the closed box. A segment misses a box exactly
/// when one of the box's three axes, or one of their products with the segment, separates them; there is nothing to divide.
#[inline(always)]
fn blocked_by(shape: &RayBox, body: &BodyLanes, eye: DVec3) -> u8 {
    let (h, sin, cos) = (shape.half, shape.sin, shape.cos);
    let turned = |v: DVec3| DVec3::new(cos * v.x + sin * v.y, cos * v.y - sin * v.x, v.z);
    let p = turned(eye - shape.center);
    let mut meets = [0_u64; BODY_POINTS];
    for (lane, meets) in meets.iter_mut().enumerate() {
        let a = turned(DVec3::new(body.0[0][lane], body.0[1][lane], body.0[2][lane]) - shape.center);
        // Twice the middle of the segment, and its extent.
        let (mx, my, mz) = (p.x + a.x, p.y + a.y, p.z + a.z);
        let (dx, dy, dz) = (p.x - a.x, p.y - a.y, p.z - a.z);
        let (ex, ey, ez) = (dx.abs(), dy.abs(), dz.abs());
        let beside = (mx.abs() <= 2.0 * h.x + ex) & (my.abs() <= 2.0 * h.y + ey) & (mz.abs() <= 2.0 * h.z + ez);
        let across = ((my * dz - mz * dy).abs() <= 2.0 * (h.y * ez + h.z * ey))
            & ((mz * dx - mx * dz).abs() <= 2.0 * (h.x * ez + h.z * ex))
            & ((mx * dy - my * dx).abs() <= 2.0 * (h.x * ey + h.y * ex));
        *meets = u64::from(beside & across);
    }
    meets.iter().enumerate().fold(0, |mask, (lane, &meets)| mask | (meets as u8) << lane)
}

simd_kernel! {
    /// Bit i is set where a box stands between body point i and `eye` (world frame, metres).
    pub fn blocked(boxes: &[RayBox], body: &BodyLanes, eye: DVec3) -> u8 {
        let mut mask = 0;
        for shape in boxes {
            mask |= blocked_by(shape, body, eye);
            if mask == ALL {
                break;
            }
        }
        mask
    }
}

/// The share of body points that `blocked` leaves.
pub fn seen_share(blocked: u8) -> f64 {
    f64::from(blocked.count_zeros()) / BODY_POINTS as f64
}

/// The level that [`blocked`] is best run with.
pub fn level() -> Level {
    Level::best()
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::OrientedBox;
    use cosfly_random::{RandomStream, Seed};

    #[test]
    fn it_agrees_with_one_segment_at_a_time_at_every_level() {
        let mut stream = Seed::of_item(1, "paper", "rays").stream("t");
        let mut hits = [0; 2];
        for _ in 0..4000 {
            let point = |stream: &mut RandomStream, reach: f64| {
                DVec3::new(stream.uniform(-reach, reach), stream.uniform(-reach, reach), stream.uniform(-reach, reach))
            };
            let body: [DVec3; BODY_POINTS] = core::array::from_fn(|_| point(&mut stream, 6.0));
            let eye = point(&mut stream, 12.0);
            let center_in_world = point(&mut stream, 6.0);
            let half_extents_m = point(&mut stream, 4.0).abs();
            let solid =
                Solid::new(&OrientedBox { center_in_world, half_extents_m, yaw_rad: stream.uniform(-4.0, 4.0) });
            let boxes = [RayBox::new(&solid)];
            for level in Level::available() {
                let mask = blocked(level, &boxes, &BodyLanes::new(&body), eye);
                for (lane, point) in body.iter().enumerate() {
                    let meets = mask >> lane & 1 == 1;
                    assert_eq!(meets, solid.meets_segment(*point, eye), "{} {solid:?} {point} {eye}", level.name());
                    hits[usize::from(meets)] += 1;
                }
            }
        }
        assert!(hits[0] > 1000 && hits[1] > 1000);
    }

    #[test]
    fn segments_of_no_length_and_boxes_of_no_size_are_met_where_they_touch() {
        let flat = OrientedBox { center_in_world: DVec3::X, half_extents_m: DVec3::new(0.0, 1.0, 1.0), yaw_rad: 0.0 };
        let at = |x: f64| BodyLanes::new(&[DVec3::X * x; BODY_POINTS]);
        let boxes = [RayBox::new(&Solid::new(&flat))];
        assert_eq!(blocked(level(), &boxes, &at(1.0), DVec3::X), u8::MAX);
        assert_eq!(blocked(level(), &[], &at(1.0), DVec3::X), 0);
        assert_eq!(blocked(level(), &boxes, &at(2.0), DVec3::new(2.0, 0.5, 0.0)), 0);
        assert_eq!(seen_share(0b0000_0011), 0.75);
    }
}
