//! The blur of lens and sensor: a separable Gaussian over bytes.

use cosfly_frames::simd::Level;
use cosfly_frames::simd_kernel;

/// Neighbours on each side that count.
const REACH: usize = 2;
/// Rows that a blurred row needs.
const ROWS: usize = 2 * REACH + 1;
/// Colours of a pixel.
const STEP: usize = 3;

/// Rows blurred along the width that are still needed: a ring, each with a margin on both sides.
#[derive(Default)]
pub struct PointSpread {
    rows: [Vec<u8>; ROWS],
    padded: Vec<u8>,
}

/// Weights of the middle and of its neighbours, in 256ths; with the neighbours on both sides they add up to 256.
type Weights = [u16; REACH + 1];

fn weights(deviation_px: f64) -> Weights {
    let share = |k: usize| libm::exp(-((k * k) as f64) / (2.0 * deviation_px * deviation_px));
    let sum = 1.0 + 2.0 * (1..=REACH).map(share).sum::<f64>();
    let mut weights = [0; REACH + 1];
    for (k, weight) in weights.iter_mut().enumerate() {
        *weight = (256.0 * share(k) / sum).round() as u16;
    }
    weights[0] = 256 - 2 * weights[1..].iter().sum::<u16>();
    weights
}

impl PointSpread {
    /// Blurs an image `width` pixels wide in place; its border repeats outwards.
    pub fn blur(&mut self, level: Level, deviation_px: f64, width: usize, rgb: &mut [u8]) {
        let bytes = STEP * width;
        if deviation_px < 0.2 || width == 0 || rgb.len() < bytes {
            return;
        }
        let weights = weights(deviation_px);
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
    /// Blurs along a row.
    fn along(padded: &[u8], weights: &Weights, out: &mut [u8]) {
        let count = out.len();
        let at = |k: usize| padded.get(k..k.wrapping_add(count)).unwrap_or(&[]);
        let [a, b, c, d, e] = [at(0), at(STEP), at(2 * STEP), at(3 * STEP), at(4 * STEP)];
        five(&[a, b, c, d, e], weights, out);
    }
}

simd_kernel! {
    /// Blurs across five rows.
    fn across(rows: &[&[u8]; ROWS], weights: &Weights, out: &mut [u8]) {
        five(rows, weights, out);
    }
}

#[inline(always)]
fn five(rows: &[&[u8]; ROWS], weights: &Weights, out: &mut [u8]) {
    let [w0, w1, w2] = *weights;
    let [a, b, c, d, e] = *rows;
    for (((((out, a), b), c), d), e) in out.iter_mut().zip(a).zip(b).zip(c).zip(d).zip(e) {
        let [a, b, c, d, e] = [a, b, c, d, e].map(|byte| u16::from(*byte));
        let sum = w0.wrapping_mul(c).wrapping_add(w1.wrapping_mul(b.wrapping_add(d)));
        // At most 255 * 256 and the half.
        let sum = sum.wrapping_add(w2.wrapping_mul(a.wrapping_add(e))).wrapping_add(128);
        *out = (sum >> 8) as u8;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blurred(
        width: usize,
        height: usize,
        deviation_px: f64,
        level: Level,
        code: impl Fn(usize, usize) -> u8,
    ) -> Vec<u8> {
        let mut rgb: Vec<u8> = (0..STEP * width * height).map(|i| code(i / STEP % width, i / STEP / width)).collect();
        PointSpread::default().blur(level, deviation_px, width, &mut rgb);
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
        }
    }
}
