//! [`SplatRenderer`]: pictures of clouds, band by band.

use crate::band::{Band, Scratch};
use crate::block::WIDE;
use crate::cloud::SplatCloud;
use crate::footprint::Footprint;
use crate::project::{Lens, project};
use crate::tile::SIDE;
use crate::view::SplatView;
use cosfly_frames::simd::Level;
use rayon::prelude::*;

/// Blocks that are projected at a time.
const CHUNK: usize = 128;

/// A picture of a cloud, row by row.
#[derive(Clone, Debug, Default)]
pub struct SplatPicture {
    /// Pixels per row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Red, green and blue in the space of training, times the share of the pixel that splats cover.
    pub colour: Vec<[f32; 3]>,
    /// Share of the light behind the splats that comes through, 0 to 1.
    pub transmittance: Vec<f32>,
    /// Planar depth at which half of the light is gone, metres; infinite where more comes through.
    pub depth_m: Vec<f32>,
    /// Mean planar depth of what is seen, metres; infinite where nothing is.
    pub mean_depth_m: Vec<f32>,
}

/// Draws clouds. Owns every buffer; keep one per thread.
#[derive(Default)]
pub struct SplatRenderer {
    level: Option<Level>,
    is_parallel: bool,
    footprints: Vec<Footprint>,
    /// Footprints of each chunk.
    counts: Vec<usize>,
    /// Footprints of each band, by number.
    bands: Vec<Vec<u32>>,
    scratch: Scratch,
    picture: SplatPicture,
}

impl SplatRenderer {
    /// Draws with these vector instructions from now on, to compare their bytes: they are the same.
    pub fn set_level(&mut self, level: Level) {
        self.level = Some(level);
    }

    /// Spreads pictures over the threads of the rayon pool that calls, from now on; the bytes are the same. Off at first.
    pub fn set_parallel(&mut self, is_parallel: bool) {
        self.is_parallel = is_parallel;
    }

    /// A picture of a cloud. With limits, planar depths in metres by pixel, only what lies before them is blended.
    ///
    /// # Panics
    /// Where there are limits, but not one for each pixel.
    pub fn draw(&mut self, cloud: &SplatCloud, view: &SplatView, limit_m: Option<&[f32]>) -> &SplatPicture {
        let pixels = view.width * view.height;
        assert!(limit_m.is_none_or(|limits| limits.len() == pixels), "there is one limit for each pixel");
        let picture = &mut self.picture;
        (picture.width, picture.height) = (view.width, view.height);
        picture.colour.resize(pixels, [0.0; 3]);
        picture.transmittance.resize(pixels, 1.0);
        picture.depth_m.resize(pixels, f32::INFINITY);
        picture.mean_depth_m.resize(pixels, f32::INFINITY);
        if pixels == 0 {
            return &self.picture;
        }
        let level = self.level.unwrap_or_else(Level::best);
        self.project(level, cloud, view);
        self.sort_into_bands(view.height.div_ceil(SIDE));
        self.blend(level, view.width, limit_m);
        &self.picture
    }

    /// Footprints of all splats in view, at the places of their chunks.
    fn project(&mut self, level: Level, cloud: &SplatCloud, view: &SplatView) {
        let lens = Lens::new(view);
        self.footprints.resize(cloud.blocks().len() * WIDE, Footprint::default());
        self.counts.resize(cloud.blocks().len().div_ceil(CHUNK), 0);
        let width = 3 * cloud.coefficients();
        macro_rules! project_all {
            ($chunks:ident, $chunks_mut:ident, $iterate:ident) => {
                (cloud.blocks().$chunks(CHUNK).zip(cloud.harmonics().$chunks(CHUNK * width)))
                    .zip(self.footprints.$chunks_mut(CHUNK * WIDE).zip(self.counts.$iterate()))
                    .for_each(|((blocks, harmonics), (footprints, count))| {
                        *count = project(level, blocks, harmonics, &lens, footprints);
                    })
            };
        }
        if self.is_parallel {
            project_all!(par_chunks, par_chunks_mut, par_iter_mut);
        } else {
            project_all!(chunks, chunks_mut, iter_mut);
        }
    }

