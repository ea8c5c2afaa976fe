//! Places in a shadow map: ground coordinates sheared along the sun's light.

use crate::seen_region::SeenRegion;
use cosfly_frames::{DVec2, DVec3};

/// Heights in the maps are above this level below the reference, so that all are positive.
pub const DEPTH_M: f64 = 1000.0;

/// Place of a map. The v axis runs along the sun's direction over the ground, so that upright edges,
/// whose shadows run that way, follow the texels and do not turn into stairs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowFrame {
    /// Sheared ground coordinates of texel (0, 0), along `axes`, texels: whole for tiles, whose places then differ by whole numbers
    /// to the last bit, whichever tiles are drawn together.
    pub corner: DVec2,
    /// Height at which a point's place over the sheared ground is its own, metres.
    pub reference_m: f64,
    /// Way over the ground along the light for each metre of height.
    pub shear: DVec2,
    /// Directions of the columns and rows over the ground.
    pub axes: [DVec2; 2],
    /// Size of a texel along the axes, metres.
    pub texels_m: DVec2,
}

impl ShadowFrame {
    /// Sheared ground coordinates along the axes, metres.
    pub fn sheared(&self, point: DVec3) -> DVec2 {
        let at = point.truncate() - (point.z - self.reference_m) * self.shear;
        DVec2::new(at.dot(self.axes[0]), at.dot(self.axes[1]))
    }

    /// Direction over the sheared ground, along the axes.
    pub fn turned(&self, direction: DVec3) -> DVec2 {
        let flat = direction.truncate() - direction.z * self.shear;
        DVec2::new(flat.dot(self.axes[0]), flat.dot(self.axes[1]))
    }

    /// Column and row of a point, texels.
    #[inline]
    pub fn place(&self, point: DVec3) -> [f64; 2] {
        (self.sheared(point) / self.texels_m - self.corner).to_array()
    }

    /// Whether a box around `center`, `half` its size along the world's axes, casts no shadow into a part of the map.
    pub fn misses(&self, part: &SeenRegion, center: DVec3, half: DVec3) -> bool {
        let at = self.place(center);
        (0..2).any(|k| {
            let axis = self.axes[k] / self.texels_m[k];
            let reach = axis.abs().dot(half.truncate()) + self.shear.dot(axis).abs() * half.z + 1.0;
            !(at[k] + reach > part.first[k] as f64 && at[k] - reach < part.end[k] as f64)
        })
    }

    /// Height of a point in the maps, metres.
    pub fn height(&self, point: DVec3) -> f64 {
        point.z - self.reference_m + DEPTH_M
    }

    /// `place` as an affine map in f32: rows of (x, y, z, 1).
    pub fn rows(&self) -> [[f32; 4]; 2] {
        [0, 1].map(|k| {
            let axis = self.axes[k] / self.texels_m[k];
            let slope = -self.shear.dot(axis);
            let constant = -slope * self.reference_m - self.corner[k];
            [axis.x as f32, axis.y as f32, slope as f32, constant as f32]
        })
    }
}
