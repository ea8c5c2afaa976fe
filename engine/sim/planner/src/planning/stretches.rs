//! Long tracks, stretch by stretch: each begins with the last waypoints of the one before and looks ahead over the
//! beginning of the next, so that memory stays that of one stretch and the whole is as smooth as its parts.
//!
//! Stretches also keep one hard place from costing a whole flight: an effort must succeed everywhere along what is planned at once, and the
//! longer that is, the more often some place lacks just this effort. Stretches choose theirs one by one.

use crate::certificate::{certify, publishable};
use crate::error::PlanError;
use crate::found::Found;
use crate::problem::frame_number;
use crate::request::PlanRequest;
use cosfly_domain::{Certificate, OrientedBox};
use cosfly_frames::{DVec3, TargetTrack};
use std::ops::Range;

/// Longest track that is planned at once, frames.
pub const STRETCH_FRAMES: usize = 4096;
/// Waypoints that a stretch takes over: enough for speed, acceleration and jerk.
const HEAD_FRAMES: usize = 3;

/// A stretch that may come next.
pub(super) struct Stretch {
    /// Its length, frames.
    pub frames: usize,
    /// Frames at the end of the stretch before that it plans again.
    again: usize,
}

const fn stretch(frames: usize, again: usize) -> Stretch {
    Stretch { frames, again }
}

/// The stretches that are tried, in this order.
pub(super) type Division = [Stretch];

/// Longest stretches that memory allows.
pub(super) const LONG: [Stretch; 1] = [stretch(STRETCH_FRAMES, 256)];
/// About as short as usual walks, which are planned at once. Where one finds no way on, others begin and end elsewhere.
pub(super) const SHORT: [Stretch; 8] = [
    stretch(240, 60),
    stretch(120, 30),
    stretch(240, 100),
    stretch(240, 30),
    stretch(400, 60),
    stretch(120, 60),
    stretch(240, 15),
    stretch(60, 30),
];

/// Plans a short request that begins with the given waypoints.
pub(super) type PlanOne<'a> = dyn Fn(&PlanRequest<'_>, &[DVec3]) -> Result<Found, PlanError> + 'a;

/// Plans a long request with `plan_one`, which plans a short one that begins with the given waypoints.
pub(super) fn plan_stretches(
    request: &PlanRequest<'_>,
    head: &[DVec3],
    division: &Division,
    plan_one: &PlanOne<'_>,
) -> Result<Found, PlanError> {
    let frames = request.track.len();
    let mut way = Way {
        request,
        given: head.len(),
        flown: head.to_vec(),
        ordered: 0,
        sum: Certificate::default(),
        seen_frames: 0.0,
        convergence: vec![],
    };
    while way.flown.len() < frames {
        way.plan_on(division, plan_one)?;
    }
    way.certified()
}

/// A way that grows stretch by stretch.
struct Way<'a> {
    request: &'a PlanRequest<'a>,
    /// Number of the first waypoints that were given.
    given: usize,
    /// Waypoints so far, with those that the next stretch plans again.
    flown: Vec<DVec3>,
    /// Losses of the target that were ordered of stretches so far.
    ordered: u32,
    sum: Certificate,
    /// Frames of all stretches.
    seen_frames: f64,
    convergence: Vec<f64>,
}

impl Way<'_> {
    /// Adds the next stretch, which begins at one of the places that the division tries.
    fn plan_on(&mut self, division: &Division, plan_one: &PlanOne<'_>) -> Result<(), PlanError> {
        let frames = self.request.track.len();
        let mut refusal = None;
        let mut tried: Vec<Range<usize>> = vec![];
        for stretch in division {
            let is_first = self.flown.len() == self.given;
            let again = if is_first { 0 } else { stretch.again };
            let done = self.flown.len().saturating_sub(again).max(self.given);
            let first = done.saturating_sub(HEAD_FRAMES);
            let end = (first + stretch.frames).min(frames);
            if end <= self.flown.len() || tried.contains(&(first..end)) {
                continue;
            }
            tried.push(first..end);
            // Losses are ordered for the whole flight: a stretch gets those that are due at its end.
            let due = f64::from(self.request.config.occlusion.count) * end as f64 / frames as f64;
            let losses = (due.round() as u32).saturating_sub(self.ordered);
            match plan_stretch(self.request, first..end, (&self.flown[first..done], losses), plan_one) {
                Ok(found) => {
                    self.ordered += losses;
                    let planned = (end - first) as f64;
                    add(&mut self.sum, &found.measured.certificate, planned);
                    self.seen_frames += planned;
                    self.convergence.extend(found.convergence);
                    self.flown.truncate(first);
                    self.flown.extend_from_slice(&found.waypoints);
                    return Ok(());
                }
                Err(reason) => {
                    let number = |frame: usize| frame_number(self.request.first_frame, frame);
                    let place = || format!("in frames {} to {}", number(first), number(end));
                    refusal.get_or_insert_with(|| reason.at(place()));
                }
            }
        }
        Err(refusal.unwrap_or_else(|| PlanError::NoWay("no stretch of frames goes on".to_owned())))
    }

    /// The whole way with its measurements.
    fn certified(self) -> Result<Found, PlanError> {
        let Self { request, given, flown: waypoints, sum, seen_frames, convergence, .. } = self;
        let exact = request.map();
        let mut measured = certify(request.track, &waypoints, given, exact, request.ground, request.config);
        let certificate = &mut measured.certificate;
        certificate.lattice_visibility = sum.lattice_visibility / seen_frames;
        certificate.visibility_regret = (certificate.lattice_visibility - certificate.mean_visibility).max(0.0);
        (certificate.attempts, certificate.searches) = (sum.attempts, sum.searches);
        (certificate.iterations, certificate.filtered_boxes) = (sum.iterations, sum.filtered_boxes);
        certificate.occlusion_ordered_s = sum.occlusion_ordered_s;
        let lost = measured.visibility.iter().filter(|seen| **seen == 0.0).count();
        certificate.occlusion_reached_s = sum.occlusion_reached_s.min(lost as f64 * request.track.dt_s);
        if !publishable(request.config, certificate) {
            return Err(PlanError::Rules(certificate.violations.clone()));
        }
        Ok(Found { waypoints, measured, convergence })
    }
}

