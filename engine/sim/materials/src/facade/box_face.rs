//! [`BoxFace`]: places on a box's upright face, and lines through it.

use crate::lanes::PixelLane;
use crate::surface::SurfacePoint;
use crate::vector::Vec3;

/// Place of a point on a box's upright face.
#[derive(Clone, Copy, Debug)]
pub struct BoxFace {
    /// The face's horizontal.
    pub along: Vec3,
    /// `along` of the edge from which lengths are counted, metres.
    pub edge_m: f32,
    /// Height of the box's foot, metres.
    pub foot_m: f32,
}

impl BoxFace {
    #[inline(always)]
    pub(super) fn along_m(&self, point: &SurfacePoint) -> f32 {
        point.world.x * self.along.x + point.world.y * self.along.y - self.edge_m
    }
}

/// How lines through the face move along it, metres along and up per metre of depth.
#[derive(Clone, Copy)]
pub(super) struct Slant {
    pub(super) along: f32,
    pub(super) up: f32,
}

/// The slant of lines at pixel `k`.
#[inline(always)]
pub(super) fn slant([along, up]: &[PixelLane; 2], k: usize) -> Slant {
    Slant { along: along[k], up: up[k] }
}
