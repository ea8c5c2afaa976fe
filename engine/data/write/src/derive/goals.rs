//! Goals of a flight: what a recorded flight shows, as the room of captions takes it.

use super::phrases::is_clear;
use cosfly_captions::Wear;
use cosfly_captions::goals::{Course, CourseData, Goal, Grain, Hidden, Hider, Neighbour, Sample, goals};
use cosfly_captions::sight::Landmarks;
use cosfly_domain::{BodyKind, Outfit, TARGET_INSTANCE, object_instance};
use cosfly_frames::{DVec3, Seed};
use cosfly_schema::losses::Loss;
use cosfly_schema::tables::GoalRow;
use cosfly_schema::{OtherBody, RenderedTrajectory, Sighting};
use std::ops::Range;

/// A target is partly hidden where less than this share of its pixels is visible.
const PARTLY: f64 = 0.5;
/// Somebody else with fewer visible pixels is not clear.
const CLEAR_PIXELS: u32 = 30;

/// All goals of a flight; none for a target that is no person on foot.
pub fn of(record: &RenderedTrajectory, losses: &[Loss], landmarks: &Landmarks) -> Vec<Goal> {
    let kind = record.target_kind().filter(|kind| kind.is_on_foot() && !record.is_empty());
    let (Some(kind), Some(outfit)) = (kind, record.outfit.as_ref()) else { return vec![] };
    let flight = flight(record, (kind, outfit), losses, landmarks);
    let seed = Seed::of_item(record.seed, "goals", &record.trajectory_id);
    goals(&Course::of(&flight, landmarks), &seed)
}

/// The row of a goal.
pub fn row(goal: &Goal) -> GoalRow {
    let mut subjects: Vec<String> = goal.said.iter().map(|said| said.claim.subject().name().to_owned()).collect();
    subjects.sort();
    subjects.dedup();
    GoalRow {
        grain: goal.grain.name().to_owned(),
        language: goal.language.code().to_owned(),
        frames: goal.frames.clone(),
        lines: goal.lines.clone(),
        fits: goal.grain != Grain::Negative,
        false_subject: goal.wrong.map(|subject| subject.name().to_owned()),
        claims: goal.said.iter().map(ToString::to_string).collect(),
        subjects,
    }
}

fn flight<'a>(
    record: &'a RenderedTrajectory,
    (kind, outfit): (BodyKind, &Outfit),
    losses: &[Loss],
    landmarks: &Landmarks,
) -> CourseData<'a> {
    let mut hidden: Vec<Hidden> = losses.iter().map(|loss| whole(record, loss)).collect();
    hidden.extend(partly(record));
    hidden.sort_by_key(|it| it.frames.start);
    let mut ids: Vec<u32> = hidden.iter().filter_map(|it| it.behind).collect();
    ids.sort_unstable();
    ids.dedup();
    CourseData {
        dt_s: record.dt_s(),
        kind,
        states: &record.trajectory.track.states,
        distance_m: (0..record.len()).map(|frame| record.distance_m(frame)).collect(),
        is_clear: (0..record.len()).map(|frame| is_clear(record, frame)).collect(),
        wear: Wear::from(outfit),
        hiders: ids.into_iter().filter_map(|id| hider(record, landmarks, id).map(|it| (id, it))).collect(),
        hidden,
        neighbours: neighbours(record),
        vehicles: vehicles(record),
    }
}

/// Frames without a visible pixel; a cause only where it is the same in all of them.
fn whole(record: &RenderedTrajectory, loss: &Loss) -> Hidden {
    let cause = record.views[loss.frames.start].occluder_instance;
    let is_same = record.views[loss.frames.clone()].iter().all(|view| view.in_view && view.occluder_instance == cause);
    Hidden {
        frames: loss.frames.clone(),
        behind: Some(cause).filter(|_| is_same && cause > TARGET_INSTANCE),
        // A body that is smaller than a pixel is in no pixel and yet in the picture.
        is_outside: loss.frames.clone().all(|frame| is_outside(record, frame)),
        is_whole: true,
    }
}

/// Whether the middle of the body is outside of the picture.
fn is_outside(record: &RenderedTrajectory, frame: usize) -> bool {
    let track = &record.trajectory.track;
    let middle = track.states[frame].feet_in_world + 0.5 * track.height_m * DVec3::Z;
    let [width, height] = [record.camera.width, record.camera.height].map(f64::from);
    let middle = record.camera_pose(frame).body_from_world_point(middle);
    let at = match record.lens.is_wide(&record.camera) {
        true => record.lens.project(&record.camera, middle),
        false => record.camera.project_seen(middle),
    };
    at.is_none_or(|(u, v, _)| !((0.0..width).contains(&u) && (0.0..height).contains(&v)))
}

/// Runs of frames in which the same thing hides more than half of the target, and not all of it.
fn partly(record: &RenderedTrajectory) -> Vec<Hidden> {
    let cause = |frame: usize| {
        let view = &record.views[frame];
        let is_partly = view.pixels > 0 && view.visible_by_pixels < PARTLY;
        if is_partly { view.occluder_instance } else { 0 }
    };
    let frames: Vec<usize> = (0..record.len()).collect();
    let runs = frames.chunk_by(|a, b| cause(*a) == cause(*b)).filter(|run| cause(run[0]) > TARGET_INSTANCE);
    let hidden =
        |frames: Range<usize>| Hidden { behind: Some(cause(frames.start)), frames, is_outside: false, is_whole: false };
    runs.map(|run| hidden(run[0]..run[run.len() - 1] + 1)).collect()
}

fn hider(record: &RenderedTrajectory, landmarks: &Landmarks, instance: u32) -> Option<Hider> {
    if let Ok(at) = record.others.binary_search_by_key(&instance, |other| other.instance) {
        return Some(Hider::Body(record.others[at].plan.kind));
    }
    let object = instance.checked_sub(object_instance(0))?;
    landmarks.kind_of(object).map(Hider::Object)
}

/// Frames that show another body.
fn samples(record: &RenderedTrajectory, place: usize) -> Vec<Sample> {
    let own = record.sightings.iter().filter(|it| it.other as usize == place);
    let sample =
        |it: &Sighting| Sample { frame: it.frame as usize, state: it.state, is_clear: it.view.pixels >= CLEAR_PIXELS };
    own.map(sample).collect()
}

fn neighbours(record: &RenderedTrajectory) -> Vec<Neighbour> {
    let is_walker = |it: &(usize, &OtherBody)| it.1.plan.kind.is_on_foot();
    let others = record.others.iter().enumerate().filter(is_walker);
    others.map(|(place, it)| Neighbour { wear: Wear::from(&it.outfit), samples: samples(record, place) }).collect()
}

fn vehicles(record: &RenderedTrajectory) -> Vec<(BodyKind, Vec<Sample>)> {
    let is_vehicle = |it: &(usize, &OtherBody)| !it.1.plan.kind.is_person() && it.1.plan.kind != BodyKind::Drone;
    let others = record.others.iter().enumerate().filter(is_vehicle);
    others.map(|(place, it)| (it.plan.kind, samples(record, place))).collect()
}
