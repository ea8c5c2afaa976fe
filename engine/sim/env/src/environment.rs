//! [`Environment`]: flies an episode, action by action.

use crate::action::Action;
use crate::craft::{Changes, Craft};
use crate::episode::Episode;
use crate::observation::{Observation, TargetSighting};
use crate::others::BodyAtTime;
use crate::reward::Reward;
use crate::score::{End, EpisodeScore};
use crate::settings::EnvironmentSettings;
use cosfly_drone::quadrotor::TrackingError;
use cosfly_drone::{Gimbal, Motion, Sensed};
use cosfly_frames::{DMat3, Pose, TargetState, real};
use cosfly_geometry::SpatialQuery;
use cosfly_sensors::Airframe;
use cosfly_surroundings::visibility::aim_point;
use std::sync::Arc;

/// Slack for the comparison of times, seconds.
const ROUNDING_S: f64 = 1e-9;

/// Result of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Observation after the step.
    pub observation: Observation,
    /// Reward of the step, by terms.
    pub reward: Reward,
    /// Why the episode ended in this step.
    pub end: Option<End>,
}

/// An action on its way to the drone.
#[derive(Clone, Copy)]
struct Answer {
    arrives_s: f64,
    action: Action,
}

/// Flies an episode, action by action.
#[derive(Clone)]
pub struct Environment {
    settings: EnvironmentSettings,
    episode: Arc<Episode>,
    drone: Craft,
    gimbal: Gimbal,
    /// Beginnings and ends of stretches in which the camera sees nothing, seconds.
    blackouts: Arc<[[f64; 2]]>,
    /// The action in force.
    action: Action,
    answer: Option<Answer>,
    observation: Observation,
    /// Changes in the last step.
    changes: Changes,
    /// Distance that the target covered so far, metres.
    target_covered_m: f64,
    score: EpisodeScore,
}

impl Environment {
    /// The beginning of an episode.
    pub fn new(episode: Arc<Episode>, settings: EnvironmentSettings) -> Self {
        let (first, start) = (episode.first_view(), episode.start);
        let motion = Motion {
            position_in_world: start.position_in_world,
            velocity_in_world: start.velocity_in_world,
            ..Motion::default()
        };
        let gimbal = Gimbal { yaw_rad: first.yaw_rad, pitch_rad: first.pitch_rad, limits: settings.gimbal };
        let drone = Craft::new(&settings, &episode, motion, gimbal.yaw_rad);
        let action = coasting(&motion);
        let target = episode.target_at(0.0);
        let sighting = TargetSighting { time_s: 0.0, target, velocity_in_world: episode.target_velocity(0.0) };
        let observation = Observation {
            step: 0,
            time_s: 0.0,
            motion,
            yaw_rad: gimbal.yaw_rad,
            pitch_rad: gimbal.pitch_rad,
            above_ground_m: episode.place.above_ground_m(motion.position_in_world),
            visible: 0.0,
            in_picture: true,
            tracked: true,
            sighting,
        };
        let blackouts = settings.blackouts.drawn(&episode.seed, episode.target.duration_s());
        let score = EpisodeScore { planned_steps: episode.steps(settings.step_s), ..EpisodeScore::default() };
        let (answer, changes, target_covered_m) = (None, Changes::default(), 0.0);
        let mut new = Self {
            settings,
            episode,
            drone,
            gimbal,
            blackouts,
            action,
            answer,
            observation,
            changes,
            target_covered_m,
            score,
        };
        new.observe(target, &new.camera().world_from_body());
        new
    }

    /// Begins an episode anew.
    pub fn reset(&mut self, episode: Arc<Episode>) -> &Observation {
        *self = Self::new(episode, self.settings);
        &self.observation
    }

    /// The present observation.
    pub fn observation(&self) -> &Observation {
        &self.observation
    }

    /// The outcome so far.
    pub fn score(&self) -> &EpisodeScore {
        &self.score
    }

    /// The episode.
    pub fn episode(&self) -> &Arc<Episode> {
        &self.episode
    }

    /// The settings.
    pub fn settings(&self) -> &EnvironmentSettings {
        &self.settings
    }

