//! People and vehicles around a target on its way: who walks beside it, and who passes it.

use super::claim::{Claim, Said};
use super::course::{Course, Neighbour, Sample};
use cosfly_frames::real;
use std::ops::Range;

/// Who walks beside the target is at most this far away, metres, and walks within this angle of its direction, degrees.
const WITH_M: f64 = 3.0;
const WITH_DEG: f64 = 30.0;
/// Nothing is said where somebody is beside the target only within limits that are wider by this factor.
const BORDER: f64 = 1.5;
/// Slowest walk, m/s.
const WALKS_MPS: f64 = 0.3;
/// Shares of the frames in which somebody beside the target is seen beside it: with it, and not with it.
const WITH_SHARE: f64 = 0.7;
const APART_SHARE: f64 = 0.3;
/// The target must walk for at least this long beside others, seconds.
const LEAST_WITH_S: f64 = 3.0;
/// Time before and after somebody passes the target in which both walk so, seconds: people who go the same way pass one another
/// slowly.
const PASSING_S: f64 = 0.5;
const PASSING_SLOWLY_S: f64 = 3.0;
/// Most people whom a text counts.
const MOST_WITH: usize = 6;
/// Who comes towards the target walks against its direction by at least this angle, degrees, and passes it at most this far
/// aside, metres.
const AGAINST_DEG: f64 = 150.0;
const MEETS_ASIDE_M: f64 = 3.0;
const VEHICLE_ASIDE_M: f64 = 8.0;
/// Way before and behind the target of somebody who passes it, metres.
const PASSES_M: f64 = 1.0;

/// Number of people who walk beside the target all through the frames.
pub(super) fn walks_with(course: &Course<'_>, frames: &Range<usize>) -> Option<Said> {
    let walked = |frame: usize| course.flight.states[frame].speed_mps >= WALKS_MPS;
    let walking = frames.clone().filter(|frame| walked(*frame)).count();
    if walking < course.frames_in(LEAST_WITH_S) || 10 * walking < 8 * frames.len() {
        return None;
    }
    let share = |neighbour: &Neighbour, factor: f64| {
        let beside = in_frames(neighbour, frames).filter(|it| is_beside(course, it, factor)).count();
        beside as f64 / frames.len() as f64
    };
    let mut count = 0;
    for neighbour in &course.flight.neighbours {
        match (share(neighbour, 1.0), share(neighbour, BORDER)) {
            (narrow, _) if narrow >= WITH_SHARE => count += 1,
            (_, wide) if wide <= APART_SHARE => {}
            _ => return None,
        }
    }
    let is_said = (1..=MOST_WITH).contains(&count);
    is_said.then(|| Said { claim: Claim::WalksWith(count), frames: frames.clone() })
}

/// How somebody passes the target.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Manner {
    Towards,
    FromAhead,
    FromBehind,
}

/// People and vehicles that pass the target in the frames, and people whom it passes.
pub(super) fn passed(course: &Course<'_>, frames: &Range<usize>) -> Vec<Said> {
    let said = |samples: &[Sample], manner, aside_m, claim| {
        passing(course, samples, frames, manner, aside_m).map(|frames| Said { claim, frames })
    };
    let mut found: Vec<Said> = vec![];
    for it in &course.flight.neighbours {
        found.extend(said(&it.samples, Manner::Towards, MEETS_ASIDE_M, Claim::Meets(it.wear.top)));
        found.extend(said(&it.samples, Manner::FromAhead, MEETS_ASIDE_M, Claim::Overtakes(it.wear.top)));
    }
    for (kind, samples) in &course.flight.vehicles {
        found.extend(said(samples, Manner::Towards, VEHICLE_ASIDE_M, Claim::MeetsVehicle(*kind)));
        found.extend(said(samples, Manner::FromBehind, VEHICLE_ASIDE_M, Claim::OvertakenBy(*kind)));
    }
    found.sort_by_key(|said| said.frames.start);
    found
}

/// The two frames between which somebody passes the target in a manner, at most so far aside.
fn passing(
    course: &Course<'_>,
    samples: &[Sample],
    frames: &Range<usize>,
    manner: Manner,
    aside_m: f64,
) -> Option<Range<usize>> {
    let sign = if manner == Manner::FromBehind { -1.0 } else { 1.0 };
    let ahead_m = |it: &Sample| sign * place(course, it).0;
    let seen: Vec<&Sample> = samples.iter().filter(|it| frames.contains(&it.frame)).collect();
    let passes = |pair: &[&Sample]| {
        let is_near = pair.iter().all(|it| place(course, it).1.abs() <= aside_m);
        pair[1].frame == pair[0].frame + 1 && ahead_m(pair[0]) > 0.0 && ahead_m(pair[1]) <= 0.0 && is_near
    };
    let at = seen.windows(2).position(passes)?;
    let goes_so = |it: &&Sample| {
        let state = &course.flight.states[it.frame];
        let turned_deg = real::wrap_angle_rad(it.state.heading_rad - state.heading_rad).to_degrees().abs();
        let is_turned = if manner == Manner::Towards { turned_deg >= AGAINST_DEG } else { turned_deg <= WITH_DEG };
        is_turned && it.state.speed_mps >= WALKS_MPS && state.speed_mps >= WALKS_MPS
    };
    let more = course.frames_in(if manner == Manner::FromAhead { PASSING_SLOWLY_S } else { PASSING_S });
    let around = &seen[at.saturating_sub(more)..(at + 2 + more).min(seen.len())];
    let is_through = around.first().is_some_and(|it| ahead_m(it) >= PASSES_M)
        && around.last().is_some_and(|it| ahead_m(it) <= -PASSES_M);
    let frames = seen[at].frame..seen[at + 1].frame + 1;
    (is_through && around.iter().all(goes_so)).then_some(frames)
}

fn in_frames<'a>(neighbour: &'a Neighbour, frames: &Range<usize>) -> impl Iterator<Item = &'a Sample> {
    let frames = frames.clone();
    neighbour.samples.iter().filter(move |it| frames.contains(&it.frame))
}

/// Way from the target to somebody, along its heading and to its right, metres.
fn place(course: &Course<'_>, it: &Sample) -> (f64, f64) {
    let state = &course.flight.states[it.frame];
    let (sin, cos) = real::sin_cos(state.heading_rad);
    let way = (it.state.feet_in_world - state.feet_in_world).truncate();
    (cos * way.x + sin * way.y, cos * way.y - sin * way.x)
}

fn is_beside(course: &Course<'_>, it: &Sample, factor: f64) -> bool {
    let state = &course.flight.states[it.frame];
    let turned = real::wrap_angle_rad(it.state.heading_rad - state.heading_rad).to_degrees().abs();
    let way = (it.state.feet_in_world - state.feet_in_world).truncate();
    way.length() <= factor * WITH_M && turned <= factor * WITH_DEG && it.state.speed_mps >= WALKS_MPS / factor
}
