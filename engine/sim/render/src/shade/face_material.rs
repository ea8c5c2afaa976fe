//! Materials, colours and axes of the faces that a frame shows.

use super::coach::Coach;
use super::geometry::FaceAxes;
use super::material::{FLAT, Material, UNDER_A_SCAN, box_axes, box_material};
use super::setting::{Seen, Setting};
use super::skin::Painted;
use crate::faces::FaceSource;
use cosfly_materials::vector::Vec3;

/// Material of a drawn face, and the axes along its surface.
pub(super) fn material_of(setting: &Setting, seen: &Seen<'_>, face: u32) -> (Material, FaceAxes) {
    let flat = FLAT;
    let Some(face) = seen.faces.get(face as usize) else { return (Material::Sky, flat) };
    match face.source {
        FaceSource::Ground { cluster, polygon } => {
            let polygon = seen.scene.clusters[cluster as usize].polygons[usize::from(polygon)];
            (Material::Ground(polygon.label), flat)
        }
        FaceSource::Prop { triangle } => {
            let props = &seen.scene.props;
            (Material::Skin(Painted::new(&props.triangles[triangle as usize].skin, &props.textures)), flat)
        }
        FaceSource::Mesh { .. } if seen.scene.lit_mesh().is_some() => (Material::Scan, flat),
        FaceSource::Mesh { .. } | FaceSource::Splats => (Material::Ground(UNDER_A_SCAN), flat),
        FaceSource::Figure { is_cloth: true, .. } => (Material::Cloth, flat),
        FaceSource::Figure { look, .. } => {
            let look = &seen.people.looks[look as usize];
            let person = seen.people.members.get(look.person as usize);
            let Some(person) = person else { return (Material::Sky, flat) };
            let [red, green, blue] = person.colours[look.region as usize];
            let sheet = (look.region, Vec3::new(red, green, blue));
            let place = (person.figure.state.feet_in_world, person.side_in_world);
            let night = if person.figure.is_parked() { 0.0 } else { setting.light.night };
            let coach = Coach::new(sheet, &person.fittings, place, night, &setting.view);
            (Material::Coach(coach), flat)
        }
        FaceSource::Box { index, face } | FaceSource::Crown { index, face } => {
            let (b, face) = (&seen.scene.boxes[index as usize], usize::from(face));
            (box_material(b, face, setting.light.night), box_axes(b, face))
        }
    }
}

/// The colour of a figure's face or of a thing or roof, in the simple look.
pub(super) fn even_colour(seen: &Seen<'_>, face: u32) -> Vec3 {
    match seen.faces.get(face as usize).map(|face| face.source) {
        Some(FaceSource::Figure { look, .. }) => {
            let look = &seen.people.looks[look as usize];
            let person = seen.people.members.get(look.person as usize);
            let [red, green, blue] = person.map_or([0.0; 3], |person| person.colours[look.region as usize]);
            Vec3::new(red, green, blue)
        }
        Some(FaceSource::Box { index, .. } | FaceSource::Crown { index, .. }) => seen.scene.colours[index as usize],
        _ => Vec3::ZERO,
    }
}

/// The axes along a box's face; any for other faces.
pub(super) fn axes_of(seen: &Seen<'_>, face: u32) -> FaceAxes {
    match seen.faces.get(face as usize).map(|face| face.source) {
        Some(FaceSource::Box { index, face } | FaceSource::Crown { index, face }) => {
            box_axes(&seen.scene.boxes[index as usize], usize::from(face))
        }
        _ => FLAT,
    }
}
