//! The causal expert: plans again and again as it flies, from the states that it has come to. It knows the past of everybody and
//! predicts that all go on at the velocity that they have; the map and the ground are known.
//!
//! The flight is certified against what really happened. Where that was not what had been predicted, the flight sees less than
//! its plans promised, or comes too near something and is rejected.

use super::causal_losses::Losses;
use super::stretches::PlanOne;
use crate::certificate::{certify, publishable};
use crate::error::PlanError;
use crate::found::Found;
use crate::problem::frame_number;
use crate::request::PlanRequest;
use cosfly_domain::{Certificate, OrientedBox};
use cosfly_frames::{DVec3, TargetState, TargetTrack, real};

/// Waypoints that a plan takes over: enough for speed, acceleration and jerk.
const HEAD_FRAMES: usize = 3;
/// Velocities are means over about this time, seconds.
const VELOCITY_S: f64 = 0.5;
/// A box that seems to move faster has just appeared, m/s; it is predicted to stand.
const FASTEST_MPS: f64 = 60.0;
/// Boxes at the height of the flight are kept clear of by half this much times the square of the predicted time more,
/// m/s^2, but at most by [`MOST_UNSURE_M`].
const UNSURE_MPS2: f64 = 1.0;
const MOST_UNSURE_M: f64 = 1.0;

/// Flies behind the target of `request` and plans with `plan_one`, which plans a short request that begins with given waypoints.
/// `head` are the first waypoints.
pub(super) fn fly(request: &PlanRequest<'_>, head: &[DVec3], plan_one: &PlanOne<'_>) -> Result<Found, PlanError> {
    let (config, frames, dt_s) = (request.config, request.track.len(), request.track.dt_s);
    let count = |time_s: f64| ((time_s / dt_s).round() as usize).max(1);
    let (horizon, stride) = (count(config.causal.horizon_s), count(config.causal.replan_s));
    let (mut flown, mut convergence) = (head.to_vec(), Vec::new());
    let mut sum = Certificate::default();
    // The plan in force, from the next frame on: waypoints and the visibility that they were planned to have.
    let mut ahead: Vec<(DVec3, f64)> = Vec::new();
    let mut losses = Losses::of(request);
    while flown.len() < frames {
        let first = flown.len().saturating_sub(HEAD_FRAMES);
        let now = flown.len().saturating_sub(1);
        let part = Part::predicted(request, first, now, horizon);
        let mut blind = 0;
        match losses.plan(&part.request(request), &flown[first..], flown.len(), plan_one) {
            Ok((found, lost)) => {
                blind = lost;
                add(&mut sum, &found.measured.certificate);
                let planned = found.waypoints.iter().copied().zip(found.measured.visibility);
                ahead = planned.skip(flown.len() - first).collect();
                convergence = found.convergence;
            }
            Err(reason) if ahead.is_empty() => {
                let frame = frame_number(request.first_frame, now);
                return Err(reason.at(format!("at frame {frame}, with what is known then")));
            }
            // The plan in force goes on; with what is known next, there may be another one.
            Err(_) => {}
        }
        let steps = stride.max(blind).min(ahead.len()).min(frames - flown.len());
        for (waypoint, seen) in ahead.drain(..steps) {
            flown.push(waypoint);
            sum.lattice_visibility += seen;
        }
    }
    let exact = request.map();
    let mut measured = certify(request.track, &flown, head.len(), exact, request.ground, config);
    let certificate = &mut measured.certificate;
    certificate.lattice_visibility = sum.lattice_visibility / (frames - head.len()).max(1) as f64;
    certificate.visibility_regret = (certificate.lattice_visibility - certificate.mean_visibility).max(0.0);
    losses.state(certificate, &measured.visibility);
    (certificate.attempts, certificate.searches) = (sum.attempts, sum.searches);
    (certificate.iterations, certificate.filtered_boxes) = (sum.iterations, sum.filtered_boxes);
    if !publishable(config, certificate) {
        let limit_m = config.limits.clearance_m;
        let pair = |i: usize| (flown[i], flown[(i + 1).min(frames - 1)]);
        let near = |i: &usize| exact.segment_clearance(*i, pair(*i).0, pair(*i).1, limit_m) < limit_m;
        let place = (0..frames).find(near).map(|i| format!(" at frame {}", frame_number(request.first_frame, i)));
        let place = format!("what was predicted did not come about{}", place.unwrap_or_default());
        return Err(PlanError::Rules(certificate.violations.clone()).at(place));
    }
    Ok(Found { waypoints: flown, measured, convergence })
}

