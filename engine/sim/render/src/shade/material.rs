//! Materials of drawn faces.

use super::coach::Coach;
use super::geometry::FaceAxes;
use super::lighting::Answers;
use super::skin::Painted;
use cosfly_domain::{ObstacleKind, SemanticLabel};
use cosfly_materials::building_form::BuildingForm;
use cosfly_materials::facade::{BoxFace, Facade, Roof, Tiles};
use cosfly_materials::lanes::PendingFours;
use cosfly_materials::light::Light;
use cosfly_materials::parts::{BOX_FACES, SceneBox};
use cosfly_materials::roof_step::FaceLook;
use cosfly_materials::slanted_wall::SlantedWall;
use cosfly_materials::thing_form::ThingForm;
use cosfly_materials::things::BoxThing;
use cosfly_materials::vector::Vec3;

/// Material of the pixels of a group.
pub(super) enum Material {
    Sky,
    Ground(SemanticLabel),
    /// A mesh that the weather lights: what it reflects is known at each pixel.
    Scan,
    Facade(Facade, BoxFace),
    Roof(Roof),
    Tiles(Tiles),
    Thing(BoxThing),
    /// See [`super::cloth::Cloths`].
    Cloth,
    /// Even surfaces of the simple look, of many colours: see [`super::face_material::even_colour`].
    Even,
    /// See [`super::leaves::Crowns`].
    Leaves,
    Coach(Coach),
    Skin(Painted),
}

/// Ground that a mesh is shaded as: its own colours come over it, darker where bodies darken that ground.
pub(super) const UNDER_A_SCAN: SemanticLabel = SemanticLabel::Ground;

/// The axes of flat ground.
pub(super) const FLAT: FaceAxes = FaceAxes { along: Vec3::new(1.0, 0.0, 0.0), up: Vec3::new(0.0, 1.0, 0.0) };

/// The colour of a box's faces in the simple look; of a building's, that of its roof.
pub(crate) fn colour_of(b: &SceneBox) -> Vec3 {
    let tiles = |face| match box_material(b, face, 0.0) {
        Material::Tiles(slope) => Some(slope.colour()),
        _ => None,
    };
    if let Some(colour) = b.roof.iter().flat_map(|_| 0..BOX_FACES.len()).find_map(tiles) {
        return colour;
    }
    match box_material(b, ROOF, 0.0) {
        Material::Thing(thing) => thing.colour(),
        Material::Roof(roof) => roof.colour(),
        _ => Vec3::ZERO,
    }
}

/// The upper face of a box among [`BOX_FACES`].
const ROOF: usize = 5;

/// The axes along a face of a box.
pub(super) fn box_axes(b: &SceneBox, face: usize) -> FaceAxes {
    let axis = BOX_FACES[face].0;
    let axes = b.axes_in_world.map(Vec3::from);
    let up = if axis == 2 { axes[1] } else { Vec3::new(0.0, 0.0, 1.0) };
    let is_piece = axis != 2 && b.roof.as_deref().is_some_and(|roof| roof.top.is_some_and(|top| top.falls.is_some()));
    if axis != 2
        && let Some(wall) = b.slanted(face)
    {
        return FaceAxes { along: wall.along, up };
    }
    // Pieces of roofs have sides of their own.
    let out: Vec3 = b.normal_in_world(face).into();
    let along = if is_piece { Vec3::new(-out.y, out.x, 0.0) } else { axes[usize::from(axis == 0)] };
    FaceAxes { along, up }
}

/// Material of a face of a box.
pub(super) fn box_material(b: &SceneBox, face: usize, night: f32) -> Material {
    let axis = BOX_FACES[face].0;
    let center: Vec3 = b.center_in_world.into();
    let axes = b.axes_in_world.map(Vec3::from);
    let half = Vec3::new(b.half_extents_m.x, b.half_extents_m.y, b.half_extents_m.z);
    let along = axes[usize::from(axis == 0)];
    if b.kind != ObstacleKind::Building {
        match b.kind {
            ObstacleKind::TreeCrown | ObstacleKind::Bush => Material::Leaves,
            _ => Material::Thing(BoxThing::of(b, axis, night)),
        }
    } else if let Some(material) = roof_material(b, face, (center, axes)) {
        material
    } else if axis == 2 {
        let roof = Roof::new(b.seed, center, axes, [half.x, half.y], b.roof_goes_on);
        Material::Roof(if b.form == BuildingForm::Tank { roof.of_sheet() } else { roof })
    } else if let Some(SlantedWall { along, edge_m, half_width_m }) = b.slanted(face) {
        Material::Facade(Facade::of_box(b, face, half_width_m), BoxFace { along, edge_m, foot_m: center.z - half.z })
    } else {
        let half_width = if axis == 0 { half.y } else { half.x };
        let look = Facade::of_box(b, face, half_width);
        let edge_m = center.dot(Vec3::new(along.x, along.y, 0.0)) - half_width;
        Material::Facade(look, BoxFace { along, edge_m, foot_m: center.z - half.z })
    }
}

