//! The course of a flight: all that a goal may say of it, in order of time.

use super::claim::{Claim, Hider, Said, is_named};
use super::crossings::crossings;
use crate::facts::{Wear, runs, walks};
use crate::sight::Landmarks;
use crate::turns::{Path, Turns};
use cosfly_claims::TurnKind;
use cosfly_domain::BodyKind;
use cosfly_frames::{DVec2, TargetState};
use std::ops::Range;

/// Slower than this is standing, m/s.
const STANDING_MPS: f64 = 0.05;
/// Shorter pauses, and shorter times out of sight or partly hidden, are not worth a word, seconds.
const LEAST_S: f64 = 1.0;

/// Frames in a row in which something hides the target.
#[derive(Clone, Debug, PartialEq)]
pub struct Hidden {
    /// The frames.
    pub frames: Range<usize>,
    /// Object or body that hides it; `None`: nothing that has a name, or several things.
    pub behind: Option<u32>,
    /// Whether the target is outside of the picture in all of the frames.
    pub is_outside: bool,
    /// Whether no pixel of it is visible; else less than half of it is.
    pub is_whole: bool,
}

/// Somebody else in one frame that shows them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// The frame.
    pub frame: usize,
    /// Place and motion.
    pub state: TargetState,
    /// Whether the picture shows enough of them.
    pub is_clear: bool,
}

/// Somebody on foot who is seen in a flight.
#[derive(Clone, Debug, PartialEq)]
pub struct Neighbour {
    /// Clothes.
    pub wear: Wear,
    /// All frames that show them, in order.
    pub samples: Vec<Sample>,
}

/// Data that a course is read from.
#[derive(Clone, Debug)]
pub struct CourseData<'a> {
    /// Time between frames, seconds.
    pub dt_s: f64,
    /// Kind of the target.
    pub kind: BodyKind,
    /// The target.
    pub states: &'a [TargetState],
    /// Distance from the drone to the feet by frame, metres.
    pub distance_m: Vec<f64>,
    /// Whether the target is clear in the picture, by frame.
    pub is_clear: Vec<bool>,
    /// Clothes of the target.
    pub wear: Wear,
    /// Times in which it is hidden, in order.
    pub hidden: Vec<Hidden>,
    /// Objects and bodies by instance id, of the ids in `hidden`.
    pub hiders: Vec<(u32, Hider)>,
    /// Everybody else on foot.
    pub neighbours: Vec<Neighbour>,
    /// All vehicles that are seen: kind and the frames that show them, in order.
    pub vehicles: Vec<(BodyKind, Vec<Sample>)>,
}

/// Facts that can be said of a flight.
#[derive(Clone, Debug)]
pub struct Course<'a> {
    pub(super) flight: &'a CourseData<'a>,
    pub(super) landmarks: &'a Landmarks,
    /// False when the target stays within a metre and is slower than somebody who walks.
    pub(super) walks: bool,
    /// The turns.
    pub(super) turns: Turns,
    /// The way of the target.
    path: Path,
    /// The pauses, in order.
    pub(super) stops: Vec<Range<usize>>,
    /// Frames on marked crossings, in order.
    pub(super) crossings: Vec<Range<usize>>,
}

impl<'a> Course<'a> {
    /// Course of a flight in a town.
    pub fn of(flight: &'a CourseData<'a>, landmarks: &'a Landmarks) -> Self {
        let feet: Vec<DVec2> = flight.states.iter().map(|state| state.feet_in_world.truncate()).collect();
        let moving: Vec<bool> = flight.states.iter().map(|state| state.speed_mps >= STANDING_MPS).collect();
        let way_m: f64 = feet.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        let walks = walks(way_m, flight.states.len().saturating_sub(1) as f64 * flight.dt_s);
        let path = if walks { Path::of(&feet, &moving, flight.dt_s) } else { Path::of(&[], &[], flight.dt_s) };
        let turns = path.turns();
        let stops = if walks { pauses(&moving, flight.dt_s) } else { vec![] };
        let crossings = crossings(flight.states, landmarks);
        Self { flight, landmarks, walks, turns, path, stops, crossings }
    }

    /// Whether the target runs: the mean of its speeds while it moves says so.
    pub(super) fn runs(&self) -> bool {
        let moving =
            self.flight.states.iter().map(|state| state.speed_mps).filter(|speed_mps| *speed_mps >= STANDING_MPS);
        let (sum_mps, count) = moving.fold((0.0, 0.0), |(sum, count), speed_mps| (sum + speed_mps, count + 1.0));
        count > 0.0 && runs(self.flight.kind == BodyKind::Runner, sum_mps / count)
    }

