//! Visibility, the share of the target that a camera can see: eight body points, one unoccluded ray each.

use cosfly_frames::{DVec3, TargetState, real};
use cosfly_geometry::SpatialQuery;

/// Number of body points.
pub const BODY_POINTS: usize = 8;

/// Body height for which [`BODY_TABLE`] is written, metres.
const TABLE_HEIGHT_M: f64 = 1.75;

/// (offset to the walker's right, height above the feet), metres, for a body of 1.75 m.
const BODY_TABLE: [(f64, f64); BODY_POINTS] =
    [(0.0, 0.12), (0.0, 0.50), (0.0, 0.90), (0.0, 1.20), (0.0, 1.45), (0.0, 1.70), (-0.22, 1.40), (0.22, 1.40)];

/// The eight points of a body `height_m` tall that visibility rays aim at (paper, section 3.2: "5-10 points
/// on the target body"): six on the axis from ankle to head, two shoulders. World frame, metres.
pub fn body_points(target: &TargetState, height_m: f64) -> [DVec3; BODY_POINTS] {
    let scale = height_m / TABLE_HEIGHT_M;
    let (sin, cos) = real::sin_cos(target.heading_rad);
    BODY_TABLE.map(|(right, up)| target.feet_in_world + scale * DVec3::new(-sin * right, cos * right, up))
}

/// Mean share of the body points that an unoccluded ray from `camera_in_world` reaches: 0, 1/8 ... 1.
pub fn visibility(exact: &dyn SpatialQuery, camera_in_world: DVec3, target: &TargetState, height_m: f64) -> f64 {
    let points = body_points(target, height_m);
    let mut blocked = [false; BODY_POINTS];
    exact.blocked_batch(camera_in_world, &points, &mut blocked);
    blocked.iter().filter(|&&hidden| !hidden).count() as f64 / BODY_POINTS as f64
}

/// The point the camera is aimed at: the middle of the body.
pub fn aim_point(target: &TargetState, height_m: f64) -> DVec3 {
    target.feet_in_world + DVec3::new(0.0, 0.0, 0.5 * height_m)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn body_points_scale_with_the_body_and_turn_with_it() {
        let target = TargetState { feet_in_world: DVec3::new(1.0, 2.0, 3.0), heading_rad: 0.0, speed_mps: 1.0 };
        let points = body_points(&target, 3.5);
        assert!((points[5] - DVec3::new(1.0, 2.0, 6.4)).length() < 1e-12);
        assert!((points[7] - DVec3::new(1.0, 2.44, 5.8)).length() < 1e-12, "right of x is y");
    }
}
