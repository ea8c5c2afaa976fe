//! The way of finished colours through lens and image processor: bloom, point spread, sharpening.

use crate::bloom::Bloom;
use crate::point_spread::PointSpread;
use cosfly_domain::Optics;
use cosfly_frames::simd::Level;

/// Factor of all light.
pub fn exposure(optics: &Optics) -> f32 {
    libm::exp2f(optics.exposure_ev as f32)
}

/// Factors of red, green and blue light: those that make a black body of the white balance's temperature white.
pub fn gains(optics: &Optics) -> [f32; 3] {
    // Logarithms of sRGB's red and blue against green change nearly evenly with the inverse temperature.
    let mired = (1e6 / optics.white_balance_k.clamp(1000.0, 40_000.0) - 1e6 / 6500.0) as f32;
    [libm::expf(-0.0021 * mired), 1.0, libm::expf(0.0032 * mired)]
}

/// Buffers of the optics.
#[derive(Default)]
pub struct Glass {
    spread: PointSpread,
    bloom: Bloom,
}

impl Glass {
    /// Takes sRGB bytes `width` pixels wide through lens and image processor.
    pub fn see(&mut self, level: Level, optics: &Optics, is_night: bool, width: usize, rgb: &mut [u8]) {
        if is_night && optics.bloom > 0.0 {
            self.bloom.add(level, optics.bloom as f32, width, rgb);
        }
        self.spread.apply(level, optics, width, rgb);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lamp_light_is_white_at_its_own_temperature() {
        let [red, green, blue] = gains(&Optics { white_balance_k: 3200.0, ..Optics::IDEAL });
        // sRGB of a black body of 3200 K, green 1: red 1.38, blue 0.60.
        assert!((red * 1.38 - 1.0).abs() < 0.03 && green == 1.0 && (blue * 0.60 - 1.0).abs() < 0.03);
        assert_eq!(gains(&Optics::IDEAL), [1.0; 3]);
    }
}
