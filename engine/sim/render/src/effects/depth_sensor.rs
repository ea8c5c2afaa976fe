//! Depth as a stereo camera measures it: a model of the errors of matching two rectified pictures, version 1.
//!
//! A surface at depth z has the disparity `d = focal * base line / z`. There is no measure out of range, beyond the right camera's
//! picture, behind what is nearer in that picture, and where the colours have too little contrast to be matched. Other disparities
//! get noise of a constant deviation, more where contrast is low, and are rounded to steps: the error of depth grows with its square.

use cosfly_domain::channels::depth_sensor;
use cosfly_domain::{Camera, FrameImages};
use cosfly_frames::Seed;

/// Distance of the right camera, metres: that of common stereo cameras for drones and robots.
const BASE_LINE_M: f64 = 0.12;
/// Depths that are measured, metres.
const RANGE_M: [f64; 2] = [0.5, 40.0];
/// Steps of disparities, pixels: those of OpenCV's matchers.
const STEP_PX: f64 = 1.0 / 16.0;
/// Deviation of disparities, pixels: everywhere, and for a contrast of one code.
const NOISE_PX: [f64; 2] = [0.06, 0.6];
/// Least difference between the darkest and the brightest green near a pixel, codes of 8 bits.
const LEAST_CONTRAST: u8 = 6;
/// Pixels to each side and rows above and below that are near.
const NEAR_PX: [usize; 2] = [4, 1];
/// Standard deviation of the sum of four uniform bytes, and its mean.
const SUM_OF_FOUR: [f64; 2] = [147.80, 510.0];

/// Fills the channel from the finished depths and colours of a frame, where it was asked for.
pub(super) fn draw(images: &mut FrameImages, camera: &Camera, seed: &Seed) {
    let FrameImages { width, height, rgb, depth_m, on_request, .. } = images;
    let Some(image) = on_request.iter_mut().find(|image| *image.channel == depth_sensor::CHANNEL) else { return };
    let (width, height) = (*width as usize, *height as usize);
    let scale = camera.focal_px() * BASE_LINE_M;
    let mut stream = seed.stream("depth-sensor");
    let mut nearest = vec![0.0; width];
    let (pixels, _) = image.bytes.as_chunks_mut::<4>();
    for (row, (measured, depths)) in pixels.chunks_mut(width).zip(depth_m.chunks(width)).enumerate() {
        let disparity = |depth_m: f32| scale / f64::from(depth_m);
        right_picture(depths.iter().map(|depth_m| disparity(*depth_m)), &mut nearest);
        for (column, (measured, depth_m)) in measured.iter_mut().zip(depths).enumerate() {
            // Every pixel has numbers of its own, whatever the others measure.
            let bits = stream.bits();
            let (true_px, is_in_range) = (disparity(*depth_m), RANGE_M[0] <= f64::from(*depth_m));
            let is_seen = in_right_picture(column, true_px).is_some_and(|at| nearest[at] <= true_px + 1.0);
            let contrast = contrast(rgb, [width, height], [column, row]);
            let found = (is_in_range && is_seen && contrast >= LEAST_CONTRAST).then(|| {
                let deviation = NOISE_PX[0] + NOISE_PX[1] / f64::from(contrast);
                let sum: u32 = (bits as u32).to_le_bytes().iter().map(|byte| u32::from(*byte)).sum();
                let noisy = true_px + deviation * (f64::from(sum) - SUM_OF_FOUR[1]) / SUM_OF_FOUR[0];
                scale / ((noisy / STEP_PX).round() * STEP_PX)
            });
            let found = found.filter(|depth_m| (RANGE_M[0]..=RANGE_M[1]).contains(depth_m));
            *measured = found.map_or(f32::NAN, |depth_m| depth_m as f32).to_le_bytes();
        }
    }
}

/// Column of the right picture that shows the point of a pixel.
fn in_right_picture(column: usize, disparity_px: f64) -> Option<usize> {
    let at = column as f64 + 0.5 - disparity_px;
    (at >= 0.0).then_some(at as usize)
}

