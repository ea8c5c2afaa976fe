//! Three numbers that stay three numbers: loops over pixels that use them become vector code across pixels.

use core::ops::{Add, AddAssign, Mul, MulAssign, Sub};
use cosfly_frames::DVec3;

/// A point, direction or linear colour (red, green, blue).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vec3 {
    /// The first, or red.
    pub x: f32,
    /// The second, or green.
    pub y: f32,
    /// The third, or blue.
    pub z: f32,
}

impl Vec3 {
    /// Nothing, or black.
    pub const ZERO: Self = Self::splat(0.0);

    /// From three numbers.
    #[inline(always)]
    pub const fn new(x: f32, y: f32, z: f32) -> Self {
        Self { x, y, z }
    }

    /// Vector of one number three times.
    #[inline(always)]
    pub const fn splat(value: f32) -> Self {
        Self::new(value, value, value)
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> f32 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// From this to the other as `t` goes from 0 to 1.
    #[inline(always)]
    pub fn lerp(self, other: Self, t: f32) -> Self {
        self + (other - self) * t
    }

    /// Vector of this direction, nearly unit length even for nearly nothing.
    #[inline(always)]
    pub fn unit(self) -> Self {
        self * (1.0 / (self.dot(self) + 1e-12).sqrt())
    }

    /// One function of each number.
    pub fn map(self, f: impl Fn(f32) -> f32) -> Self {
        Self::new(f(self.x), f(self.y), f(self.z))
    }
}

impl From<DVec3> for Vec3 {
    fn from(v: DVec3) -> Self {
        Self::new(v.x as f32, v.y as f32, v.z as f32)
    }
}

impl Add for Vec3 {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl Sub for Vec3 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl Mul for Vec3 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::new(self.x * other.x, self.y * other.y, self.z * other.z)
    }
}

impl Mul<f32> for Vec3 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f32) -> Self {
        Self::new(self.x * factor, self.y * factor, self.z * factor)
    }
}

impl AddAssign for Vec3 {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl MulAssign<f32> for Vec3 {
    #[inline(always)]
    fn mul_assign(&mut self, factor: f32) {
        *self = *self * factor;
    }
}
