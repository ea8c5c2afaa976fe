//! Meaning of actions: LeRobot does not state it, so the usual meanings are tried, and the exact one is taken.

use super::features::Features;
use crate::ExaminedEpisode;
use cosfly_frames::{DVec3, Pose};
use std::collections::BTreeMap;

/// Largest median error of a meaning that is taken, metres.
const EXACT_M: f64 = 1e-3;
/// Smallest number of frames for a verdict.
const ENOUGH: usize = 8;
/// Shifts of actions that are tried, frames.
const SHIFTS: [i64; 5] = [0, -1, 1, -2, 2];

/// An episode with the numbers of its actions.
pub struct RecordedActions {
    /// The episode without its actions.
    pub episode: ExaminedEpisode,
    /// Three numbers per frame.
    pub actions: Vec<Option<[f64; 3]>>,
    /// Three angles per frame: pitch, yaw, roll.
    pub turns: Vec<Option<[f64; 3]>>,
    /// Index of the episode to whose next pose actions lead; none: the own episode.
    pub expert: Option<String>,
}

/// Meaning of the three numbers of an action.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Meaning {
    /// A step along the world's axes.
    Step,
    /// A step along the drone's own axes.
    StepOfBody,
    /// The next position.
    Place,
    /// A velocity along the world's axes.
    Velocity,
    /// A velocity along the drone's own axes.
    VelocityOfBody,
}

const MEANINGS: [Meaning; 5] =
    [Meaning::Step, Meaning::StepOfBody, Meaning::Place, Meaning::Velocity, Meaning::VelocityOfBody];

impl Meaning {
    /// The position that an action leads to from a pose.
    fn target(self, from: &Pose, action: [f64; 3], dt_s: f64) -> DVec3 {
        let action = DVec3::from_array(action);
        let place = from.position_in_world;
        let turned = |step: DVec3| place + from.world_from_body() * step;
        match self {
            Self::Step => place + action,
            Self::StepOfBody => turned(action),
            Self::Place => action,
            Self::Velocity => place + action * dt_s,
            Self::VelocityOfBody => turned(action * dt_s),
        }
    }
}

/// Finds the meaning of all actions and sets the positions that they lead to, or notes that no meaning fits.
pub fn interpret(recordings: &mut [RecordedActions], features: &Features, notes: &mut Vec<String>) {
    if features.action.is_none() || features.position.is_none() {
        if features.position.is_some() {
            notes.push("actions: no feature `action` with three numbers along axes".to_owned());
        }
        return;
    }
    let poses = |it: &RecordedActions| it.episode.moments.iter().map(|moment| moment.drone).collect();
    let all: BTreeMap<String, Vec<Pose>> = recordings.iter().map(|it| (it.episode.id.clone(), poses(it))).collect();
    // None when the expert is not among the episodes.
    let led_of = |it: &RecordedActions| all.get(it.expert.as_ref().unwrap_or(&it.episode.id));
    let mut best: Option<(f64, Meaning)> = None;
    for meaning in MEANINGS {
        for shift in SHIFTS {
            let gaps = recordings.iter().flat_map(|it| {
                let led = led_of(it).map_or(&[][..], Vec::as_slice);
                gaps(it, led, meaning, shift)
            });
            let mut gaps: Vec<f64> = gaps.collect();
            gaps.sort_by(f64::total_cmp);
            let middle = gaps.get(gaps.len() / 2).copied().filter(|_| gaps.len() >= ENOUGH);
            if let Some(error) = middle.filter(|error| best.is_none_or(|(least, _)| *error < 0.5 * least)) {
                best = Some((error, meaning));
            }
        }
    }
    let Some((_, meaning)) = best.filter(|(error, _)| *error <= EXACT_M) else {
        notes.push(match best {
            Some((error, _)) => format!(
                "actions: as steps, places or velocities, along the world's axes or the drone's, they miss the next place \
                 by {error:.3} m or more in the middle frame; their meaning is not stated"
            ),
            None => "actions: there are too few".to_owned(),
        });
        return;
    };
    for recording in recordings {
        let Some(led) = led_of(recording).cloned() else { continue };
        let dt_s = recording.episode.dt_s;
        // The last action of an episode leads nowhere.
        let last = recording.episode.moments.len().saturating_sub(1);
        for (frame, moment) in recording.episode.moments.iter_mut().enumerate().take(last) {
            moment.next_in_world = recording.actions[frame].map(|action| meaning.target(&moment.drone, action, dt_s));
            moment.turn_deg = recording.turns[frame].filter(|_| meaning == Meaning::Step);
        }
        recording.episode.followed = Some(led);
    }
}

/// Errors of actions, metres, where each belongs to the frame `shift` after it.
fn gaps<'a>(it: &'a RecordedActions, led: &'a [Pose], meaning: Meaning, shift: i64) -> impl Iterator<Item = f64> + 'a {
    let moments = &it.episode.moments;
    let count = moments.len().min(led.len());
    it.actions.iter().enumerate().take(count.saturating_sub(1)).filter_map(move |(frame, action)| {
        let from = frame.checked_add_signed(shift as isize).filter(|from| from + 1 < count)?;
        let target = meaning.target(&moments[from].drone, (*action)?, it.episode.dt_s);
        Some(target.distance(led[from + 1].position_in_world))
    })
}
