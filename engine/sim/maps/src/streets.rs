//! [`invent_streets`]: streets between the rows of houses of a town whose file has houses alone.
//!
//! [`clearance`] measures the open ground, [`middles`] finds the lines that run around all blocks of houses, [`layout`] makes
//! a plan of streets of them. Drawn as a generated place is, they lie on the ground by [`drape`].

mod clearance;
mod drape;
mod layout;
mod middles;

use crate::formats::opendrive::{OpenDrive, OpenDriveOptions};
use clearance::Clearance;
use cosfly_domain::{ObstacleKind, SemanticLabel, Town, WalkableKind};
use cosfly_frames::DVec2;
use cosfly_town::{MapError, MapFormat};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Side of the cells in which the ground is measured, metres, and most of them.
const CELL_M: f64 = 1.0;
const MOST_CELLS: f64 = 6e6;
/// Ground that is looked at around the houses, metres.
const MARGIN_M: f64 = 30.0;
/// Longest piece of a street that lies straight on the ground, metres.
const PIECE_M: f64 = 4.0;

/// Streets of a town.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Streets {
    /// Those of the file, if any.
    File,
    /// Invented between the rows of houses, where no file has any.
    Invented,
}

/// Whether a town has houses, and neither carriageways, lanes nor pavements.
pub(crate) fn has_houses_alone(town: &Town) -> bool {
    let is_street = |label| matches!(label, SemanticLabel::Roads | SemanticLabel::SideWalks);
    let has_streets = town.surfaces.iter().any(|mesh| is_street(mesh.label) && !mesh.triangles.is_empty());
    town.obstacles.iter().any(|one| one.kind == ObstacleKind::Building)
        && town.lanes.is_empty()
        && !has_streets
        && town.walkable.iter().all(|polygon| polygon.kind == WalkableKind::Plaza)
}

/// Lays streets between the houses of a town without streets, and notes them.
///
/// # Errors
/// Why there are none, for a warning.
pub(crate) fn invent_streets(town: &mut Town) -> Result<(), String> {
    if !has_houses_alone(town) {
        return Err("no streets are invented: the town has streets or pavements, or no houses".to_owned());
    }
    let houses = town.obstacles.iter().filter(|one| one.kind == ObstacleKind::Building);
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for house in houses {
        let (from, to) = house.shape.bounds_in_world();
        (low, high) = (low.min(from.truncate()), high.max(to.truncate()));
    }
    let (low, high) = (low - MARGIN_M, high + MARGIN_M);
    if !low.is_finite() || !high.is_finite() || (high - low).element_product() > MOST_CELLS * CELL_M * CELL_M {
        return Err(format!(
            "no streets are invented: the houses spread over more than {:.0} square kilometres; `bounds_m` keeps a part",
            1e-6 * MOST_CELLS * CELL_M * CELL_M
        ));
    }
    let ground = Clearance::of(town, low, high, CELL_M);
    let (points, middles) = middles::middles(&ground);
    let plan = layout::layout(&ground, points, middles);
    if plan.links.is_empty() {
        return Err("no streets are invented: no ground of 8 to 30 m lies between rows of houses".to_owned());
    }
    let text = cosfly_places::streets::open_drive(&plan, "invented streets");
    let options = OpenDriveOptions { sample_step_m: PIECE_M, ..OpenDriveOptions::default() };
    let (streets, _) = OpenDrive::read(text.as_bytes(), &options)
        .map_err(|MapError { message, .. }| format!("no streets are invented: {message}"))?;
    let length_m: f64 = plan.links.iter().map(|link| layout::length_m(&plan.points(link))).sum();
    drape::drape(town, streets);
    town.synthetic.notes.push(format!(
        "{} streets of {:.1} km in all, with carriageways and pavements, are invented between the rows of houses \
         (`streets = \"invented\"`): the file has no street",
        plan.links.len(),
        1e-3 * length_m
    ));
    Ok(())
}
