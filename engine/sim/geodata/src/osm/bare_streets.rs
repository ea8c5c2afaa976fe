//! Streets without ground for people beside them, of which the file says nothing: a warning with the option that helps.

use super::options::OsmOptions;
use super::pavements::{PAVEMENT_M, is_street, may_be_assumed};
use super::roads::Road;
use cosfly_domain::WalkablePolygon;
use cosfly_frames::DVec2;
use cosfly_town::polygons::PolygonIndex;

/// Distance between the places of a street that are looked at, metres.
const STEP_M: f64 = 20.0;
/// Widest gap between a carriageway and ground beside it, metres.
const BESIDE_M: f64 = 6.0;
/// Share of the streets' length, and length in metres, from which bare streets are said.
const NOTABLE_SHARE: f64 = 0.5;
const NOTABLE_M: f64 = 100.0;

/// Says so where more than half of the streets are bare and `assume_pavements` would give them pavements.
pub fn warning(roads: &[Road<'_>], walkable: &[WalkablePolygon], options: &OsmOptions) -> Option<String> {
    if options.assume_pavements {
        return None;
    }
    let ground = PolygonIndex::new(walkable.iter().map(WalkablePolygon::plan).collect());
    let (mut all_m, mut bare_m) = (0.0, 0.0);
    for road in roads.iter().filter(|road| is_street(&road.way.tags)) {
        for pair in road.pieces.iter().flat_map(|piece| piece.windows(2)) {
            let length_m = pair[0].distance(pair[1]);
            all_m += length_m;
            if may_be_assumed(&road.way.tags) {
                bare_m += length_m * bare_share(pair[0], pair[1], road.half_width_m, &ground);
            }
        }
    }
    (bare_m > NOTABLE_SHARE * all_m && bare_m > NOTABLE_M).then(|| {
        format!(
            "{:.1} of {:.1} km of streets have no ground for people beside them, and the file says nothing of their pavements: \
             `assume_pavements = true` invents some",
            1e-3 * bare_m,
            1e-3 * all_m
        )
    })
}

/// Share of the places along a straight piece of street that have no ground on either side.
fn bare_share(from: DVec2, to: DVec2, half_width_m: f64, ground: &PolygonIndex) -> f64 {
    let side = (to - from).normalize_or_zero().perp();
    let places = (from.distance(to) / STEP_M).ceil().max(1.0) as usize;
    let is_bare = |place: &usize| {
        let at = from.lerp(to, (*place as f64 + 0.5) / places as f64);
        let mut beside = (0..=(BESIDE_M / PAVEMENT_M) as usize).flat_map(|step| {
            let away_m = half_width_m + PAVEMENT_M * (step as f64 + 0.5);
            [at + away_m * side, at - away_m * side]
        });
        !beside.any(|point| ground.at(point).next().is_some())
    };
    (0..places).filter(is_bare).count() as f64 / places as f64
}
