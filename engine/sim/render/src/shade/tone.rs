//! From linear light to sRGB bytes: a filmic curve and gamma, through one table.

use super::pattern::nearest_index;
use glam::Vec3A as Vec3;

/// Entries of the table; it is indexed by the square root of light, so darkness is fine-grained.
const ENTRIES: usize = 2048;
/// Light that becomes pure white.
const WHITE: f32 = 8.0;

/// The tone curve as a table.
pub struct ToneCurve {
    bytes: Vec<u8>,
}

impl ToneCurve {
    /// Computes the table.
    pub fn new() -> Self {
        let bytes = (0..ENTRIES)
            .map(|i| {
                let root = i as f32 / (ENTRIES - 1) as f32;
                let x = root * root * WHITE;
                // Narkowicz's fit of the ACES curve, and a share of Reinhard's, which keeps shade open.
                let filmic = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
                let bright = 2.0 * x;
                let gentle = bright * (1.0 + bright / (4.0 * WHITE * WHITE)) / (1.0 + bright);
                let y = (0.65 * filmic + 0.35 * gentle).clamp(0.0, 1.0);
                let srgb = if y <= 0.003_130_8 { 12.92 * y } else { 1.055 * libm::powf(y, 1.0 / 2.4) - 0.055 };
                (255.0 * srgb + 0.5) as u8
            })
            .collect();
        Self { bytes }
    }

    /// Writes a row of linear colours as bytes.
    pub fn store(&self, colours: &[Vec3], exposure: f32, rgb: &mut [u8]) {
        let scale = exposure / WHITE;
        for (colour, out) in colours.iter().zip(rgb.chunks_exact_mut(3)) {
            for (value, byte) in colour.to_array().into_iter().zip(out) {
                let root = (value * scale).clamp(0.0, 1.0).sqrt();
                *byte = self.bytes[nearest_index(root * (ENTRIES - 1) as f32) & (ENTRIES - 1)];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brighter_light_is_never_a_darker_byte() {
        let curve = ToneCurve::new();
        assert!(curve.bytes.windows(2).all(|pair| pair[0] <= pair[1]));
        assert_eq!((curve.bytes[0], curve.bytes[ENTRIES - 1]), (0, 255));
    }
}
