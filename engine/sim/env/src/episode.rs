//! [`Episode`]: a town, the track of a target, a start.

use crate::place::Place;
use cosfly_frames::{DVec3, Pose, Seed, TargetState, TargetTrack, real};
use cosfly_planner::aim_point;
use std::sync::Arc;

/// State of the drone at the beginning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// Position, world frame, metres.
    pub position_in_world: DVec3,
    /// Velocity, world frame, m/s.
    pub velocity_in_world: DVec3,
}

/// A town, the track of a target, a start.
#[derive(Clone)]
pub struct Episode {
    /// Name of the episode in its suite.
    pub name: String,
    /// Group of the episode in tables.
    pub stratum: String,
    /// Surroundings.
    pub place: Arc<Place>,
    /// The target.
    pub target: Arc<TargetTrack>,
    /// State of the drone at the beginning; the camera is aimed at the target.
    pub start: Start,
    /// Seed of what is drawn while the episode runs.
    pub seed: Seed,
}

impl Episode {
    /// Number of steps of `step_s` seconds until the target's track ends.
    pub fn steps(&self, step_s: f64) -> u32 {
        (self.target.duration_s() / step_s + 1e-9) as u32
    }

    /// The target at a time, seconds from its first frame: between frames on the straight line, beyond its ends there.
    pub fn target_at(&self, time_s: f64) -> TargetState {
        let states = &self.target.states;
        let Some(last) = states.len().checked_sub(1) else {
            return TargetState { feet_in_world: DVec3::ZERO, heading_rad: 0.0, speed_mps: 0.0 };
        };
        let place = (time_s / self.target.dt_s).clamp(0.0, last as f64);
        let (frame, share) = (place as usize, place.fract());
        let (from, to) = (&states[frame], &states[(frame + 1).min(last)]);
        let turn = real::wrap_angle_rad(to.heading_rad - from.heading_rad);
        TargetState {
            feet_in_world: from.feet_in_world.lerp(to.feet_in_world, share),
            heading_rad: real::wrap_angle_rad(from.heading_rad + share * turn),
            speed_mps: from.speed_mps + share * (to.speed_mps - from.speed_mps),
        }
    }

    /// Velocity of the target at a time, m/s, world frame.
    pub fn target_velocity(&self, time_s: f64) -> DVec3 {
        let states = &self.target.states;
        let last = states.len().saturating_sub(1);
        let frame = ((time_s / self.target.dt_s).max(0.0) as usize).min(last.saturating_sub(1));
        let between = states.get(frame).zip(states.get(frame + 1));
        between.map_or(DVec3::ZERO, |(from, to)| (to.feet_in_world - from.feet_in_world) / self.target.dt_s)
    }

    /// View of a camera that is aimed at the target from the start.
    pub fn first_view(&self) -> Pose {
        let target = self.target_at(0.0);
        Pose::looking_at(self.start.position_in_world, aim_point(&target, self.target.height_m))
    }
}
