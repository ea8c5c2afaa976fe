//! Towns whose things are kilometres apart: most likely two places, or a broken coordinate.

use crate::bounds::PlanRectangle;
use cosfly_domain::{SemanticLabel, Town};
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::MapError;

/// A gap with nothing in it is said from this width on, metres.
const NOTABLE_M: f64 = 2_000.0;
/// A wider one is refused: no walk and no flight uses both sides.
const WIDEST_M: f64 = 20_000.0;

/// Extents of a thing or a piece of ground, metres.
type Span = [[f64; 2]; 3];

/// A gap between the things of a town.
struct Gap {
    width_m: f64,
    axis: usize,
    /// Where it begins.
    from_m: f64,
}

/// Says so where a gap with nothing in it parts the town.
///
/// # Errors
/// A gap of more than 20 km.
pub(crate) fn check(town: &Town) -> Result<Option<String>, MapError> {
    let spans = spans(town);
    let Some(gap) = (0..3).filter_map(|axis| widest_gap(&spans, axis)).max_by(|a, b| a.width_m.total_cmp(&b.width_m))
    else {
        return Ok(None);
    };
    if gap.width_m < NOTABLE_M {
        return Ok(None);
    }
    let (main, others) = parted(&spans);
    let far = others.first().map_or(String::new(), |span| {
        let [x, y, z] = span.map(|[low, high]| (0.5 * (low + high)).round());
        format!(", the first at x {x}, y {y}, z {z}")
    });
    let axis = ["x", "y", "z"][gap.axis];
    let message = format!(
        "{:.1} km along {axis} with nothing in them part the town: {} of its {} things and pieces of ground lie beyond{far}",
        1e-3 * gap.width_m,
        others.len(),
        spans.len()
    );
    let plan = |at: usize| main.iter().map(move |span| DVec2::new(span[0][at], span[1][at]));
    let kept = PlanRectangle::around(plan(0).chain(plan(1)));
    let hint = match (gap.axis, kept) {
        (0 | 1, Some(kept)) => format!("`{}` keeps the larger part", kept.grown(10.0).written()),
        _ => "check the heights of the file, and `heights` of `more`".to_owned(),
    };
    match gap.width_m > WIDEST_M {
        true => Err(MapError::new(message).hint(hint)),
        false => Ok(Some(format!("{message}; {hint}"))),
    }
}

/// Extents of all that the file has: not of invented land, nor of water and meadows, which may reach far.
fn spans(town: &Town) -> Vec<Span> {
    let span = |low: [f64; 3], high: [f64; 3]| [0, 1, 2].map(|axis| [low[axis], high[axis]]);
    let things = town.obstacles.iter().map(|one| one.shape.bounds_in_world());
    let around = |points: &[DVec3]| {
        let low = points.iter().copied().reduce(DVec3::min)?;
        Some((low, points.iter().copied().fold(low, DVec3::max)))
    };
    let ground = town.walkable.iter().filter_map(|polygon| around(&polygon.outline_in_world));
    let lanes = town.lanes.iter().filter_map(|lane| around(&lane.middle_in_world));
    let is_road = |label| matches!(label, SemanticLabel::Roads | SemanticLabel::SideWalks | SemanticLabel::RailTrack);
    let roads = town.surfaces.iter().filter(|mesh| !mesh.synthetic && is_road(mesh.label)).flat_map(|mesh| {
        mesh.triangles.iter().filter_map(move |it| around(&it.map(|corner| mesh.vertices_in_world[corner as usize])))
    });
    let all = things.chain(ground).chain(lanes).chain(roads);
    all.map(|(low, high)| span(low.to_array(), high.to_array())).collect()
}

/// The widest stretch of an axis between things.
fn widest_gap(spans: &[Span], axis: usize) -> Option<Gap> {
    let mut sorted: Vec<[f64; 2]> = spans.iter().map(|span| span[axis]).collect();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut end_m = sorted.first()?[1];
    let mut widest = Gap { width_m: 0.0, axis, from_m: end_m };
    for [low_m, high_m] in sorted {
        if low_m - end_m > widest.width_m {
            widest = Gap { width_m: low_m - end_m, axis, from_m: end_m };
        }
        end_m = end_m.max(high_m);
    }
    Some(widest)
}

/// The larger part, cut at every notable gap in plan, and all others.
fn parted(spans: &[Span]) -> (Vec<Span>, Vec<Span>) {
    let (mut main, mut others) = (spans.to_vec(), vec![]);
    loop {
        let gaps = (0..2).filter_map(|axis| widest_gap(&main, axis));
        let Some(gap) = gaps.filter(|gap| gap.width_m >= NOTABLE_M).max_by(|a, b| a.width_m.total_cmp(&b.width_m))
        else {
            return (main, others);
        };
        let (before, behind): (Vec<Span>, Vec<Span>) =
            main.into_iter().partition(|span| span[gap.axis][0] <= gap.from_m);
        let (larger, smaller) = if before.len() >= behind.len() { (before, behind) } else { (behind, before) };
        main = larger;
        others.extend(smaller);
    }
}