    /// Number of frames.
    pub(super) fn len(&self) -> usize {
        self.flight.states.len()
    }

    /// Frames that a time takes, at least one.
    pub(super) fn frames_in(&self, time_s: f64) -> usize {
        ((time_s / self.flight.dt_s).round() as usize).max(1)
    }

    /// Whether the way around a frame leads to a side so much that people may call it a turn.
    pub(super) fn leads(&self, frame: usize, to: TurnKind) -> bool {
        self.path.leads(frame, to)
    }

    pub(super) fn clothes(&self) -> Said {
        Said { claim: Claim::Wears(self.flight.wear), frames: 0..self.len() }
    }

    /// Mean distance over frames.
    pub(super) fn distance(&self, frames: &Range<usize>) -> Said {
        let part = &self.flight.distance_m[frames.clone()];
        let mean_m = part.iter().sum::<f64>() / part.len().max(1) as f64;
        Said { claim: Claim::Distance(mean_m.round() as u32), frames: frames.clone() }
    }

    /// All turns and pauses that begin in the frames, in order.
    pub(super) fn moves(&self, frames: &Range<usize>) -> Vec<Said> {
        let is_in = |frame: usize| frames.contains(&frame);
        let turns =
            self.turns.sure.iter().filter(|turn| is_in(turn.frame as usize)).map(|turn| Said {
                claim: Claim::Turns(turn.kind),
                frames: turn.frame as usize..turn.frame as usize + 1,
            });
        let stops = self.stops.iter().filter(|stop| is_in(stop.start)).map(|stop| Said {
            claim: Claim::Stops((stop.len() as f64 * self.flight.dt_s).round() as u32),
            frames: stop.clone(),
        });
        let mut moves: Vec<Said> = turns.chain(stops).collect();
        moves.sort_by_key(|said| said.frames.start);
        moves
    }

    /// Words for a target that stands, or that does not turn, where that is so beyond doubt all through the frames.
    pub(super) fn quiet(&self, frames: &Range<usize>) -> Option<Said> {
        let stands = |frame: usize| self.flight.states[frame].speed_mps < STANDING_MPS;
        let mut turns = self.turns.sure.iter().chain(&self.turns.doubtful);
        let claim = match () {
            () if frames.clone().all(stands) => Claim::Stands,
            () if frames.clone().any(stands) => return None,
            () if turns.all(|turn| !frames.contains(&(turn.frame as usize))) => Claim::NoTurn,
            () => return None,
        };
        Some(Said { claim, frames: frames.clone() })
    }

    /// Times out of sight, and partly hidden, that begin in the frames.
    pub(super) fn sights(&self, frames: &Range<usize>) -> Vec<Said> {
        let said = |hidden: &Hidden| {
            let length_s = hidden.frames.len() as f64 * self.flight.dt_s;
            let behind = hidden.behind.and_then(|id| self.flight.hiders.iter().find(|it| it.0 == id)).map(|it| it.1);
            let behind = behind.filter(|hider| is_named(*hider));
            let claim = match (hidden.is_whole, behind) {
                _ if length_s < LEAST_S - 1e-9 => return None,
                (true, None) if !hidden.is_outside => return None,
                (true, behind) => Claim::Lost {
                    behind: behind.filter(|_| !hidden.is_outside),
                    seconds: length_s.round() as u32,
                    found: hidden.frames.end < self.len(),
                },
                (false, Some(hider)) => Claim::PartlyHidden(hider),
                (false, _) => return None,
            };
            Some(Said { claim, frames: hidden.frames.clone() })
        };
        let begin = self.flight.hidden.iter().filter(|hidden| frames.contains(&hidden.frames.start));
        begin.filter_map(said).collect()
    }
}

/// Runs of standing frames of at least [`LEAST_S`].
fn pauses(moving: &[bool], dt_s: f64) -> Vec<Range<usize>> {
    let frames: Vec<usize> = (0..moving.len()).collect();
    let runs = frames.chunk_by(|a, b| moving[*a] == moving[*b]);
    let stands = runs.filter(|run| !moving[run[0]] && run.len() as f64 * dt_s >= LEAST_S - 1e-9);
    stands.map(|run| run[0]..run[0] + run.len()).collect()
}
