//! Effects of a real camera on an ideal picture: lens distortion, motion blur, a rolling shutter, sensor noise. All off at
//! first.
//!
//! Colour goes through the blur (a mean of light over the shutter), then the lens (bilinear), then the sensor (noise).
//! Depth, ids and channels on request are those of the middle of the shutter, seen through the lens at the nearest sample:
//! they are never mixed.
//! A rolling shutter takes all channels of a strip of rows at the strip's moment, so that they still agree.

mod comparison;
mod depth_sensor;
mod disparity;
mod lens;
mod shot;

use crate::frame::RenderedFrame;
use crate::renderer::Renderer;
use crate::renderer::flow::SeenThrough;
use crate::scene::Scene;
use crate::target_view;
use comparison::Comparison;
use cosfly_domain::{BodyView, Camera, ChannelImage, FrameImages, Lens, MotionBlur, Noise, RollingShutter};
use cosfly_figures::Bystander;
use cosfly_frames::simd::Level;
use cosfly_optics::{Exposure, add_noise};
use lens::LensMap;
use shot::setup;
pub use shot::{FrameBeside, Moment, Neighbours, Shot};
use std::ops::Range;

/// The effects of one camera with their buffers; keep one per thread beside its renderer.
pub struct Effects {
    finished: SeenThrough,
    blur: MotionBlur,
    rolling: RollingShutter,
    noise: Noise,
    base_line_m: Option<f64>,
    lens: Option<LensMap>,
    exposure: Exposure,
    /// Strips put together, and the target's pixels in them.
    rolled: FrameImages,
    rolled_target: Vec<u32>,
    images: FrameImages,
    covered: Vec<u32>,
    occluders: Vec<u32>,
    mask: Vec<bool>,
    bystanders: Vec<Bystander>,
    seen: Vec<BodyView>,
    comparison: Comparison,
}

impl Effects {
    /// The effects of a camera whose finished pictures have the size and field of view of `camera`. The field of view is
    /// that of the ideal camera without the lens: its focal length stays the same.
    pub fn new(camera: Camera, lens: Lens, blur: MotionBlur, rolling: RollingShutter) -> Self {
        let finished = SeenThrough { camera, lens };
        let lens = (!lens.is_none()).then(|| LensMap::new(camera, lens));
        Self {
            finished,
            blur,
            rolling,
            noise: Noise::default(),
            base_line_m: None,
            lens,
            exposure: Exposure::default(),
            rolled: FrameImages::default(),
            rolled_target: vec![],
            images: FrameImages::default(),
            covered: vec![],
            occluders: vec![],
            mask: vec![],
            bystanders: vec![],
            seen: vec![],
            comparison: Comparison::default(),
        }
    }

    /// Effects of a camera of a stereo pair with this base line, where there is one.
    pub fn of_pair(self, base_line_m: Option<f64>) -> Self {
        Self { base_line_m, ..self }
    }

    /// Adds this noise from now on; none at first.
    pub fn set_noise(&mut self, noise: Noise) {
        self.noise = noise;
    }

    /// The ideal camera that the renderer has to draw with: wider than the finished picture where the lens needs it.
    pub fn ideal_camera(&self) -> Camera {
        self.lens.as_ref().map_or(self.finished.camera, LensMap::ideal_camera)
    }

    /// Moments at which [`Self::film`] looks at what is in front of the camera, seconds from the middle of the shutter.
    pub fn moments_s(&self) -> Vec<f64> {
        let strips = self.rolling.strips(self.ideal_camera().height as usize);
        let moments = strips.flat_map(|(_, moment_s)| self.blur.offsets_s().chain([0.0]).map(move |it| moment_s + it));
        moments.collect()
    }

