//! [`Person`]: one member of a crowd: what is drawn once, and the present state.

use crate::crowd::CrowdConfig;
use crate::kinds::OfKind;
use cosfly_domain::{BodyKind, BodyPlan};
use cosfly_frames::{DVec2, DVec3, RandomStream, Seed, TargetState, real};

/// Largest acceleration that people choose, m/s2.
pub(super) const HARDEST_MPS2: f64 = 2.5;

/// Slower than this, a person stands, m/s.
const STANDING_MPS: f64 = 0.03;

/// Time after which the variation of the own speed is forgotten, seconds.
const TEMPO_S: f64 = 6.0;

/// Fastest turn of a body, rad/s.
const TURN_RAD_PER_S: f64 = 3.0;

/// Slower than this, a person keeps the heading, m/s.
const HEADING_MPS: f64 = 0.15;

/// Who walks slower than this share of the planned speed is blocked, unless that is slow itself, m/s.
const BLOCKED_SHARE: f64 = 0.3;
const BLOCKED_MPS: f64 = 0.3;
/// Time for which a blocked person goes straight on, longest time that counts, seconds; turn of the way on after that, rad/s.
const PATIENCE_S: f64 = 0.6;
const LONGEST_BLOCKED_S: f64 = 2.5;
const YIELDING_RAD_PER_S: f64 = 0.7;

/// Time after which the irregularity of the steps is forgotten, seconds.
const UNEVEN_S: f64 = 1.0;

/// One person of a crowd.
#[derive(Clone, Debug)]
pub(crate) struct Person {
    /// Free speed, m/s.
    pub cruise_mps: f64,
    pub radius_m: f64,
    pub height_m: f64,
    kind: BodyKind,
    /// Own distance to the right of the middle of the way, metres.
    pub side_m: f64,
    /// Number of the company that the person belongs to.
    pub company: usize,
    looks: Seed,
    stream: RandomStream,
    /// Present place in plan, height of the ground, velocity and heading.
    pub at: DVec2,
    pub z: f64,
    pub velocity_mps: DVec2,
    pub heading_rad: f64,
    /// Place in the last frame; the straight way from there to the present place is free.
    pub frame_place: DVec2,
    /// Place that the person walks towards now.
    pub target: DVec2,
    /// Place on the company's route, as an index of its nodes.
    pub progress: usize,
    /// Speed that the person would walk at now without others, m/s: rises and falls at the braking limit.
    pub pace_mps: f64,
    /// Sway to the right, metres, and relative variation of the speed.
    pub sway_m: f64,
    pub tempo: f64,
    /// How long the person has hardly come on, seconds: rises while others are in the way, falls again on the move.
    pub blocked_s: f64,
    /// Irregularity of the velocity, m/s, world axes.
    pub uneven_mps: DVec2,
}

impl Person {
    /// Draws a person who stands at the origin.
    pub fn drawn(config: &CrowdConfig, company: usize, seed: Seed) -> Self {
        let mut stream = seed.stream("person");
        let speed = &config.speed;
        let person = Self {
            cruise_mps: stream.normal(speed.mean_mps, speed.deviation_mps).clamp(speed.min_mps, speed.max_mps),
            height_m: stream.uniform(config.height.min_m, config.height.max_m),
            radius_m: stream.uniform(config.radius.min_m, config.radius.max_m),
            side_m: stream.normal(config.side.mean_m, config.side.deviation_m),
            company,
            kind: BodyKind::Pedestrian,
            looks: seed.child("looks", 0),
            sway_m: stream.normal(0.0, config.side.drift_m),
            tempo: stream.normal(0.0, config.speed_deviation_share),
            blocked_s: 0.0,
            uneven_mps: DVec2::ZERO,
            stream,
            at: DVec2::ZERO,
            z: 0.0,
            velocity_mps: DVec2::ZERO,
            heading_rad: 0.0,
            frame_place: DVec2::ZERO,
            target: DVec2::ZERO,
            progress: 0,
            pace_mps: 0.0,
        };
        person.of_kind(config.kinds.draw(&seed), &seed)
    }

    /// The person with the size and pace of a kind.
    fn of_kind(self, kind: BodyKind, seed: &Seed) -> Self {
        let OfKind { pace, height_m, radius_m } = OfKind::drawn(kind, seed, self.height_m, self.radius_m);
        Self { kind, cruise_mps: self.cruise_mps * pace, height_m, radius_m, ..self }
    }

    /// Whether the person sits and never moves.
    pub fn sits(&self) -> bool {
        self.kind == BodyKind::Sitter
    }

    /// Puts the person at a place.
    pub fn place(&mut self, at: DVec2) {
        (self.at, self.frame_place, self.target) = (at, at, at);
    }

    /// Lets sway, tempo and steps wander on (Ornstein-Uhlenbeck processes).
    pub fn wander(&mut self, config: &CrowdConfig, step_s: f64) {
        let mut wander = |value: &mut f64, deviation: f64, forget_s: f64| {
            let kept = 1.0 / (1.0 + step_s / forget_s);
            *value = *value * kept + deviation * (1.0 - kept * kept).sqrt() * self.stream.normal(0.0, 1.0);
        };
        wander(&mut self.sway_m, config.side.drift_m, config.side.drift_s);
        wander(&mut self.tempo, config.speed_deviation_share, TEMPO_S);
        wander(&mut self.uneven_mps.x, config.step_deviation_mps, UNEVEN_S);
        wander(&mut self.uneven_mps.y, config.step_deviation_mps, UNEVEN_S);
    }

    /// Direction of the way on from the straight one: who is blocked goes to the right, as the others do to theirs.
    pub fn way_on(&mut self, ahead: DVec2, step_s: f64) -> DVec2 {
        let is_blocked = self.velocity_mps.length() < BLOCKED_SHARE * self.pace_mps && self.pace_mps > BLOCKED_MPS;
        let change_s = if is_blocked { step_s } else { -step_s };
        self.blocked_s = (self.blocked_s + change_s).clamp(0.0, LONGEST_BLOCKED_S);
        let turn = (self.blocked_s - PATIENCE_S).max(0.0) * YIELDING_RAD_PER_S;
        let (sin, cos) = real::sin_cos(turn);
        DVec2::new(cos * ahead.x - sin * ahead.y, sin * ahead.x + cos * ahead.y)
    }

    /// Turns the body into the direction of the velocity.
    pub fn turn(&mut self, step_s: f64) {
        if self.velocity_mps.length() > HEADING_MPS {
            let turn = real::atan2(self.velocity_mps.y, self.velocity_mps.x) - self.heading_rad;
            let most = TURN_RAD_PER_S * step_s;
            self.heading_rad = real::wrap_angle_rad(self.heading_rad + real::wrap_angle_rad(turn).clamp(-most, most));
        }
    }

    /// Properties that do not change.
    pub fn plan(&self, group: Option<u32>) -> BodyPlan {
        let outline_m = self.kind.row().walking.as_ref().and_then(|it| it.outline_m);
        let [length_m, width_m] = outline_m.unwrap_or([2.0 * self.radius_m; 2]);
        BodyPlan {
            source: String::new(),
            kind: self.kind,
            size_m: DVec3::new(length_m, width_m, self.height_m),
            looks: self.looks,
            group,
        }
    }

    /// Present state.
    pub fn state(&self) -> TargetState {
        let speed_mps = self.velocity_mps.length();
        TargetState {
            feet_in_world: self.at.extend(self.z),
            heading_rad: self.heading_rad,
            speed_mps: if speed_mps < STANDING_MPS { 0.0 } else { speed_mps },
        }
    }
}
