//! The slope of a picture's power spectrum, from the Fourier transform of its middle square.

use cosfly_frames::real;

/// Waves per picture from which the slope is fitted.
const LOWEST_WAVES: usize = 4;
/// Bands of frequency, evenly spaced by their logarithms.
const BANDS: usize = 24;

#[derive(Clone, Copy, Default)]
struct Complex {
    re: f64,
    im: f64,
}

/// Exponent of power over frequency, all directions together: a line through the means of bands that are evenly spaced by the
/// logarithm of frequency, up to the finest that pixels hold. `values` are rows of `width`.
pub fn slope(values: &[f64], width: usize) -> f64 {
    let height = values.len() / width.max(1);
    let side = 1 << width.min(height).max(1).ilog2();
    if side < 16 {
        return 0.0;
    }
    let power = power_of_square(values, width, side);
    let highest = side as f64 / 2.0;
    let (mut sums, low) = ([(0.0, 0.0, 0.0); BANDS], real::ln(LOWEST_WAVES as f64));
    for (at, power) in power.iter().enumerate() {
        let wave = |k: usize| if k <= side / 2 { k as f64 } else { k as f64 - side as f64 };
        let (x, y) = (wave(at % side), wave(at / side));
        let frequency = (x * x + y * y).sqrt();
        if frequency >= LOWEST_WAVES as f64 && frequency < highest {
            let log = real::ln(frequency);
            let band = ((log - low) / (real::ln(highest) - low) * BANDS as f64) as usize;
            let sum = &mut sums[band.min(BANDS - 1)];
            *sum = (sum.0 + log, sum.1 + power, sum.2 + 1.0);
        }
    }
    let points: Vec<(f64, f64)> = sums
        .iter()
        .filter(|(_, power, count)| *count > 0.0 && *power > 0.0)
        .map(|(log, power, count)| (log / count, real::ln(power / count)))
        .collect();
    let count = points.len().max(1) as f64;
    let mean_x = points.iter().map(|(x, _)| x).sum::<f64>() / count;
    let mean_y = points.iter().map(|(_, y)| y).sum::<f64>() / count;
    let across: f64 = points.iter().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    let square: f64 = points.iter().map(|(x, _)| (x - mean_x) * (x - mean_x)).sum();
    if square > 0.0 { across / square } else { 0.0 }
}

/// Power of each frequency of the middle square under Hann's window.
fn power_of_square(values: &[f64], width: usize, side: usize) -> Vec<f64> {
    let (left, top) = ((width - side) / 2, (values.len() / width - side) / 2);
    let window: Vec<f64> =
        (0..side).map(|k| 0.5 - 0.5 * real::sin_cos(real::TAU * (k as f64 + 0.5) / side as f64).1).collect();
    let mut square = vec![Complex::default(); side * side];
    let inside = |k: usize| values[(top + k / side) * width + left + k % side];
    let mean = (0..side * side).map(inside).sum::<f64>() / (side * side) as f64;
    for (k, value) in square.iter_mut().enumerate() {
        value.re = (inside(k) - mean) * window[k % side] * window[k / side];
    }
    let twiddles: Vec<Complex> = (0..side / 2)
        .map(|k| {
            let (sin, cos) = real::sin_cos(-real::TAU * k as f64 / side as f64);
            Complex { re: cos, im: sin }
        })
        .collect();
    square.chunks_exact_mut(side).for_each(|row| transform(row, &twiddles));
    let mut column = vec![Complex::default(); side];
    for x in 0..side {
        for (y, value) in column.iter_mut().enumerate() {
            *value = square[y * side + x];
        }
        transform(&mut column, &twiddles);
        for (y, value) in column.iter().enumerate() {
            square[y * side + x] = *value;
        }
    }
    square.iter().map(|value| value.re * value.re + value.im * value.im).collect()
}

/// The Fourier transform of a power of two of numbers, in place.
fn transform(values: &mut [Complex], twiddles: &[Complex]) {
    let count = values.len();
    let bits = count.trailing_zeros();
    for k in 0..count {
        let reversed = k.reverse_bits() >> (usize::BITS - bits);
        if k < reversed {
            values.swap(k, reversed);
        }
    }
    let mut half = 1;
    while half < count {
        for start in (0..count).step_by(2 * half) {
            for k in 0..half {
                let turn = twiddles[k * (count / (2 * half))];
                let (a, b) = (values[start + k], values[start + k + half]);
                let b = Complex { re: b.re * turn.re - b.im * turn.im, im: b.re * turn.im + b.im * turn.re };
                values[start + k] = Complex { re: a.re + b.re, im: a.im + b.im };
                values[start + k + half] = Complex { re: a.re - b.re, im: a.im - b.im };
            }
        }
        half *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_random::Seed;

    #[test]
    fn noise_is_even_and_its_running_sum_falls_with_the_square() {
        let mut random = Seed([3; 32]).stream("noise");
        let side = 128;
        let white: Vec<f64> = (0..side * side).map(|_| random.uniform(-1.0, 1.0)).collect();
        assert!(slope(&white, side).abs() < 0.1);
        // Means over a box of a picture fall steeper than the picture.
        let smooth: Vec<f64> = (0..side * side).map(|k| white[k] + white[(k + 1) % (side * side)]).collect();
        assert!(slope(&smooth, side) < slope(&white, side) - 0.1);
    }

    #[test]
    fn the_power_of_a_wave_lies_at_its_frequency() {
        let side = 64;
        let wave: Vec<f64> =
            (0..side * side).map(|k| real::sin_cos(real::TAU * 5.0 * (k % side) as f64 / side as f64).0).collect();
        let power = power_of_square(&wave, side, side);
        let most = (0..power.len()).max_by(|a, b| power[*a].total_cmp(&power[*b])).unwrap();
        assert!(most == 5 || most == side - 5, "{most}");
    }
}
