//! Joints of a walking person. Places before the person's heading: forward, right, up in body heights.

use crate::BodyFigure;
use crate::body_shape::Posture;
use crate::build::{ArmBearing, Build, head_size};
use cosfly_frames::real;

/// Height of the chin: the head is above.
const CHIN: f64 = 0.865;

/// Share of the swing of the legs, and lean beyond the usual, of stooped people.
const STOOPED: (f64, f64) = (0.65, 0.22);

/// Swing of the legs and bend of the knees relative to those of walkers as fast, and lean, of people who run.
const RUNNING: (f64, f64, f64) = (0.9, 1.5, 0.16);

/// People who run and are held up walk at no more than the first speed; from the second on they run, m/s. Between the two they
/// change over.
const RUNNING_MPS: [f64; 2] = [1.3, 1.8];

/// Forward and up.
pub(crate) type Side = (f64, f64);

/// Limbs of a person, left before right.
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
    pub fn of(figure: &BodyFigure, build: &Build) -> Self {
        let stout = (figure.radius_m / (0.15 * figure.height_m)).clamp(0.8, 1.25);
        let (shoulders, hips) = (build.shoulders * stout, build.hips * stout);
        let swing = 0.5 * (figure.state.speed_mps / 1.3).clamp(0.0, 1.2);
        let (left, right) = (figure.gait_phase_rad, figure.gait_phase_rad + real::PI);
        let posture = figure.body.posture();
        let runs = if posture == Posture::Running { running_share(figure.state.speed_mps) } else { 0.0 };
        let (steps, knees, stoop) = match posture {
            Posture::Stooped => (STOOPED.0, 1.0, STOOPED.1),
            _ => (mix(1.0, RUNNING.0, runs), mix(1.0, RUNNING.1, runs), mix(0.0, RUNNING.2, runs)),
        };
        let (stride, arm_swing) = (steps * swing * build.stride, 0.8 * swing * build.arm_swing + 0.08);
        let right_arm = if figure.body.has_umbrella() { ArmBearing::Holds } else { build.right_arm };
        let arms = match posture {
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
                ArmJoints::of((-1.0, shoulders), right, arm_swing, (arms.0, runs)),
                ArmJoints::of((1.0, shoulders), left, arm_swing, (arms.1, runs)),
            ],
            bearing: Bearing { lean: build.lean + stoop, head: head_size(figure.height_m) },
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
    /// An arm whose shoulder angle is `swing * sin(phase)`, with a bent elbow; or one that is busy; or, by a share, one that runs.
    fn of((side, shoulders): (f64, f64), phase: f64, swing: f64, (arm, runs): (ArmBearing, f64)) -> Self {
        let (angle, bend) = match arm {
            ArmBearing::Swings => (swing * real::sin(phase), 0.25 + 0.5 * swing),
            ArmBearing::Pocket => (-0.25 + 0.1 * swing * real::sin(phase), 0.55),
            ArmBearing::Holds => (0.15 + 0.1 * swing * real::sin(phase), 2.0),
            ArmBearing::Leads => (0.25 + 0.2 * swing * real::sin(phase), 0.5),
            ArmBearing::Pushes => (0.55, 0.6),
        };
        let (angle, bend) = (mix(angle, 1.2 * swing * real::sin(phase), runs), mix(bend, 1.5, runs));
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

/// How far somebody of a speed runs: 0 walks, 1 runs.
fn running_share(speed_mps: f64) -> f64 {
    let share = ((speed_mps - RUNNING_MPS[0]) / (RUNNING_MPS[1] - RUNNING_MPS[0])).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

/// Exactly `of_none` at a share of 0, `of_all` at 1.
fn mix(of_none: f64, of_all: f64, share: f64) -> f64 {
    if share > 0.0 { (1.0 - share) * of_none + share * of_all } else { of_none }
}

/// The point `length` below `(forward, up)`, turned forward by an angle.
fn reach((forward, up): Side, angle_rad: f64, length: f64) -> Side {
    let (sin, cos) = real::sin_cos(angle_rad);
    (forward + length * sin, up - length * cos)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::BodyShape;
    use cosfly_frames::{DVec3, Seed, TargetState};

    /// Lean, and height of the left hand and knee, of somebody in the middle of a step.
    fn bearing(posture: Posture, speed_mps: f64) -> [f64; 3] {
        let figure = BodyFigure {
            state: TargetState { feet_in_world: DVec3::ZERO, heading_rad: 0.0, speed_mps },
            height_m: 1.75,
            radius_m: 0.25,
            clothes_seed: Seed([4; 32]),
            gait_phase_rad: 0.6,
            body: BodyShape::Person { umbrella: false, posture },
        };
        let limbs = Limbs::of(&figure, &Build::draw(&figure.clothes_seed));
        [limbs.bearing.lean, limbs.arms[0].hand.1, limbs.legs[0].knee.1]
    }

    #[test]
    fn runners_who_are_held_up_walk_and_change_over_gently() {
        for speed_mps in [0.0, 0.6, 1.0, 1.3] {
            assert_eq!(bearing(Posture::Running, speed_mps), bearing(Posture::Upright, speed_mps), "{speed_mps} m/s");
        }
        let [walks, runs] = [Posture::Upright, Posture::Running].map(|posture| bearing(posture, 1.8));
        assert!(runs[0] > walks[0] + 0.15 && runs[1] > walks[1] + 0.05, "{walks:?} {runs:?}");
        let speeds = (0..=300).map(|step| bearing(Posture::Running, 0.01 * f64::from(step)));
        let steps: Vec<[f64; 3]> = speeds.collect();
        for pair in steps.windows(2) {
            let jump = (0..3).map(|part| (pair[1][part] - pair[0][part]).abs()).fold(0.0, f64::max);
            assert!(jump < 0.02, "{pair:?}");
        }
    }
}
