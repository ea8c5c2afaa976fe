//! The perturbed twin of an expert flight: one that a drone could fly, or the paper's two independent events per frame, with
//! safe displacements (paper, section "Dual-Trajectory Augmentation").

use super::config::PerturbConfig;
use super::flyable;
use super::kinds::Departure;
use cosfly_domain::{Perturbation, PerturbationKind, PlanOutcome, Trajectory};
use cosfly_frames::{DVec3, Pose};
use cosfly_planner::certificate::{certify, view_rates_deg_s};
use cosfly_planner::config::limits::LimitsConfig;
use cosfly_planner::config::muco::MucoConfig;
use cosfly_random::Seed;
use cosfly_surroundings::exact::ExactMap;

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
    let (poses, frames) = match &kind.departure {
        Departure::FrameByFrame(depart) => depart(expert, map, &config.jumps(), &seed),
        Departure::Flown { offsets, views } => flyable::twin(expert, (*offsets, *views), map, config, &seed),
    };
    let kind = PerturbationKind::named(kind.name);
    let probability = |probability| if kind.is_flyable() { 0.0 } else { probability };
    let perturbation = Perturbation {
        expert_item: expert_item.to_owned(),
        position_probability: probability(config.position_probability),
        rotation_probability: probability(config.rotation_probability),
        kind,
        frames,
    };
    let twin = measured(expert, poses, perturbation, map, config);
    match twin.certificate.min_clearance_m {
        free if free > 0.0 => PlanOutcome::Planned(Box::new(twin)),
        touching => rejected(format!("the twin comes to {touching:.2} m from an obstacle, as its expert does")),
    }
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
