//! Effects of a real camera on an ideal picture: lens distortion, motion blur, a rolling shutter, sensor noise. All off at
//! first.
//!
//! Colour goes through the blur (a mean of light over the shutter), then the lens (bilinear), then the sensor (noise).
//! Depth, ids and channels on request are those of the middle of the shutter, seen through the lens at the nearest sample:
//! they are never mixed.
//! A rolling shutter takes all channels of a strip of rows at the strip's moment, so that they still agree.

mod comparison;
mod depth_sensor;
mod depth_stereo;
mod disparity;
mod lens;
mod shot;
mod views;

use crate::frame::RenderedFrame;
use crate::renderer::Renderer;
use crate::renderer::flow::SeenThrough;
use crate::scene::Scene;
use crate::setup::FrameSetup;
use crate::target_view;
use comparison::Comparison;
use cosfly_domain::channels;
use cosfly_domain::{BodyView, Camera, ChannelImage, FrameImages, Lens, MotionBlur, Noise, RollingShutter, StereoEye};
use cosfly_figures::FigureInPicture;
use cosfly_frames::simd::Level;
use cosfly_frames::{Pose, Seed};
use cosfly_optics::{Exposure, add_noise};
use depth_stereo::PairMatcher;
use lens::LensMap;
use shot::setup;
pub use shot::{FrameBeside, Moment, Neighbours, Shot};
use std::ops::Range;
use views::{AHEAD, View, turned};

/// The effects of one camera with their buffers; keep one per thread beside its renderer.
pub struct Effects {
    finished: SeenThrough,
    blur: MotionBlur,
    rolling: RollingShutter,
    noise: Noise,
    stereo: Option<StereoEye>,
    /// There from the first frame on that has the depth of the pair.
    other_eye: Option<Box<OtherEye>>,
    lens: Option<LensMap>,
    exposure: Exposure,
    /// Strips put together, and the target's pixels in them.
    rolled: FrameImages,
    rolled_target: Vec<u32>,
    images: FrameImages,
    covered: Vec<u32>,
    occluders: Vec<u32>,
    mask: Vec<bool>,
    bystanders: Vec<FigureInPicture>,
    seen: Vec<BodyView>,
    comparison: Comparison,
}

/// The other camera of a pair.
struct OtherEye {
    effects: Effects,
    renderer: Renderer,
    pair: PairMatcher,
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
            stereo: None,
            other_eye: None,
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

    /// Effects of this camera of a stereo pair, where it is one.
    pub fn of_pair(self, stereo: Option<StereoEye>) -> Self {
        Self { stereo, ..self }
    }

    /// Adds this noise from now on; none at first.
    pub fn set_noise(&mut self, noise: Noise) {
        self.noise = noise;
    }

    /// The ideal camera that the renderer has to draw with: wider than the finished picture where the lens needs it.
    pub fn ideal_camera(&self) -> Camera {
        self.lens.as_ref().map_or(self.finished.camera, LensMap::ideal_camera)
    }

    /// Ideal views of a camera in a pose; one, but of a wide lens.
    pub fn poses(&self, pose: Pose) -> impl Iterator<Item = Pose> {
        self.views().iter().map(move |view| turned(&pose, view))
    }

