//! The RGB pass: light, materials and weather for the faces seen, in bands of rows.
//!
//! Pixels of one face (of one label, for ground) in a band are gathered into blocks of sixteen, and kernels take a
//! block through all of shading: where it is ([`geometry`], [`shadow`]), what it is made of ([`ground`], [`facade`],
//! [`things`]), what it sends to the camera ([`lighting`]). Bands depend on nothing but the faces, so threads share them.

mod bands;
pub mod facade;
pub mod geometry;
pub mod grid;
pub mod ground;
pub mod lanes;
pub mod light;
pub mod lighting;
pub mod pattern;
pub mod shadow;
pub mod shadow_region;
pub mod simple;
pub mod sky;
pub mod smooth;
pub mod surface;
pub mod things;
pub mod tone;
pub mod vector;

use crate::config::PictureLook;
use crate::frame::FrameImages;
use crate::passes::ids::Band;
use crate::people::People;
use crate::renderer::{DrawnFace, Eye, FrameSetup};
use crate::scene::Scene;
use crate::visibility::Screen;
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec3, Pose};
use geometry::View;
use light::Light;
use pattern::hash;
use std::sync::Mutex;
use vector::Vec3;

/// Shades whole frames; owns the shadow maps.
pub struct Shader {
    screen: Screen,
    level: Level,
    look: PictureLook,
    view: View,
    light: Light,
    haze: Vec3,
    shadows: shadow::Shadows,
    tone: tone::ToneCurve,
    idle: Mutex<Vec<bands::Worker>>,
}

/// What shading reads besides the shader.
#[derive(Clone, Copy)]
pub(crate) struct Seen<'a> {
    pub scene: &'a Scene,
    pub faces: &'a [DrawnFace],
    pub people: &'a People,
}

impl Shader {
    /// A shader for one image size.
    pub fn new(screen: &Screen) -> Self {
        let pose = Pose { position_in_world: DVec3::ZERO, pitch_rad: 0.0, yaw_rad: 0.0, roll_rad: 0.0 };
        Self {
            screen: *screen,
            level: Level::best(),
            look: PictureLook::Full,
            view: View::new(screen, &Eye::new(&pose)),
            light: Light::new(&crate::presets::clear_noon()),
            haze: Vec3::ZERO,
            shadows: shadow::Shadows::new(),
            tone: tone::ToneCurve::new(),
            idle: Mutex::new(Vec::new()),
        }
    }

    /// Shades with these vector instructions from now on.
    pub fn set_level(&mut self, level: Level) {
        self.level = level;
    }

    /// Shades in this look from now on.
    pub fn set_look(&mut self, look: PictureLook) {
        self.look = look;
    }

    /// Takes over a frame's light, camera and shadows.
    pub(crate) fn prepare(&mut self, scene: &Scene, setup: &FrameSetup<'_>, eye: &Eye, people: &People) {
        self.light = Light::new(setup.weather);
        self.view = View::new(&self.screen, eye);
        self.haze =
            self.light.horizon * (0.8 - 0.2 * self.light.rain) + self.light.zenith * 0.2 + self.light.lamp * 0.02;
        if self.look == PictureLook::Full {
            self.shadows.prepare(self.level, scene, (eye, &self.screen), self.light.to_sun, people);
        }
    }

    /// Shades the faces seen in a band, without smoothing.
    pub(crate) fn shade(&self, seen: &Seen<'_>, band: &mut Band<'_>) {
        bands::shade(self, seen, band);
    }

    /// Rain in front of everything.
    pub(crate) fn overlay(&mut self, images: &mut FrameImages) {
        sky::rain(&self.light, self.view.seed, images);
    }
}

impl View {
    fn new(screen: &Screen, eye: &Eye) -> Self {
        let [forward, right, up] = [eye.world_from_body.x_axis, eye.world_from_body.y_axis, eye.world_from_body.z_axis];
        let across = right / screen.focal_px;
        let down = -up / screen.focal_px;
        let corner = forward - across * screen.center_u - down * screen.center_v;
        let position = eye.position_in_world;
        let seed = [position.x, position.y, position.z, forward.x, forward.y].iter().fold(17, |seed, value| {
            let bits = value.to_bits();
            hash(hash(seed, bits as u32), (bits >> 32) as u32)
        });
        Self { position: position.into(), corner: corner.into(), across: across.into(), down: down.into(), seed }
    }
}
