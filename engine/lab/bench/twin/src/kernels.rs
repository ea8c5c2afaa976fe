//! Costs that exist twice, in a plugin and natively, to measure what the border between them takes.

/// One square root: the distance from the best distance to the feet, squared.
#[inline]
pub fn root(waypoint: [f64; 3], feet: [f64; 3]) -> f64 {
    let (x, y, z) = (waypoint[0] - feet[0], waypoint[1] - feet[1], waypoint[2] - feet[2]);
    let off = (x * x + y * y + z * z).sqrt() - 28.0;
    off * off
}

/// Full of functions: exp, two atan2, sin, cos, ln, a root.
#[inline]
pub fn heavy(waypoint: [f64; 3], feet: [f64; 3]) -> f64 {
    let (x, y, z) = (waypoint[0] - feet[0], waypoint[1] - feet[1], waypoint[2] - feet[2]);
    let across = (x * x + y * y).sqrt();
    let (bearing, pitch) = (::libm::atan2(y, x), ::libm::atan2(z, across));
    let swing = ::libm::sin(bearing) * ::libm::cos(pitch);
    ::libm::exp(-0.01 * across) + swing * swing + ::libm::log(1.0 + across)
}