/// Material of a face of a pitched roof; none for other faces.
fn roof_material(b: &SceneBox, face: usize, (center, axes): (Vec3, [Vec3; 2])) -> Option<Material> {
    let step = b.roof.as_deref()?;
    let (axis, sign, _) = BOX_FACES[face];
    if axis == 2 {
        let slope = step.top.filter(|_| sign > 0.0)?;
        let tiles = Tiles::top(b.seed, b.town, center, axes, &slope);
        // Windows have their places on whole slopes.
        let is_piece = slope.falls.is_some();
        return Some(Material::Tiles(if is_piece { tiles } else { tiles.of_roof(b, step.wall_m) }));
    }
    match step.sides[face] {
        FaceLook::Wall => None,
        FaceLook::Slope(_) if step.top.is_some_and(|top| top.falls.is_some()) => {
            step.top.map(|slope| Material::Tiles(Tiles::top(b.seed, b.town, center, axes, &slope)))
        }
        FaceLook::Slope(pitch) => {
            let tiles = Tiles::side(b.seed, b.town, axes[axis] * sign as f32, pitch);
            Some(Material::Tiles(tiles.of_roof(b, step.wall_m)))
        }
        FaceLook::Gable => {
            let half_width = if axis == 0 { b.half_extents_m.y } else { b.half_extents_m.x };
            let [foot_m, height_m] = step.wall_m.map(|value| value as f32);
            let look =
                Facade::new(b.seed, b.town, face as u32, [2.0 * half_width, height_m], (b.form, 2.0 * b.whole[1].z))
                    .bare();
            let along = box_axes(b, face).along;
            let edge_m = center.dot(along) - half_width;
            Some(Material::Facade(look, BoxFace { along, edge_m, foot_m }))
        }
    }
}

impl Material {
    /// Whether the material has normals of its own.
    pub(super) fn is_bent(&self) -> bool {
        matches!(self, Self::Leaves | Self::Cloth | Self::Tiles(_))
    }

    /// Whether the sun shines on the back of a flat face: no shadow matters there. Faces of boxes show their outside.
    pub(super) fn faces_away(&self, stage: &PendingFours, light: &Light) -> bool {
        let is_flat = matches!(self, Self::Facade(..) | Self::Roof(_) | Self::Thing(_));
        let [x, y, z] = stage.normal.each_ref().map(|row| row[0]);
        is_flat && Vec3::new(x, y, z).dot(light.to_sun) <= 0.0
    }

    /// How the material reflects and glows.
    pub(super) fn answers(&self) -> Answers {
        let matt = Answers { wettable: false, shiny: false, glows: false };
        match self {
            // Rain soaks into grass: no puddles there.
            Self::Ground(label) => {
                let shiny = *label == SemanticLabel::Water;
                Answers { wettable: *label != SemanticLabel::Terrain, shiny, glows: false }
            }
            Self::Facade(..) => Answers { wettable: false, shiny: true, glows: true },
            Self::Roof(_) => Answers { wettable: true, shiny: false, glows: false },
            Self::Coach(_) => Answers { wettable: false, shiny: true, glows: true },
            Self::Thing(thing) if thing.form != ThingForm::Plain => {
                Answers { wettable: false, shiny: thing.form.is_shiny(), glows: thing.form == ThingForm::Cabin }
            }
            Self::Thing(thing) => match thing.kind {
                ObstacleKind::Car | ObstacleKind::Lamp | ObstacleKind::TrafficLight | ObstacleKind::Pole => {
                    Answers { wettable: false, shiny: true, glows: true }
                }
                _ => matt,
            },
            Self::Scan | Self::Sky | Self::Even | Self::Cloth | Self::Leaves | Self::Skin(_) | Self::Tiles(_) => matt,
        }
    }
}
