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
/// Chunks of a group.
const GROUP: usize = 8;

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
}

/// Draws clouds. Owns every buffer; keep one per thread.
#[derive(Default)]
pub struct SplatRenderer {
    level: Option<Level>,
    is_parallel: bool,
    /// Footprints by group and band.
    groups: Vec<Vec<Vec<Footprint>>>,
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
        if pixels == 0 {
            return &self.picture;
        }
        let level = self.level.unwrap_or_else(Level::best);
        self.project(level, cloud, view);
        self.blend(level, view.width, limit_m);
        &self.picture
    }

    /// Footprints of all splats in view, into the bands that they reach.
    fn project(&mut self, level: Level, cloud: &SplatCloud, view: &SplatView) {
        let (lens, bands, width) = (Lens::new(view), view.height.div_ceil(SIDE), 3 * cloud.coefficients());
        self.groups.resize(cloud.blocks().len().div_ceil(GROUP * CHUNK), Vec::new());
        let fill = |number: usize, group: &mut Vec<Vec<Footprint>>| {
            group.resize(bands, Vec::new());
            group.iter_mut().for_each(Vec::clear);
            let chunks = cloud.blocks().chunks(CHUNK).zip(cloud.harmonics().chunks(CHUNK * width));
            let mut seen = vec![Footprint::default(); CHUNK * WIDE];
            for (blocks, harmonics) in chunks.skip(number * GROUP).take(GROUP) {
                let count = project(level, blocks, harmonics, &lens, &mut seen);
                for footprint in &seen[..count] {
                    let [top, end] = [footprint.first[1], footprint.last[1]].map(|row| usize::from(row) / SIDE);
                    group[top..=end].iter_mut().for_each(|band| band.push(*footprint));
                }
            }
        };
        if self.is_parallel {
            self.groups.par_iter_mut().enumerate().for_each(|(number, group)| fill(number, group));
        } else {
            self.groups.iter_mut().enumerate().for_each(|(number, group)| fill(number, group));
        }
    }

    /// Blends the bands.
    fn blend(&mut self, level: Level, width: usize, limit_m: Option<&[f32]>) {
        let Self { groups, scratch, picture, .. } = self;
        let pixels = SIDE * width;
        let limits = |number: usize| limit_m.and_then(|limits| limits.chunks(pixels).nth(number));
        let draw = |scratch: &mut Scratch, band: Band<'_>| {
            let number = band.number;
            scratch.draw(level, groups.iter().map(|group| group[number].as_slice()), band);
        };
        macro_rules! bands {
            ($chunks_mut:ident) => {
                (picture.colour.$chunks_mut(pixels))
                    .zip(picture.transmittance.$chunks_mut(pixels).zip(picture.depth_m.$chunks_mut(pixels)))
                    .enumerate()
                    .map(|(number, (colour, (transmittance, depth_m)))| Band {
                        number,
                        width,
                        colour,
                        transmittance,
                        depth_m,
                        limit_m: limits(number),
                    })
            };
        }
        if self.is_parallel {
            bands!(par_chunks_mut).for_each_init(Scratch::default, draw);
        } else {
            bands!(chunks_mut).for_each(|band| draw(scratch, band));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{self, ExactPixel};
    use crate::placement::{Placement, SplatsConfig};
    use crate::splat::{MOST_COEFFICIENTS, Splat};
    use cosfly_domain::Camera;
    use cosfly_frames::{DVec3, Pose, Seed};
    use cosfly_scans::up_axis::UpAxis;

    fn placement() -> Placement {
        let plain = SplatsConfig::new("", UpAxis::MinusY);
        let config = SplatsConfig { unit_m: Some(1.7), turn_deg: Some(20.0), ..plain };
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
            let numbers = picture.transmittance.iter().chain(&picture.depth_m);
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
        let config = SplatsConfig::new("", UpAxis::Z);
        let camera = Camera { width: 20, height: 20, horizontal_fov_rad: 0.2 };
        let above = Pose::looking_at(DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO);
        let view = SplatView::new(&camera, &above, &config.placement(DVec3::ZERO).expect("a place"), true);
        let mut renderer = SplatRenderer::default();
        let picture = renderer.draw(&cloud, &view, None);
        let middle = 10 * 20 + 10;
        assert!((picture.colour[middle][1] - 0.75 * 0.25).abs() < 1e-3, "{:?}", picture.colour[middle]);
        assert!((picture.depth_m[middle] - 5.0).abs() < 1e-3 && picture.transmittance[middle] < 0.07);
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
