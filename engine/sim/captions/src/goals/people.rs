//! People around a target on its way: who walks beside it, and who comes towards it.

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
/// Most people whom a text counts.
const MOST_WITH: usize = 6;
/// Who comes towards the target walks against its direction by at least this angle, degrees, and passes it at most this far
/// aside, metres.
const AGAINST_DEG: f64 = 150.0;
const MEETS_ASIDE_M: f64 = 3.0;
/// Way before and behind the target of somebody who passes it, metres.
const PASSES_M: f64 = 1.0;

/// Number of people who walk beside the target all through the frames.
pub(super) fn walks_with(course: &Course<'_>, frames: &Range<usize>) -> Option<Said> {
    let walked = |frame: usize| course.flight.states[frame].speed_mps >= WALKS_MPS;
    let walking = frames.clone().filter(|frame| walked(*frame)).count();
    if walking < 6 || 10 * walking < 8 * frames.len() {
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

/// People who come towards the target and pass it in the frames.
pub(super) fn meets(course: &Course<'_>, frames: &Range<usize>) -> Vec<Said> {
    let meeting = |neighbour: &Neighbour| {
        let seen: Vec<&Sample> = in_frames(neighbour, frames).collect();
        let passes = |pair: &[&Sample]| {
            let [from, to] = [pair[0], pair[1]].map(|it| place(course, it));
            let is_near = from.1.abs() <= MEETS_ASIDE_M && to.1.abs() <= MEETS_ASIDE_M;
            pair[1].frame == pair[0].frame + 1 && from.0 > 0.0 && to.0 <= 0.0 && is_near
        };
        let at = seen.windows(2).position(passes)?;
        let goes_against = |it: &&Sample| {
            let state = &course.flight.states[it.frame];
            let turned = real::wrap_angle_rad(it.state.heading_rad - state.heading_rad).to_degrees().abs();
            turned >= AGAINST_DEG && it.state.speed_mps >= WALKS_MPS && state.speed_mps >= WALKS_MPS
        };
        let around = &seen[at.saturating_sub(1)..(at + 3).min(seen.len())];
        let is_through = around.first().is_some_and(|it| place(course, it).0 >= PASSES_M)
            && around.last().is_some_and(|it| place(course, it).0 <= -PASSES_M);
        let frames = seen[at].frame..seen[at + 1].frame + 1;
        (is_through && around.iter().all(goes_against))
            .then_some(Said { claim: Claim::Meets(neighbour.wear.top), frames })
    };
    let mut met: Vec<Said> = course.flight.neighbours.iter().filter_map(meeting).collect();
    met.sort_by_key(|said| said.frames.start);
    met
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
