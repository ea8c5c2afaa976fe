//! From a valid flight to the trajectory that is handed out.

use crate::certificate::{Measured, certify, term_costs};
use crate::found::Found;
use crate::problem::frame_number;
use crate::request::PlanRequest;
use crate::terms::term::{TermContext, WeightedTerm};
use crate::walk::Walk;
use cosfly_domain::{PlanOutcome, Trajectory};
use cosfly_frames::{DVec3, Pose};
use cosfly_surroundings::exact::{ExactMap, ExactObstacles};
use cosfly_surroundings::visibility::aim_point;

/// The flight as it is handed out: without the frames before the first one, with poses and the costs of all terms.
pub(super) fn publish(request: &PlanRequest<'_>, terms: &[WeightedTerm], found: Found) -> PlanOutcome {
    let (track, config) = (request.track, request.config);
    let map = request.map();
    let before = found.waypoints.len().saturating_sub(track.len());
    let waypoints = &found.waypoints[before..];
    let measured = if before > 0 { measured_again(request, map, &found, waypoints) } else { found.measured };
    let walk = Walk::of(track);
    let sampled;
    let grid = match request.ground_grid {
        Some(grid) => grid,
        None => {
            sampled = request.sampled_ground();
            &sampled
        }
    };
    let surroundings =
        ExactObstacles { track, map, ground: grid, known: waypoints, known_visibility: &measured.visibility };
    let context = TermContext { track, view: &config.view, walk: &walk, surroundings: &surroundings };
    terms.iter().for_each(|weighted| weighted.term.begin(&context));
    let costs = term_costs(terms, waypoints, &context);
    let pose = |(&w, state): (&DVec3, &_)| Pose::looking_at(w, aim_point(state, track.height_m));
    let flight = Trajectory {
        track: track.clone(),
        poses_in_world: waypoints.iter().zip(&track.states).map(pose).collect(),
        visibility: measured.visibility.clone(),
        clearance_m: measured.clearance_m,
        terms: costs,
        convergence: found.convergence,
        certificate: measured.certificate,
        perturbation: None,
    };
    match not_a_number(&flight, request.first_frame) {
        Some(reason) => PlanOutcome::Rejected { track: track.clone(), reason },
        None => PlanOutcome::Planned(Box::new(flight)),
    }
}

/// Measurements without the frames before the first one. Speed, acceleration, jerk, limits and the solver's own figures
/// stay those of the whole flight.
fn measured_again(request: &PlanRequest<'_>, map: ExactMap<'_>, found: &Found, waypoints: &[DVec3]) -> Measured {
    let whole = &found.measured.certificate;
    let mut measured = certify(request.track, waypoints, 0, map, request.ground, request.config);
    let certificate = &mut measured.certificate;
    (certificate.max_speed_mps, certificate.max_acceleration_mps2, certificate.max_jerk_mps3) =
        (whole.max_speed_mps, whole.max_acceleration_mps2, whole.max_jerk_mps3);
    (certificate.holds, certificate.violations) = (whole.holds, whole.violations.clone());
    (certificate.lattice_visibility, certificate.visibility_regret) =
        (whole.lattice_visibility, whole.visibility_regret);
    (certificate.attempts, certificate.searches) = (whole.attempts, whole.searches);
    (certificate.iterations, certificate.filtered_boxes) = (whole.iterations, whole.filtered_boxes);
    (certificate.occlusion_ordered_s, certificate.occlusion_reached_s) =
        (whole.occlusion_ordered_s, whole.occlusion_reached_s);
    measured
}

/// Terms from outside may return anything; a flight with such a cost is not published.
fn not_a_number(flight: &Trajectory, first: i64) -> Option<String> {
    flight.terms.iter().find_map(|term| {
        let frame = term.per_frame.iter().position(|cost| !cost.is_finite())?;
        Some(format!(
            "cost term `{}` is {} at frame {}; it must be a finite number",
            term.name,
            term.per_frame[frame],
            frame_number(first, frame)
        ))
    })
}
