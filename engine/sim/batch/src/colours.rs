//! Colours, by the large renderer's own shading of the faces that were found here.

use crate::canvas::Canvas;
use crate::faces::{DrawnFace, SKY};
use crate::view::View;
use cosfly_frames::simd::Level;

use cosfly_render::{Camera, FrameSetup, Renderer, TargetSetup, Walker, Weather};

/// Weather of views without any.
const WEATHER: &str = "ClearNoon";

/// The shading of one painter; its buffers are there once somebody asks for colours.
#[derive(Default)]
pub struct Colours {
    renderer: Option<Renderer>,
    noon: Option<Weather>,
    /// Numbers of the faces in the scene, pixel by pixel.
    found: Vec<u32>,
}

impl Colours {
    /// Shades a picture whose town is drawn, and who moves in it is not yet.
    ///
    /// # Panics
    /// Where the scene of the view was made without colours.
    pub fn draw(&mut self, level: Level, view: &View<'_>, canvas: &Canvas, faces: &[DrawnFace], rgb: &mut [u8]) {
        let Some(scene) = &view.scene.large else {
            panic!("colours are asked for of a scene that was prepared without them");
        };
        self.found.clear();
        let number = |face: &f32| faces.get(*face as i32 as usize).unwrap_or(&SKY).number;
        for row in canvas.face.chunks_exact(canvas.blocks.max(1)) {
            self.found.extend(row.as_flattened().iter().take(canvas.width).map(number));
        }
        let (width, height) = (canvas.width as u32, canvas.height as u32);
        let camera = Camera { width, height, horizontal_fov_rad: view.horizontal_fov_rad };
        let renderer = match &mut self.renderer {
            Some(known) if known.camera() == camera => known,
            other => other.insert(new_renderer(camera)),
        };
        renderer.set_level(level);
        renderer.set_look(view.look);
        if self.noon.is_none() {
            self.noon = Weather::preset(WEATHER);
        }
        let Some(weather) = view.weather.or(self.noon.as_ref()) else { return };
        let target = view.target.map(setup_of);
        let setup = FrameSetup { pose: view.pose, weather, target, others: view.others };
        rgb.copy_from_slice(&renderer.render_found(scene, &setup, &self.found).images.rgb);
    }
}

fn new_renderer(camera: Camera) -> Renderer {
    let mut renderer = Renderer::new(camera);
    renderer.set_parallel(false);
    renderer
}

fn setup_of(walker: Walker) -> TargetSetup {
    let Walker { state, height_m, radius_m, clothes_seed, gait_phase_rad, body } = walker;
    TargetSetup { state, height_m, radius_m, clothes_seed, gait_phase_rad, visible_by_rays: 1.0, body }
}
