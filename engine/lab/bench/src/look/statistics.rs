//! Statistics of one picture.

use super::spectrum::slope;
use serde::Serialize;

/// Pixels whose neighbourhood deviates less than this from its mean are flat, codes.
const FLAT_CODES: f64 = 2.0;
/// Pixels beside which brightness changes by more than this per pixel are edges, codes.
const EDGE_CODES: f64 = 20.0;

/// Statistics of a picture; brightness is luma of 8-bit codes.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Statistics {
    /// Exponent with which the power of brightness falls with spatial frequency, from 4 waves a picture to the finest.
    pub spectral_slope: f64,
    /// Share of pixels around which the 3 x 3 brightnesses deviate by less than 2 codes.
    pub flat_share: f64,
    /// Share of pixels where brightness changes by more than 20 codes per pixel.
    pub edge_share: f64,
    /// Root of the summed variances of red - green and (red + green) / 2 - blue, codes.
    pub colour_spread: f64,
}

impl Statistics {
    /// Computes every statistic by the way that picks it from a picture's.
    pub fn each(value: impl Fn(fn(&Self) -> f64) -> f64) -> Self {
        Self {
            spectral_slope: value(|it| it.spectral_slope),
            flat_share: value(|it| it.flat_share),
            edge_share: value(|it| it.edge_share),
            colour_spread: value(|it| it.colour_spread),
        }
    }
}

/// Statistics of sRGB bytes `width` pixels wide.
pub fn of_picture(rgb: &[u8], width: usize) -> Statistics {
    let pixels = rgb.as_chunks::<3>().0;
    let luma: Vec<f64> =
        pixels.iter().map(|[r, g, b]| 0.299 * f64::from(*r) + 0.587 * f64::from(*g) + 0.114 * f64::from(*b)).collect();
    let height = luma.len() / width.max(1);
    if width < 16 || height < 16 {
        return Statistics::default();
    }
    let at = |x: usize, y: usize| luma[y * width + x];
    let (mut flat, mut edges) = (0, 0);
    for y in 1..height - 1 {
        for x in 1..width - 1 {
            let (mut sum, mut squares) = (0.0, 0.0);
            for value in (y - 1..=y + 1).flat_map(|y| (x - 1..=x + 1).map(move |x| (x, y))).map(|(x, y)| at(x, y)) {
                sum += value;
                squares += value * value;
            }
            let variance = (squares - sum * sum / 9.0) / 9.0;
            let (across, down) = (0.5 * (at(x + 1, y) - at(x - 1, y)), 0.5 * (at(x, y + 1) - at(x, y - 1)));
            flat += usize::from(variance < FLAT_CODES * FLAT_CODES);
            edges += usize::from(across * across + down * down > EDGE_CODES * EDGE_CODES);
        }
    }
    let inner = ((width - 2) * (height - 2)) as f64;
    let variance = |pick: &dyn Fn(&[u8; 3]) -> f64| {
        let (sum, squares) =
            pixels.iter().map(pick).fold((0.0, 0.0), |(sum, squares), it| (sum + it, squares + it * it));
        let mean = sum / pixels.len() as f64;
        squares / pixels.len() as f64 - mean * mean
    };
    let red_green = variance(&|[r, g, _]| f64::from(*r) - f64::from(*g));
    let yellow_blue = variance(&|[r, g, b]| 0.5 * (f64::from(*r) + f64::from(*g)) - f64::from(*b));
    Statistics {
        spectral_slope: slope(&luma, width),
        flat_share: f64::from(flat as u32) / inner,
        edge_share: f64::from(edges as u32) / inner,
        colour_spread: (red_green + yellow_blue).max(0.0).sqrt(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flat_pictures_are_flat_and_stripes_are_edges() {
        let grey = of_picture(&[90; 3 * 64 * 64], 64);
        assert_eq!((grey.flat_share, grey.edge_share, grey.colour_spread), (1.0, 0.0, 0.0));
        let stripes: Vec<u8> = (0..3 * 64 * 64).map(|i| if i / 3 % 64 / 2 % 2 == 0 { 0 } else { 200 }).collect();
        let stripes = of_picture(&stripes, 64);
        assert_eq!((stripes.flat_share, stripes.edge_share), (0.0, 1.0));
    }
}
