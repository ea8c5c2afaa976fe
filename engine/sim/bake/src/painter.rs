//! [`Painter`]: pictures of single faces from straight above, by the renderer's own shading.

use crate::patch::Patch;
use cosfly_domain::{Camera, Optics, Weather};
use cosfly_frames::Pose;
use cosfly_raster::visibility::NO_FACE;
use cosfly_render::{FoundFace, FoundPicture, FoundSource, FrameSetup, Renderer, Scene};

/// Sides of the pictures, pixels: small patches take the first.
const SIDES: [u32; 2] = [16, 64];
/// Field of view: narrow, so that all of a picture is seen from straight above.
const FOV_RAD: f64 = 0.25;

/// Paints patches of one scene.
pub struct Painter<'a> {
    scene: &'a Scene,
    weather: &'a Weather,
    renderers: [Renderer; 2],
}

impl<'a> Painter<'a> {
    pub fn new(scene: &'a Scene, weather: &'a Weather) -> Self {
        let renderers = SIDES.map(|side| {
            let mut renderer = Renderer::new(Camera { width: side, height: side, horizontal_fov_rad: FOV_RAD });
            renderer.set_optics(Optics::IDEAL);
            renderer.set_parallel(false);
            renderer
        });
        Self { scene, weather, renderers }
    }

    /// Paints the face of a number in [`Scene::faces_of`].
    pub fn paint(&mut self, face: u32, patch: &mut Patch) {
        let [width, height] = patch.size;
        let is_small = width.max(height) <= SIDES[0] as usize;
        let renderer = &mut self.renderers[usize::from(!is_small)];
        let side = renderer.camera().width as usize;
        let away_m = patch.texel_m * renderer.camera().focal_px();
        let forward = patch.attitude.world_from_body().x_axis;
        let plane = [1.0 / away_m, 0.0, 0.0];
        let seen = [FoundFace {
            plane,
            of: FoundSource::Town(face),
            triangle: 0,
            label: patch.label,
            instance: patch.instance,
        }];
        let (mut nearest, mut inverse_depth) = (vec![NO_FACE; side * side], vec![0.0; side * side]);
        patch.rgb = vec![[0; 3]; width * height];
        for top in (0..height).step_by(side) {
            for left in (0..width).step_by(side) {
                let [columns, rows] = [side.min(width - left), side.min(height - top)];
                nearest.fill(NO_FACE);
                inverse_depth.fill(0.0);
                for row in 0..rows {
                    nearest[row * side..row * side + columns].fill(0);
                    inverse_depth[row * side..row * side + columns].fill((1.0 / away_m) as f32);
                }
                let middle = patch.in_world([left, top].map(|at| (at + side / 2) as f64));
                let pose = Pose { position_in_world: middle - away_m * forward, ..patch.attitude };
                let setup = FrameSetup { pose, weather: self.weather, target: None, others: &[] };
                let picture =
                    FoundPicture { nearest: &nearest, inverse_depth: &inverse_depth, faces: &seen, parts: &[] };
                let rgb = renderer.colours_of(self.scene, &setup, &picture).as_chunks::<3>().0;
                for row in 0..rows {
                    let at = (top + row) * width + left;
                    patch.rgb[at..at + columns].copy_from_slice(&rgb[row * side..row * side + columns]);
                }
            }
        }
    }
}
