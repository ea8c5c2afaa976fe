//! From linear light to sRGB bytes: a filmic curve and gamma, through one table.

use crate::pattern::{fixed_size, least, most};
use crate::vector::Vec3;

/// Entries of the table: 128 for each doubling of light, so darkness is as fine-grained as brightness.
const ENTRIES: usize = 2048;
/// Light of the first entry, and everything darker.
const BLACK: f32 = 1.0 / 8192.0;
/// Light that becomes pure white.
const WHITE: f32 = 8.0;

/// The tone curve as a table.
pub struct ToneCurve {
    bytes: [u32; ENTRIES],
    contrast: f32,
    /// Factors of red, green and blue before the curve.
    pub gains: Vec3,
}

impl Default for ToneCurve {
    /// The film curve.
    fn default() -> Self {
        Self::with_contrast(0.0)
    }
}

impl ToneCurve {
    /// The film curve, steepened by the share `contrast` of an S; gains stay.
    pub fn set_contrast(&mut self, contrast: f32) {
        if contrast != self.contrast {
            *self = Self { gains: self.gains, ..Self::with_contrast(contrast) };
        }
    }

    fn with_contrast(contrast: f32) -> Self {
        let bytes = (0..ENTRIES)
            .map(|i| {
                // The middle of the lights that have this place.
                let x = f32::from_bits(BLACK.to_bits() + ((i as u32) << 16) + 0x8000).min(WHITE);
                // Narkowicz's fit of the ACES curve, and a share of Reinhard's, which keeps shade open.
                let filmic = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
                let bright = 2.0 * x;
                let gentle = bright * (1.0 + bright / (4.0 * WHITE * WHITE)) / (1.0 + bright);
                let y = (0.65 * filmic + 0.35 * gentle).clamp(0.0, 1.0);
                let srgb = if y <= 0.003_130_8 { 12.92 * y } else { 1.055 * libm::powf(y, 1.0 / 2.4) - 0.055 };
                let steep = srgb * srgb * (3.0 - 2.0 * srgb);
                (255.0 * (srgb + contrast * (steep - srgb)) + 0.5) as u32
            })
            .collect();
        Self { bytes: *fixed_size(bytes), contrast, gains: Vec3::splat(1.0) }
    }

    /// The byte for linear light, exposed. The bits of a float grow nearly like its logarithm.
    #[inline(always)]
    pub fn byte(&self, light: f32) -> u32 {
        // The last place is the one below `WHITE`.
        let bits = least(most(light, BLACK), 0.998 * WHITE).to_bits();
        self.bytes[(bits.wrapping_sub(BLACK.to_bits()) >> 16) as usize & (ENTRIES - 1)]
    }

    /// The pixel for a linear colour, exposed: red in the lowest byte, then green and blue.
    #[inline(always)]
    pub fn pixel(&self, colour: Vec3) -> u32 {
        let Vec3 { x, y, z } = colour * self.gains;
        self.byte(x) | (self.byte(y) << 8) | (self.byte(z) << 16)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brighter_light_is_never_a_darker_byte() {
        let mut curve = ToneCurve::default();
        curve.set_contrast(1.0);
        assert!(curve.bytes.windows(2).all(|pair| pair[0] <= pair[1]));
        curve.set_contrast(0.0);
        assert!(curve.bytes.windows(2).all(|pair| pair[0] <= pair[1]));
        assert_eq!((curve.bytes[0], curve.bytes[ENTRIES - 1]), (0, 255));
        assert_eq!((curve.byte(0.0), curve.byte(-1.0), curve.byte(f32::NAN), curve.byte(1e9)), (0, 0, 0, 255));
    }
}
