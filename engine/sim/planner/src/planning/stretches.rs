//! Long tracks, stretch by stretch: each begins with the last waypoints of the one before and looks ahead over the
//! beginning of the next, so that memory stays that of one stretch and the whole is as smooth as its parts.

use crate::certificate::{certify, publishable};
use crate::found::Found;
use crate::problem::frame_number;
use crate::request::PlanRequest;
use crate::trajectory::Certificate;
use cosfly_frames::{DVec3, TargetTrack};
use cosfly_geometry::OrientedBox;

/// Longest track that is planned at once, frames.
pub const STRETCH_FRAMES: usize = 4096;
/// Frames at the end of a stretch that the next one plans again.
const LOOK_AHEAD_FRAMES: usize = 256;
/// Waypoints that a stretch takes over: enough for speed, acceleration and jerk.
const HEAD_FRAMES: usize = 3;

/// Plans a short request that begins with the given waypoints.
pub(super) type PlanOne<'a> = dyn Fn(&PlanRequest<'_>, &[DVec3]) -> Result<Found, String> + 'a;

/// Plans a long request with `plan_one`, which plans a short one that begins with the given waypoints.
pub fn plan_stretches(request: &PlanRequest<'_>, head: &[DVec3], plan_one: &PlanOne<'_>) -> Result<Found, String> {
    let frames = request.track.len();
    let mut waypoints = head.to_vec();
    let mut convergence = Vec::new();
    let mut sum = Certificate::default();
    let mut seen_frames = 0.0;
    loop {
        let first = waypoints.len().saturating_sub(HEAD_FRAMES);
        let end = (first + STRETCH_FRAMES).min(frames);
        let number = |frame: usize| frame_number(request.first_frame, frame);
        let found = plan_stretch(request, first..end, &waypoints[first..], plan_one)
            .map_err(|reason| format!("in frames {} to {}: {reason}", number(first), number(end)))?;
        let keep = if end == frames { end } else { end - LOOK_AHEAD_FRAMES };
        let planned = (end - first) as f64;
        add(&mut sum, &found.measured.certificate, planned);
        seen_frames += planned;
        convergence.extend(found.convergence);
        waypoints.truncate(first);
        waypoints.extend_from_slice(&found.waypoints[..keep - first]);
        if keep == frames {
            break;
        }
    }
    let exact = request.map();
    let mut measured = certify(request.track, &waypoints, head.len(), exact, request.ground, request.config);
    let certificate = &mut measured.certificate;
    certificate.lattice_visibility = sum.lattice_visibility / seen_frames;
    certificate.visibility_regret = (certificate.lattice_visibility - certificate.mean_visibility).max(0.0);
    (certificate.attempts, certificate.searches) = (sum.attempts, sum.searches);
    (certificate.iterations, certificate.filtered_boxes) = (sum.iterations, sum.filtered_boxes);
    certificate.occlusion_ordered_s = sum.occlusion_ordered_s;
    certificate.occlusion_reached_s = sum.occlusion_reached_s;
    if !publishable(request.config, certificate) {
        return Err(certificate.violations.join("; "));
    }
    Ok(Found { waypoints, measured, convergence })
}

fn plan_stretch(
    request: &PlanRequest<'_>,
    frames: core::ops::Range<usize>,
    head: &[DVec3],
    plan_one: &PlanOne<'_>,
) -> Result<Found, String> {
    let cut = |track: &TargetTrack| TargetTrack { states: track.states[frames.clone()].to_vec(), ..*track };
    let companions: Vec<TargetTrack> = request.companions.iter().map(cut).collect();
    let movers: Vec<Vec<OrientedBox>> = request.movers.iter().map(|places| places[frames.clone()].to_vec()).collect();
    let track = cut(request.track);
    let stretch = PlanRequest {
        track: &track,
        extra_terms: Vec::new(),
        start: None,
        flight: None,
        ground_grid: None,
        companions: &companions,
        movers: &movers,
        first_frame: request.first_frame.saturating_add(i64::try_from(frames.start).unwrap_or(i64::MAX)),
        ..*request
    };
    plan_one(&stretch, head)
}

/// Sums of figures; the lattice's visibility weighted by the frames.
fn add(sum: &mut Certificate, one: &Certificate, frames: f64) {
    sum.lattice_visibility += one.lattice_visibility * frames;
    sum.attempts = sum.attempts.max(one.attempts);
    sum.searches = sum.searches.saturating_add(one.searches);
    sum.iterations = sum.iterations.saturating_add(one.iterations);
    sum.filtered_boxes = sum.filtered_boxes.saturating_add(one.filtered_boxes);
    sum.occlusion_ordered_s += one.occlusion_ordered_s;
    sum.occlusion_reached_s += one.occlusion_reached_s;
}
