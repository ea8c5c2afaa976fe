//! The certificate of a trajectory: limits, reached values, and figures of the planner.

use super::columns::Trajectories;
use crate::published_costs::costs;
use crate::tables::DatasetItem;
use crate::tables::column::columns;
use cosfly_domain::{Certificate, Perturbation};

columns! { Trajectories::CERTIFICATE of DatasetItem;
    /// Whether all limits hold, checked against the unsimplified map.
    certificate_holds: bool = |item, _| certificate(item).holds;
    /// Violated limits, in words.
    certificate_violations: Vec<String> = |item, _| certificate(item).violations.clone();
    /// Smallest allowed distance from obstacles; null: no limit.
    limit_clearance_m: Option<f64> = |item, _| limit(certificate(item).limits.clearance_m);
    /// Largest allowed speed; null: no limit.
    limit_speed_mps: Option<f64> = |item, _| limit(certificate(item).limits.speed_mps);
    /// Largest allowed acceleration; null: no limit.
    limit_acceleration_mps2: Option<f64> = |item, _| limit(certificate(item).limits.acceleration_mps2);
    /// Largest allowed jerk; null: no limit.
    limit_jerk_mps3: Option<f64> = |item, _| limit(certificate(item).limits.jerk_mps3);
    /// Largest allowed yaw rate of the drone; null: no limit.
    limit_yaw_rate_deg_s: Option<f64> = |item, _| limit(certificate(item).limits.yaw_rate_deg_s);
    /// Largest allowed pitch rate of the drone; null: no limit.
    limit_pitch_rate_deg_s: Option<f64> = |item, _| limit(certificate(item).limits.pitch_rate_deg_s);
    /// Mean visibility by rays, 0..1.
    mean_visibility: f64 = |item, _| certificate(item).mean_visibility;
    /// Share of frames with a visibility of at least one half, 0..1.
    frames_half_visible: f64 = |item, _| certificate(item).frames_half_visible;
    /// Smallest distance of the swept path to an obstacle, at most 50.
    min_clearance_m: f64 = |item, _| certificate(item).min_clearance_m;
    /// Largest speed of the drone.
    max_speed_mps: f64 = |item, _| certificate(item).max_speed_mps;
    /// Largest acceleration of the drone.
    max_acceleration_mps2: f64 = |item, _| certificate(item).max_acceleration_mps2;
    /// Largest jerk of the drone.
    max_jerk_mps3: f64 = |item, _| certificate(item).max_jerk_mps3;
    /// Largest yaw rate of the drone as planned, from frame to frame.
    max_yaw_rate_deg_s: f64 = |item, _| certificate(item).max_yaw_rate_deg_s;
    /// Largest pitch rate of the drone as planned, from frame to frame.
    max_pitch_rate_deg_s: f64 = |item, _| certificate(item).max_pitch_rate_deg_s;
    /// Mean distance from the drone to the target's feet.
    mean_distance_m: f64 = |item, _| certificate(item).mean_distance_m;
    /// Mean horizontal angle from straight behind the target; frames in which the target stands are excluded.
    mean_rear_angle_deg: f64 = |item, _| certificate(item).mean_rear_angle_deg;
    /// Path length of the drone.
    length_m: f64 = |item, _| certificate(item).length_m;
    /// Path length of the drone divided by the target's; 0 when the target stands.
    length_ratio: f64 = |item, _| certificate(item).length_ratio;

    /// Steps of refinement or descent and of corridor smoothing; 0 for perturbed trajectories.
    iterations: u32 = |item, _| certificate(item).iterations;
    /// Mean visibility of the lattice's cheapest path, from which the trajectory was refined; 0 without a lattice.
    lattice_visibility: f64 = |item, _| certificate(item).lattice_visibility;
    /// Visibility lost relative to the lattice's path; 0 when the trajectory sees as much or more.
    visibility_regret: f64 = |item, _| certificate(item).visibility_regret;
    /// Number of lattices tried, from the coarsest to finer ones.
    attempts: u32 = |item, _| certificate(item).attempts;
    /// Number of searches through the last lattice.
    searches: u32 = |item, _| certificate(item).searches;
    /// Time for which the target was to be lost on purpose.
    occlusion_ordered_s: f64 = |item, _| certificate(item).occlusion_ordered_s;
    /// Part of `occlusion_ordered_s` for which the target was lost.
    occlusion_reached_s: f64 = |item, _| certificate(item).occlusion_reached_s;
    /// Number of obstacle boxes left by the per-path filter.
    filtered_boxes: u32 = |item, _| certificate(item).filtered_boxes;
    /// Names of the planner's terms; empty for perturbed trajectories.
    term_names: Vec<String> = |item, _| {
        costs(&item.record.trajectory).map(|term| term.name.to_owned()).collect()
    };
    /// Weights of the planner's terms; empty for perturbed trajectories.
    term_weights: Vec<f64> = |item, _| costs(&item.record.trajectory).map(|term| term.weight).collect();
    /// Unweighted costs of the planner's terms over all frames; empty for perturbed trajectories.
    term_sums: Vec<f64> = |item, _| costs(&item.record.trajectory).map(|term| term.sum).collect();
    /// Names of the labels given by plugins, see `frames.labels`; empty without such plugins.
    label_names: Vec<String> = |item, _| {
        item.record.trajectory.labels.iter().map(|it| it.name.clone()).collect()
    };
    /// Plugin of each label, with its version.
    label_plugins: Vec<String> = |item, _| {
        item.record.trajectory.labels.iter().map(|it| format!("{} {}", it.plugin, it.version)).collect()
    };
    /// Total cost against the planning boxes before and after refinement (preset `paper`: after each iteration of
    /// descent) and of the published trajectory; empty for baselines and perturbed trajectories.
    convergence: Vec<f64> = |item, _| item.record.trajectory.convergence.clone();
    /// Kind of the perturbation, such as `jumps` (the paper's) or `drift`; null for experts.
    perturbation: Option<String> = |item, _| perturbation(item).map(|it| it.kind.name().to_owned());
    /// Probability of the position event per frame; null for experts and for kinds of perturbation but `jumps`.
    position_probability: Option<f64> = |item, _| jumps(item).map(|it| it.position_probability);
    /// Probability of the rotation event per frame; null for experts and for kinds of perturbation but `jumps`.
    rotation_probability: Option<f64> = |item, _| jumps(item).map(|it| it.rotation_probability);
}

fn certificate(item: &DatasetItem) -> &Certificate {
    &item.record.trajectory.certificate
}

/// Limit as a value; `None` where it is infinite.
fn limit(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

fn perturbation(item: &DatasetItem) -> Option<&Perturbation> {
    item.record.trajectory.perturbation.as_ref()
}

fn jumps(item: &DatasetItem) -> Option<&Perturbation> {
    perturbation(item).filter(|it| !it.kind.is_flyable())
}
