//! Prune: specks beside a kept box.

use super::candidate::BoxCandidate;
use super::containment::{covered_by_another, retain_by};
use cosfly_domain::OrientedBox;

/// Drops the boxes no larger than `tolerance_m` whose every point is within `tolerance_m` of one larger box. Larger
/// boxes are never dropped, so what covers a speck stays.
pub fn drop_specks(boxes: &mut Vec<BoxCandidate>, tolerance_m: f64) {
    let shapes: Vec<OrientedBox> = boxes.iter().map(|one| one.shape).collect();
    let is_speck = |index: usize| 2.0 * shapes[index].half_extents_m.abs().max_element() <= tolerance_m;
    if !(0..shapes.len()).any(is_speck) {
        return;
    }
    // Growth of the cover by merging must not add up with the gap beside it: distances are to the kept box itself.
    let is_covered = covered_by_another(&shapes, |index| !is_speck(index), tolerance_m);
    retain_by(boxes, |index| !(is_speck(index) && is_covered[index]));
}
