//! Pictures whose nearest faces were found elsewhere, those of people and vehicles too: what colours are drawn from.

use crate::faces::{DrawnFace, FaceSource};
use crate::scene::Scene;
use cosfly_figures::Region;
use cosfly_frames::DVec3;
use cosfly_materials::parts::BOX_FACES;
use cosfly_raster::eye::Eye;
use cosfly_raster::visibility::{PlaneOnScreen, Screen};

/// The faces of a picture.
#[derive(Clone, Copy)]
pub struct FoundPicture<'a> {
    /// Number of the nearest one of `faces` at each pixel centre; [`cosfly_raster::visibility::NO_FACE`] for none.
    pub nearest: &'a [u32],
    /// Inverse depth at each pixel centre, 1/m, for telling who hides whom: a margin of 10^-5 of it does not matter.
    pub inverse_depth: &'a [f32],
    /// All faces that are seen.
    pub faces: &'a [FoundFace],
    /// All parts of bodies that are seen.
    pub parts: &'a [BodyPart],
}

/// A face that is seen.
#[derive(Clone, Copy, Debug)]
pub struct FoundFace {
    /// Inverse depth at the image's centre and its change per pixel to the right and down, 1/m.
    pub plane: [f64; 3],
    /// Owner of the face.
    pub of: FoundSource,
    /// Number of a vehicle's triangle in its figure; any for other faces.
    pub triangle: u32,
    /// CARLA label id.
    pub label: u8,
    /// Instance id.
    pub instance: u32,
}

/// Owner of a face: ground, a box, a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FoundSource {
    /// A face of the town, by its number in [`Scene::faces_of`].
    Town(u32),
    /// A part of a body, by its number in the picture.
    Body(u32),
}

/// A part of somebody's body.
#[derive(Clone, Copy, Debug)]
pub struct BodyPart {
    /// 0 for the target, else one more than the place among the others of the frame.
    pub who: u32,
    /// Material.
    pub region: Region,
    /// The ends of its middle line: people are round around it.
    pub middle_in_world: [DVec3; 2],
}

/// Notes faces as if they had been drawn here.
pub(crate) struct Adoption<'a> {
    pub scene: &'a Scene,
    pub eye: &'a Eye,
    pub screen: &'a Screen,
    /// First face of each part of a body.
    pub first_faces: &'a mut Vec<u32>,
}

impl Adoption<'_> {
    /// Puts all faces into an empty list.
    pub fn adopt(&mut self, picture: &FoundPicture<'_>, faces: &mut Vec<DrawnFace>) {
        self.first_faces.clear();
        self.first_faces.resize(picture.parts.len(), u32::MAX);
        for (number, face) in (0u32..).zip(picture.faces) {
            let drawn = self.drawn(number, face, picture.parts);
            faces.push(drawn);
        }
    }

    fn drawn(&mut self, number: u32, face: &FoundFace, parts: &[BodyPart]) -> DrawnFace {
        let [center, across, down] = face.plane;
        let constant = center - across * self.screen.center_u - down * self.screen.center_v;
        let plane = PlaneOnScreen { constant, across, down };
        let (source, normal) = match face.of {
            FoundSource::Town(number) => self.of_town(number),
            FoundSource::Body(part) => {
                let look = (part as usize).min(parts.len().saturating_sub(1));
                let is_cloth = parts.get(look).is_some_and(|part| part.region.is_of_people());
                let first_face = self.first_faces.get_mut(look).map_or(number, |first| {
                    *first = (*first).min(number);
                    *first
                });
                let focal_px = self.screen.focal_px;
                let in_body = DVec3::new(center, across * focal_px, -down * focal_px);
                let normal = (self.eye.world_from_body * in_body).normalize_or_zero();
                (FaceSource::Figure { look: look as u32, first_face, triangle: face.triangle, is_cloth }, normal)
            }
        };
        let normal = normal.as_vec3().to_array();
        DrawnFace { plane, normal, source, label: face.label, instance: face.instance }
    }

    /// Source and normal of a face of the town; the last one for numbers beyond it.
    fn of_town(&self, number: u32) -> (FaceSource, DVec3) {
        let scene = self.scene;
        let (index, face) = (number as usize / BOX_FACES.len(), number as usize % BOX_FACES.len());
        if let Some(b) = scene.boxes.get(index) {
            return (FaceSource::of_box(scene, index as u32, face as u8), b.normal_in_world(face));
        }
        let (cluster, polygon) = scene.ground_face(number);
        let normal = scene.clusters[cluster].polygons[polygon].normal_in_world;
        (FaceSource::Ground { cluster: cluster as u32, polygon: polygon as u16 }, normal)
    }
}
