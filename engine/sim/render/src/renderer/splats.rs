//! Splats of a scene in a frame: bodies stand among them, and their shadows fall on them.

use super::Renderer;
use crate::faces::{DrawnFace, FaceSource};
use crate::look::PictureLook;
use crate::people::Person;
use crate::scene::Scene;
use crate::scene_splats::BEFORE_BODIES_M;
use crate::setup::FrameSetup;
use cosfly_domain::SemanticLabel;
use cosfly_figures::BodyFigure;
use cosfly_frames::Pose;
use cosfly_materials::scan_light::lit_shares;
use cosfly_raster::eye::Eye;
use cosfly_raster::visibility::PlaneOnScreen;

impl Renderer {
    /// Median distance along the optical axis between the scene's splats and its geometry in the last frame, metres; none without
    /// pixels of both.
    pub fn splats_off_m(&self) -> Option<f32> {
        self.composer.median_off_m()
    }

    /// Pixels of bodies that splats hide in the last frame, and all pixels of bodies.
    pub fn hidden_by_splats(&self) -> [usize; 2] {
        [self.composer.hiding.len(), self.composer.bodies.len()]
    }

    /// How much brighter the ground of the scene's scan is than ground is drawn in the light of the last frame, stops; none of little ground.
    pub fn scan_brighter_stops(&self) -> Option<f32> {
        self.composer.ground.stops()
    }

    /// Puts the scene's splats over the shaded faces of all that is no body. Depth and ids stay those of the geometry, but where splats
    /// hide a body.
    pub(super) fn draw_splats(&mut self, scene: &Scene, setup: &FrameSetup<'_>) {
        let Some(splats) = &scene.splats else { return };
        let Self { composer, images, nearest, faces, people, runs, camera, parallel, shader, .. } = self;
        let is_of_body = |face: u32| match faces.get(face as usize).map(|face| face.source) {
            Some(FaceSource::Figure { look, .. }) => {
                is_body(&people.members[people.looks[look as usize].person as usize])
            }
            _ => false,
        };
        composer.limit_m.clear();
        composer.limit_m.extend(
            nearest
                .face
                .iter()
                .zip(&images.depth_m)
                .map(|(face, depth_m)| if is_of_body(*face) { depth_m - BEFORE_BODIES_M } else { f32::INFINITY }),
        );
        composer.bodies.clear();
        composer.bodies.extend((0..composer.limit_m.len()).filter(|pixel| composer.limit_m[*pixel].is_finite()));
        for pixel in &composer.bodies {
            composer.lit.get_mut(*pixel).into_iter().for_each(|lit| *lit = 1.0);
        }
        let through = (shader.camera_light(), shader.scan_air());
        composer.compose(splats, (camera, &setup.pose), (*parallel, through), (&mut images.rgb, &images.depth_m));
        // Edges within the geometry do not show.
        runs.join_surfaces(is_of_body);
        self.label_covered(&setup.pose);
    }

    /// Depth and ids of the pixels at which splats take more than half of a body's light: a thing without a kind, where the splats are.
    fn label_covered(&mut self, pose: &Pose) {
        let Self { composer, images, nearest, faces, .. } = self;
        let normal = (-Eye::new(pose).world_from_body.x_axis).as_vec3().to_array();
        for &(pixel, depth_m) in &composer.hiding {
            let plane = PlaneOnScreen { constant: 1.0 / f64::from(depth_m), across: 0.0, down: 0.0 };
            let label = SemanticLabel::Static.id();
            (images.depth_m[pixel], images.semantic[pixel], images.instance[pixel]) = (depth_m, label, 0);
            (nearest.face[pixel], nearest.inverse_depth[pixel]) = (faces.len() as u32, 1.0 / depth_m);
            faces.push(DrawnFace { plane, normal, source: FaceSource::Splats, label, instance: 0 });
        }
    }

    /// Light that pixels of a scan lose to bodies: the same frame is shaded without them.
    pub(super) fn measure_shadows(&mut self, scene: &Scene, setup: &FrameSetup<'_>) {
        self.composer.lit.clear();
        if self.look != PictureLook::Full || !self.people.members.iter().any(is_body) {
            return;
        }
        let mut bare = self.bare.take().unwrap_or_else(|| {
            let mut bare = self.beside();
            bare.set_optics(self.optics);
            Box::new(bare)
        });
        // A target without extent is not drawn; the town's shadows lie where they lie with it.
        let target = setup.target.map(|target| BodyFigure { height_m: 0.0, ..target });
        bare.shade_faces(scene, &FrameSetup { target, others: &[], ..*setup });
        lit_shares(&bare.images.rgb, &self.images.rgb, &mut self.composer.lit);
        self.bare = Some(bare);
    }
}

/// Whether somebody is no thing of the town.
fn is_body(person: &Person) -> bool {
    person.town_label.is_none()
}
