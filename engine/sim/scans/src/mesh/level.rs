//! Which triangles are level enough to stand on.

use cosfly_frames::DVec3;

/// Triangles steeper than this are faces of kerbs: the share of their normal that points up.
const STEEPEST: f64 = 0.5;
/// Smallest triangle to walk on, square metres.
const SMALLEST_M2: f64 = 1e-3;

/// Whether one can stand on a triangle.
pub fn is_level([a, b, c]: &[DVec3; 3]) -> bool {
    let normal = (*b - *a).cross(*c - *a);
    normal.z.abs() > STEEPEST * normal.length() && 0.5 * normal.z.abs() > SMALLEST_M2
}