/// The greatest disparity in each column of a row of the right picture.
fn right_picture(disparities_px: impl Iterator<Item = f64>, nearest: &mut [f64]) {
    nearest.fill(0.0);
    for (column, disparity_px) in disparities_px.enumerate() {
        if let Some(at) = in_right_picture(column, disparity_px) {
            nearest[at] = disparity_px.max(nearest[at]);
        }
    }
}

/// Difference between the darkest and the brightest green near a pixel.
fn contrast(rgb: &[u8], [width, height]: [usize; 2], [column, row]: [usize; 2]) -> u8 {
    let columns = column.saturating_sub(NEAR_PX[0])..(column + NEAR_PX[0] + 1).min(width);
    let (mut low, mut high) = (u8::MAX, 0);
    for row in row.saturating_sub(NEAR_PX[1])..(row + NEAR_PX[1] + 1).min(height) {
        for green in rgb[3 * (row * width + columns.start)..3 * (row * width + columns.end)].iter().skip(1).step_by(3) {
            (low, high) = (low.min(*green), high.max(*green));
        }
    }
    high.saturating_sub(low)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::ChannelImage;

    const CAMERA: Camera = Camera { width: 320, height: 40, horizontal_fov_rad: 1.4 };

    /// A post two metres away before a wall, all of it in stripes but for the left fifth of the wall.
    fn measured(wall_m: f32, seed: u8) -> Vec<f32> {
        let pixels = 320 * 40;
        let depth_m: Vec<f32> =
            (0..pixels).map(|at| if (160..180).contains(&(at % 320)) { 2.0 } else { wall_m }).collect();
        let rgb = (0..pixels).flat_map(|at| [if at % 320 > 64 && at % 6 < 3 { 90 } else { 60 }; 3]).collect();
        let on_request = vec![ChannelImage::new(&depth_sensor::CHANNEL, pixels)];
        let mut images = FrameImages { width: 320, height: 40, rgb, depth_m, on_request, ..FrameImages::default() };
        draw(&mut images, &CAMERA, &Seed([seed; 32]));
        let (bytes, _) = images.on_request[0].bytes.as_chunks::<4>();
        bytes.iter().map(|four| f32::from_le_bytes(*four)).collect()
    }

    fn deviation(depths_m: &[f32], true_m: f32) -> f64 {
        let errors: Vec<f64> =
            (0..depths_m.len()).filter(|at| at % 320 > 200).map(|at| f64::from(depths_m[at] - true_m)).collect();
        (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt()
    }

    #[test]
    fn errors_grow_with_the_square_of_depth_and_seeds_differ() {
        let [near, far] = [5.0, 10.0].map(|wall_m| deviation(&measured(wall_m, 1), wall_m));
        assert!((3.0..5.5).contains(&(far / near)) && (0.02..0.2).contains(&near), "{near} {far}");
        let bits = |seed: u8| measured(5.0, seed).iter().map(|depth_m| depth_m.to_bits()).collect::<Vec<_>>();
        assert!(bits(1) == bits(1) && bits(1) != bits(2));
    }

    #[test]
    fn there_are_holes_beside_what_is_near_without_texture_and_out_of_range() {
        let found = measured(6.0, 1);
        // f b / z: 11.4 px at 2 m, 3.8 px at 6 m; the wall left of the post is hidden from the right camera's place.
        assert!(found[154..159].iter().all(|depth_m| depth_m.is_nan()), "{:?}", &found[145..185]);
        assert!(found[110..145].iter().all(|depth_m| depth_m.is_finite()));
        assert!(found[..58].iter().all(|depth_m| depth_m.is_nan()), "no texture");
        assert!(measured(0.4, 1)[200..].iter().take(50).all(|depth_m| depth_m.is_nan()));
        assert!(measured(60.0, 1)[200..300].iter().filter(|depth_m| depth_m.is_nan()).count() > 80);
    }
}
