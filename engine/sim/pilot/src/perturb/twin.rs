//! The perturbed twin of an expert flight: one that a drone could fly, or the paper's two independent events per frame, with
//! safe displacements (paper, section "Dual-Trajectory Augmentation").

use super::config::PerturbConfig;
use super::displacement::{Corridor, free_offset, horizontal_offset};
use super::flyable;
use cosfly_domain::{FramePerturbation, Perturbation, PerturbationKind, PlanOutcome, Trajectory};
use cosfly_frames::{DVec3, Pose, real};
use cosfly_planner::certificate::{certify, view_rates_deg_s};
use cosfly_planner::config::limits::LimitsConfig;
use cosfly_planner::config::muco::MucoConfig;
use cosfly_random::{RandomStream, Seed};
use cosfly_surroundings::exact::ExactMap;
use cosfly_surroundings::visibility::aim_point;

/// Steepest pitch of a turned view, radians (89.9 degrees): at 90 a pose has no unique yaw.
const STEEPEST_PITCH_RAD: f64 = 89.9 * (real::PI / 180.0);

/// The perturbed twin of `expert`, of the kind that the seed draws from the mixture; [`Mixture::of_flight`] leaves one kind.
///
/// [`Mixture::of_flight`]: super::mixture::Mixture::of_flight
///
/// Twins of all kinds but `jumps` could be flown: the certificate states their limits of speed and acceleration; a
/// displacement that would break them, or that comes too near to an obstacle, still or moving, is made smaller, smoothly in time.
///
/// Kind `jumps`: with probability `position_probability` the drone is displaced and aims at a displaced point; independently,
/// with probability `rotation_probability`, its view is turned. A displacement that would come nearer to an obstacle than
/// `clearance_m`, there or on the way from the frame before or to the expert's next position, is drawn again, then
/// shortened, at last zero; the event stays recorded with the displacement that was flown. So the swept path of the
/// twin keeps `clearance_m` wherever the expert does.
///
/// Frames without events are the expert's, to the bit. `terms` is empty: costs belong to the expert's optimisation.
/// The certificate states infinite kinematic limits.
///
/// Rejected are only a config that breaks its rules, an expert whose frames do not match its track, and a twin that
/// touches an obstacle, which takes an expert that does.
pub fn perturb(
    expert: &Trajectory,
    expert_item: &str,
    map: ExactMap<'_>,
    config: &PerturbConfig,
    seed: Seed,
) -> PlanOutcome {
    let rejected = |reason: String| PlanOutcome::Rejected { track: expert.track.clone(), reason };
    if let Err((_, rule)) = config.validate() {
        return rejected(rule);
    }
    let count = expert.track.len();
    if expert.poses_in_world.len() != count {
        return rejected(format!("the expert has {} poses for {count} frames", expert.poses_in_world.len()));
    }
    let kind = config.mixture.draw(&seed);
    let (poses, frames) = match kind {
        PerturbationKind::Jumps => jumps(expert, map, config, &seed),
        _ => flyable::twin(expert, kind, map, config, &seed),
    };
    let probability = |probability| if kind == PerturbationKind::Jumps { probability } else { 0.0 };
    let perturbation = Perturbation {
        expert_item: expert_item.to_owned(),
        kind,
        position_probability: probability(config.position_probability),
        rotation_probability: probability(config.rotation_probability),
        frames,
    };
    let twin = measured(expert, poses, perturbation, map, config);
    match twin.certificate.min_clearance_m {
        free if free > 0.0 => PlanOutcome::Planned(Box::new(twin)),
        touching => rejected(format!("the twin comes to {touching:.2} m from an obstacle, as its expert does")),
    }
}

/// Poses and events of kind `jumps`.
fn jumps(
    expert: &Trajectory,
    map: ExactMap<'_>,
    config: &PerturbConfig,
    seed: &Seed,
) -> (Vec<Pose>, Vec<FramePerturbation>) {
    let count = expert.track.len();
    let mut frames = Vec::with_capacity(count);
    let mut poses: Vec<Pose> = Vec::with_capacity(count);
    let (mut position_events, mut rotation_events) = (seed.stream("position event"), seed.stream("rotation event"));
    for frame in 0..count {
        let mut applied = FramePerturbation {
            position: position_events.chance(config.position_probability),
            rotation: rotation_events.chance(config.rotation_probability),
            drone_offset_in_world: DVec3::ZERO,
            aim_offset_in_world: DVec3::ZERO,
            pitch_offset_rad: 0.0,
            yaw_offset_rad: 0.0,
            expert_frame: frame as u32,
        };
        let before = poses.last().map(|pose| pose.position_in_world);
        let own = seed.child("frame", frame as u64);
        let pose = perturbed(expert, frame, before, map, config, &own, &mut applied);
        poses.push(pose);
        frames.push(applied);
    }
    (poses, frames)
}

