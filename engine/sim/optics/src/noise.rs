//! Sensor noise: read noise of equal strength everywhere and shot noise that grows with brightness.

use cosfly_domain::Noise;
use cosfly_frames::Seed;

/// Standard deviation of the sum of four uniform 16-bit numbers: 65536 / sqrt(3).
const SUM_DEVIATION: f32 = 37_837.227;
/// Mean of their sum.
const SUM_MEAN: i32 = 2 * 65535;

/// Adds noise to sRGB codes: nearly normal (sums of four uniform numbers), independent per channel and pixel.
pub fn add_noise(noise: &Noise, rgb: &mut [u8], seed: &Seed) {
    if noise.is_none() {
        return;
    }
    let scales: [f32; 256] = core::array::from_fn(|code| {
        let variance = noise.gaussian * noise.gaussian + noise.shot * noise.shot * code as f64 / 255.0;
        variance.sqrt() as f32 / SUM_DEVIATION
    });
    let base = seed.stream("noise").bits();
    for (index, code) in rgb.iter_mut().enumerate() {
        let bits = mixed(base.wrapping_add((index as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15)));
        let sum: i32 = [0, 16, 32, 48].iter().map(|shift| ((bits >> shift) & 0xffff) as i32).sum();
        let noisy = f32::from(*code) + scales[usize::from(*code)] * (sum - SUM_MEAN) as f32;
        *code = (noisy + 0.5).clamp(0.0, 255.0) as u8;
    }
}

/// The finaliser of SplitMix64.
fn mixed(mut bits: u64) -> u64 {
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn deviation(noise: Noise, code: u8) -> (f64, f64) {
        let mut rgb = vec![code; 90_000];
        add_noise(&noise, &mut rgb, &Seed([3; 32]));
        let mean = rgb.iter().map(|code| f64::from(*code)).sum::<f64>() / rgb.len() as f64;
        let variance = rgb.iter().map(|code| (f64::from(*code) - mean).powi(2)).sum::<f64>() / rgb.len() as f64;
        (mean, variance.sqrt())
    }

    #[test]
    fn noise_has_the_asked_deviation_and_no_bias() {
        let noise = Noise { gaussian: 3.0, shot: 8.0 };
        for code in [100, 200] {
            let (mean, found) = deviation(noise, code);
            let asked = (9.0 + 64.0 * f64::from(code) / 255.0).sqrt();
            assert!(
                (mean - f64::from(code)).abs() < 0.1 && (found / asked - 1.0).abs() < 0.02,
                "{mean} {found} {asked}"
            );
        }
        assert_eq!(deviation(Noise::default(), 77), (77.0, 0.0));
    }

    #[test]
    fn another_seed_gives_another_grain() {
        let noise = Noise { gaussian: 2.0, shot: 0.0 };
        let with = |seed: u8| {
            let mut rgb = vec![128; 300];
            add_noise(&noise, &mut rgb, &Seed([seed; 32]));
            rgb
        };
        assert_eq!(with(1), with(1));
        assert_ne!(with(1), with(2));
    }
}
