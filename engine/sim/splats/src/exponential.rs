//! Powers of two and logarithms in plain arithmetic: the same bytes on every processor, and sixteen at a time.

/// Adding this rounds to a whole number, which stands in the lowest bits.
const ROUNDER: f32 = 12_582_912.0;

/// `2^x` within 5e-6 of its value, for x from -120 to 120; anything for others.
#[inline(always)]
pub fn power_of_two(x: f32) -> f32 {
    let shifted = x + ROUNDER;
    let f = x - (shifted - ROUNDER);
    // Of 2^f, f from -0.5 to 0.5, by Chebyshev.
    let series = 1.000_000_1 + f * (0.693_121 + f * (0.240_221_07 + f * (0.055_922_04 + f * 0.009_676_04)));
    f32::from_bits(series.to_bits().wrapping_add(shifted.to_bits() << 23))
}

/// Logarithm to the base 2 within 4e-6, for normal numbers above 0; anything for others.
#[inline(always)]
pub fn logarithm(x: f32) -> f32 {
    let bits = x.to_bits();
    let exponent = (bits >> 23) as i32 as f32 - 127.0;
    let f = f32::from_bits((bits & 0x007f_ffff) | 0x3f80_0000) - 1.0;
    // Of the logarithm of 1 + f, f from 0 to 1, by Chebyshev.
    let tail = 0.455_527_1 + f * (-0.274_623_26 + f * (0.119_298_24 + f * -0.025_123_203));
    exponent + (2.123_741e-6 + f * (1.442_475_3 + f * (-0.717_557_9 + f * tail)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::real;

    #[test]
    fn powers_and_logarithms_are_those_of_the_library() {
        for step in 0..=12_000 {
            let x = -0.01 * step as f32;
            let exact = real::powf(2.0, x.into());
            assert!((f64::from(power_of_two(x)) / exact - 1.0).abs() < 5e-6, "{x}");
        }
        for step in 1..=5000 {
            let x = 0.001 * step as f32;
            let exact = real::ln(x.into()) / real::ln(2.0);
            assert!((f64::from(logarithm(x)) - exact).abs() < 4e-6, "{x}");
        }
    }
}