/// The pose of a frame after the events that `applied` names, whose displacements and turns are written there.
fn perturbed(
    expert: &Trajectory,
    frame: usize,
    before: Option<DVec3>,
    map: ExactMap<'_>,
    config: &PerturbConfig,
    own: &Seed,
    applied: &mut FramePerturbation,
) -> Pose {
    let mut pose = expert.poses_in_world[frame];
    if applied.position {
        let corridor = Corridor {
            map,
            frame,
            clearance_m: config.clearance_m,
            lowest_z_m: expert.track.states[frame].feet_in_world.z + config.min_height_m,
            before,
            after: expert.poses_in_world.get(frame + 1).map(|pose| pose.position_in_world),
        };
        applied.drone_offset_in_world =
            free_offset(&corridor, pose.position_in_world, &config.drone_offset, own.stream("drone"));
        applied.aim_offset_in_world = horizontal_offset(&config.aim_offset, own.stream("aim"));
        pose = displaced(pose, expert, frame, applied);
    }
    if applied.rotation {
        turn(&mut pose, applied, config, own.stream("rotation"));
    }
    pose
}

/// The pose from the displaced position towards the displaced aim. The undisplaced aim is the point of the expert's
/// own line of sight abreast of the target, so that zero displacements give the expert's view.
fn displaced(expert_pose: Pose, expert: &Trajectory, frame: usize, applied: &FramePerturbation) -> Pose {
    let position = expert_pose.position_in_world;
    let forward = expert_pose.world_from_body() * DVec3::X;
    let ahead_m = (aim_point(&expert.track.states[frame], expert.track.height_m) - position).dot(forward).max(1.0);
    let aim = position + ahead_m * forward + applied.aim_offset_in_world;
    Pose { roll_rad: expert_pose.roll_rad, ..Pose::looking_at(position + applied.drone_offset_in_world, aim) }
}

/// Turns the view by an angle uniform in 0..=max, split into pitch and yaw by a uniform direction. The pitch stops at
/// [`STEEPEST_PITCH_RAD`]; what was turned is recorded, not what was drawn.
fn turn(pose: &mut Pose, applied: &mut FramePerturbation, config: &PerturbConfig, mut stream: RandomStream) {
    let angle = stream.uniform(0.0, config.max_rotation_deg.to_radians());
    let (sin, cos) = real::sin_cos(stream.uniform(-real::PI, real::PI));
    let pitch_rad = (pose.pitch_rad + sin * angle).clamp(-STEEPEST_PITCH_RAD, STEEPEST_PITCH_RAD);
    applied.pitch_offset_rad = pitch_rad - pose.pitch_rad;
    applied.yaw_offset_rad = cos * angle;
    pose.pitch_rad = pitch_rad;
    pose.yaw_rad = real::wrap_angle_rad(pose.yaw_rad + applied.yaw_offset_rad);
}

/// The twin with visibility, clearance and certificate measured anew.
pub(super) fn measured(
    expert: &Trajectory,
    poses: Vec<Pose>,
    perturbation: Perturbation,
    map: ExactMap<'_>,
    config: &PerturbConfig,
) -> Trajectory {
    let positions: Vec<DVec3> = poses.iter().map(|pose| pose.position_in_world).collect();
    let flyable = Some(&config.flyable).filter(|_| perturbation.kind.is_flyable());
    let limits = LimitsConfig {
        clearance_m: config.clearance_m,
        speed_mps: flyable.map_or(f64::INFINITY, |limits| limits.max_speed_mps),
        acceleration_mps2: flyable.map_or(f64::INFINITY, |limits| limits.max_acceleration_mps2),
        jerk_mps3: f64::INFINITY,
        yaw_rate_deg_s: Some(f64::INFINITY),
        pitch_rate_deg_s: Some(f64::INFINITY),
        require_kinematics: false,
    };
    // Height is kept above the target's feet while displacing; no ground below is known here.
    let no_ground = |_: f64, _: f64| f64::NEG_INFINITY;
    let muco = MucoConfig { limits, ..MucoConfig::default() };
    let mut measured = certify(&expert.track, &positions, 0, map, &no_ground, &muco);
    let certificate = &mut measured.certificate;
    certificate.filtered_boxes = expert.certificate.filtered_boxes;
    let [yaw, pitch] = view_rates_deg_s(&poses, expert.track.dt_s);
    (certificate.max_yaw_rate_deg_s, certificate.max_pitch_rate_deg_s) = (yaw, pitch);
    Trajectory {
        track: expert.track.clone(),
        poses_in_world: poses,
        visibility: measured.visibility,
        clearance_m: measured.clearance_m,
        terms: vec![],
        coverage: vec![],
        labels: vec![],
        convergence: vec![],
        certificate: measured.certificate,
        perturbation: Some(perturbation),
    }
}
