//! Facts of a trajectory: directions, turns, stops, distances, angles.

use crate::turns::{Path, Turn};
use cosfly_claims::{Compass, TurnKind};
use cosfly_domain::{BodyKind, Colour, Outfit, Trajectory};
use cosfly_frames::DVec2;
use serde::{Deserialize, Serialize};

/// Slower than this is standing, m/s.
const STANDING_MPS: f64 = 0.05;
/// Shorter pauses are not worth a word, seconds.
pub(crate) const LEAST_STOP_S: f64 = 1.0;
/// A target that moves less than this in all stands, metres, unless it moves at the pace of a walk.
const LEAST_WALK_M: f64 = 1.0;
/// Slower than this nobody walks, m/s.
const SLOWEST_WALK_MPS: f64 = 0.5;
/// People who are faster while they move run, m/s.
const RUNNING_MPS: f64 = 2.2;
/// Runners run from a lower pace on, m/s; those who keep pace with people who walk walk.
const JOGGING_MPS: f64 = 1.8;
/// Way at the start and at the end of a walk that gives their directions, metres.
const END_M: f64 = 3.0;
/// The first turn comes soon in the first fifth of the time and the first seconds; late in the second half, after some seconds.
pub(crate) const SOON_SHARE: f64 = 0.2;
pub(crate) const SOON_S: f64 = 6.0;
pub(crate) const LATE_SHARE: f64 = 0.5;
pub(crate) const LATE_S: f64 = 10.0;

/// A pause of the target.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TargetStop {
    /// First frame that stands.
    pub frame: u32,
    /// Standing frames x time step, seconds.
    pub duration_s: f64,
}

/// Clothes of the target, as words name them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Wear {
    /// Colour of the shirt or jacket.
    pub top: Colour,
    /// Colour of the trousers.
    pub trousers: Colour,
    /// Wears a backpack.
    pub backpack: bool,
}

impl From<&Outfit> for Wear {
    fn from(outfit: &Outfit) -> Self {
        Self { top: outfit.top.name, trousers: outfit.trousers.name, backpack: outfit.backpack }
    }
}

/// Typed facts of one trajectory.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Facts {
    /// False when the target stays within a metre and is slower than somebody who walks.
    pub walks: bool,
    /// Walking direction at the start (facing, when it stands).
    pub start_direction: Compass,
    /// Walking direction at the end.
    pub end_direction: Compass,
    /// Turns that everybody sees, in order: bends of 60 to 125 degrees within some metres, and turns around.
    pub turns: Vec<Turn>,
    /// Bends of which nobody can say whether they are turns, in order; one bend may stand here with two sides.
    #[serde(default)]
    pub doubtful_turns: Vec<Turn>,
    /// Whether the way is not straight from its start to its end.
    #[serde(default)]
    pub bends: bool,
    /// Time between frames, seconds; 0 where it is unknown.
    #[serde(default)]
    pub dt_s: f64,
    /// Pauses of at least a second, in order.
    pub stops: Vec<TargetStop>,
    /// Time from the first to the last frame, seconds.
    pub duration_s: f64,
    /// Way that the target walks, metres.
    pub way_m: f64,
    /// Mean speed of the target while it walks, m/s.
    pub walking_speed_mps: f64,
    /// Mean distance from drone to the target's feet, metres.
    pub distance_m: f64,
    /// Mean angle of the camera below the horizon, degrees; negative when it looks up.
    pub pitch_down_deg: f64,
    /// Mean height of the drone above the target's feet, metres.
    pub altitude_m: f64,
    /// Mean share of the target that is unoccluded, 0..=1.
    pub visibility: f64,
    /// Clothes of the target; `None` where they are unknown: texts do not name them, and claims about them are not judged.
    pub wear: Option<Wear>,
    /// Whether the target is of the kind `runner`.
    #[serde(default)]
    pub is_runner: bool,
    /// Facts that the frames leave out, where they are a part of the flight's.
    #[serde(default)]
    pub left_out: Option<LeftOut>,
}

/// Part of the whole flight's facts that those of every n-th frame may miss.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LeftOut {
    /// Time at either end of the flight, and between frames, seconds.
    pub time_s: f64,
    /// Error of the mean distance, metres.
    pub distance_m: f64,
    /// Error of the mean pitch, degrees.
    pub pitch_deg: f64,
    /// Error of the mean height, metres.
    pub altitude_m: f64,
}

impl Facts {
    /// Facts with the target's clothes.
    pub fn wearing(self, wear: Option<Wear>) -> Self {
        Self { wear, ..self }
    }

    /// Facts of a target of a kind.
    pub fn of_kind(self, kind: BodyKind) -> Self {
        Self { is_runner: kind == BodyKind::Runner, ..self }
    }

    /// Whether the target runs: nobody walks as fast, or it is a runner whom nobody holds up.
    pub fn runs(&self) -> bool {
        runs(self.is_runner, self.walking_speed_mps)
    }

