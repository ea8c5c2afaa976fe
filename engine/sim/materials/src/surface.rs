//! Input and output of materials at a pixel.

use super::vector::Vec3;

/// A point of a surface.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    /// Where, metres.
    pub world: Vec3,
    /// Unit normal of the drawn face.
    pub normal: Vec3,
    /// Size of the pixel on the surface, metres, averaged over directions.
    pub footprint_m: f32,
    /// Size of the pixel along the face's own horizontal and vertical (or x and y on flat faces), metres.
    pub footprints_m: [f32; 2],
}

/// Looks of a surface. Colours are linear RGB.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// Share of light sent back.
    pub albedo: Vec3,
    /// Light of its own.
    pub emission: Vec3,
    /// Normal for shading.
    pub normal: Vec3,
    /// Share of a mirror in it, 0..=1 (before Fresnel).
    pub mirror: f32,
    /// Share of the surroundings' openness it keeps, 0..=1.
    pub openness: f32,
}

impl Look {
    /// A dull surface.
    #[inline(always)]
    pub fn matt(albedo: Vec3, normal: Vec3) -> Self {
        Self { albedo, emission: Vec3::ZERO, normal, mirror: 0.0, openness: 1.0 }
    }

    /// From this look to another as `t` goes from 0 to 1.
    #[inline(always)]
    pub fn lerp(&self, other: &Self, t: f32) -> Self {
        Self {
            albedo: self.albedo.lerp(other.albedo, t),
            emission: self.emission.lerp(other.emission, t),
            normal: self.normal.lerp(other.normal, t),
            mirror: self.mirror + (other.mirror - self.mirror) * t,
            openness: self.openness + (other.openness - self.openness) * t,
        }
    }
}
