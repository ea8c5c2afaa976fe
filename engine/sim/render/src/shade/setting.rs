//! Everything that shading reads: view and light of a frame, shadows, tone; and the scene, faces and people seen.

use super::geometry::View;
use super::shadow::Shadows;
use crate::faces::DrawnFace;
use crate::look::PictureLook;
use crate::people::People;
use crate::scene::Scene;
use crate::setup::FrameSetup;
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec3, Pose};
use cosfly_materials::light::Light;
use cosfly_materials::pattern::hash;
use cosfly_materials::tone::ToneCurve;
use cosfly_materials::vector::Vec3;
use cosfly_raster::eye::Eye;
use cosfly_raster::visibility::{Screen, VisibilityBuffer};

/// Camera, light and shadows of a frame.
pub struct Setting {
    pub screen: Screen,
    pub level: Level,
    pub look: PictureLook,
    pub view: View,
    pub light: Light,
    pub haze: Vec3,
    pub shadows: Shadows,
    /// Factor of all light before the tone curve.
    pub exposure: f32,
    pub tone: ToneCurve,
}

/// Scene, faces and people of a frame.
#[derive(Clone, Copy)]
pub(crate) struct Seen<'a> {
    pub scene: &'a Scene,
    pub faces: &'a [DrawnFace],
    pub people: &'a People,
    /// Colours of the scene's mesh at each pixel.
    pub albedo: &'a [[f32; 3]],
}

/// Exposure at night of a town without any lamp, of that of others.
const UNLIT: f32 = 1.8;

impl Setting {
    /// A clear noon over the world's origin, for one image size.
    pub fn new(screen: &Screen) -> Self {
        let pose = Pose { position_in_world: DVec3::ZERO, pitch_rad: 0.0, yaw_rad: 0.0, roll_rad: 0.0 };
        Self {
            screen: *screen,
            level: Level::best(),
            look: PictureLook::Full,
            view: View::new(screen, &Eye::new(&pose)),
            light: Light::new(&cosfly_materials::presets::clear_noon()),
            haze: Vec3::ZERO,
            shadows: Shadows::new(),
            exposure: 1.0,
            tone: ToneCurve::default(),
        }
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
        self.light = Light::new(setup.weather);
        // A camera gathers light for longer at night where no lamp is.
        let waits = if scene.grid.has_lamps() { 1.0 } else { 1.0 + (UNLIT - 1.0) * self.light.night };
        self.light.exposure *= self.exposure * waits;
        self.view = View::new(&self.screen, eye);
        self.haze =
            self.light.horizon * (0.8 - 0.2 * self.light.rain) + self.light.zenith * 0.2 + self.light.lamp * 0.02;
        if self.look == PictureLook::Full {
            let target = setup.target.map(|target| target.state.feet_in_world);
            self.shadows.prepare(self.level, scene, (eye, &self.screen), self.light.to_sun, (people, target), drawn);
        }
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
