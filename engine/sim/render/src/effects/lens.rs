//! Pictures through a lens: each pixel of the finished picture from a wider ideal one.

use cosfly_domain::{Camera, ChannelImage, FrameImages, Lens};
use cosfly_frames::real;

/// Place in the ideal picture of each pixel of the finished one.
pub(crate) struct LensMap {
    camera: Camera,
    ideal: Camera,
    samples: Vec<Sample>,
}

/// The upper left of four ideal pixels and the shares of the right and lower ones, in 256ths.
#[derive(Clone, Copy)]
struct Sample {
    corner: u32,
    right: u16,
    down: u16,
}

impl LensMap {
    pub fn new(camera: Camera, lens: Lens) -> Self {
        let (cx, cy, focal) = camera.centre_and_focal_px();
        // A lens that `RenderConfig::validate` refuses shows the ideal picture where it shows nothing.
        let unbend = |column: u32, row: u32| {
            let seen = (f64::from(column) + 0.5, f64::from(row) + 0.5);
            lens.unbend(&camera, seen).unwrap_or(seen)
        };
        let (mut reach_u, mut reach_v) = (cx, cy);
        let (last_column, last_row) = (camera.width.saturating_sub(1), camera.height.saturating_sub(1));
        let rows = (0..camera.height).flat_map(|row| [(0, row), (last_column, row)]);
        for (column, row) in rows.chain((0..camera.width).flat_map(|column| [(column, 0), (column, last_row)])) {
            let (u, v) = unbend(column, row);
            reach_u = reach_u.max((u - cx).abs() + 1.0);
            reach_v = reach_v.max((v - cy).abs() + 1.0);
        }
        let margin = |reach: f64, half: f64| (reach - half).ceil().clamp(0.0, 4.0 * half) as u32;
        let (margin_u, margin_v) = (margin(reach_u, cx), margin(reach_v, cy));
        let ideal = Camera {
            width: camera.width + 2 * margin_u,
            height: camera.height + 2 * margin_v,
            horizontal_fov_rad: 2.0 * real::atan2(cx + f64::from(margin_u), focal),
        };
        let mut samples = Vec::with_capacity(camera.width as usize * camera.height as usize);
        let place = |at: f64, size: u32| {
            let at = (at - 0.5).clamp(0.0, f64::from(size.saturating_sub(2)) + 255.0 / 256.0);
            let steps = (at * 256.0).round() as u32;
            let first = (steps / 256).min(size.saturating_sub(2));
            (first, (steps - 256 * first) as u16)
        };
        for row in 0..camera.height {
            for column in 0..camera.width {
                let (u, v) = unbend(column, row);
                let (x, right) = place(u + f64::from(margin_u), ideal.width);
                let (y, down) = place(v + f64::from(margin_v), ideal.height);
                samples.push(Sample { corner: y * ideal.width + x, right, down });
            }
        }
        Self { camera, ideal, samples }
    }

    pub fn ideal_camera(&self) -> Camera {
        self.ideal
    }

    /// The ideal pixel that holds a sample's point.
    fn nearest(&self, sample: &Sample) -> usize {
        let (right, down) = (usize::from(sample.right >= 128), usize::from(sample.down >= 128));
        sample.corner as usize + right + down * self.ideal.width as usize
    }

    /// All channels of `ideal`, with `rgb` as its colours, into `out`.
    pub fn bend(&self, ideal: &FrameImages, rgb: &[u8], out: &mut FrameImages) {
        let pixels = self.samples.len();
        (out.width, out.height) = (self.camera.width, self.camera.height);
        out.rgb.resize(3 * pixels, 0);
        out.depth_m.resize(pixels, f32::INFINITY);
        out.semantic.resize(pixels, 0);
        out.instance.resize(pixels, 0);
        ChannelImage::match_channels(&mut out.on_request, &ideal.on_request, pixels);
        for (out, ideal) in out.on_request.iter_mut().zip(&ideal.on_request) {
            for (pixel, sample) in self.samples.iter().enumerate() {
                out.copy_pixel(pixel, ideal, self.nearest(sample));
            }
        }
        let row = 3 * self.ideal.width as usize;
        for (pixel, sample) in self.samples.iter().enumerate() {
            let nearest = self.nearest(sample);
            out.depth_m[pixel] = ideal.depth_m[nearest];
            out.semantic[pixel] = ideal.semantic[nearest];
            out.instance[pixel] = ideal.instance[nearest];
            let (right, down) = (u32::from(sample.right), u32::from(sample.down));
            let first = 3 * sample.corner as usize;
            for channel in 0..3 {
                let at = |offset: usize| u32::from(rgb[first + offset + channel]);
                let above = at(0) * (256 - right) + at(3) * right;
                let below = at(row) * (256 - right) + at(row + 3) * right;
                out.rgb[3 * pixel + channel] = ((above * (256 - down) + below * down + (1 << 15)) >> 16) as u8;
            }
        }
    }

    /// Indices of the finished pixels whose nearest sample is one of the ideal `pixels`, ascending. `mask` is scratch.
    pub fn bend_pixels(&self, pixels: &[u32], mask: &mut Vec<bool>, out: &mut Vec<u32>) {
        out.clear();
        if pixels.is_empty() {
            return;
        }
        mask.clear();
        mask.resize(self.ideal.width as usize * self.ideal.height as usize, false);
        pixels.iter().for_each(|pixel| mask[*pixel as usize] = true);
        let hit = self.samples.iter().enumerate().filter(|(_, sample)| mask[self.nearest(sample)]);
        out.extend(hit.map(|(pixel, _)| pixel as u32));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAMERA: Camera = Camera { width: 320, height: 180, horizontal_fov_rad: 1.4 };

    #[test]
    fn a_barrel_lens_draws_wider_with_the_same_focal_length() {
        let map = LensMap::new(CAMERA, Lens::brown(-0.2, 0.0));
        let ideal = map.ideal_camera();
        assert!(ideal.width > CAMERA.width && ideal.height > CAMERA.height);
        assert!((ideal.focal_px() - CAMERA.focal_px()).abs() < 1e-9);
        let pincushion = LensMap::new(CAMERA, Lens::brown(0.2, 0.0));
        assert_eq!(pincushion.ideal_camera().width, CAMERA.width);
    }
}
