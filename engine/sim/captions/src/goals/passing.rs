//! Crossings that a target uses, and landmarks that it passes, counted by kind and side.

use super::claim::{Claim, Passed, Said};
use super::course::Course;
use crate::sight::landmarks::way_to;
use crate::sight::{LandmarkKind, OnSide};
use cosfly_frames::real;
use std::collections::BTreeMap;
use std::ops::Range;

/// A landmark beside the target is at most this far away, metres; a building may be farther.
const REACH_M: f64 = 5.0;
const BUILDING_REACH_M: f64 = 10.0;
/// Nothing is counted where one more of the kind is within the reach times this factor: nobody can say whether it counts.
const BORDER: f64 = 1.4;
/// A landmark is beside the target where it is this little before or behind, and at least so far to a side, metres.
const ABREAST_M: f64 = 1.0;
const LEAST_ASIDE_M: f64 = 0.5;
/// Around the ends of a stretch nothing may be beside the target for this long, seconds: nobody can say whether it counts.
const EDGE_S: f64 = 1.0;
/// More are not counted at a glance.
const MOST: usize = 6;
/// A landmark begins at most this far above or below the feet, metres.
const LEVEL_M: f64 = 3.0;

/// Who crosses a street goes at least this far on the crossing, metres: more than the width of most.
const LEAST_ACROSS_M: f64 = 5.0;

/// Frames in which one landmark is beside the target.
#[derive(Default)]
struct Beside {
    left: usize,
    right: usize,
    /// Least distance, metres.
    least_m: f64,
    first: usize,
    last: usize,
}

/// Numbers of landmarks that the target passes in the frames, by kind and side; the best first. Only what nobody could dispute.
pub(super) fn passed(course: &Course<'_>, frames: &Range<usize>) -> Vec<Said> {
    let mut found: Vec<Said> = vec![];
    let (beside, edge) = (all_beside(course, frames), course.frames_in(EDGE_S));
    for kind in LandmarkKind::ALL {
        let of_kind: Vec<&Beside> = beside.iter().filter(|(key, _)| key.0 == kind).map(|(_, it)| it).collect();
        for side in [OnSide::Left, OnSide::Right] {
            let on_side = |it: &&&Beside| if side == OnSide::Left { it.left > 0 } else { it.right > 0 };
            let there: Vec<&&Beside> = of_kind.iter().filter(on_side).collect();
            let is_clear = |it: &&&Beside| {
                (it.left == 0) != (it.right == 0)
                    && it.least_m <= reach_m(kind)
                    && it.first >= frames.start + edge
                    && it.last + edge < frames.end
            };
            if (1..=MOST).contains(&there.len()) && there.iter().all(is_clear) {
                let frames = frames.clone();
                found.push(Said {
                    claim: Claim::Passes(Passed { kind, side, count: there.len(), after_crossing: false }),
                    frames,
                });
            }
        }
    }
    found
}

/// Crossings at which the target crosses the street in the frames; and what it passes after the crossing, where there is one only.
pub(super) fn crossed(course: &Course<'_>, frames: &Range<usize>) -> Vec<Said> {
    let inside = |run: &&Range<usize>| run.end > frames.start && run.start < frames.end;
    let runs: Vec<&Range<usize>> = course.crossings.iter().filter(inside).collect();
    let is_whole = |run: &&&Range<usize>| run.start > frames.start && run.end < frames.end;
    let crosses = |run: &&&Range<usize>| {
        let [from, to] = [run.start, run.end - 1].map(|frame| course.flight.states[frame].feet_in_world.truncate());
        is_whole(run) && from.distance(to) >= LEAST_ACROSS_M
    };
    let told: Vec<&Range<usize>> = runs.iter().filter(crosses).copied().collect();
    let mut found: Vec<Said> = told.iter().map(|it| Said { claim: Claim::Crosses, frames: (*it).clone() }).collect();
    if let ([only], 1) = (told.as_slice(), runs.len()) {
        for mut said in passed(course, &(only.end..frames.end)) {
            if let Claim::Passes(passed) = &mut said.claim {
                passed.after_crossing = true;
            }
            found.push(said);
        }
    }
    found
}

/// Whether no landmark of a kind is on a side of the target in the frames, not even at the border.
pub(super) fn is_free(course: &Course<'_>, frames: &Range<usize>, kind: LandmarkKind, side: OnSide) -> bool {
    let is_on_side = |it: &Beside| if side == OnSide::Left { it.left > 0 } else { it.right > 0 };
    all_beside(course, frames).iter().all(|(key, it)| key.0 != kind || !is_on_side(it))
}

fn reach_m(kind: LandmarkKind) -> f64 {
    if kind == LandmarkKind::Building { BUILDING_REACH_M } else { REACH_M }
}

/// Everything that is beside the target in some of the frames, within the widened reach.
fn all_beside(course: &Course<'_>, frames: &Range<usize>) -> BTreeMap<(LandmarkKind, u32), Beside> {
    let mut found: BTreeMap<(LandmarkKind, u32), Beside> = BTreeMap::new();
    for frame in frames.clone() {
        let state = &course.flight.states[frame];
        let (sin, cos) = real::sin_cos(state.heading_rad);
        for (kind, object, shape) in course.landmarks.around(state.feet_in_world, BORDER * BUILDING_REACH_M) {
            let way = way_to(shape, state.feet_in_world);
            let (before_m, aside_m) = (cos * way.x + sin * way.y, cos * way.y - sin * way.x);
            let bottom_m = shape.center_in_world.z - shape.half_extents_m.z;
            let is_level = (bottom_m - state.feet_in_world.z).abs() <= LEVEL_M;
            let is_abreast = before_m.abs() <= ABREAST_M && aside_m.abs() <= BORDER * reach_m(kind);
            if !(is_level && is_abreast) {
                continue;
            }
            let new = || Beside { least_m: f64::INFINITY, first: frame, ..Beside::default() };
            let it = found.entry((kind, object)).or_insert_with(new);
            it.last = frame;
            it.least_m = it.least_m.min(aside_m.abs());
            // Straight ahead or underfoot it is on no side, so on both.
            it.left += usize::from(aside_m < LEAST_ASIDE_M);
            it.right += usize::from(aside_m > -LEAST_ASIDE_M);
        }
    }
    found
}
