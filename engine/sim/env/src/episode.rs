//! [`Episode`]: a town, the track of a target, a start.

use crate::others::Others;
use crate::place::FlightSite;
use cosfly_domain::{BodyPlan, Weather};
use cosfly_frames::{DVec3, Pose, Seed, TargetState, TargetTrack};
use cosfly_geometry::SpatialQuery;
use cosfly_surroundings::moving::Encounter;
use cosfly_surroundings::visibility::{BODY_POINTS, aim_point, body_points};
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
    pub place: Arc<FlightSite>,
    /// The target.
    pub target: Arc<TargetTrack>,
    /// Kind, size and looks of a target that is a body of traffic; a person otherwise.
    pub followed: Option<BodyPlan>,
    /// Seed of the target's clothes or paint.
    pub looks: Seed,
    /// Weather of colours; noon under a clear sky where there is none.
    pub weather: Option<Weather>,
    /// Bodies that move around the target.
    pub others: Arc<Others>,
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
        states[frame].toward(&states[(frame + 1).min(last)], share)
    }

    /// Velocity of the target at a time, m/s, world frame.
    pub fn target_velocity(&self, time_s: f64) -> DVec3 {
        let states = &self.target.states;
        let last = states.len().saturating_sub(1);
        let frame = ((time_s / self.target.dt_s).max(0.0) as usize).min(last.saturating_sub(1));
        let between = states.get(frame).zip(states.get(frame + 1));
        between.map_or(DVec3::ZERO, |(from, to)| (to.feet_in_world - from.feet_in_world) / self.target.dt_s)
    }

    /// Way that the target has walked by a time, metres.
    pub fn walked_m(&self, time_s: f64) -> f64 {
        let frames = (time_s / self.target.dt_s).max(0.0) as usize;
        let way_m: f64 = self.target.states.windows(2).take(frames).map(|pair| step_m(&pair[0], &pair[1])).sum();
        let rest_s = time_s - frames as f64 * self.target.dt_s;
        way_m + rest_s.max(0.0) * self.target_velocity(time_s).truncate().length()
    }

    /// Whether the target is a vehicle.
    pub fn is_vehicle(&self) -> bool {
        self.followed.as_ref().is_some_and(|plan| !plan.kind.is_person())
    }

    /// Share of the target's body points that a camera sees at a time, past the town and whoever moves.
    pub fn visible(&self, time_s: f64, camera: DVec3, target: &TargetState) -> f64 {
        let height_m = self.target.height_m;
        let mut hidden = [false; BODY_POINTS];
        self.place.exact.blocked_batch(camera, &body_points(target, height_m), &mut hidden);
        self.others.hide(time_s, camera, target, height_m, &mut hidden);
        hidden.iter().filter(|hidden| !**hidden).count() as f64 / BODY_POINTS as f64
    }

    /// Smallest distance from a followed vehicle of a drone that flies straight from one place to another between two times, capped
    /// at `within_m`.
    pub fn vehicle_clearance_m(&self, times_s: [f64; 2], [from, to]: [DVec3; 2], within_m: f64) -> f64 {
        let vehicle = self.followed.as_ref().filter(|plan| !plan.kind.is_person());
        vehicle.map_or(within_m, |plan| {
            let [here, next] = times_s.map(|time_s| plan.box_at(&self.target_at(time_s)));
            Encounter { here: &here, next: &next, from, to }.clearance_m(within_m)
        })
    }

    /// View of a camera that is aimed at the target from the start.
    pub fn first_view(&self) -> Pose {
        let target = self.target_at(0.0);
        Pose::looking_at(self.start.position_in_world, aim_point(&target, self.target.height_m))
    }
}

fn step_m(from: &TargetState, to: &TargetState) -> f64 {
    from.feet_in_world.truncate().distance(to.feet_in_world.truncate())
}