    fn views(&self) -> &[View] {
        self.lens.as_ref().map_or(&[AHEAD][..], LensMap::views)
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
        self.look_beside(renderer, scene, shot);
        if self.lens.is_none() && self.blur.is_none() && self.rolling.is_none() {
            let setup = setup(shot, 0.0, &mut self.bystanders);
            renderer.render_retouched(scene, &setup, grain);
            let Self { finished, stereo, other_eye, .. } = self;
            measure(renderer.images_mut(), (&finished.camera, *stereo), other_eye, &shot.noise_seed);
            self.comparison.draw(renderer, &setup, &(0..self.finished.camera.height as usize), &self.finished);
            return renderer.finished();
        }
        let ideal = self.ideal_camera();
        let strips: Vec<_> = self.rolling.strips(ideal.height as usize).collect();
        let Self { blur, exposure, rolled, rolled_target, bystanders, comparison, finished, lens, .. } = self;
        let views = lens.as_ref().map_or(&[AHEAD][..], LensMap::views);
        rolled_target.clear();
        size(rolled, ideal.width, ideal.height * views.len() as u32);
        let shots = views.iter().enumerate().flat_map(|view| strips.iter().map(move |strip| (view, strip)));
        for ((number, view), (rows, moment_s)) in shots {
            exposure.open();
            for offset_s in blur.offsets_s() {
                let setup = seen_in(view, setup(shot, moment_s + offset_s, bystanders));
                exposure.add(&renderer.render(scene, &setup).images.rgb);
            }
            // The middle comes last: its depth and ids are what stays.
            let setup = seen_in(view, setup(shot, *moment_s, bystanders));
            renderer.render(scene, &setup);
            comparison.draw(renderer, &setup, rows, finished);
            let frame = renderer.finished();
            if !blur.is_none() {
                exposure.add(&frame.images.rgb);
            }
            let rgb = exposure.developed().unwrap_or(&frame.images.rgb);
            let width = ideal.width as usize;
            let first = number * width * ideal.height as usize;
            add_rows(frame.images, rgb, rows.start * width..rows.end * width, (first, &mut *rolled));
            let pixels = (rows.start * width) as u32..(rows.end * width) as u32;
            let target = frame.target_pixels.iter().filter(|pixel| pixels.contains(*pixel));
            rolled_target.extend(target.map(|pixel| first as u32 + pixel));
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
        let Self { finished, stereo, other_eye, .. } = self;
        measure(&mut self.images, (&finished.camera, *stereo), other_eye, &shot.noise_seed);
        let view = target_view::measure(&self.images, &self.covered, &mut self.occluders);
        target_view::measure_bodies(Level::best(), &self.images, bystanders, &mut self.seen);
        RenderedFrame { images: &self.images, target_view: view, target_pixels: &self.covered, others: &self.seen }
    }

    /// Takes the picture of the other camera of a pair, where a channel needs it.
    fn look_beside(&mut self, renderer: &mut Renderer, scene: &Scene, shot: &Shot<'_>) {
        let is_asked = |image: &ChannelImage| *image.channel == channels::depth_stereo::CHANNEL;
        let SeenThrough { camera, lens } = self.finished;
        let eye = self.stereo.filter(|_| lens.is_none() && renderer.images_mut().on_request.iter().any(is_asked));
        let Some(eye) = eye else { return };
        let other = self.other_eye.get_or_insert_with(|| {
            let effects = Self::new(camera, lens, self.blur, self.rolling);
            Box::new(OtherEye { effects, renderer: renderer.beside(), pair: PairMatcher::new(eye, &camera) })
        });
        let OtherEye { effects, renderer: beside, pair } = &mut **other;
        beside.look_as(renderer);
        effects.set_noise(self.noise);
        let moment = |offset_s: f64| {
            let Moment { pose, target } = (shot.moment)(offset_s);
            Moment { pose: pair.other_pose(&pose), target }
        };
        // Its own noise, for this purpose: that of its film is another stage's task.
        let noise_seed = shot.noise_seed.child("other-eye", 0);
        let frame = effects.film(beside, scene, &Shot { moment: &moment, noise_seed, ..*shot });
        pair.other_rgb.clone_from(&frame.images.rgb);
    }
}

/// Draws what follows from the finished depths and colours of a camera, one of a pair where there is one.
fn measure(
    images: &mut FrameImages,
    (camera, stereo): (&Camera, Option<StereoEye>),
    other_eye: &mut Option<Box<OtherEye>>,
    seed: &Seed,
) {
    depth_sensor::draw(images, camera, seed);
    disparity::draw(images, camera, stereo.map(|eye| eye.base_line_m));
    if let Some(other) = other_eye {
        other.pair.draw(images);
    }
}

/// A frame in a view of its camera.
fn seen_in<'a>(view: &View, setup: FrameSetup<'a>) -> FrameSetup<'a> {
    FrameSetup { pose: turned(&setup.pose, view), ..setup }
}

/// Makes room for a picture without new buffers when its size stays.
fn size(images: &mut FrameImages, width: u32, height: u32) {
    let pixels = width as usize * height as usize;
    (images.width, images.height) = (width, height);
    images.rgb.resize(3 * pixels, 0);
    images.depth_m.resize(pixels, 0.0);
    images.semantic.resize(pixels, 0);
    images.instance.resize(pixels, 0);
}

/// Copies pixels of all channels, those of `rgb` for colours, to where the pixels from `first` on are those of the view.
fn add_rows(from: &FrameImages, rgb: &[u8], pixels: Range<usize>, (first, to): (usize, &mut FrameImages)) {
    let there = first + pixels.start..first + pixels.end;
    to.rgb[3 * there.start..3 * there.end].copy_from_slice(&rgb[3 * pixels.start..3 * pixels.end]);
    to.depth_m[there.clone()].copy_from_slice(&from.depth_m[pixels.clone()]);
    to.semantic[there.clone()].copy_from_slice(&from.semantic[pixels.clone()]);
    to.instance[there.clone()].copy_from_slice(&from.instance[pixels.clone()]);
    let all = to.depth_m.len();
    ChannelImage::match_channels(&mut to.on_request, &from.on_request, all);
    for (to, from) in to.on_request.iter_mut().zip(&from.on_request) {
        let size = from.channel.bytes_on_request();
        to.bytes[size * there.start..size * there.end]
            .copy_from_slice(&from.bytes[size * pixels.start..size * pixels.end]);
    }
}