/// Figures of the solver over all plans.
fn add(sum: &mut Certificate, one: &Certificate) {
    sum.attempts = sum.attempts.max(one.attempts);
    sum.searches = sum.searches.saturating_add(one.searches);
    sum.iterations = sum.iterations.saturating_add(one.iterations);
    sum.filtered_boxes = sum.filtered_boxes.max(one.filtered_boxes);
}

/// Knowledge from frame `first` to the present, and predictions from there.
struct Part {
    first: usize,
    track: TargetTrack,
    companions: Vec<TargetTrack>,
    movers: Vec<Vec<OrientedBox>>,
}

impl Part {
    fn predicted(request: &PlanRequest<'_>, first: usize, now: usize, horizon: usize) -> Self {
        let track = |track: &TargetTrack| predicted_track(track, request.ground, first..=now, horizon);
        // Boxes below the lowest flight are only looked past: there the prediction itself is the best guess.
        let floor_m = request.track.states[now].feet_in_world.z + request.config.view.min_altitude_m
            - request.config.limits.clearance_m;
        let mover =
            |places: &Vec<OrientedBox>| predicted_box(places, request.track.dt_s, first..=now, horizon, floor_m);
        Self {
            first,
            track: track(request.track),
            companions: request.companions.iter().map(track).collect(),
            movers: request.movers.iter().map(mover).collect(),
        }
    }

    fn request<'a>(&'a self, original: &PlanRequest<'a>) -> PlanRequest<'a> {
        PlanRequest {
            track: &self.track,
            extra_terms: Vec::new(),
            start: None,
            flight: None,
            ground_grid: None,
            companions: &self.companions,
            movers: &self.movers,
            first_frame: original.first_frame.saturating_add(i64::try_from(self.first).unwrap_or(i64::MAX)),
            ..*original
        }
    }
}

/// Feet go on evenly over the ground; at the first frame, where nothing is past, as heading and speed say.
fn predicted_track(
    track: &TargetTrack,
    ground: &dyn Fn(f64, f64) -> f64,
    known: core::ops::RangeInclusive<usize>,
    horizon: usize,
) -> TargetTrack {
    let (now, dt_s) = (*known.end(), track.dt_s);
    let state = track.states[now];
    let back = ((VELOCITY_S / dt_s).round() as usize).clamp(1, now.max(1));
    let velocity = if now == 0 {
        let (sin, cos) = real::sin_cos(state.heading_rad);
        DVec3::new(cos, sin, 0.0) * state.speed_mps
    } else {
        (state.feet_in_world - track.states[now - back].feet_in_world).with_z(0.0) / (back as f64 * dt_s)
    };
    let height_m = |at: DVec3| ground(at.x, at.y);
    let later = |frames: usize| {
        let mut feet_in_world = state.feet_in_world + velocity * (frames as f64 * dt_s);
        let rise_m = height_m(feet_in_world) - height_m(state.feet_in_world);
        feet_in_world.z += if rise_m.is_finite() { rise_m } else { 0.0 };
        TargetState { feet_in_world, ..state }
    };
    let states = track.states[known].iter().copied().chain((1..=horizon).map(later)).collect();
    TargetTrack { states, ..*track }
}

/// A box goes on evenly without turning; those whose top is above `floor_m` grow with the time that is predicted.
fn predicted_box(
    places: &[OrientedBox],
    dt_s: f64,
    known: core::ops::RangeInclusive<usize>,
    horizon: usize,
    floor_m: f64,
) -> Vec<OrientedBox> {
    let now = *known.end();
    let place = places[now];
    let step = place.center_in_world - places[now.saturating_sub(1)].center_in_world;
    let step = if step.length() > FASTEST_MPS * dt_s { DVec3::ZERO } else { step };
    let is_high = place.center_in_world.z + place.half_extents_m.z > floor_m;
    let later = |frames: usize| {
        let time_s = frames as f64 * dt_s;
        let unsure_m = if is_high { (0.5 * UNSURE_MPS2 * time_s * time_s).min(MOST_UNSURE_M) } else { 0.0 };
        OrientedBox {
            center_in_world: place.center_in_world + step * frames as f64,
            half_extents_m: place.half_extents_m + DVec3::splat(unsure_m),
            ..place
        }
    };
    places[known].iter().copied().chain((1..=horizon).map(later)).collect()
}
