//! The town of a cloud.

use super::classify::{self, Unknown};
use super::options::CloudOptions;
use super::points::{Cloud, class};
use super::sorting::Sorted;
use super::survey::{self, Survey};
use super::{buildings, ground, things, trees};
use crate::open_ground::open_ground;
use cosfly_diagnose::counted;
use cosfly_domain::{ObstacleKind, SemanticLabel, Synthetic, Town};
use cosfly_frames::DVec2;
use cosfly_town::MapError;
use cosfly_town::mesh::MeshBuilder;
use cosfly_town::terrain::{USUAL_MARGIN_M, add_terrain};

/// Note of a cloud that is higher than wide: phones and trainers of splats write files whose y axis points up.
fn upended(cloud: &Cloud) -> Option<String> {
    let heights_m = || (0..cloud.len()).map(|point| cloud.point(point).z);
    let height_m = heights_m().fold(f64::NEG_INFINITY, f64::max) - heights_m().fold(f64::INFINITY, f64::min);
    let width_m = (cloud.bounds[1] - cloud.bounds[0]).min_element();
    (height_m > width_m).then(|| {
        format!(
            "the cloud is {height_m:.0} m high and {width_m:.0} m wide: check `options.up_axis`, the axis of the \
             file that points up"
        )
    })
}

/// The town of a cloud, and what the user should know.
///
/// # Errors
/// Points that leave no ground to walk on.
pub fn town_of(mut cloud: Cloud, options: &CloudOptions) -> Result<(Town, Vec<String>), MapError> {
    let mut warnings = std::mem::take(&mut cloud.warnings);
    let mut notes = Vec::new();
    warnings.extend(upended(&cloud));
    let spacing_m = survey::spacing_m(&cloud);
    let voxel_m = survey::voxel_m(&cloud, spacing_m, options.voxel_m, &mut warnings);
    let grid = survey::grid_of(&cloud, voxel_m);
    let sorted = Sorted::new(&mut cloud, grid);
    let is_classified = ground::is_classified(&cloud);
    if !is_classified {
        notes.push(ground::estimate(&mut cloud, &sorted));
    }
    warnings.extend(survey::unevenness(&cloud, &sorted, is_classified));
    let relief = ground::relief(&cloud, &sorted);
    let unknown = Unknown::of(&cloud);
    if let Some(unknown) = unknown {
        notes.push(classify::estimate(&mut cloud, &sorted, &relief, unknown));
    }
    let mut survey = Survey::new(&cloud, relief, sorted, spacing_m, options.step_m);
    survey.tells_plants = !matches!(unknown, Some(Unknown::Both | Unknown::Plants));
    let mut obstacles = Vec::new();
    let houses = buildings::add(&survey, &mut obstacles);
    trees::add(&survey, &mut obstacles);
    let volumes = houses.plus(things::add(&survey, &mut obstacles), 1.0);
    if volumes.solid > 0.0 {
        let [gained, lost] = [volumes.gained, volumes.lost].map(|volume| 100.0 * volume / volumes.solid);
        notes.push(format!(
            "boxes of buildings and things hold {:.0} m3 of cells of {voxel_m:.2} m: {gained:.1} % more is filled, {lost:.1} % \
             (at feet on slopes) is lost",
            volumes.solid
        ));
    }
    let walkable = open_ground(&obstacles, &survey.relief);
    if walkable.is_empty() {
        let error = MapError::new("the cloud leaves no open ground to walk on");
        return Err(
            error.hint("the cloud must show ground; check `options.unit_m`, or give a smaller `options.voxel_m`")
        );
    }
    notes.push(format!(
        "{} plazas on the open ground are invented: a cloud does not say where people walk",
        walkable.len()
    ));
    let trunks = obstacles.iter().filter(|one| one.kind == ObstacleKind::TreeTrunk).count();
    if trunks > 0 {
        notes.push(format!("{} invented under the crowns of the cloud", counted(trunks, "trunk")));
    }
    let masts = obstacles.iter().filter(|one| one.kind == ObstacleKind::Pole && one.synthetic).count();
    if masts > 0 {
        notes.push(format!("{} invented under things that hang in the air", counted(masts, "mast")));
    }
    let mut meshes = MeshBuilder::default();
    survey.relief.add_mesh(&mut meshes, |at| label(&survey, at));
    warnings.extend(add_terrain(&mut meshes, &obstacles, USUAL_MARGIN_M)?);
    let town = Town {
        name: "town".to_owned(),
        origin: cloud.world.origin(cloud.geo_reference.clone()),
        obstacles,
        walkable,
        surfaces: meshes.finish(),
        synthetic: Synthetic { notes, ..Synthetic::default() },
        ..Town::default()
    };
    Ok((town, warnings))
}

/// Label of the ground at a place: that of the nearest ground points, where they have a class of their own.
fn label(survey: &Survey<'_>, at: DVec2) -> SemanticLabel {
    let cell = survey.grid.cell_of(at);
    let mut counts = [0_usize; 3];
    for point in survey.grid.around_cell(cell, 1).flat_map(|cell| survey.points_of(cell)) {
        match survey.cloud.classes[point] {
            class::GROUND => counts[0] += 1,
            class::WATER => counts[1] += 1,
            class::ROAD => counts[2] += 1,
            _ => {}
        }
    }
    match counts {
        [ground, water, road] if water > ground.max(road) => SemanticLabel::Water,
        [ground, _, road] if road > ground => SemanticLabel::Roads,
        _ => SemanticLabel::Terrain,
    }
}
