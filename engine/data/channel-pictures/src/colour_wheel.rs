//! Pictures of optical flow: the direction as a hue of the colour wheel of Baker et al. (2011), the length as its strength.

use cosfly_frames::real;

/// Hues from red over yellow, green, cyan, blue and magenta back to red, and the steps from each to the next.
const HUES: [([f64; 3], usize); 6] = [
    ([1.0, 0.0, 0.0], 15),
    ([1.0, 1.0, 0.0], 6),
    ([0.0, 1.0, 0.0], 4),
    ([0.0, 1.0, 1.0], 11),
    ([0.0, 0.0, 1.0], 13),
    ([1.0, 0.0, 1.0], 6),
];
/// Steps around the wheel.
const STEPS: usize = 55;
/// Shortest way that has a full colour, pixels: where nothing moves, roundings stay white.
const LEAST_FULL_PX: f32 = 0.1;

/// Ways on the picture (right, down) as colours: to the right red, down yellow to green, to the left cyan to blue, up magenta;
/// white where nothing moves, full from the 99th percentile of the picture's own lengths on. 3 bytes a pixel.
pub fn flow_picture(ways_px: &[[f32; 2]]) -> Vec<u8> {
    let wheel = wheel();
    let lengths: Vec<f32> = ways_px.iter().map(|[right, down]| (right * right + down * down).sqrt()).collect();
    let full_px = percentile_99(&lengths).max(LEAST_FULL_PX);
    let colour = |([right, down], length): (&[f32; 2], &f32)| {
        let turn = real::atan2(f64::from(*down), f64::from(*right)) / real::TAU;
        let hue = wheel[((turn + 1.0) * STEPS as f64).round() as usize % STEPS];
        let strength = f64::from(length / full_px).min(1.0);
        hue.map(|part| (255.0 * (1.0 - strength * (1.0 - part))).round() as u8)
    };
    ways_px.iter().zip(&lengths).flat_map(colour).collect()
}

/// The colours around the wheel, clockwise from the right.
fn wheel() -> Vec<[f64; 3]> {
    let ends = HUES.iter().map(|(hue, _)| *hue).skip(1).chain([HUES[0].0]);
    let part = |((from, steps), to): (&([f64; 3], usize), [f64; 3])| {
        let (from, steps) = (*from, *steps);
        (0..steps).map(move |step| core::array::from_fn(|k| from[k] + (to[k] - from[k]) * step as f64 / steps as f64))
    };
    HUES.iter().zip(ends).flat_map(part).collect()
}

/// The length that 99 of 100 do not exceed; 0 without lengths.
fn percentile_99(lengths: &[f32]) -> f32 {
    let mut sorted: Vec<f32> = lengths.iter().copied().filter(|length| length.is_finite()).collect();
    let Some(last) = sorted.len().checked_sub(1) else { return 0.0 };
    *sorted.select_nth_unstable_by(last * 99 / 100, f32::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_have_hues_and_rest_is_white() {
        let colours = flow_picture(&[[5.0, 0.0], [-5.0, 0.0], [0.0, 0.0], [0.0, 5.0], [0.0, -5.0]]);
        let (pixels, _) = colours.as_chunks::<3>();
        assert_eq!((pixels[0], pixels[2]), ([255, 0, 0], [255; 3]));
        assert!(pixels[1][0] == 0 && pixels[1][2] > 200, "{pixels:?}");
        assert!(pixels[3][0] > 200 && pixels[3][1] > 200 && pixels[4][2] > 200, "{pixels:?}");
        assert_eq!(wheel().len(), STEPS);
    }

    #[test]
    fn numbers_that_are_none_are_some_colour() {
        assert_eq!(flow_picture(&[[f32::NAN, 0.0], [f32::INFINITY, 1.0]]).len(), 6);
        assert!(flow_picture(&[]).is_empty());
    }
}
