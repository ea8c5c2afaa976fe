//! [`bake`]: pictures of all faces of a town.

use crate::painter::Painter;
use crate::patch::Patch;
use cosfly_domain::{ObstacleKind, OrientedBox, Town, Weather};
use cosfly_figures::{Clothes, FigureInPicture, FigureTriangle, Livery, add_figure};
use cosfly_frames::{DVec3, Seed, real};
use cosfly_geometry::BoxBvh;
use cosfly_materials::light::Light;
use cosfly_materials::parts::BOX_FACES;
use cosfly_render::Scene;
use cosfly_render::outside::SceneFace;
use cosfly_town::GroundIndex;
use rayon::prelude::*;
use std::collections::BTreeSet;

/// Most pixels of all pictures: memory, and what readers of meshes take.
pub const MOST_TEXELS: usize = 60_000_000;
/// Undersides of boxes that lie no higher above the ground are not seen, metres.
const ON_GROUND_M: f64 = 0.05;
/// Light of a car's side that the sun does not reach, as a share.
const SHADE: f64 = 0.4;

/// A town whose faces have pictures.
pub struct BakedTown {
    pub(crate) patches: Vec<Patch>,
    pub(crate) boxes: BoxBvh,
    /// Offset that the town's reader took off its map's points, world axes, metres.
    pub(crate) origin_m: DVec3,
}

/// A town that is too large for its pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BakeProblem {
    /// Pixels that it needs.
    pub texels: usize,
}

/// Pictures of all faces of a town in the light of a weather, with pixels of `texel_m`; `seed` draws its looks, as for [`Scene::new`].
///
/// # Errors
/// More pixels than [`MOST_TEXELS`].
pub fn bake(town: &Town, seed: Seed, weather: &Weather, texel_m: f64) -> Result<BakedTown, BakeProblem> {
    let filmed = Scene::new(town, seed);
    let cars: BTreeSet<u32> = filmed.parked().iter().map(|car| car.instance).collect();
    let ground = GroundIndex::new(town);
    let faces = Scene::faces_of(town);
    let is_seen = |face: &SceneFace| {
        let is_low = |corner: &DVec3| {
            ground.ground_height_m(corner.x, corner.y).is_some_and(|height_m| corner.z <= height_m + ON_GROUND_M)
        };
        let is_underside = face.outward_in_world.is_some() && face.normal_in_world.z < -0.9;
        !(cars.contains(&face.instance) || is_underside && face.corners_in_world.iter().all(is_low))
    };
    let patch = |(number, face): (u32, &SceneFace)| {
        let patch = Patch::new(face.corners_in_world.clone(), face.normal_in_world, texel_m)?;
        Some((number, Patch { label: face.label, instance: face.instance, lift: face.lift, ..patch }))
    };
    let mut patches: Vec<(u32, Patch)> =
        (0..).zip(&faces).filter(|(_, face)| is_seen(face)).filter_map(patch).collect();
    let texels = patches.iter().map(|(_, patch)| patch.size[0] * patch.size[1]).sum();
    if texels > MOST_TEXELS {
        return Err(BakeProblem { texels });
    }
    let scene = Scene::of_boxes(town, seed);
    patches
        .par_iter_mut()
        .for_each_init(|| Painter::new(&scene, weather), |painter, (number, patch)| painter.paint(*number, patch));
    let mut patches: Vec<Patch> = patches.into_iter().map(|(_, patch)| patch).collect();
    let to_sun = Light::new(weather).to_sun;
    let to_sun = DVec3::new(to_sun.x.into(), to_sun.y.into(), to_sun.z.into());
    patches.extend(filmed.parked().iter().flat_map(|car| of_car(car, to_sun, texel_m)));
    Ok(BakedTown { patches, boxes: opaque(&faces, &cars), origin_m: town.origin.offset_m })
}

impl BakedTown {
    /// Number of triangles.
    pub fn triangles(&self) -> usize {
        self.patches.iter().map(|patch| patch.corners_in_world.len() - 2).sum()
    }
}

/// Boxes in which nothing is seen: those of cars hold vehicles, those of pitched roofs reach over their slopes, and those of slanted
/// walls over these.
fn opaque(faces: &[SceneFace], cars: &BTreeSet<u32>) -> BoxBvh {
    let is_whole = |faces: &&[SceneFace]| {
        let is_box = faces[0].outward_in_world.is_some() && !cars.contains(&faces[0].instance);
        let is_opposite = |a: usize| faces[a].normal_in_world.dot(faces[a + 1].normal_in_world) < -1.0 + 1e-9;
        is_box && faces[..4].iter().all(|face| face.normal_in_world.z == 0.0) && is_opposite(0) && is_opposite(2)
    };
    let shape = |faces: &[SceneFace]| {
        let (low, high) = (&faces[4].corners_in_world, &faces[5].corners_in_world);
        let [x, y, z] = [low[1] - low[0], low[2] - low[1], high[0] - low[0]].map(DVec3::length);
        OrientedBox {
            center_in_world: 0.5 * (low[0] + low[2].with_z(high[2].z)),
            half_extents_m: 0.5 * DVec3::new(x, y, z),
            yaw_rad: real::atan2(faces[1].normal_in_world.y, faces[1].normal_in_world.x),
        }
    };
    let boxes = faces.partition_point(|face| face.outward_in_world.is_some());
    BoxBvh::build(faces[..boxes].chunks_exact(BOX_FACES.len()).filter(is_whole).map(shape).collect())
}

/// The patches of a parked car: one a triangle, of one colour.
fn of_car(car: &FigureInPicture, to_sun: DVec3, texel_m: f64) -> Vec<Patch> {
    let mut triangles = vec![];
    add_figure(&car.figure, &Clothes::draw(&car.figure.clothes_seed), 0, &mut triangles);
    let colours = Livery::draw(&car.figure.body, &car.figure.clothes_seed).colours(&car.figure.body);
    let patch = |triangle: &FigureTriangle| {
        let normal = triangle.normal_in_world;
        let mut patch = Patch::new(triangle.corners_in_world.to_vec(), normal, texel_m)?;
        let light = SHADE + (1.0 - SHADE) * normal.dot(to_sun).max(0.0);
        let byte = |colour: f32| (255.0 * real::powf(light * f64::from(colour), 1.0 / 2.2)) as u8;
        patch.rgb = vec![colours[triangle.region as usize].map(byte); patch.size[0] * patch.size[1]];
        Some(Patch { label: ObstacleKind::Car.label().id(), instance: car.instance, ..patch })
    };
    triangles.iter().filter_map(patch).collect()
}
