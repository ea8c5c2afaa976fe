//! What a real camera adds to an ideal picture: lens distortion, motion blur, sensor noise. All off by default.
//!
//! Colour goes through the blur (a mean of light over the shutter), then the lens (bilinear), then the sensor (noise).
//! Depth and ids are those of the middle of the shutter, seen through the lens at the nearest sample: they are never mixed.

mod lens;
mod motion_blur;
mod noise;

pub use lens::Lens;
pub use motion_blur::{MotionBlur, pose_at, target_state_at};
pub use noise::Noise;

use crate::backend::{Backend, BackendError};
use crate::camera::Camera;
use crate::figure::{Bystander, TargetSetup};
use crate::frame::{FrameImages, PersonView};
use crate::renderer::{FrameSetup, RenderedFrame};
use crate::scene::Scene;
use crate::target_view;
use crate::weather::Weather;
use cosfly_frames::simd::Level;
use cosfly_frames::{Pose, Seed};
use lens::LensMap;
use motion_blur::Exposure;

/// What is in front of the camera at a moment.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// The camera's pose.
    pub pose: Pose,
    /// The followed target, if there is one.
    pub target: Option<TargetSetup>,
}

/// One picture to take.
pub struct Shot<'a> {
    /// Weather with its sun azimuth drawn.
    pub weather: &'a Weather,
    /// What is to be seen this many seconds after the middle of the shutter (before it, when negative).
    pub moment: &'a dyn Fn(f64) -> Moment,
    /// Adds everybody else who is about then to an empty list.
    pub others: &'a dyn Fn(f64, &mut Vec<Bystander>),
    /// Seed of the sensor's noise; another one per frame.
    pub noise_seed: Seed,
}

/// The effects of one camera with their buffers; keep one per thread beside its backend.
pub struct Effects {
    camera: Camera,
    blur: MotionBlur,
    noise: Noise,
    lens: Option<LensMap>,
    exposure: Exposure,
    images: FrameImages,
    covered: Vec<u32>,
    occluders: Vec<u32>,
    mask: Vec<bool>,
    bystanders: Vec<Bystander>,
    seen: Vec<PersonView>,
}

impl Effects {
    /// The effects of a camera whose finished pictures have the size and field of view of `camera`. The field of view is
    /// that of the ideal camera without the lens: its focal length stays the same.
    pub fn new(camera: Camera, lens: Lens, blur: MotionBlur, noise: Noise) -> Self {
        let lens = (!lens.is_none()).then(|| LensMap::new(camera, lens));
        let images =
            FrameImages { width: 0, height: 0, rgb: vec![], depth_m: vec![], semantic: vec![], instance: vec![] };
        Self {
            camera,
            blur,
            noise,
            lens,
            exposure: Exposure::default(),
            images,
            covered: vec![],
            occluders: vec![],
            mask: vec![],
            bystanders: vec![],
            seen: vec![],
        }
    }

    /// The ideal camera that the backend has to draw with: wider than the finished picture where the lens needs it.
    pub fn ideal_camera(&self) -> Camera {
        self.lens.as_ref().map_or(self.camera, LensMap::ideal_camera)
    }

    /// Takes a picture with `backend`, which draws with [`Self::ideal_camera`].
    ///
    /// # Errors
    /// What the backend says.
    pub fn film<'a>(
        &'a mut self,
        backend: &'a mut dyn Backend,
        scene: &Scene,
        shot: &Shot<'_>,
    ) -> Result<RenderedFrame<'a>, BackendError> {
        if self.lens.is_none() && self.blur.is_none() && self.noise.is_none() {
            return backend.render(scene, &setup(shot, 0.0, &mut self.bystanders));
        }
        self.exposure.open();
        for offset_s in self.blur.offsets_s() {
            let setup = setup(shot, offset_s, &mut self.bystanders);
            self.exposure.add(&backend.render(scene, &setup)?.images.rgb);
        }
        // The middle comes last: its depth and ids are what stays.
        let middle = setup(shot, 0.0, &mut self.bystanders);
        let frame = backend.render(scene, &middle)?;
        if !self.blur.is_none() {
            self.exposure.add(&frame.images.rgb);
        }
        match &self.lens {
            None => {
                copy(frame.images, &mut self.images);
                self.exposure.develop_into(&mut self.images.rgb);
                self.covered.clear();
                self.covered.extend_from_slice(frame.target_pixels);
            }
            Some(lens) => {
                let developed = self.exposure.developed();
                lens.bend(frame.images, developed.unwrap_or(&frame.images.rgb), &mut self.images);
                lens.bend_pixels(frame.target_pixels, &mut self.mask, &mut self.covered);
            }
        }
        self.noise.add(&mut self.images.rgb, &shot.noise_seed);
        let mut view = target_view::measure(&self.images, &self.covered, &mut self.occluders);
        view.visible_by_rays = middle.target.map_or(0.0, |target| target.visible_by_rays);
        target_view::measure_people(Level::best(), &self.images, middle.others, &mut self.seen);
        Ok(RenderedFrame { images: &self.images, target_view: view, target_pixels: &self.covered, others: &self.seen })
    }
}

/// The frame at a moment of a shot; `bystanders` is room for who is about.
fn setup<'a>(shot: &Shot<'a>, offset_s: f64, bystanders: &'a mut Vec<Bystander>) -> FrameSetup<'a> {
    let Moment { pose, target } = (shot.moment)(offset_s);
    bystanders.clear();
    (shot.others)(offset_s, bystanders);
    FrameSetup { pose, weather: shot.weather, target, others: bystanders }
}

/// Copies all channels, without new buffers when the sizes agree.
fn copy(from: &FrameImages, to: &mut FrameImages) {
    (to.width, to.height) = (from.width, from.height);
    to.rgb.clone_from(&from.rgb);
    to.depth_m.clone_from(&from.depth_m);
    to.semantic.clone_from(&from.semantic);
    to.instance.clone_from(&from.instance);
}
