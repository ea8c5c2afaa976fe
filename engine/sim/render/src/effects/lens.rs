//! Pictures through a lens: each pixel of the finished picture from a wider ideal one, or from ideal views all around.

use super::views::{AHEAD, View, views};
use cosfly_domain::{Camera, ChannelImage, FrameImages, Lens};
use cosfly_frames::{DVec3, real};
use cosfly_optics::margins_px;

/// Pixels of a view beyond its quarter: what is blurred and sampled across an edge is in both views.
const MARGIN_PX: u32 = 8;

/// Place in the ideal picture of each pixel of the finished one.
pub(crate) struct LensMap {
    camera: Camera,
    /// One ideal view.
    ideal: Camera,
    /// Turns of the views from the camera; pictures of all stand below each other.
    views: Vec<View>,
    /// Whether depth is the distance along the ray.
    is_wide: bool,
    samples: Vec<Sample>,
}

/// The upper left of four ideal pixels and the shares of the right and lower ones, in 256ths.
#[derive(Clone, Copy)]
struct Sample {
    corner: u32,
    right: u16,
    down: u16,
}

impl Sample {
    /// The sample at pixel coordinates of a picture that begins with a row.
    fn at((u, v): (f64, f64), size: [u32; 2], first_row: u32) -> Self {
        let place = |at: f64, size: u32| {
            let at = (at - 0.5).clamp(0.0, f64::from(size.saturating_sub(2)) + 255.0 / 256.0);
            let steps = (at * 256.0).round() as u32;
            let first = (steps / 256).min(size.saturating_sub(2));
            (first, (steps - 256 * first) as u16)
        };
        let ((x, right), (y, down)) = (place(u, size[0]), place(v, size[1]));
        Self { corner: (first_row + y) * size[0] + x, right, down }
    }
}

impl LensMap {
    pub fn new(camera: Camera, lens: Lens) -> Self {
        if lens.is_wide(&camera) {
            return Self::all_around(camera, lens);
        }
        let (cx, _, focal) = camera.centre_and_focal_px();
        // A lens that `RenderConfig::validate` refuses shows the ideal picture where it shows nothing.
        let unbend = |(column, row): (u32, u32)| {
            let seen = (f64::from(column) + 0.5, f64::from(row) + 0.5);
            lens.unbend(&camera, seen).unwrap_or(seen)
        };
        let [margin_u, margin_v] = margins_px(&lens, &camera);
        let ideal = Camera {
            width: camera.width + 2 * margin_u,
            height: camera.height + 2 * margin_v,
            horizontal_fov_rad: 2.0 * real::atan2(cx + f64::from(margin_u), focal),
        };
        let sample = |pixel| {
            let (u, v) = unbend(pixel);
            let place = (u + f64::from(margin_u), v + f64::from(margin_v));
            Sample::at(place, [ideal.width, ideal.height], 0)
        };
        Self { camera, ideal, views: vec![AHEAD], is_wide: false, samples: pixels(&camera).map(sample).collect() }
    }

    /// The map of a wide lens, from those of six views that it needs.
    fn all_around(camera: Camera, lens: Lens) -> Self {
        let focal = camera.focal_px();
        let half = focal.ceil() as u32 + MARGIN_PX;
        let side = 2 * half;
        let horizontal_fov_rad = 2.0 * real::atan2(f64::from(half), focal);
        let ideal = Camera { width: side, height: side, horizontal_fov_rad };
        let (mut used, mut samples): (Vec<View>, Vec<Sample>) = (vec![], vec![]);
        for (column, row) in pixels(&camera) {
            let ray = lens.ray(&camera, (f64::from(column) + 0.5, f64::from(row) + 0.5)).unwrap_or(DVec3::X);
            let nearest = views().max_by(|a, b| a.x_axis.dot(ray).total_cmp(&b.x_axis.dot(ray))).unwrap_or(AHEAD);
            let number = used.iter().position(|view| *view == nearest).unwrap_or_else(|| {
                used.push(nearest);
                used.len() - 1
            });
            let seen = nearest.transpose() * ray;
            let place = [seen.y, -seen.z].map(|off| f64::from(half) + focal * off / seen.x);
            samples.push(Sample::at((place[0], place[1]), [side, side], number as u32 * side));
        }
        Self { camera, ideal, views: used, is_wide: true, samples }
    }

    pub fn ideal_camera(&self) -> Camera {
        self.ideal
    }

    /// Turns of the ideal views, from above to below.
    pub fn views(&self) -> &[View] {
        &self.views
    }

    /// The ideal pixel that holds a sample's point.
    fn nearest(&self, sample: &Sample) -> usize {
        let (right, down) = (usize::from(sample.right >= 128), usize::from(sample.down >= 128));
        sample.corner as usize + right + down * self.ideal.width as usize
    }

    /// Depth of an ideal pixel as the finished picture has it.
    fn depth_m(&self, planar_m: f32, pixel: usize) -> f32 {
        if !self.is_wide {
            return planar_m;
        }
        let side = self.ideal.width as usize;
        let (half, focal) = (0.5 * side as f64, self.camera.focal_px());
        let [right, down] = [pixel % side, pixel / side % side].map(|at| (at as f64 + 0.5 - half) / focal);
        (f64::from(planar_m) * (1.0 + right * right + down * down).sqrt()) as f32
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
            out.depth_m[pixel] = self.depth_m(ideal.depth_m[nearest], nearest);
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
        mask.resize(self.views.len() * self.ideal.width as usize * self.ideal.height as usize, false);
        pixels.iter().for_each(|pixel| mask[*pixel as usize] = true);
        let hit = self.samples.iter().enumerate().filter(|(_, sample)| mask[self.nearest(sample)]);
        out.extend(hit.map(|(pixel, _)| pixel as u32));
    }
}

/// Columns and rows of a picture, row by row.
fn pixels(camera: &Camera) -> impl Iterator<Item = (u32, u32)> + use<> {
    let Camera { width, height, .. } = *camera;
    (0..height).flat_map(move |row| (0..width).map(move |column| (column, row)))
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
