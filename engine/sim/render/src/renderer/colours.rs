//! Colours alone, of a picture whose faces were found elsewhere.

use super::Renderer;
use crate::found::{Adoption, FoundPicture};
use crate::look::PictureLook;
use crate::scene::Scene;
use crate::setup::FrameSetup;
use cosfly_materials::far_light::FarLight;
use cosfly_raster::eye::Eye;

impl Renderer {
    /// The colours of a frame whose faces were found elsewhere: sRGB, 3 bytes a pixel, those that [`Self::render`] draws. Nothing
    /// else of the frame is drawn or measured.
    ///
    /// # Panics
    /// Where the picture does not have the camera's pixels.
    pub fn colours_of(&mut self, scene: &Scene, setup: &FrameSetup<'_>, picture: &FoundPicture<'_>) -> &[u8] {
        let eye = Eye::new(&setup.pose);
        self.faces.clear();
        let Self { screen, faces, first_faces, .. } = self;
        Adoption { scene, eye: &eye, screen, first_faces }.adopt(picture, faces);
        self.nearest.adopt_all(picture.nearest, picture.inverse_depth);
        let is_full = self.look == PictureLook::Full;
        if is_full {
            self.nearer.measure(&self.nearest);
        }
        let drawn = is_full.then_some(&self.nearer);
        self.people.adopt(setup, (&eye, &self.screen), FarLight::of(setup.weather), picture.parts, drawn);
        self.shader.prepare(scene, setup, &eye, &self.people, &self.nearest);
        self.fill_channels(scene, true);
        if is_full {
            self.smooth_edges(scene);
            self.finish_colours();
        }
        &self.images.rgb
    }
}
