//! Which pieces of an object or node are one thing.

use super::parts::{Part, bounds};
use cosfly_frames::DVec3;

/// A named object or node that is wider is many things, metres.
const WIDEST_NAMED_M: f64 = 150.0;
/// Pieces without a telling name that touch are one thing up to this width, metres.
const WIDEST_TOUCHING_M: f64 = 40.0;
/// Pieces whose boxes are closer touch, metres.
const TOUCHING_M: f64 = 0.05;
/// More pieces of one name are not compared with each other.
const MOST_PIECES: usize = 1000;

/// The pieces of a named object or node: all of them one thing, or each its own where the name is in the plural or the object is very
/// wide. The second value says that several pieces were taken apart.
pub fn in_one_thing(pieces: Vec<Part>, is_collection: bool) -> (Vec<Vec<Part>>, bool) {
    let is_wide = width_m(&pieces) > WIDEST_NAMED_M;
    if pieces.len() > 1 && (is_collection || is_wide) {
        return (pieces.into_iter().map(|piece| vec![piece]).collect(), true);
    }
    (if pieces.is_empty() { Vec::new() } else { vec![pieces] }, false)
}

/// Pieces that touch as one thing each, where they are of one name and do not reach far.
pub fn in_groups(pieces: Vec<Part>, is_named: bool) -> Vec<Vec<Part>> {
    if !is_named || pieces.len() > MOST_PIECES {
        return pieces.into_iter().map(|piece| vec![piece]).collect();
    }
    let ends: Vec<(DVec3, DVec3)> = pieces.iter().map(|piece| bounds(piece.vertices.iter())).collect();
    let touch = |a: usize, b: usize| {
        let gap = (ends[b].0 - ends[a].1).max(ends[a].0 - ends[b].1);
        gap.max_element() <= TOUCHING_M
    };
    let mut group: Vec<usize> = (0..pieces.len()).collect();
    for b in 0..pieces.len() {
        for a in 0..b {
            let (old, new) = (group[b].max(group[a]), group[b].min(group[a]));
            if old != new && touch(a, b) {
                group.iter_mut().filter(|it| **it == old).for_each(|it| *it = new);
            }
        }
    }
    let mut groups: Vec<Vec<Part>> = (0..pieces.len()).map(|_| Vec::new()).collect();
    for (piece, group) in pieces.into_iter().zip(group) {
        groups[group].push(piece);
    }
    let (mut out, mut far) = (Vec::new(), Vec::new());
    for group in groups.into_iter().filter(|group| !group.is_empty()) {
        if width_m(&group) > WIDEST_TOUCHING_M { far.extend(group) } else { out.push(group) }
    }
    out.extend(far.into_iter().map(|piece| vec![piece]));
    out
}

fn width_m(pieces: &[Part]) -> f64 {
    let (low, high) = bounds(pieces.iter().flat_map(|piece| &piece.vertices));
    if pieces.is_empty() { 0.0 } else { (high - low).truncate().max_element() }
}
