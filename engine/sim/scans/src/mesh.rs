//! From triangles with names to a town: ground as surfaces, everything else as boxes.
//!
//! [`parts`] holds the triangles, [`names`] tells things by their names, [`solid`] covers them with boxes, [`ground`]
//! makes the relief, the surfaces and the walkable ground, [`one_surface`] finds it in a scan without names; [`slabs`] and [`uncovered`]
//! tell tops from undersides, [`whole`] which pieces are one thing.

pub mod ground;
mod level;
pub mod names;
pub mod one_surface;
pub mod options;
pub mod parts;
pub mod plan_index;
pub mod slabs;
pub mod solid;
pub mod uncovered;
pub mod whole;

pub use options::MeshOptions;
pub use parts::{Part, PartBuilder};

use crate::open_ground::open_ground;
use cosfly_diagnose::counted;
use cosfly_domain::{Obstacle, Synthetic, Town};
use cosfly_town::MapError;
use cosfly_town::mesh::MeshBuilder;
use cosfly_town::terrain::{USUAL_MARGIN_M, add_terrain};
use cosfly_town::world::WorldFromMap;
use names::{Kind, Thing};
use options::IN_A_PLAN;

/// Side of the cells in which shapes become boxes, metres.
const USUAL_VOXEL_M: f64 = 0.5;
/// Widest scene, metres.
const WIDEST_M: f64 = 20_000.0;
/// Largest height, metres.
const HIGHEST_M: f64 = 1e5;
/// Most boxes of a scene.
const MOST_BOXES: usize = 500_000;

/// The town of parts in the map frame (right-handed, z up, metres), and what the user should know.
///
/// # Errors
/// No triangles, a scene that is too wide, or more boxes than a town may have.
pub fn town_of(
    mut parts: Vec<Part>,
    options: &MeshOptions,
    mut warnings: Vec<String>,
) -> Result<(Town, Vec<String>), MapError> {
    parts.retain(|part| !part.triangles.is_empty());
    if parts.is_empty() {
        return Err(MapError::new("the file has no triangles").hint("export meshes, not curves or points"));
    }
    let world = WorldFromMap::around(parts.iter().flat_map(|part| &part.vertices).map(|vertex| vertex.truncate()));
    for vertex in parts.iter_mut().flat_map(|part| &mut part.vertices) {
        *vertex = world.point(*vertex);
    }
    let (low, high) = parts::bounds(parts.iter().flat_map(|part| &part.vertices));
    if (high - low).max_element() > WIDEST_M {
        let error = MapError::new(format!(
            "the scene is {:.0} m across; at most {WIDEST_M} m are read",
            (high - low).max_element()
        ));
        return Err(error.hint(
            "give the length of the file's unit with `options.unit_m`: 0.01 for centimetres; else export a part of the scene",
        ));
    }
    if low.z.abs().max(high.z.abs()) > HIGHEST_M {
        let error = MapError::new(format!(
            "the scene lies {:.0} km above its origin: its coordinates seem to count from the centre of the Earth",
            1e-3 * high.z
        ));
        return Err(error.hint(IN_A_PLAN));
    }
    let size = high - low;
    if size.z > size.truncate().min_element() {
        let narrow_m = size.truncate().min_element();
        warnings.push(format!(
            "the scene is {:.0} m high and {narrow_m:.0} m wide: check `options.up_axis`, the axis of the file that points up",
            size.z
        ));
    }
    let mut notes = Vec::new();
    if options.one_surface {
        parts = one_surface::apart(parts, names::is_telling);
        notes.push("the ground is told from what stands on it by shape: `options.one_surface`".to_owned());
    }
    let mut things = names::things(parts, &mut notes);
    let ground = things.iter_mut().filter(|thing| thing.kind.is_ground());
    let mut work = slabs::MOST_WORK;
    ground.flat_map(|thing| &mut thing.parts).for_each(|part| slabs::drop_undersides(part, &mut work));
    let mut meshes = MeshBuilder::default();
    let obstacles = solids_and_surfaces(&things, options, &mut meshes, [&mut warnings, &mut notes])?;
    let relief = ground::relief(&things, low, high, &mut notes);
    let mut walkable = ground::walkable(&things, &mut notes);
    if walkable.is_empty() {
        walkable = open_ground(&obstacles, &relief);
        notes
            .push(format!("{} plazas on the open ground are invented: nothing is named as a pavement", walkable.len()));
    }
    if walkable.is_empty() {
        let error = MapError::new("the scene leaves no open ground to walk on");
        let error = error.hint("name the meshes to walk on `sidewalk`; check `options.up_axis` and `options.unit_m`");
        return Err(error.hint("for a scan that is one surface, set `options.one_surface = true`"));
    }
    warnings.extend(add_terrain(&mut meshes, &obstacles, USUAL_MARGIN_M)?);
    let town = Town {
        name: "town".to_owned(),
        origin: world.origin(None),
        obstacles,
        walkable,
        surfaces: meshes.finish(),
        synthetic: Synthetic { notes, ..Synthetic::default() },
        ..Town::default()
    };
    Ok((town, warnings))
}

/// Boxes of solid things; ground goes to the meshes.
fn solids_and_surfaces(
    things: &[Thing],
    options: &MeshOptions,
    meshes: &mut MeshBuilder,
    [warnings, notes]: [&mut Vec<String>; 2],
) -> Result<Vec<Obstacle>, MapError> {
    let mut obstacles = Vec::new();
    let mut cells = solid::CellBudget::new(options.voxel_m.unwrap_or(USUAL_VOXEL_M));
    let mut unnamed = 0;
    for (object, thing) in things.iter().enumerate() {
        match thing.kind {
            Kind::Ground(label, _) => thing.parts.iter().for_each(|part| ground::add_surface(meshes, label, part)),
            Kind::Solid { kind, is_named } => {
                let shapes = thing.parts.iter().flat_map(|part| cells.boxes(part));
                let obstacle = |shape| Obstacle { shape, kind, object_id: object as u32 + 1, synthetic: false };
                obstacles.extend(shapes.map(obstacle));
                unnamed += usize::from(!is_named);
                if obstacles.len() > MOST_BOXES {
                    let error = MapError::new(format!("the meshes need more than {MOST_BOXES} boxes"));
                    return Err(error.hint("give a larger `options.voxel_m`, or cut the scene into pieces"));
                }
            }
        }
    }
    warnings.extend(cells.warning());
    if unnamed > 0 {
        notes.push(format!("{} told by size: the file gives no name that says more", counted(unnamed, "thing")));
    }
    Ok(obstacles)
}
