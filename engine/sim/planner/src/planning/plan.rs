//! The planner's main function: from a request to a certified flight, or the reason why there is none.

use super::join::join;
use super::planners::solve;
use super::publish::publish;
use super::start::LongerRequest;
use super::stretches::STRETCH_FRAMES;
use crate::config::foresight::Foresight;
use crate::config::muco::MucoConfig;
use crate::error::PlanError;
use crate::request::PlanRequest;
use crate::terms::built_in_terms;
use crate::terms::term::WeightedTerm;
use crate::track_check::check_track;
use cosfly_domain::{OrientedBox, PlanOutcome};
use cosfly_frames::TargetTrack;
use cosfly_geometry::SpatialQuery;
use cosfly_random::Seed;

/// Plans a flight behind `track`.
///
/// * `exact`: all unsimplified boxes; the certificate is measured against them.
/// * `planning_boxes`: what the solver avoids and looks past (simplified or the same).
/// * `ground`: height of the ground at (x, y), metres; where it is not finite the target's height is taken.
///
/// A `Planned` flight keeps the configured clearance along its whole swept path, and with
/// `limits.require_kinematics` its speed, acceleration and jerk limits; everything else is `Rejected` with the
/// reason. The built-in solver draws no random numbers; `seed` is there for those that will.
pub fn plan(
    track: &TargetTrack,
    exact: &dyn SpatialQuery,
    planning_boxes: &[OrientedBox],
    ground: &dyn Fn(f64, f64) -> f64,
    config: &MucoConfig,
    seed: Seed,
) -> PlanOutcome {
    plan_with_terms(track, exact, planning_boxes, ground, config, Vec::new(), seed)
}

/// [`plan`] with further cost terms beside the paper's nine; they join the search, the refinement and the
/// costs in the output.
pub fn plan_with_terms(
    track: &TargetTrack,
    exact: &dyn SpatialQuery,
    planning_boxes: &[OrientedBox],
    ground: &dyn Fn(f64, f64) -> f64,
    config: &MucoConfig,
    extra: Vec<WeightedTerm>,
    _seed: Seed,
) -> PlanOutcome {
    let mut request = PlanRequest::new(track, exact, planning_boxes, ground, config);
    request.extra_terms = extra;
    plan_request(request)
}

/// [`plan`] with all that may be asked for.
pub fn plan_request(request: PlanRequest<'_>) -> PlanOutcome {
    let (track, config) = (request.track, request.config);
    let checked = config.validate().map_err(|(_, message)| PlanError::Request(message));
    let checked = checked.and_then(|()| check_track(track, config.limits.speed_mps)).and_then(|()| request.validate());
    if let Err(reason) = checked {
        return PlanOutcome::Rejected { track: track.clone(), reason: reason.to_string() };
    }
    // The solver and what follows it ask for the same ground. Parts that are planned one by one have ground of their own.
    let is_whole = track.len() <= STRETCH_FRAMES && config.foresight != Foresight::Causal;
    let sampled = (is_whole && request.ground_grid.is_none()).then(|| request.sampled_ground());
    let mut request = PlanRequest { ground_grid: sampled.as_ref().or(request.ground_grid), ..request };
    let mut terms = built_in_terms(&config.resolved_weights());
    let built_in = terms.len();
    terms.append(&mut request.extra_terms);
    let found = match request.start.map(|start| LongerRequest::new(&request, start)) {
        None => solve(&request, &terms, built_in, &[]),
        Some(longer) => {
            let asked = longer.request(&request);
            let joined = request.flight.and_then(|flight| join(&asked, &longer.head, flight));
            joined.map_or_else(|| solve(&asked, &terms, built_in, &longer.head), Ok)
        }
    };
    match found {
        Ok(found) => publish(&request, &terms, found),
        Err(reason) => PlanOutcome::Rejected { track: track.clone(), reason: reason.to_string() },
    }
}
