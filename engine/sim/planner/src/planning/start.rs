//! Given starts: frames are put before the first one, in which everything stands still and the drone arrives.

use crate::request::{PlanRequest, StartState};
use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec3, TargetTrack};

/// Number of frames that a start state fixes before the first one.
const FRAMES_BEFORE: usize = 2;

/// A request whose drone starts in a given state, with frames before the first one.
pub(super) struct LongerRequest {
    track: TargetTrack,
    companions: Vec<TargetTrack>,
    movers: Vec<Vec<OrientedBox>>,
    /// The first waypoints, world frame, metres.
    pub head: Vec<DVec3>,
}

impl LongerRequest {
    /// Of a request whose drone starts in `start`.
    pub(super) fn new(request: &PlanRequest<'_>, start: StartState) -> Self {
        let dt_s = request.track.dt_s;
        let back = |frames: usize| start.position_in_world - frames as f64 * dt_s * start.velocity_in_world;
        Self {
            track: with_frames_before(request.track),
            companions: request.companions.iter().map(with_frames_before).collect(),
            movers: request.movers.iter().map(|places| repeated_before(places)).collect(),
            head: (0..=FRAMES_BEFORE).rev().map(back).collect(),
        }
    }

    /// The request itself; `original` is the one that it was made from.
    pub(super) fn request<'a>(&'a self, original: &PlanRequest<'a>) -> PlanRequest<'a> {
        PlanRequest {
            track: &self.track,
            extra_terms: Vec::new(),
            start: None,
            flight: None,
            companions: &self.companions,
            movers: &self.movers,
            first_frame: original.first_frame.saturating_sub(FRAMES_BEFORE as i64),
            ..*original
        }
    }
}

fn with_frames_before(track: &TargetTrack) -> TargetTrack {
    TargetTrack { states: repeated_before(&track.states), ..track.clone() }
}

fn repeated_before<T: Clone>(values: &[T]) -> Vec<T> {
    let first = values.first().into_iter().flat_map(|first| core::iter::repeat_n(first, FRAMES_BEFORE));
    first.chain(values).cloned().collect()
}
