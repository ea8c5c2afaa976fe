//! Radial distortion after Brown: `r_seen = r (1 + k1 r^2 + k2 r^4)`, with r the tangent of the angle from the optical axis.

use cosfly_domain::{Camera, ChannelImage, FrameImages};
use cosfly_frames::real;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Radial distortion, as OpenCV's `D = [k1, k2, 0, 0, 0]`; both 0: an ideal pinhole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Lens {
    /// Second-order coefficient; negative: barrel, positive: pincushion.
    #[schemars(range(min = -1, max = 1))]
    pub k1: f64,
    /// Fourth-order coefficient.
    #[schemars(range(min = -1, max = 1))]
    pub k2: f64,
}

impl Lens {
    /// Whether it bends nothing.
    pub fn is_none(&self) -> bool {
        self.k1 == 0.0 && self.k2 == 0.0
    }

    /// From the ideal to the seen radius.
    pub fn seen_radius(&self, ideal: f64) -> f64 {
        let square = ideal * ideal;
        ideal * (1.0 + square * (self.k1 + square * self.k2))
    }

    /// From the seen to the ideal radius; `None` where nothing is seen at that radius because the curve turns back.
    pub fn ideal_radius(&self, seen: f64) -> Option<f64> {
        let slope = |r: f64| 1.0 + r * r * (3.0 * self.k1 + 5.0 * self.k2 * r * r);
        let turn = self.turning_radius();
        // Newton's steps from the seen radius; the curve grows up to where it turns, so a root below is the only one.
        let mut ideal = seen;
        for _ in 0..12 {
            ideal -= (self.seen_radius(ideal) - seen) / slope(ideal);
        }
        if (0.0..turn).contains(&ideal) && (self.seen_radius(ideal) - seen).abs() <= 1e-13 * seen.max(1.0) {
            return Some(ideal);
        }
        let (mut low, mut high) = (0.0, if turn.is_finite() { turn } else { 64.0 * seen });
        if self.seen_radius(high) < seen {
            return None;
        }
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if self.seen_radius(middle) < seen {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(0.5 * (low + high))
    }

    /// The ideal radius from which on the curve falls; infinite when it never does.
    fn turning_radius(&self) -> f64 {
        // 1 + 3 k1 q + 5 k2 q^2 = 0, with q the square of the radius.
        let (a, b) = (5.0 * self.k2, 3.0 * self.k1);
        let square = if a == 0.0 {
            -1.0 / b
        } else {
            let discriminant = b * b - 4.0 * a;
            let root = discriminant.max(0.0).sqrt();
            let roots = [(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)];
            let positive = roots.into_iter().filter(|q| *q > 0.0 && discriminant >= 0.0);
            positive.fold(f64::INFINITY, f64::min)
        };
        if square > 0.0 { square.sqrt() } else { f64::INFINITY }
    }

    /// Seen pixel coordinates of a point that an ideal camera would see at (u, v).
    pub fn bend(&self, camera: &Camera, (u, v): (f64, f64)) -> (f64, f64) {
        if self.is_none() {
            return (u, v);
        }
        let (cx, cy, focal) = centre_and_focal(camera);
        let (x, y) = ((u - cx) / focal, (v - cy) / focal);
        let square = x * x + y * y;
        let scale = 1.0 + square * (self.k1 + square * self.k2);
        (cx + focal * x * scale, cy + focal * y * scale)
    }

    /// Pixel coordinates in an ideal camera of the point that this lens shows at (u, v); `None` outside of the lens's
    /// reach.
    pub fn unbend(&self, camera: &Camera, (u, v): (f64, f64)) -> Option<(f64, f64)> {
        if self.is_none() {
            return Some((u, v));
        }
        let (cx, cy, focal) = centre_and_focal(camera);
        let (x, y) = ((u - cx) / focal, (v - cy) / focal);
        let seen = (x * x + y * y).sqrt();
        if seen == 0.0 {
            return Some((u, v));
        }
        let scale = self.ideal_radius(seen)? / seen;
        Some((cx + focal * x * scale, cy + focal * y * scale))
    }

    /// Width of the ideal picture that this lens needs, in widths of the picture; `None` when there is none.
    pub fn widening(&self, camera: &Camera) -> Option<f64> {
        let corner = self.unbend(camera, (0.0, 0.0))?;
        let (cx, cy, _) = centre_and_focal(camera);
        Some(((cx - corner.0) / cx).max((cy - corner.1) / cy).max(1.0))
    }
}

fn centre_and_focal(camera: &Camera) -> (f64, f64, f64) {
    (0.5 * f64::from(camera.width), 0.5 * f64::from(camera.height), camera.focal_px())
}

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
        let (cx, cy, focal) = centre_and_focal(&camera);
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
    fn bending_and_unbending_are_each_other_s_inverse() {
        for lens in [Lens { k1: -0.2, k2: 0.03 }, Lens { k1: 0.15, k2: 0.0 }, Lens { k1: -0.1, k2: -0.02 }] {
            for seen in [(0.5, 0.5), (160.0, 90.0), (319.5, 3.5), (17.5, 140.5)] {
                let ideal = lens.unbend(&CAMERA, seen).expect("in reach");
                let back = lens.bend(&CAMERA, ideal);
                assert!((back.0 - seen.0).abs() < 1e-9 && (back.1 - seen.1).abs() < 1e-9, "{seen:?} {back:?}");
            }
        }
    }

    #[test]
    fn a_curve_that_turns_back_shows_nothing_beyond() {
        assert_eq!(Lens { k1: -1.0, k2: 0.0 }.ideal_radius(0.5), None);
        assert_eq!(Lens { k1: -1.0, k2: 0.0 }.widening(&CAMERA), None);
        assert_eq!(Lens::default().widening(&CAMERA), Some(1.0));
    }

    #[test]
    fn a_barrel_lens_draws_wider_with_the_same_focal_length() {
        let map = LensMap::new(CAMERA, Lens { k1: -0.2, k2: 0.0 });
        let ideal = map.ideal_camera();
        assert!(ideal.width > CAMERA.width && ideal.height > CAMERA.height);
        assert!((ideal.focal_px() - CAMERA.focal_px()).abs() < 1e-9);
        let pincushion = LensMap::new(CAMERA, Lens { k1: 0.2, k2: 0.0 });
        assert_eq!(pincushion.ideal_camera().width, CAMERA.width);
    }
}
