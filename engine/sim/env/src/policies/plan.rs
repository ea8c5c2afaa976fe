//! [`FollowedPlan`]: a planned flight, followed step by step.

use crate::{Action, Environment, VelocityAxes};
use cosfly_drone::Spline;
use cosfly_frames::DVec3;
use std::sync::Arc;

/// Rate at which a drone comes back to its plan, 1/s.
const RETURN: f64 = 1.0;

/// A planned flight, followed step by step.
pub struct FollowedPlan {
    /// Control points of the spline that is flown, world frame, metres; at least one.
    controls: Arc<[DVec3]>,
    /// Time of the first waypoint, seconds.
    begins_s: f64,
    /// Time between waypoints, seconds.
    dt_s: f64,
}

impl FollowedPlan {
    /// A flight through waypoints that begin at a time. Its spline passes them at some centimetres: control points lie as far
    /// outside of each bend as the spline cuts it.
    pub fn through(waypoints: &[DVec3], begins_s: f64, dt_s: f64) -> Self {
        let mut controls: Vec<DVec3> = waypoints.to_vec();
        for (control, around) in controls.iter_mut().skip(1).zip(waypoints.windows(3)) {
            *control -= (around[0] - 2.0 * around[1] + around[2]) / 6.0;
        }
        Self { controls: controls.into(), begins_s, dt_s }
    }

    /// Action that leads along the plan for a step, with the camera aimed at `aim_in_world`, where the target is then. A drone that
    /// is on the plan stays on it exactly, where its limits allow; another one comes back to it.
    pub fn action(&self, environment: &Environment, aim_in_world: DVec3) -> Action {
        let (observation, step_s) = (environment.observation(), environment.settings().step_s);
        let spline = Spline { waypoints: &self.controls, dt_s: self.dt_s };
        let time_s = observation.time_s - self.begins_s;
        let (here, next) = (spline.at(time_s), spline.at(time_s + step_s));
        let velocity = (next.position_in_world - here.position_in_world) / step_s;
        let before = match time_s - step_s {
            before_s if before_s < 0.0 => here.velocity_in_world,
            before_s => (here.position_in_world - spline.at(before_s).position_in_world) / step_s,
        };
        let beside = here.position_in_world - observation.motion.position_in_world;
        Action {
            axes: VelocityAxes::World,
            velocity_mps: velocity + RETURN * beside,
            acceleration_mps2: (velocity - before) / step_s,
            view: environment.gimbal().rates_to(next.position_in_world, aim_in_world, step_s),
            ..Action::default()
        }
    }
}
