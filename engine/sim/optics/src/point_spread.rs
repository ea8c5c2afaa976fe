//! The blur of lens and sensor, and the sharpening of the image processor: one separable kernel over bytes.

use cosfly_domain::Optics;
use cosfly_frames::simd::Level;
use cosfly_frames::simd_kernel;

/// Neighbours on each side that count.
const REACH: usize = 2;
/// Rows that a finished row needs.
const ROWS: usize = 2 * REACH + 1;
/// Colours of a pixel.
const STEP: usize = 3;

/// Rows done along the width that are still needed: a ring, each with a margin on both sides.
#[derive(Default)]
pub struct PointSpread {
    rows: [Vec<u8>; ROWS],
    padded: Vec<u8>,
}

/// Weights of the neighbours at distance 1 and 2 on both sides, in parts of `1 << shift`; the middle has what is left.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Weights {
    near: i16,
    far: i16,
    shift: u32,
}

/// The kernel along one axis: a Gaussian, then an unsharp mask with the neighbours' mean; nothing where both are too weak to
/// be seen.
fn weights(optics: &Optics) -> Option<Weights> {
    let (deviation_px, sharpening) = (optics.point_spread_px, optics.sharpening);
    let (near, far) = gaussian(deviation_px);
    let (middle, mask) = (1.0 - 2.0 * (near + far), 0.25 * sharpening);
    let sharp_near = near * (1.0 + 2.0 * mask) - mask * (middle + far);
    let sharp_far = far * (1.0 + 2.0 * mask) - mask * near;
    // Differences of three bytes are below 511; all sums stay in 16 bits.
    let reach = 511.0 * (sharp_near.abs() + sharp_far.abs());
    if reach < 2.0 {
        return None;
    }
    let shift = (1..=12).rev().find(|shift| reach * f64::from(1u32 << shift) < 30_000.0)?;
    let parts = |weight: f64| (weight * f64::from(1u32 << shift)).round() as i16;
    Some(Weights { near: parts(sharp_near), far: parts(sharp_far), shift })
}

/// Weights of the neighbours at distance 1 and 2 of a Gaussian.
fn gaussian(deviation_px: f64) -> (f64, f64) {
    if deviation_px <= 0.0 {
        return (0.0, 0.0);
    }
    let share = |k: f64| libm::exp(-k * k / (2.0 * deviation_px * deviation_px));
    let sum = 1.0 + 2.0 * (share(1.0) + share(2.0));
    let (near, far) = (share(1.0) / sum, share(2.0) / sum);
    // Samples of a narrow Gaussian have less than its variance: what is missing goes to the nearest neighbours.
    (near.max((0.5 * deviation_px * deviation_px - 4.0 * far).min(0.21)), far)
}

impl PointSpread {
    /// Blurs and sharpens an image `width` pixels wide in place; its border repeats outwards.
    pub fn apply(&mut self, level: Level, optics: &Optics, width: usize, rgb: &mut [u8]) {
        let bytes = STEP * width;
        let Some(weights) = weights(optics).filter(|_| width > 0 && rgb.len() >= bytes) else { return };
        let height = rgb.len() / bytes;
        self.rows.iter_mut().for_each(|row| row.resize(bytes, 0));
        self.padded.resize(bytes + 2 * REACH * STEP, 0);
        let mut done = 0;
        for row in 0..height {
            while done < (row + REACH + 1).min(height) {
                pad(&rgb[done * bytes..(done + 1) * bytes], &mut self.padded);
                along(level, &self.padded, &weights, &mut self.rows[done % ROWS]);
                done += 1;
            }
            let near = |by: isize| {
                let at = row.saturating_add_signed(by).min(height - 1);
                self.rows[at % ROWS].as_slice()
            };
            let five = [near(-2), near(-1), near(0), near(1), near(2)];
            across(level, &five, &weights, &mut rgb[row * bytes..(row + 1) * bytes]);
        }
    }
}

/// Copies a row between repetitions of its ends.
fn pad(row: &[u8], padded: &mut [u8]) {
    let margin = REACH * STEP;
    padded[margin..margin + row.len()].copy_from_slice(row);
    for k in 0..REACH {
        padded[k * STEP..(k + 1) * STEP].copy_from_slice(&row[..STEP]);
        let at = margin + row.len() + k * STEP;
        padded[at..at + STEP].copy_from_slice(&row[row.len() - STEP..]);
    }
}

simd_kernel! {
    /// Blurs and sharpens along a row.
    fn along(padded: &[u8], weights: &Weights, out: &mut [u8]) {
        let count = out.len();
        let at = |k: usize| padded.get(k..k.wrapping_add(count)).unwrap_or(&[]);
        let [a, b, c, d, e] = [at(0), at(STEP), at(2 * STEP), at(3 * STEP), at(4 * STEP)];
        five(&[a, b, c, d, e], weights, out);
    }
}

simd_kernel! {
    /// Blurs and sharpens across five rows.
    fn across(rows: &[&[u8]; ROWS], weights: &Weights, out: &mut [u8]) {
        five(rows, weights, out);
    }
}

