//! Sensor noise: read noise of equal strength everywhere and shot noise that grows with brightness.

use cosfly_domain::Noise;
use cosfly_frames::Seed;
use cosfly_frames::simd::Level;
use cosfly_frames::simd_kernel;

/// Standard deviation of the sum of four uniform bytes: sqrt(4 (256^2 - 1) / 12).
const SUM_DEVIATION: f32 = 147.80;
/// Mean of that sum.
const MEAN: i32 = 2 * 255;
/// Codes that are moved together.
const BLOCK: usize = 32;
/// Distance of the numbers of neighbouring codes, before they are mixed.
const STRIDE: u32 = 0x9e37_79b9;

/// Adds noise to sRGB codes: nearly normal (sums of four uniform numbers), independent per channel and pixel.
pub fn add_noise(level: Level, noise: &Noise, rgb: &mut [u8], seed: &Seed) {
    if noise.is_none() {
        return;
    }
    let unit = 1.0 / (SUM_DEVIATION * SUM_DEVIATION);
    let everywhere = (noise.gaussian * noise.gaussian) as f32 * unit;
    let per_code = (noise.shot * noise.shot / 255.0) as f32 * unit;
    // Two keys: with one alone, the grain of one picture would be that of another, moved by some pixels.
    let keys = seed.stream("noise").bits();
    grain(level, [keys as u32, (keys >> 32) as u32], everywhere, per_code, rgb);
}

simd_kernel! {
    /// Moves each code by its own number; variances are in units of the sum's.
    fn grain(keys: [u32; 2], everywhere: f32, per_code: f32, rgb: &mut [u8]) {
        let (blocks, rest) = rgb.as_chunks_mut::<BLOCK>();
        let [mut first, key] = keys;
        for block in &mut *blocks {
            *block = moved(*block, first, key, everywhere, per_code);
            first = first.wrapping_add(STRIDE.wrapping_mul(BLOCK as u32));
        }
        let mut last = [0; BLOCK];
        last[..rest.len()].copy_from_slice(rest);
        rest.copy_from_slice(&moved(last, first, key, everywhere, per_code)[..rest.len()]);
    }
}

/// A block of codes with noise: the number of code `i` comes from `first + i * STRIDE` and `key`.
#[inline(always)]
fn moved(codes: [u8; BLOCK], first: u32, key: u32, everywhere: f32, per_code: f32) -> [u8; BLOCK] {
    core::array::from_fn(|index| {
        let bits = mixed(first.wrapping_add((index as u32).wrapping_mul(STRIDE)), key);
        let sum = (bits & 0xff) + ((bits >> 8) & 0xff) + ((bits >> 16) & 0xff) + (bits >> 24);
        let value = f32::from(codes[index]);
        let moved = (everywhere + per_code * value).sqrt() * (sum as i32 - MEAN) as f32;
        // The lowest bits of a float from 2^23 on are its whole number.
        ((value + moved).clamp(0.0, 255.0) + 8_388_608.0).to_bits() as u8
    })
}

/// A bijection of 32 bits, another one for each key, in which every bit depends on all others.
#[inline(always)]
fn mixed(mut bits: u32, key: u32) -> u32 {
    bits = (bits ^ (bits >> 16)).wrapping_mul(0x7feb_352d) ^ key;
    bits = (bits ^ (bits >> 15)).wrapping_mul(0x846c_a68b);
    bits ^ (bits >> 16)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn deviation(noise: Noise, code: u8) -> (f64, f64) {
        let mut rgb = vec![code; 90_000];
        add_noise(Level::best(), &noise, &mut rgb, &Seed([3; 32]));
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
            add_noise(Level::best(), &noise, &mut rgb, &Seed([seed; 32]));
            rgb
        };
        assert_eq!(with(1), with(1));
        assert_ne!(with(1), with(2));
    }

    #[test]
    fn the_grain_of_a_picture_is_not_that_of_another_moved_by_pixels() {
        // Pictures whose first keys are neighbours, as they are among a few thousand pictures.
        let noise = |first: u32, key: u32| {
            let mut rgb = vec![128; 4 * BLOCK];
            grain(Level::best(), [first, key], 1e-3, 0.0, &mut rgb);
            rgb
        };
        let (a, b) = (noise(7, 1), noise(7_u32.wrapping_add(STRIDE), 2));
        let same = a[1..].iter().zip(&b).filter(|(a, b)| a == b).count();
        assert!(same < a.len() / 4, "{same} of {} codes are the same", a.len());
    }

    #[test]
    fn all_levels_give_the_same_bytes() {
        let noise = Noise { gaussian: 1.3, shot: 2.7 };
        let with = |level: Level| {
            let mut rgb: Vec<u8> = (0..1001).map(|i| (i * 37) as u8).collect();
            add_noise(level, &noise, &mut rgb, &Seed([5; 32]));
            rgb
        };
        assert!(Level::available().into_iter().all(|level| with(level) == with(Level::PLAIN)));
    }
}