    /// Time of all stops together, seconds.
    pub fn standing_s(&self) -> f64 {
        self.stops.iter().map(|stop| stop.duration_s).sum()
    }

    /// Number of turns of a kind.
    pub fn turns_of(&self, kind: TurnKind) -> usize {
        self.turns.iter().filter(|turn| turn.kind == kind).count()
    }

    /// Whether the target walks before and after each of its stops.
    pub fn stops_on_the_way(&self) -> bool {
        let end_s = |stop: &TargetStop| f64::from(stop.frame) * self.dt_s + stop.duration_s;
        self.stops.iter().all(|stop| stop.frame > 0 && end_s(stop) < self.duration_s)
    }

    /// When the first turn comes; `None` where it comes neither soon nor late.
    pub fn first_turn(&self) -> Option<FirstTurn> {
        let time_s = f64::from(self.turns.first()?.frame) * self.dt_s;
        match time_s {
            soon if soon <= SOON_S.min(SOON_SHARE * self.duration_s) => Some(FirstTurn::Soon),
            late if late >= LATE_S.max(LATE_SHARE * self.duration_s) => Some(FirstTurn::Late),
            _ => None,
        }
    }
}

/// When the first turn of a walk comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FirstTurn {
    /// In the first fifth of the time and the first 6 seconds.
    Soon,
    /// In the second half of the time, after 10 seconds at least.
    Late,
}

/// Reads the facts off a trajectory. An empty one gives zeros.
pub fn facts(trajectory: &Trajectory) -> Facts {
    let track = &trajectory.track;
    let feet: Vec<DVec2> = track.states.iter().map(|state| state.feet_in_world.truncate()).collect();
    let moving: Vec<bool> = track.states.iter().map(|state| state.speed_mps >= STANDING_MPS).collect();
    let way_m = track.length_m();
    let walks = walks(way_m, track.duration_s());
    let path = if walks { Path::of(&feet, &moving, track.dt_s) } else { Path::of(&[], &[], track.dt_s) };
    let facing = track.states.first().map_or(0.0, |state| state.heading_rad);
    let direction = |from_m: f64| Compass::of_yaw_rad(path.direction_rad(from_m, from_m + END_M).unwrap_or(facing));
    let turns = path.turns();
    let steps = moving.len().saturating_sub(1).max(1) as f64;
    let walking_s = track.duration_s() * (moving.iter().skip(1).filter(|moves| **moves).count() as f64 / steps);
    let pairs = || trajectory.poses_in_world.iter().zip(&track.states);
    let count = pairs().count().max(1) as f64;
    Facts {
        walks,
        start_direction: direction(0.0),
        end_direction: direction((path.length_m() - END_M).max(0.0)),
        turns: turns.sure,
        doubtful_turns: turns.doubtful,
        bends: !path.is_straight(),
        dt_s: track.dt_s,
        stops: if walks { stops(&moving, track.dt_s) } else { vec![] },
        duration_s: track.duration_s(),
        way_m,
        walking_speed_mps: if walks && walking_s > 0.0 { way_m / walking_s } else { 0.0 },
        distance_m: pairs().map(|(pose, target)| pose.position_in_world.distance(target.feet_in_world)).sum::<f64>()
            / count,
        pitch_down_deg: -pairs().map(|(pose, _)| pose.pitch_rad.to_degrees()).sum::<f64>() / count,
        altitude_m: pairs().map(|(pose, target)| pose.position_in_world.z - target.feet_in_world.z).sum::<f64>()
            / count,
        visibility: trajectory.visibility.iter().sum::<f64>() / trajectory.visibility.len().max(1) as f64,
        wear: None,
        is_runner: false,
        left_out: None,
    }
}

/// Whether somebody with a speed runs.
pub(crate) fn runs(is_runner: bool, speed_mps: f64) -> bool {
    speed_mps > running_mps(is_runner)
}

/// Pace from which somebody runs, m/s.
pub(crate) fn running_mps(is_runner: bool) -> f64 {
    if is_runner { JOGGING_MPS } else { RUNNING_MPS }
}

/// Whether a way in a time is a walk, be it a short one.
pub(crate) fn walks(way_m: f64, duration_s: f64) -> bool {
    way_m >= LEAST_WALK_M || way_m > 0.0 && way_m >= SLOWEST_WALK_MPS * duration_s
}

/// Runs of standing frames of at least [`LEAST_STOP_S`].
fn stops(moving: &[bool], dt_s: f64) -> Vec<TargetStop> {
    let mut stops = vec![];
    let mut first = 0;
    while first < moving.len() {
        let count = moving[first..].iter().take_while(|moves| !**moves).count();
        let duration_s = count as f64 * dt_s;
        if count > 0 && duration_s >= LEAST_STOP_S - 1e-9 {
            stops.push(TargetStop { frame: first as u32, duration_s });
        }
        first += count.max(1);
    }
    stops
}

