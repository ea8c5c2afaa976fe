//! Shades whole frames band by band.

use super::bands::Worker;
use super::foliage::Foliage;
use super::setting::{Seen, Setting};
use super::sky;
use crate::look::PictureLook;
use crate::passes::ids::{Band, SeenRuns};
use crate::people::People;
use crate::scan_air::ScanAir;
use crate::scene::Scene;
use crate::setup::FrameSetup;
use cosfly_domain::{FrameImages, Optics};
use cosfly_frames::simd::Level;
use cosfly_materials::vector::Vec3;
use cosfly_raster::eye::Eye;
use cosfly_raster::visibility::{Screen, VisibilityBuffer};
use std::sync::{Mutex, PoisonError};

/// Shades whole frames; owns the shadow maps.
pub struct Shader {
    setting: Setting,
    foliage: Foliage,
    /// Buffers that no thread uses now.
    idle: Mutex<Vec<Worker>>,
}

impl Shader {
    /// A shader for one image size.
    pub fn new(screen: &Screen) -> Self {
        Self { setting: Setting::new(screen), foliage: Foliage::default(), idle: Mutex::new(Vec::new()) }
    }

    /// Shades with these vector instructions from now on.
    pub fn set_level(&mut self, level: Level) {
        self.setting.level = level;
    }

    /// Shades in this look from now on.
    pub fn set_look(&mut self, look: PictureLook) {
        self.setting.look = look;
    }

    /// Exposes and balances colours like this from now on.
    pub fn set_optics(&mut self, optics: &Optics) {
        self.setting.exposure = cosfly_optics::exposure(optics);
        let [red, green, blue] = cosfly_optics::gains(optics);
        self.setting.tone.set_contrast(optics.contrast as f32);
        self.setting.tone.gains = Vec3::new(red, green, blue);
    }

    /// Whether lamps are lit in the frame at hand.
    pub fn is_night(&self) -> bool {
        self.setting.light.night > 0.0
    }

    /// Factors of red, green and blue light by exposure and white balance of the camera.
    pub(crate) fn camera_light(&self) -> [f32; 3] {
        let Vec3 { x, y, z } = self.setting.tone.gains * self.setting.exposure;
        [x, y, z]
    }

    /// Haze before a scan in the frame at hand.
    pub(crate) fn scan_air(&self) -> Option<ScanAir> {
        let Setting { light, haze, tone, view, .. } = &self.setting;
        ScanAir::new((light, *haze), tone, *view)
    }

    /// Takes over a frame's light, camera and shadows.
    pub(crate) fn prepare(
        &mut self,
        scene: &Scene,
        setup: &FrameSetup<'_>,
        eye: &Eye,
        people: &People,
        drawn: &VisibilityBuffer,
    ) {
        self.setting.prepare(scene, setup, eye, people, drawn);
    }

    /// Shades the faces seen in a band, without smoothing.
    pub(crate) fn shade(&self, seen: &Seen<'_>, band: &mut Band<'_>) {
        let idle = || self.idle.lock().unwrap_or_else(PoisonError::into_inner);
        let mut worker = idle().pop().unwrap_or_else(Worker::new);
        worker.shade(&self.setting, seen, band);
        idle().push(worker);
    }

    /// Breaks the edges of crowns, before edges are smoothed.
    pub(crate) fn fray(&mut self, scene: &Scene, runs: &SeenRuns, images: &mut FrameImages) {
        self.foliage.fray(&self.setting, scene, runs, images);
    }

    /// Rain in front of everything.
    pub(crate) fn overlay(&mut self, images: &mut FrameImages) {
        sky::rain(&self.setting.light, self.setting.view.seed, images);
    }
}
