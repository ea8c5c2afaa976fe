//! Options of the stage `map` that bring something which a town lacks.

use crate::MapConfig;
use crate::bounds::PlanRectangle;
use cosfly_domain::{ObstacleKind, SemanticLabel, Town, WalkableKind};
use cosfly_frames::DVec2;
use cosfly_geodata::reference::GeoReference;
use std::collections::BTreeMap;

/// Largest extent of ground that people walk in, square metres.
pub const WIDEST_WALKS_M2: f64 = 4e8;
/// Side of the part that is proposed of a wider town, metres.
const PART_M: f64 = 4_000.0;

/// Advice about a town that was read with `config`, a sentence each; each names the option that helps.
pub fn advice(town: &Town, config: &MapConfig) -> Vec<String> {
    let has_houses = town.obstacles.iter().any(|one| one.kind == ObstacleKind::Building);
    let is_street = |label| label == SemanticLabel::Roads;
    let mut seen = town.surfaces.iter().filter(|mesh| !mesh.synthetic && !mesh.triangles.is_empty());
    let are_invented = town.surfaces.iter().any(|mesh| mesh.synthetic && is_street(mesh.label))
        && !town.surfaces.iter().any(|mesh| !mesh.synthetic && is_street(mesh.label));
    let has_streets = seen.any(|mesh| is_street(mesh.label)) || !town.lanes.is_empty() && !are_invented;
    let has_pavements = town.walkable.iter().any(|polygon| polygon.kind == WalkableKind::Sidewalk && !are_invented);
    let is_placed = town.origin.geo_reference.is_some() && why_not_compared(town).is_none();
    let place = if is_placed { "" } else { ", shift_m = [X, Y, Z]" };
    let mut advice = vec![];
    if let Some(wide) = wide(town) {
        advice.push(wide);
    }
    if !has_houses && (has_streets || has_pavements) && !config.fill.buildings {
        advice.push(format!(
            "the town has no houses: `fill.buildings = true` invents some beside the streets, \
             `more = [{{ source = \"FILE\"{place} }}]` takes those of another file"
        ));
    }
    if has_houses && !has_streets && !has_pavements {
        let (state, without) = match are_invented {
            true => ("the streets of the town are invented", "`streets = \"file\"` leaves them out"),
            false => (
                "the town has no streets",
                "`streets = \"invented\"` lays some between rows of houses; without both, people walk on the open ground",
            ),
        };
        advice.push(format!(
            "{state}: `more = [{{ source = \"FILE\", take = [\"ground\"]{place} }}]` takes those of another file, such as an \
             extract of OpenStreetMap; {without}"
        ));
    }
    advice
}

/// Why the projection of a town is not compared with those of other files; none where it is, and where there is none.
pub fn why_not_compared(town: &Town) -> Option<String> {
    let text = town.origin.geo_reference.as_deref()?;
    GeoReference::parse(text).is_none().then(|| GeoReference::why_unknown(text))
}

/// The way out for ground that is too wide for walks.
fn wide(town: &Town) -> Option<String> {
    let own = PlanRectangle::around(corners(town))?;
    let size_m = own.high - own.low;
    let part = busiest_part(town).filter(|_| size_m.element_product() > WIDEST_WALKS_M2)?;
    Some(format!(
        "the ground for people spans {:.0} x {:.0} km, walks need one of at most {:.0} square kilometres: `{}` keeps the part \
         with the most of it",
        1e-3 * size_m.x,
        1e-3 * size_m.y,
        1e-6 * WIDEST_WALKS_M2,
        part.written()
    ))
}

fn corners(town: &Town) -> impl Iterator<Item = DVec2> + '_ {
    town.walkable.iter().flat_map(|polygon| &polygon.outline_in_world).map(|corner| corner.truncate())
}

/// The square of 4 km with the most pieces of ground for people; none in a town without any.
pub fn busiest_part(town: &Town) -> Option<PlanRectangle> {
    let cell = |at: DVec2| ((at.x / PART_M).floor() as i64, (at.y / PART_M).floor() as i64);
    let mut counts: BTreeMap<(i64, i64), usize> = BTreeMap::new();
    for polygon in &town.walkable {
        let middle = polygon.outline_in_world.iter().map(|corner| corner.truncate()).sum::<DVec2>()
            / polygon.outline_in_world.len().max(1) as f64;
        *counts.entry(cell(middle)).or_default() += 1;
    }
    let most = counts.values().copied().max()?;
    let ((column, row), _) = counts.into_iter().find(|(_, count)| *count == most)?;
    let low = PART_M * DVec2::new(column as f64, row as f64);
    Some(PlanRectangle { low, high: low + PART_M })
}
