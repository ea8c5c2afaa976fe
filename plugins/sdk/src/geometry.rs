//! Points and the little that is done with them.

/// x, y, z in the world frame, metres; z up.
pub type Point = [f64; 3];

/// `a + b`.
pub fn add(a: Point, b: Point) -> Point {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// `a - b`.
pub fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a` times a number.
pub fn scale(a: Point, by: f64) -> Point {
    [a[0] * by, a[1] * by, a[2] * by]
}

/// The inner product.
pub fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The length.
pub fn length(a: Point) -> f64 {
    dot(a, a).sqrt()
}

/// The distance.
pub fn distance(a: Point, b: Point) -> f64 {
    length(sub(a, b))
}

/// z of the outer product of what lies in the plane.
pub fn cross_2d(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}
