//! Joining a known flight from a given start: the flight itself, and on top the departure of the start, which dies away.
//!
//! The known flight has made all decisions (side, height, time of a change of sides); a drone beside it takes them over. So the
//! answer to a state on the flight is the flight, and answers to states near it agree with it.

use crate::certificate::{certify, publishable};
use crate::found::Found;
use crate::muco::lead_in;
use crate::request::PlanRequest;
use cosfly_frames::DVec3;

/// A departure up to here is none: rounded positions of the flight itself, metres.
const SAME_PLACE_M: f64 = 0.05;
/// Each further attempt takes longer by this factor.
const LONGER: f64 = 1.5;
/// Longest time over which the departure dies away, seconds. Where that is not enough, a new flight is planned.
const LONGEST_S: f64 = 12.0;

/// The shortest valid way from `head` to `flight`, which has a waypoint for every frame from the last of `head` on; `None`
/// where there is none.
pub(super) fn join(request: &PlanRequest<'_>, head: &[DVec3], flight: &[DVec3]) -> Option<Found> {
    let (dt_s, limits) = (request.track.dt_s, &request.config.limits);
    let first = head.len().checked_sub(1)?;
    let mut known = head[..first].to_vec();
    known.extend_from_slice(flight);
    let is_there = head[first].distance(known[first]) <= SAME_PLACE_M;
    if is_there && let Some(found) = judged(request, head, known.clone()) {
        return Some(found);
    }
    let mut frames = lead_in::frames(head, limits, dt_s, &known);
    while frames * dt_s <= LONGEST_S {
        let mut waypoints = known.clone();
        lead_in::lead_in(head, frames, &mut waypoints);
        if let Some(found) = judged(request, head, waypoints) {
            return Some(found);
        }
        frames = (LONGER * frames).ceil();
    }
    None
}

/// The flight, if it may be published.
fn judged(request: &PlanRequest<'_>, head: &[DVec3], mut waypoints: Vec<DVec3>) -> Option<Found> {
    waypoints[..head.len()].copy_from_slice(head);
    let exact = request.map();
    let measured = certify(request.track, &waypoints, head.len(), exact, request.ground, request.config);
    let valid = publishable(request.config, &measured.certificate);
    valid.then_some(Found { waypoints, measured, convergence: Vec::new() })
}
