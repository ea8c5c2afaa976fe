//! Where the surfaces lie that a picture shows, over ground sheared along the light: their shadows alone are needed.

use cosfly_frames::simd::Level;
use cosfly_frames::{DVec2, DVec3, simd_kernel};
use cosfly_raster::eye::Eye;
use cosfly_raster::seen_region::FAR_M;
use cosfly_raster::shadow_frame::ShadowFrame;
use cosfly_raster::visibility::{Screen, VisibilityBuffer};

/// Sides of the blocks of a large picture and of a small one, pixels.
const SIDES: [usize; 2] = [16, 8];
/// A picture of no more pixels is small.
const SMALL_PIXELS: usize = 1 << 16;

/// Least and greatest inverse depth of what is drawn in square blocks of pixels.
#[derive(Default)]
pub(super) struct SeenPlaces {
    blocks: Vec<[f32; 2]>,
    /// Least and greatest inverse depths of the columns of a row of blocks.
    least: Vec<f32>,
    greatest: Vec<f32>,
}

impl SeenPlaces {
    /// Visits a rectangle over the sheared ground, metres, for each block of pixels that shows any surface: all that the
    /// block shows lies within.
    pub(super) fn visit(
        &mut self,
        level: Level,
        lattice: &ShadowFrame,
        (eye, screen): (&Eye, &Screen),
        drawn: &VisibilityBuffer,
        mut visit: impl FnMut(DVec2, DVec2),
    ) {
        let (width, height) = drawn.size();
        if width == 0 {
            return;
        }
        let side = SIDES[usize::from(width * height <= SMALL_PIXELS)];
        let columns = width.div_ceil(side);
        self.blocks.clear();
        self.least.resize(width, 0.0);
        self.greatest.resize(width, 0.0);
        for rows in drawn.inverse_depth.chunks(width * side) {
            measure_columns(level, rows, &mut self.least, &mut self.greatest);
            let columns = self.least.chunks(side).zip(self.greatest.chunks(side));
            self.blocks.extend(columns.map(|(least, greatest)| {
                let least =
                    least.iter().fold(f32::INFINITY, |least, value| if *value < least { *value } else { least });
                [least, greatest.iter().fold(0.0, |most, value| if *value > most { *value } else { most })]
            }));
        }
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
    /// Least and greatest inverse depth of each column of some rows; infinite and 0 where nothing is drawn.
    fn measure_columns(rows: &[f32], least: &mut [f32], greatest: &mut [f32]) {
        least.fill(f32::INFINITY);
        greatest.fill(0.0);
        for row in rows.chunks_exact(least.len()) {
            for ((value, least), greatest) in row.iter().zip(least.iter_mut()).zip(greatest.iter_mut()) {
                let drawn = if *value > 0.0 { *value } else { f32::INFINITY };
                // Choices in place would become masked stores, which are slow on many processors.
                (*least, *greatest) = (least.min(drawn), greatest.max(*value));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shade::sun_tiles::Sun;
    use cosfly_domain::Camera;
    use cosfly_frames::Pose;
    use cosfly_materials::vector::Vec3;

    #[test]
    fn every_drawn_pixel_lies_in_a_visited_rectangle() {
        for (width, height) in [(84, 84), (131, 60), (640, 360)] {
            let camera = Camera { width, height, horizontal_fov_rad: 1.3 };
            let screen = Screen::new(&camera);
            let eye = Eye::new(&Pose::looking_at(DVec3::new(3.0, 4.0, 20.0), DVec3::new(30.0, -9.0, 1.0)));
            let lattice = Sun::new(Vec3::new(0.5, -0.4, 0.6).unit(), [0.0; 2]).lattice(0);
            let (width, height) = (width as usize, height as usize);
            let mut drawn = VisibilityBuffer::new(width, height);
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
