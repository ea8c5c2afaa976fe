//! Effects of lens and sensor on light: point spread, exposure, white balance, bloom.
//!
//! Exposure and white balance scale light before the tone curve. Point spread and bloom mix neighbouring pixels of the
//! finished colours; depth and ids stay as sampled at pixel centres.

use crate::bloom::Bloom;
use crate::point_spread::PointSpread;
use cosfly_frames::simd::Level;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Lens and sensor of the camera, for colours of the full look.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Optics {
    /// Standard deviation of the blur of lens and sensor, pixels; 0: none. The default brings the spectrum of pictures to the
    /// slope of real drone pictures.
    #[schemars(range(min = 0, max = 1.2))]
    pub point_spread_px: f64,
    /// Exposure beyond the one that suits the weather, in stops: 1 doubles the light.
    #[schemars(range(min = -4, max = 4))]
    pub exposure_ev: f64,
    /// Colour temperature that is rendered as white, kelvin; below 6500 pictures are bluer, above they are redder.
    #[schemars(range(min = 2500, max = 10000))]
    pub white_balance_k: f64,
    /// Strength of the glow around bright lamps at night; 0: none.
    #[schemars(range(min = 0, max = 2))]
    pub bloom: f64,
}

impl Default for Optics {
    fn default() -> Self {
        Self { point_spread_px: 0.7, exposure_ev: 0.0, white_balance_k: 6500.0, bloom: 1.0 }
    }
}

impl Optics {
    /// Factor of all light.
    pub fn exposure(&self) -> f32 {
        libm::exp2f(self.exposure_ev as f32)
    }

    /// Factors of red, green and blue light: those that make a black body of the white balance's temperature white.
    pub fn gains(&self) -> [f32; 3] {
        // Logarithms of sRGB's red and blue against green change nearly evenly with the inverse temperature.
        let mired = (1e6 / self.white_balance_k.clamp(1000.0, 40_000.0) - 1e6 / 6500.0) as f32;
        [libm::expf(-0.0021 * mired), 1.0, libm::expf(0.0032 * mired)]
    }
}

/// Buffers of the optics.
#[derive(Default)]
pub struct Glass {
    spread: PointSpread,
    bloom: Bloom,
}

impl Glass {
    /// Takes sRGB bytes `width` pixels wide through the optics.
    pub fn see(&mut self, level: Level, optics: &Optics, is_night: bool, width: usize, rgb: &mut [u8]) {
        if is_night && optics.bloom > 0.0 {
            self.bloom.add(level, optics.bloom as f32, width, rgb);
        }
        self.spread.blur(level, optics.point_spread_px, width, rgb);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lamp_light_is_white_at_its_own_temperature() {
        let gains = Optics { white_balance_k: 3200.0, ..Optics::default() }.gains();
        // sRGB of a black body of 3200 K, green 1: red 1.38, blue 0.60.
        assert!((gains[0] * 1.38 - 1.0).abs() < 0.03 && (gains[2] * 0.60 - 1.0).abs() < 0.03, "{gains:?}");
        assert_eq!(Optics::default().gains(), [1.0; 3]);
    }
}