    fn sort_into_bands(&mut self, count: usize) {
        self.bands.resize(count, Vec::new());
        self.bands.iter_mut().for_each(Vec::clear);
        for (chunk, count) in self.counts.iter().enumerate() {
            let first = chunk * CHUNK * WIDE;
            for (number, footprint) in (first as u32..).zip(&self.footprints[first..first + count]) {
                let [top, end] = [footprint.first[1], footprint.last[1]].map(|row| usize::from(row) / SIDE);
                self.bands[top..=end].iter_mut().for_each(|band| band.push(number));
            }
        }
    }

    fn blend(&mut self, level: Level, width: usize, limit_m: Option<&[f32]>) {
        let Self { footprints, bands, scratch, picture, .. } = self;
        let pixels = SIDE * width;
        let limits = |number: usize| limit_m.and_then(|limits| limits.chunks(pixels).nth(number));
        macro_rules! bands {
            ($chunks_mut:ident, $iterate:ident) => {
                (picture.colour.$chunks_mut(pixels).zip(picture.transmittance.$chunks_mut(pixels)))
                    .zip(picture.depth_m.$chunks_mut(pixels).zip(picture.mean_depth_m.$chunks_mut(pixels)))
                    .zip(bands.$iterate())
                    .enumerate()
                    .map(|(number, (((colour, transmittance), (depth_m, mean_depth_m)), members))| {
                        let limit_m = limits(number);
                        (members, Band { number, width, colour, transmittance, depth_m, mean_depth_m, limit_m })
                    })
            };
        }
        if self.is_parallel {
            bands!(par_chunks_mut, par_iter).for_each_init(Scratch::default, |scratch, (members, band)| {
                scratch.draw(level, footprints, members, band);
            });
        } else {
            bands!(chunks_mut, iter).for_each(|(members, band)| scratch.draw(level, footprints, members, band));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{self, ExactPixel};
    use crate::placement::{Placement, PlacementConfig, SplatUpAxis};
    use crate::splat::{MOST_COEFFICIENTS, Splat};
    use cosfly_domain::Camera;
    use cosfly_frames::{DVec3, Pose, Seed};

    fn placement() -> Placement {
        let (up_axis, unit_m) = (SplatUpAxis::MinusY, Some(1.7));
        let config = PlacementConfig { up_axis, unit_m, turn_deg: Some(20.0), origin_m: None, points: None };
        config.placement(DVec3::ZERO).expect("a place")
    }

    /// Splats around the origin of the world, some of them thin, large, behind the camera or at its edges.
    fn scene(number: u64, count: usize) -> Vec<Splat> {
        let mut stream = Seed::of_item(number, "splats", "scene").stream("splats");
        let mut real = |low: f32, high: f32| low + (high - low) * stream.index(1 << 20) as f32 / 1_048_576.0;
        let splat = |_| {
            let middle = [real(-4.0, 4.0), real(-4.0, 4.0), real(-4.0, 4.0)];
            let spread = [0, 1, 2].map(|_| real(-6.0, -0.7).exp2());
            let turn = [0, 1, 2, 3].map(|_| real(-1.0, 1.0));
            let mut harmonics = [[0.0; 3]; MOST_COEFFICIENTS];
            harmonics.iter_mut().flatten().for_each(|value| *value = real(-0.4, 0.5));
            Splat { middle, spread, turn, opacity: real(0.01, 1.0), harmonics }
        };
        (0..count).map(splat).collect()
    }

    fn cloud_of(splats: &[Splat], degree: usize) -> SplatCloud {
        let mut cloud = SplatCloud::new(degree);
        splats.iter().for_each(|splat| cloud.push(splat));
        cloud
    }

    fn view(is_antialiased: bool, width: u32) -> SplatView {
        let camera = Camera { width, height: 53, horizontal_fov_rad: 1.2 };
        let pose = Pose { roll_rad: 0.3, ..Pose::looking_at(DVec3::new(-5.0, 6.0, 4.0), DVec3::new(0.5, 0.2, -0.3)) };
        SplatView::new(&camera, &pose, &placement(), is_antialiased)
    }

    /// Ratio of the peak to the noise, decibels.
    fn psnr_db(picture: &SplatPicture, exact: &[ExactPixel]) -> f64 {
        let squares =
            picture.colour.iter().zip(&picture.transmittance).zip(exact).flat_map(|((colour, light), exact)| {
                let [r, g, b] = [0, 1, 2].map(|k| f64::from(colour[k]) - exact.colour[k]);
                [r, g, b, f64::from(*light) - exact.transmittance].map(|off| off * off)
            });
        let mean = squares.sum::<f64>() / (4 * exact.len()) as f64;
        -10.0 * cosfly_frames::real::ln(mean) / cosfly_frames::real::ln(10.0)
    }

    #[test]
    fn pictures_are_those_of_the_published_equations() {
        for (number, degree, is_antialiased) in [(1, 3, true), (2, 3, false), (3, 2, true), (4, 1, true), (5, 0, false)]
        {
            let (splats, view) = (scene(number, 900), view(is_antialiased, 70));
            let exact = exact::picture(&splats, (degree + 1) * (degree + 1), &view);
            let mut renderer = SplatRenderer::default();
            let picture = renderer.draw(&cloud_of(&splats, degree), &view, None);
            let psnr_db = psnr_db(picture, &exact);
            assert!(psnr_db >= 100.0, "scene {number}: {psnr_db:.1} dB");
            let off = |(own, exact): (&f32, &ExactPixel)| (f64::from(*own) - exact.depth_m).abs() > 1e-3;
            let wrong = picture.depth_m.iter().zip(&exact).filter(|(own, exact)| {
                own.is_finite() != exact.depth_m.is_finite() || own.is_finite() && off((own, exact))
            });
            assert!(wrong.count() <= exact.len() / 200, "scene {number}");
        }
    }

    #[test]
    fn threads_and_vector_instructions_change_no_byte() {
        let (cloud, view) = (cloud_of(&scene(7, 3000), 3), view(true, 131));
        let bits = |picture: &SplatPicture| {
            let numbers = [&picture.transmittance, &picture.depth_m, &picture.mean_depth_m].into_iter().flatten();
            let all: Vec<u32> = picture.colour.iter().flatten().chain(numbers).map(|number| number.to_bits()).collect();
            all
        };
        let expected = bits(SplatRenderer::default().draw(&cloud, &view, None));
        for level in Level::available() {
            let mut renderer = SplatRenderer::default();
            renderer.set_level(level);
            renderer.set_parallel(level == Level::PLAIN);
            // After another picture, too.
            renderer.draw(&cloud, &self::view(false, 40), None);
            assert!(bits(renderer.draw(&cloud, &view, None)) == expected, "{}", level.name());
        }
    }

    #[test]
    fn what_lies_behind_a_limit_is_not_blended() {
        let level =
            |depth: f32, srgb| Splat::plain([0.0, 0.0, depth], [2.0, 2.0, 0.01], [1.0, 0.0, 0.0, 0.0], 0.75, srgb);
        let cloud = cloud_of(&[level(0.0, [1.0, 0.0, 0.0]), level(-3.0, [0.0, 1.0, 0.0])], 0);
        let config =
            PlacementConfig { up_axis: SplatUpAxis::Z, unit_m: None, turn_deg: None, origin_m: None, points: None };
        let camera = Camera { width: 20, height: 20, horizontal_fov_rad: 0.2 };
        let above = Pose::looking_at(DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO);
        let view = SplatView::new(&camera, &above, &config.placement(DVec3::ZERO).expect("a place"), true);
        let mut renderer = SplatRenderer::default();
        let picture = renderer.draw(&cloud, &view, None);
        let middle = 10 * 20 + 10;
        assert!((picture.colour[middle][1] - 0.75 * 0.25).abs() < 1e-3, "{:?}", picture.colour[middle]);
        assert!((picture.depth_m[middle] - 5.0).abs() < 1e-3 && picture.transmittance[middle] < 0.07);
        assert!((picture.mean_depth_m[middle] - (5.0 * 0.75 + 8.0 * 0.1875) / 0.9375).abs() < 1e-2);
        let mut limits = vec![f32::INFINITY; 400];
        limits[middle] = 6.0;
        let picture = renderer.draw(&cloud, &view, Some(&limits));
        assert_eq!(picture.colour[middle][1], 0.0);
        assert!((picture.transmittance[middle] - 0.25).abs() < 1e-3 && picture.transmittance[middle + 1] < 0.07);
    }

    #[test]
    fn nothing_is_drawn_of_nothing() {
        let (empty, view) = (SplatCloud::new(3), view(true, 33));
        let picture = SplatRenderer::default().draw(&empty, &view, None).clone();
        assert!(picture.transmittance.iter().all(|light| *light == 1.0));
        assert!(picture.depth_m.iter().all(|depth| depth.is_infinite()));
    }
}