    /// Number of bodies that a policy may take for the target: of its kind, in the same clothes, their middles in the picture and
    /// nearer than a target that is tracked may be, with no obstacle of the town before them.
    pub fn look_alikes(&self) -> usize {
        let (camera, settings, place) = (self.camera(), &self.settings, &self.episode.place);
        let eye = camera.position_in_world;
        let is_seen = |present: &BodyAtTime<'_>| {
            let middle = aim_point(&present.state, present.body.plan.size_m.z);
            let is_near = eye.distance(middle) <= settings.farthest_m;
            is_near && settings.lens.shows(&camera, middle) && !place.exact.blocked(eye, middle)
        };
        self.episode.others.look_alikes(self.observation.time_s).filter(is_seen).count()
    }

    /// Distance that the target covered so far, metres.
    pub fn target_covered_m(&self) -> f64 {
        self.target_covered_m
    }

    /// Pose of the camera.
    pub fn camera(&self) -> Pose {
        self.gimbal.pose(self.drone.motion().position_in_world)
    }

    /// The camera's turns.
    pub fn gimbal(&self) -> &Gimbal {
        &self.gimbal
    }

    /// How well a quadrotor could do what it was asked for; `None` of a point mass.
    pub fn tracking_error(&self) -> Option<&TrackingError> {
        self.drone.tracking_error()
    }

    /// Attitude of a quadrotor: x, y, z, w of the rotation from its right-handed axes (x ahead, y left, z up) to those of the world
    /// with y negated; `None` of a point mass.
    pub fn attitude_xyzw(&self) -> Option<[f64; 4]> {
        self.drone.attitude_xyzw()
    }

    /// The body of the drone now. That of a point mass is of a quadrotor that flies its acceleration and the mean jerk of the last step.
    pub fn airframe(&self) -> Airframe {
        self.drone.airframe(&self.changes, self.gimbal.yaw_rad)
    }

    /// Samples of the sensors of a quadrotor, by time; nothing without sensors.
    pub fn sensed(&self) -> &[Sensed] {
        self.drone.sensed()
    }

    /// Whether the camera sees nothing now.
    pub fn is_blind(&self) -> bool {
        let now_s = self.observation.time_s;
        self.blackouts.iter().any(|[begins_s, ends_s]| (*begins_s..*ends_s).contains(&now_s))
    }

    /// Whether the policy is free to answer the present observation; false while its last answer is on its way.
    pub fn wants_action(&self) -> bool {
        self.answer.is_none() && self.score.end.is_none()
    }

    /// Moves on by one step. An action that is given while another is on its way is dropped. After the end nothing moves.
    pub fn step(&mut self, action: Option<&Action>) -> Step {
        self.step_late(action, self.settings.latency_s)
    }

    /// Step like [`Self::step`], with a latency of this action's own, seconds.
    pub fn step_late(&mut self, action: Option<&Action>, latency_s: f64) -> Step {
        if self.score.end.is_some() {
            return Step { observation: self.observation, reward: Reward::default(), end: self.score.end };
        }
        let begins_s = self.observation.time_s;
        if let (Some(&action), true) = (action, self.wants_action()) {
            self.answer = Some(Answer { arrives_s: begins_s + latency_s, action });
        }
        let (before, yaw_rad) = (self.drone.motion(), self.gimbal.yaw_rad);
        self.observation.step += 1;
        let ends_s = f64::from(self.observation.step) * self.settings.step_s;
        self.observation.time_s = ends_s;
        let mut touched = false;
        let mut now_s = begins_s;
        if let Some(Answer { arrives_s, action }) = self.answer.filter(|answer| answer.arrives_s < ends_s - ROUNDING_S)
        {
            if arrives_s > now_s + ROUNDING_S {
                touched |= self.fly(now_s, arrives_s);
                now_s = arrives_s;
            }
            (self.action, self.answer) = (action, None);
        }
        touched |= self.fly(now_s, ends_s);
        if let Some(Answer { action, .. }) = self.answer.filter(|answer| answer.arrives_s <= ends_s + ROUNDING_S) {
            (self.action, self.answer) = (action, None);
        }
        let bent = self.drone.motion().acceleration_in_world - before.acceleration_in_world;
        self.changes = Changes {
            jerk_in_world: bent / self.settings.step_s,
            yaw_rate_rad_s: real::wrap_angle_rad(self.gimbal.yaw_rad - yaw_rad) / self.settings.step_s,
        };
        let target = self.episode.target_at(ends_s);
        let step = target.feet_in_world - self.episode.target_at(begins_s).feet_in_world;
        self.target_covered_m += step.length();
        touched |= self.touches(&target);
        let world_from_camera = self.camera().world_from_body();
        self.observe(target, &world_from_camera);
        let reward = self.judge(&before, &target, &world_from_camera, touched);
        Step { observation: self.observation, reward, end: self.score.end }
    }

    /// Ends the episode in its last step by a collision with something that the episode does not know, such as another drone.
    /// Whether the episode did not end by a collision already.
    pub fn collide(&mut self) -> bool {
        if self.score.end == Some(End::Collision) {
            return false;
        }
        self.score.end = Some(End::Collision);
        self.score.reward_sum -= self.settings.weights.collision;
        true
    }

    /// Flies on with the action in force; whether something is touched on the way.
    fn fly(&mut self, from_s: f64, to_s: f64) -> bool {
        let from = self.drone.motion().position_in_world;
        self.drone.step(&self.action, self.gimbal.yaw_rad, to_s - from_s);
        self.gimbal.step(&self.action.view, to_s - from_s);
        let (to, radius_m, episode) = (self.drone.motion().position_in_world, self.settings.radius_m, &self.episode);
        let above_m = episode.place.above_ground_m(to);
        self.observation.above_ground_m = above_m;
        episode.place.collides([from, to], above_m, radius_m)
            || episode.others.clearance_m([from_s, to_s], [from, to], radius_m) < radius_m
            || episode.vehicle_clearance_m([from_s, to_s], [from, to], radius_m) < radius_m
    }

    /// Whether a target on foot is touched.
    fn touches(&self, target: &TargetState) -> bool {
        let away = self.drone.motion().position_in_world - target.feet_in_world;
        let (radius_m, track) = (self.settings.radius_m, &self.episode.target);
        !self.episode.is_vehicle()
            && away.z < track.height_m + radius_m
            && away.truncate().length() < track.radius_m + radius_m
    }

    /// Fills the observation from the present state, but the height above ground.
    fn observe(&mut self, target: TargetState, world_from_camera: &DMat3) {
        let is_blind = self.is_blind();
        let (episode, settings) = (&self.episode, &self.settings);
        let position = self.drone.motion().position_in_world;
        let height_m = episode.target.height_m;
        let observation = &mut self.observation;
        (observation.motion, observation.yaw_rad) = (self.drone.motion(), self.gimbal.yaw_rad);
        observation.pitch_rad = self.gimbal.pitch_rad;
        observation.visible = episode.visible(observation.time_s, position, &target);
        let seen = world_from_camera.transpose() * (aim_point(&target, height_m) - position);
        observation.in_picture = !is_blind && settings.lens.holds(seen);
        let is_near = position.distance(target.feet_in_world) <= settings.farthest_m;
        observation.tracked = observation.visible >= settings.least_visible && observation.in_picture && is_near;
        if observation.tracked {
            let velocity_in_world = episode.target_velocity(observation.time_s);
            observation.sighting = TargetSighting { time_s: observation.time_s, target, velocity_in_world };
        }
    }

    /// Counts the step.
    fn judge(&mut self, before: &Motion, target: &TargetState, world_from_camera: &DMat3, touched: bool) -> Reward {
        let (settings, observation, score) = (&self.settings, &self.observation, &mut self.score);
        let motion = self.drone.motion();
        score.count(observation.tracked, settings.step_s);
        let distance_m = motion.position_in_world.distance(target.feet_in_world);
        let seen = aim_point(target, self.episode.target.height_m) - motion.position_in_world;
        let off_rad = real::acos((world_from_camera.x_axis.dot(seen) / seen.length().max(1e-9)).clamp(-1.0, 1.0));
        let share = motion.acceleration_in_world.length() / settings.motion.acceleration_mps2;
        let reward = Reward {
            visibility: if observation.in_picture { observation.visible } else { 0.0 },
            framing: -(off_rad / (0.5 * settings.lens.horizontal_deg.to_radians())).min(1.0),
            distance: Reward::outside_band(distance_m, settings),
            effort: -share * share,
            collision: -f64::from(touched),
            loss: -f64::from(!observation.tracked),
        };
        score.visible_sum += observation.visible;
        score.distance_sum_m += distance_m;
        score.in_band_steps += u32::from(reward.distance == 0.0);
        let jerk = (motion.acceleration_in_world - before.acceleration_in_world).length() / settings.step_s;
        score.jerk_sum_mps3 += jerk;
        score.reward_sum += reward.sum(&settings.weights);
        score.end = if touched {
            Some(End::Collision)
        } else if score.untracked_s >= settings.give_up_s - ROUNDING_S {
            Some(End::Lost)
        } else {
            (score.steps >= score.planned_steps).then_some(End::Finished)
        };
        reward
    }
}

/// The action that keeps a velocity.
fn coasting(motion: &Motion) -> Action {
    Action { axes: crate::VelocityAxes::World, velocity_mps: motion.velocity_in_world, ..Action::default() }
}
