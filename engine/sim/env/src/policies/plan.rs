//! [`Plan`]: a planned flight, followed step by step.

use crate::{Action, Axes, Environment};
use cosfly_drone::Spline;
use cosfly_frames::DVec3;
use std::sync::Arc;

/// A planned flight, followed step by step.
pub struct Plan {
    /// Control points of the spline that is flown, world frame, metres; at least one.
    controls: Arc<[DVec3]>,
    /// Time of the first waypoint, seconds.
    begins_s: f64,
    /// Time between waypoints, seconds.
    dt_s: f64,
}

impl Plan {
    /// A flight through waypoints that begin at a time. Its spline passes them at some centimetres: control points lie as far
    /// outside of each bend as the spline cuts it.
    pub fn through(waypoints: &[DVec3], begins_s: f64, dt_s: f64) -> Self {
        let mut controls: Vec<DVec3> = waypoints.to_vec();
        for (control, around) in controls.iter_mut().skip(1).zip(waypoints.windows(3)) {
            *control -= (around[0] - 2.0 * around[1] + around[2]) / 6.0;
        }
        Self { controls: controls.into(), begins_s, dt_s }
    }

    /// Action that leads to the place of the plan one step ahead, with the camera aimed at `aim_in_world`, where the target is
    /// then.
    pub fn action(&self, environment: &Environment, aim_in_world: DVec3) -> Action {
        let (observation, settings) = (environment.observation(), environment.settings());
        let spline = Spline { waypoints: &self.controls, dt_s: self.dt_s };
        let next_s = observation.time_s + settings.step_s;
        let next = spline.at(next_s - self.begins_s).position_in_world;
        let motion = &observation.motion;
        let velocity = (next - motion.position_in_world) / settings.step_s;
        let change = (velocity - motion.velocity_in_world) / settings.step_s;
        Action {
            axes: Axes::World,
            velocity_mps: velocity,
            acceleration_mps2: change,
            view: environment.gimbal().rates_to(next, aim_in_world, settings.step_s),
        }
    }
}
