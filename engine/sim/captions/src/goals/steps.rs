//! Steps: the stretches of a flight, each with its move, what is on the way, and the distance.

use super::around::surroundings;
use super::claim::{Claim, Said, Subject};
use super::course::Course;
use super::plan::{Grain, Plan};
use cosfly_random::RandomStream;
use std::ops::Range;

/// Time behind a turn that belongs to its stretch, seconds.
const TURN_S: f64 = 3.0;
/// Shorter stretches have no goal, seconds and frames.
const LEAST_S: f64 = 3.0;
const LEAST_FRAMES: usize = 3;
/// Longer stretches without a move are cut, seconds.
const LONGEST_S: f64 = 20.0;

/// A goal for each stretch of which there is something to say.
pub(super) fn steps(course: &Course<'_>, words: &mut RandomStream) -> Vec<Plan> {
    stretches(course).into_iter().filter_map(|(frames, action)| step(course, frames, action, words)).collect()
}

/// The stretches in order, each with the move that ends it.
fn stretches(course: &Course<'_>) -> Vec<(Range<usize>, Option<Said>)> {
    let in_frames = |time_s: f64| (time_s / course.flight.dt_s) as usize;
    let (turn, least) = (in_frames(TURN_S).max(1), in_frames(LEAST_S).max(LEAST_FRAMES));
    let mut found = vec![];
    let mut start = 0;
    let moves = course.moves(&(0..course.len()));
    for (number, said) in moves.iter().enumerate() {
        let next = moves.get(number + 1).map_or(course.len(), |it| it.frames.start);
        let end = match said.claim {
            Claim::Turns(_) => (said.frames.start + turn).min(next),
            _ => said.frames.end.min(course.len()),
        };
        if end >= start + least && said.frames.start >= start {
            found.push((start..end, Some(said.clone())));
            start = end;
        }
    }
    let longest = in_frames(LONGEST_S).max(least);
    let left = course.len().saturating_sub(start);
    let pieces = left.div_ceil(longest).max(1);
    for piece in 0..pieces {
        let frames = start + left * piece / pieces..start + left * (piece + 1) / pieces;
        if frames.len() >= least {
            found.push((frames, None));
        }
    }
    found
}

fn step(course: &Course<'_>, frames: Range<usize>, action: Option<Said>, words: &mut RandomStream) -> Option<Plan> {
    let before =
        frames.start..action.as_ref().map_or(frames.end, |said| said.frames.start.saturating_sub(1)).max(frames.start);
    let mut said = vec![];
    // At most two things on the way: one around the target, one that hides it.
    let around = if course.walks { surroundings(course, &before) } else { vec![] };
    if !around.is_empty() {
        said.push(around[words.index(around.len())].clone());
    }
    let sights: Vec<Said> = course.sights(&before).into_iter().filter(|it| it.frames.end <= before.end).collect();
    said.extend(sights.into_iter().max_by_key(|it| (it.frames.len(), std::cmp::Reverse(it.frames.start))));
    said.sort_by_key(|it| it.frames.start);
    said.extend(action.or_else(|| course.quiet(&frames).filter(|_| said.is_empty())));
    if said.is_empty() {
        said.extend(course.sights(&frames).into_iter().next());
    }
    if said.is_empty() {
        return None;
    }
    said.push(course.distance(&frames));
    let wrong: Option<Subject> = None;
    Some(Plan { grain: Grain::Step, frames, said, wrong, mistaken: None, is_other_of_two: false })
}