#[inline(always)]
fn five(rows: &[&[u8]; ROWS], weights: &Weights, out: &mut [u8]) {
    let Weights { near, far, shift } = *weights;
    let half = 1i16 << (shift - 1);
    let [a, b, c, d, e] = *rows;
    for (((((out, a), b), c), d), e) in out.iter_mut().zip(a).zip(b).zip(c).zip(d).zip(e) {
        let [a, b, c, d, e] = [a, b, c, d, e].map(|byte| i16::from(*byte));
        let twice = c.wrapping_add(c);
        let change = near.wrapping_mul(b.wrapping_add(d).wrapping_sub(twice));
        let change = change.wrapping_add(far.wrapping_mul(a.wrapping_add(e).wrapping_sub(twice)));
        *out = c.wrapping_add(change.wrapping_add(half) >> shift).clamp(0, 255) as u8;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn optics(point_spread_px: f64, sharpening: f64) -> Optics {
        Optics { point_spread_px, sharpening, ..Optics::IDEAL }
    }

    /// Standard deviation of the kernel along one axis.
    fn deviation(optics: &Optics) -> f64 {
        let Some(Weights { near, far, shift }) = weights(optics) else { return 0.0 };
        (2.0 * (f64::from(near) + 4.0 * f64::from(far)) / f64::from(1u32 << shift)).sqrt()
    }

    #[test]
    fn the_kernel_has_the_asked_deviation() {
        for asked_px in [0.1, 0.2, 0.3, 0.45, 0.6, 0.7, 0.8] {
            let found_px = deviation(&optics(asked_px, 0.0));
            assert!((found_px - asked_px).abs() < 0.02, "{asked_px}: {found_px}");
        }
        assert_eq!(weights(&optics(0.0, 0.0)), None);
    }

    #[test]
    fn sharpening_steepens_an_edge_and_leaves_even_colours() {
        let edge = |sharpening: f64| {
            let mut rgb: Vec<u8> = (0..STEP * 12 * 5).map(|i| if i / STEP % 12 < 6 { 80 } else { 160 }).collect();
            PointSpread::default().apply(Level::best(), &optics(0.4, sharpening), 12, &mut rgb);
            [2, 5, 6, 9].map(|x| rgb[STEP * (2 * 12 + x)])
        };
        let ([far, dark, bright, end], [_, soft_dark, soft_bright, _]) = (edge(0.8), edge(0.0));
        assert!(soft_dark > 80 && soft_bright < 160 && dark < 80 && bright > 160);
        assert_eq!((far, end), (80, 160));
    }

    fn blurred(
        width: usize,
        height: usize,
        deviation_px: f64,
        level: Level,
        code: impl Fn(usize, usize) -> u8,
    ) -> Vec<u8> {
        let mut rgb: Vec<u8> = (0..STEP * width * height).map(|i| code(i / STEP % width, i / STEP / width)).collect();
        PointSpread::default().apply(level, &optics(deviation_px, 0.0), width, &mut rgb);
        rgb
    }

    #[test]
    fn a_point_spreads_evenly_and_keeps_its_light() {
        let rgb = blurred(9, 9, 0.7, Level::best(), |x, y| if (x, y) == (4, 4) { 255 } else { 0 });
        let at = |x: usize, y: usize| i32::from(rgb[STEP * (9 * y + x)]);
        assert_eq!([at(3, 4), at(4, 3), at(4, 5)], [at(5, 4); 3]);
        let sum: i32 = rgb.iter().step_by(STEP).map(|byte| i32::from(*byte)).sum();
        assert!((sum - 255).abs() < 12 && at(4, 4) > at(5, 4) && at(5, 4) > at(5, 5), "{sum}");
        // Second moment of the middle row's shape: the square of the deviation.
        let row: Vec<f64> = (0..9).map(|x| f64::from(at(x, 4))).collect();
        let second = (0..9).map(|x| (x as f64 - 4.0).powi(2) * row[x]).sum::<f64>() / row.iter().sum::<f64>();
        assert!((second.sqrt() - 0.7).abs() < 0.05, "{second}");
    }

    #[test]
    fn even_pictures_stay_and_all_levels_give_the_same_bytes() {
        assert!(blurred(37, 5, 1.1, Level::best(), |_, _| 255).iter().all(|byte| *byte == 255));
        let code = |x: usize, y: usize| (x * 71 + y * 37 + x * y * 11) as u8;
        let plain = blurred(131, 7, 0.7, Level::PLAIN, code);
        for level in Level::available() {
            assert_eq!(blurred(131, 7, 0.7, level, code), plain);
            let mut rgb = plain.clone();
            PointSpread::default().apply(level, &optics(0.3, 1.0), 131, &mut rgb);
            let mut same = plain.clone();
            PointSpread::default().apply(Level::PLAIN, &optics(0.3, 1.0), 131, &mut same);
            assert!(rgb == same && rgb != plain);
        }
    }
}
