//! [`SlantedWall`]: a straight wall that faces of several boxes are parts of.

use crate::vector::Vec3;

/// A straight wall that faces of several boxes are parts of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlantedWall {
    /// Its horizontal unit vector.
    pub along: Vec3,
    /// `along` of its first end, metres.
    pub edge_m: f32,
    /// Half its width, metres.
    pub half_width_m: f32,
}