    /// Takes a picture with `renderer`, which draws with [`Self::ideal_camera`].
    pub fn film<'a>(&'a mut self, renderer: &'a mut Renderer, scene: &Scene, shot: &Shot<'_>) -> RenderedFrame<'a> {
        let noise = self.noise;
        let grain = |rgb: &mut [u8]| add_noise(Level::best(), &noise, rgb, &shot.noise_seed);
        self.comparison.look((renderer, scene), (shot.weather, &shot.neighbours), &self.rolling);
        if self.lens.is_none() && self.blur.is_none() && self.rolling.is_none() {
            let setup = setup(shot, 0.0, &mut self.bystanders);
            renderer.render_retouched(scene, &setup, grain);
            depth_sensor::draw(renderer.images_mut(), &self.finished.camera, &shot.noise_seed);
            disparity::draw(renderer.images_mut(), &self.finished.camera, self.base_line_m);
            self.comparison.draw(renderer, &setup, &(0..self.finished.camera.height as usize), &self.finished);
            return renderer.finished();
        }
        let strips = self.rolling.strips(self.ideal_camera().height as usize);
        let Self { blur, exposure, rolled, rolled_target, bystanders, comparison, finished, .. } = self;
        rolled_target.clear();
        for (rows, moment_s) in strips {
            exposure.open();
            for offset_s in blur.offsets_s() {
                let setup = setup(shot, moment_s + offset_s, bystanders);
                exposure.add(&renderer.render(scene, &setup).images.rgb);
            }
            // The middle comes last: its depth and ids are what stays.
            let setup = setup(shot, moment_s, bystanders);
            renderer.render(scene, &setup);
            comparison.draw(renderer, &setup, &rows, finished);
            let frame = renderer.finished();
            if !blur.is_none() {
                exposure.add(&frame.images.rgb);
            }
            let rgb = exposure.developed().unwrap_or(&frame.images.rgb);
            add_rows(frame.images, rgb, rows.clone(), rolled);
            let width = frame.images.width as usize;
            let pixels = (rows.start * width) as u32..(rows.end * width) as u32;
            rolled_target.extend(frame.target_pixels.iter().filter(|pixel| pixels.contains(*pixel)));
        }
        match &self.lens {
            None => {
                core::mem::swap(rolled, &mut self.images);
                core::mem::swap(rolled_target, &mut self.covered);
            }
            Some(lens) => {
                lens.bend(rolled, &rolled.rgb, &mut self.images);
                lens.bend_pixels(rolled_target, &mut self.mask, &mut self.covered);
            }
        }
        grain(&mut self.images.rgb);
        depth_sensor::draw(&mut self.images, &self.finished.camera, &shot.noise_seed);
        disparity::draw(&mut self.images, &self.finished.camera, self.base_line_m);
        let view = target_view::measure(&self.images, &self.covered, &mut self.occluders);
        target_view::measure_bodies(Level::best(), &self.images, bystanders, &mut self.seen);
        RenderedFrame { images: &self.images, target_view: view, target_pixels: &self.covered, others: &self.seen }
    }
}

/// Copies rows of all channels, those of `rgb` for colours, without new buffers when the sizes agree.
fn add_rows(from: &FrameImages, rgb: &[u8], rows: Range<usize>, to: &mut FrameImages) {
    (to.width, to.height) = (from.width, from.height);
    let width = from.width as usize;
    let pixels = rows.start * width..rows.end * width;
    let colours = 3 * pixels.start..3 * pixels.end;
    to.rgb.resize(from.rgb.len(), 0);
    to.depth_m.resize(from.depth_m.len(), 0.0);
    to.semantic.resize(from.semantic.len(), 0);
    to.instance.resize(from.instance.len(), 0);
    to.rgb[colours.clone()].copy_from_slice(&rgb[colours]);
    to.depth_m[pixels.clone()].copy_from_slice(&from.depth_m[pixels.clone()]);
    to.semantic[pixels.clone()].copy_from_slice(&from.semantic[pixels.clone()]);
    to.instance[pixels.clone()].copy_from_slice(&from.instance[pixels.clone()]);
    ChannelImage::match_channels(&mut to.on_request, &from.on_request, from.depth_m.len());
    for (to, from) in to.on_request.iter_mut().zip(&from.on_request) {
        let size = from.channel.bytes_on_request();
        let bytes = size * pixels.start..size * pixels.end;
        to.bytes[bytes.clone()].copy_from_slice(&from.bytes[bytes]);
    }
}