fn plan_stretch(
    request: &PlanRequest<'_>,
    frames: Range<usize>,
    (head, losses): (&[DVec3], u32),
    plan_one: &PlanOne<'_>,
) -> Result<Found, PlanError> {
    let mut config = request.config.clone();
    config.occlusion.count = losses;
    let cut = |track: &TargetTrack| TargetTrack { states: track.states[frames.clone()].to_vec(), ..*track };
    let companions: Vec<TargetTrack> = request.companions.iter().map(cut).collect();
    let movers: Vec<Vec<OrientedBox>> = request.movers.iter().map(|places| places[frames.clone()].to_vec()).collect();
    let track = cut(request.track);
    let stretch = PlanRequest {
        track: &track,
        config: &config,
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::muco::MucoConfig;
    use cosfly_frames::TargetState;
    use cosfly_geometry::BoxBvh;
    use std::cell::RefCell;

    fn walk(frames: usize) -> TargetTrack {
        let state = |i: usize| TargetState {
            feet_in_world: DVec3::new(0.6 * i as f64, 0.0, 0.0),
            heading_rad: 0.0,
            speed_mps: 1.2,
        };
        TargetTrack { dt_s: 0.5, height_m: 1.75, radius_m: 0.3, states: (0..frames).map(state).collect() }
    }

    /// A planner that flies straight behind, unless what it is to plan is refused.
    fn flown_unless(
        refused: impl Fn(Range<usize>) -> bool,
        losses: u32,
    ) -> (Result<Found, PlanError>, Vec<(usize, u32)>) {
        let (track, exact) = (walk(1000), BoxBvh::build(vec![]));
        let mut config = MucoConfig::default();
        config.occlusion.count = losses;
        let request = PlanRequest::new(&track, &exact, &[], &|_, _| 0.0, &config);
        let planned = RefCell::new(vec![]);
        let one = |part: &PlanRequest<'_>, head: &[DVec3]| {
            let first = part.first_frame as usize;
            if refused(first..first + part.track.len()) {
                return Err(PlanError::NoWay("it is refused".to_owned()));
            }
            planned.borrow_mut().push((first, part.config.occlusion.count));
            let behind = DVec3::new(-15.0, 0.0, 20.0);
            let waypoints: Vec<DVec3> = part.track.states.iter().map(|state| state.feet_in_world + behind).collect();
            assert_eq!(head, &waypoints[..head.len()]);
            let measured = certify(part.track, &waypoints, 0, part.map(), part.ground, part.config);
            Ok(Found { waypoints, measured, convergence: vec![] })
        };
        let found = plan_stretches(&request, &[], &SHORT, &one);
        (found, planned.into_inner())
    }

    #[test]
    fn where_a_stretch_finds_no_way_on_others_begin_and_end_elsewhere() {
        // Nothing may begin between frames 225 and 240, nor be longer than 130 frames at the beginning.
        let refused = |part: Range<usize>| (225..240).contains(&part.start) || (part.start == 0 && part.end > 130);
        let (found, planned) = flown_unless(refused, 0);
        let found = found.unwrap();
        assert_eq!(found.waypoints.len(), 1000);
        assert!(found.measured.certificate.holds);
        assert_eq!((planned[0].0, planned.iter().any(|part| (225..240).contains(&part.0))), (0, false));
        let reason = flown_unless(|part| part.contains(&500), 0).0.err().unwrap().to_string();
        assert!(reason.starts_with("in frames ") && reason.ends_with(": it is refused"), "{reason}");
    }

    #[test]
    fn losses_are_ordered_for_the_flight_and_not_for_each_stretch() {
        for losses in [0, 1, 3] {
            let planned = flown_unless(|_| false, losses).1;
            assert_eq!(planned.iter().map(|part| part.1).sum::<u32>(), losses);
            assert!(planned.iter().all(|part| part.1 <= 1), "{planned:?}");
        }
    }
}