#[cfg(test)]
pub(crate) mod test_flights {
    //! Flights with known facts.

    use super::*;
    use cosfly_domain::{Certificate, Limits};
    use cosfly_frames::{DVec3, Pose, TargetState, TargetTrack, real};

    /// A target that goes `count` steps of 0.6 m in each of the yaws (degrees), `None` = stands; a drone
    /// 20 m behind (west of it) and 20 m above.
    pub(crate) fn flight(legs: &[(Option<f64>, usize)]) -> Trajectory {
        let mut states = vec![];
        let (mut feet, mut heading_rad) = (DVec3::new(7.0, -3.0, 1.0), 0.0);
        for &(yaw_deg, count) in legs {
            for _ in 0..count {
                let speed_mps = if yaw_deg.is_some() { 1.2 } else { 0.0 };
                if let Some(yaw_deg) = yaw_deg {
                    heading_rad = yaw_deg.to_radians();
                    let (sin, cos) = real::sin_cos(heading_rad);
                    feet += 0.6 * DVec3::new(cos, sin, 0.0);
                }
                states.push(TargetState { feet_in_world: feet, heading_rad, speed_mps });
            }
        }
        let poses_in_world = states
            .iter()
            .map(|state| {
                let feet: DVec3 = state.feet_in_world;
                Pose::looking_at(feet + DVec3::new(-20.0, 0.0, 20.0), feet)
            })
            .collect();
        let visibility = vec![0.9; states.len()];
        let clearance_m = vec![10.0; states.len()];
        Trajectory {
            track: TargetTrack { dt_s: 0.5, height_m: 1.7, radius_m: 0.25, states },
            poses_in_world,
            visibility,
            clearance_m,
            terms: vec![],
            coverage: vec![],
            labels: vec![],
            convergence: vec![],
            certificate: Certificate {
                limits: Limits { clearance_m: 1.5, speed_mps: 12.0, acceleration_mps2: 6.0, ..Limits::default() },
                holds: true,
                violations: vec![],
                mean_visibility: 0.9,
                frames_half_visible: 1.0,
                min_clearance_m: 10.0,
                max_speed_mps: 1.2,
                max_acceleration_mps2: 0.0,
                max_jerk_mps3: 0.0,
                mean_distance_m: 28.28,
                mean_rear_angle_deg: 0.0,
                length_m: 100.0,
                length_ratio: 1.0,
                iterations: 1,
                filtered_boxes: 1,
                ..Certificate::default()
            },
            perturbation: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::test_flights::flight;
    use super::*;

    #[test]
    fn the_facts_of_a_walk_round_two_corners() {
        let known = facts(&flight(&[
            (Some(-90.0), 40),
            (None, 8),
            (Some(0.0), 40),
            (None, 1),
            (Some(-90.0), 40),
            (None, 3),
            (Some(-90.0), 20),
        ]));
        assert_eq!((known.start_direction, known.end_direction), (Compass::North, Compass::North));
        assert_eq!(known.turns.iter().map(|turn| turn.kind).collect::<Vec<_>>(), [TurnKind::Right, TurnKind::Left]);
        assert_eq!(
            known.stops.iter().map(|stop| (stop.frame, stop.duration_s)).collect::<Vec<_>>(),
            [(40, 4.0), (129, 1.5)]
        );
        assert!((known.duration_s - 75.5).abs() < 1e-9 && (known.way_m - 83.4).abs() < 1e-9);
        assert!((known.distance_m - 800.0_f64.sqrt()).abs() < 1e-9);
        assert!((known.pitch_down_deg - 45.0).abs() < 1e-9 && (known.altitude_m - 20.0).abs() < 1e-9);
        assert!((known.walking_speed_mps - 1.2).abs() < 0.02, "{}", known.walking_speed_mps);
        assert!((known.visibility - 0.9).abs() < 1e-12);
    }

    #[test]
    fn a_target_that_stays_walks_nowhere() {
        let known = facts(&flight(&[(None, 50)]));
        assert_eq!((known.walks, known.start_direction, known.walking_speed_mps), (false, Compass::East, 0.0));
        assert!(known.turns.is_empty() && known.stops.is_empty());
    }

    #[test]
    fn a_short_flight_behind_somebody_who_walks_is_a_walk() {
        let known = facts(&flight(&[(Some(0.0), 2)]));
        assert!(known.walks && known.way_m < LEAST_WALK_M, "{known:?}");
        assert!(walks(0.3, 0.5) && !walks(0.2, 0.5) && walks(1.0, 60.0) && !walks(0.0, 0.0));
    }

    #[test]
    fn an_empty_trajectory_gives_zeros() {
        let known = facts(&flight(&[]));
        assert_eq!((known.distance_m, known.duration_s, known.way_m), (0.0, 0.0, 0.0));
    }
}
