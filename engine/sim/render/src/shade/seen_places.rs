//! Where the surfaces lie that a picture shows, over ground sheared along the light: their shadows alone are needed.

use super::shadow_frame::Frame;
use super::shadow_region::FAR_M;
use crate::eye::Eye;
use crate::visibility::{Screen, Visibility};
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec2, DVec3, simd_kernel};

/// Pixels of a row that are measured together.
const WIDE: usize = 8;
/// Larger pictures have blocks of twice the side.
const SMALL_PIXELS: usize = 1 << 16;

/// Least and greatest inverse depth of what is drawn in square blocks of pixels.
#[derive(Default)]
pub(super) struct SeenPlaces {
    blocks: Vec<[f32; 2]>,
}

impl SeenPlaces {
    /// Visits a rectangle over the sheared ground, metres, for each block of pixels that shows any surface: all that the
    /// block shows lies within.
    pub(super) fn visit(
        &mut self,
        level: Level,
        lattice: &Frame,
        (eye, screen): (&Eye, &Screen),
        drawn: &Visibility,
        mut visit: impl FnMut(DVec2, DVec2),
    ) {
        let (width, height) = drawn.size();
        let scale = if width * height <= SMALL_PIXELS { 1 } else { 2 };
        let side = WIDE * scale;
        let columns = width.div_ceil(side);
        self.blocks.clear();
        self.blocks.resize(columns * height.div_ceil(side), [f32::INFINITY, 0.0]);
        if width == 0 {
            return;
        }
        measure(level, &drawn.inverse_depth, width, scale, &mut self.blocks);
        let apex = lattice.sheared(eye.position_in_world);
        let ray = |y: f64, z: f64, x: f64| lattice.turned(eye.world_from_body * DVec3::new(x, y, z));
        let corner = ray(-screen.center_u / screen.focal_px, screen.center_v / screen.focal_px, 1.0);
        let (across, down) = (ray(1.0 / screen.focal_px, 0.0, 0.0), ray(0.0, -1.0 / screen.focal_px, 0.0));
        for (number, [least, greatest]) in self.blocks.iter().enumerate() {
            let near_m = 1.0 / f64::from(*greatest);
            // Without anything drawn, that is infinite.
            if near_m > FAR_M {
                continue;
            }
            let far_m = (1.0 / f64::from(*least)).min(FAR_M);
            let (left, top) = ((number % columns * side) as f64, (number / columns * side) as f64);
            let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
            for (u, v) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
                let ray = corner + across * (left + u * side as f64) + down * (top + v * side as f64);
                for depth_m in [near_m, far_m] {
                    let at = apex + ray * depth_m;
                    (low, high) = (low.min(at), high.max(at));
                }
            }
            visit(low, high);
        }
    }
}

simd_kernel! {
    /// Measures blocks of `scale` times eight pixels a side.
    fn measure(inverse_depth: &[f32], width: usize, scale: usize, blocks: &mut [[f32; 2]]) {
        let side = scale.wrapping_mul(WIDE);
        let columns = width.div_ceil(side);
        for (band, blocks) in inverse_depth.chunks(width.wrapping_mul(side)).zip(blocks.chunks_exact_mut(columns)) {
            for row in band.chunks_exact(width) {
                for (at, eight) in row.chunks(WIDE).enumerate() {
                    let Some([least, greatest]) = blocks.get_mut(at / scale) else { continue };
                    let mut lows = [f32::INFINITY; WIDE];
                    let mut highs = [0.0f32; WIDE];
                    if let Some(eight) = eight.first_chunk::<WIDE>() {
                        for k in 0..WIDE {
                            lows[k] = if eight[k] > 0.0 { eight[k] } else { f32::INFINITY };
                            highs[k] = eight[k];
                        }
                    } else {
                        for (k, value) in eight.iter().enumerate() {
                            lows[k] = if *value > 0.0 { *value } else { f32::INFINITY };
                            highs[k] = *value;
                        }
                    }
                    let mut count = WIDE / 2;
                    while count > 0 {
                        for k in 0..count {
                            lows[k] = if lows[k + count] < lows[k] { lows[k + count] } else { lows[k] };
                            highs[k] = if highs[k + count] > highs[k] { highs[k + count] } else { highs[k] };
                        }
                        count /= 2;
                    }
                    *least = if lows[0] < *least { lows[0] } else { *least };
                    *greatest = if highs[0] > *greatest { highs[0] } else { *greatest };
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Camera;
    use crate::shade::sun_map::Sun;
    use crate::shade::vector::Vec3;
    use cosfly_frames::Pose;

    #[test]
    fn every_drawn_pixel_lies_in_a_visited_rectangle() {
        for (width, height) in [(84, 84), (131, 60), (640, 360)] {
            let camera = Camera { width, height, horizontal_fov_rad: 1.3 };
            let screen = Screen::new(&camera);
            let eye = Eye::new(&Pose::looking_at(DVec3::new(3.0, 4.0, 20.0), DVec3::new(30.0, -9.0, 1.0)));
            let lattice = Sun::new(Vec3::new(0.5, -0.4, 0.6).unit(), 0.0).lattice(0);
            let (width, height) = (width as usize, height as usize);
            let mut drawn = Visibility::new(width, height);
            for (at, depth) in drawn.inverse_depth.iter_mut().enumerate() {
                let (u, v) = (at % width, at / width);
                *depth = if (u * v) % 7 == 3 { 0.0 } else { 0.002 + ((u * 31 + v * 17) % 97) as f32 * 1e-3 };
            }
            let mut all = vec![];
            SeenPlaces::default().visit(Level::best(), &lattice, (&eye, &screen), &drawn, |low, high| {
                all.push((low, high));
            });
            for at in (0..width * height).step_by(37).filter(|at| drawn.inverse_depth[*at] > 0.0) {
                let (u, v) = ((at % width) as f64 + 0.5, (at / width) as f64 + 0.5);
                let ray =
                    DVec3::new(1.0, (u - screen.center_u) / screen.focal_px, (screen.center_v - v) / screen.focal_px);
                let depth_m = 1.0 / f64::from(drawn.inverse_depth[at]);
                let place = lattice.sheared(eye.position_in_world + eye.world_from_body * ray * depth_m);
                assert!(
                    all.iter().any(|(low, high)| place.cmpge(*low - 1e-6).all() && place.cmple(*high + 1e-6).all()),
                    "{u} {v}"
                );
            }
        }
    }
}
