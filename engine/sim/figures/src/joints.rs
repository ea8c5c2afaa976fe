//! Joints of a walking person. Places before the person's heading: forward, right, up in body heights.

use crate::Walker;
use crate::body_shape::Posture;
use crate::build::{ArmBearing, Build, head_size};
use cosfly_frames::real;

/// Height of the chin: the head is above.
const CHIN: f64 = 0.865;

/// Share of the swing of the legs, and lean beyond the usual, of stooped people.
const STOOPED: (f64, f64) = (0.65, 0.22);

/// Swing of the legs and bend of the knees relative to those of walkers as fast, and lean, of people who run.
const RUNNING: (f64, f64, f64) = (0.9, 1.5, 0.16);

/// Forward and up.
pub(crate) type Side = (f64, f64);

/// Limbs of a walker, left before right.
pub(crate) struct Limbs {
    /// Widths relative to the usual.
    pub shoulders: f64,
    pub hips: f64,
    pub legs: [LegJoints; 2],
    pub arms: [ArmJoints; 2],
    pub bearing: Bearing,
}

pub(crate) struct LegJoints {
    pub right: f64,
    pub hip: Side,
    pub knee: Side,
    pub ankle: Side,
}

pub(crate) struct ArmJoints {
    /// Places to the right: at the shoulder, at the elbow, of wrist and hand, and of the top of the sleeve.
    pub right: f64,
    pub out: f64,
    pub far: f64,
    pub tip: f64,
    pub shoulder: Side,
    pub elbow: Side,
    pub wrist: Side,
    pub hand: Side,
}

/// Lean of the trunk, and size of the head relative to a grown person's: the neck moves down by what the head takes.
pub(crate) struct Bearing {
    lean: f64,
    pub head: f64,
}

impl Limbs {
    pub fn of(walker: &Walker, build: &Build) -> Self {
        let stout = (walker.radius_m / (0.15 * walker.height_m)).clamp(0.8, 1.25);
        let (shoulders, hips) = (build.shoulders * stout, build.hips * stout);
        let swing = 0.5 * (walker.state.speed_mps / 1.3).clamp(0.0, 1.2);
        let (left, right) = (walker.gait_phase_rad, walker.gait_phase_rad + real::PI);
        let posture = walker.body.posture();
        let is_fast = posture == Posture::Running && walker.state.speed_mps > 0.5;
        let (steps, knees, stoop) = match posture {
            Posture::Stooped => (STOOPED.0, 1.0, STOOPED.1),
            Posture::Running if is_fast => RUNNING,
            _ => (1.0, 1.0, 0.0),
        };
        let (stride, arm_swing) = (steps * swing * build.stride, 0.8 * swing * build.arm_swing + 0.08);
        let right_arm = if walker.body.has_umbrella() { ArmBearing::Holds } else { build.right_arm };
        let (left_arm, right_arm) = match posture {
            Posture::Running if is_fast => (ArmBearing::Runs, ArmBearing::Runs),
            Posture::Upright | Posture::Running => (ArmBearing::Swings, right_arm),
            Posture::Stooped => (ArmBearing::Leads, right_arm),
            Posture::Pushing => (ArmBearing::Pushes, ArmBearing::Pushes),
            Posture::Leading => (ArmBearing::Swings, ArmBearing::Leads),
        };
        Self {
            shoulders,
            hips,
            legs: [
                LegJoints::of(-0.047 * hips, left, stride, knees),
                LegJoints::of(0.047 * hips, right, stride, knees),
            ],
            arms: [
                ArmJoints::of((-1.0, shoulders), right, arm_swing, left_arm),
                ArmJoints::of((1.0, shoulders), left, arm_swing, right_arm),
            ],
            bearing: Bearing { lean: build.lean + stoop, head: head_size(walker.height_m) },
        }
    }
}

impl LegJoints {
    /// A leg whose hip angle is `swing * sin(phase)`, with the knee bent while it comes forward.
    fn of(right: f64, phase: f64, swing: f64, knees: f64) -> Self {
        let hip_angle = swing * real::sin(phase);
        let knee_angle = swing * 1.3 * knees * real::sin(phase + 0.5 * real::PI).max(0.0);
        let hip = (0.0, 0.49);
        let knee = reach(hip, hip_angle, 0.235);
        let ankle = reach(knee, hip_angle - knee_angle, 0.225);
        Self { right, hip, knee, ankle }
    }
}

impl ArmJoints {
    /// An arm whose shoulder angle is `swing * sin(phase)`, with a bent elbow; or one that is busy.
    fn of((side, shoulders): (f64, f64), phase: f64, swing: f64, arm: ArmBearing) -> Self {
        let (angle, bend) = match arm {
            ArmBearing::Swings => (swing * real::sin(phase), 0.25 + 0.5 * swing),
            ArmBearing::Pocket => (-0.25 + 0.1 * swing * real::sin(phase), 0.55),
            ArmBearing::Holds => (0.15 + 0.1 * swing * real::sin(phase), 2.0),
            ArmBearing::Leads => (0.25 + 0.2 * swing * real::sin(phase), 0.5),
            ArmBearing::Runs => (1.2 * swing * real::sin(phase), 1.5),
            ArmBearing::Pushes => (0.55, 0.6),
        };
        let right = side * (0.112 * shoulders + 0.014);
        let shoulder = (0.0, 0.815);
        let elbow = reach(shoulder, angle, 0.165);
        let wrist = reach(elbow, angle + bend, 0.15);
        let hand = reach(wrist, angle + bend + 0.05, 0.05);
        let (out, far, tip) = (right + side * 0.010, right + side * 0.012, right - side * 0.016);
        Self { right, out, far, tip, shoulder, elbow, wrist, hand }
    }
}

impl Bearing {
    /// Place of a point of the upright figure.
    pub fn bear(&self, (forward, up): Side) -> Side {
        let below = (1.0 - (1.0 - CHIN) * self.head) / CHIN;
        let forward = forward + self.lean * (up - 0.49).max(0.0);
        (forward, if up < CHIN { up * below } else { 1.0 - (1.0 - up) * self.head })
    }
}

/// The point `length` below `(forward, up)`, turned forward by an angle.
fn reach((forward, up): Side, angle_rad: f64, length: f64) -> Side {
    let (sin, cos) = real::sin_cos(angle_rad);
    (forward + length * sin, up - length * cos)
}
