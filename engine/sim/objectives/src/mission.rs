//! [`Mission`]: a moving point to be watched, and wishes, as the planner is asked for it.

use crate::meeting::Meeting;
use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec2, TargetTrack};
use cosfly_geometry::SpatialQuery;
use cosfly_planner::{MucoConfig, PlanRequest, Preset, WeightedTerm};

/// Body height of a point to be watched that is nobody, metres: the smallest that can be followed.
pub const POINT_HEIGHT_M: f64 = 0.2;

/// The town as objectives see it. World frame, metres.
pub struct Site<'a> {
    /// All unsimplified boxes.
    pub exact: &'a dyn SpatialQuery,
    /// Buildings, each as its boxes.
    pub structures: &'a [Vec<OrientedBox>],
    /// Height of the ground at (x, y); may be no number.
    pub ground: &'a dyn Fn(f64, f64) -> f64,
    /// Corners of the ground that people use, seen from above: (smallest, largest).
    pub bounds: (DVec2, DVec2),
}

/// Flights that have places to be at fly as `agile`, where the recipe leaves the preset as it is: calm ones would miss them.
pub(crate) fn agile(config: &MucoConfig) -> MucoConfig {
    let preset = if config.preset == Preset::Cosfly { Preset::Agile } else { config.preset };
    MucoConfig { preset, ..config.clone() }
}

/// The request of an objective to the planner.
#[derive(Clone, Debug)]
pub struct Mission {
    /// The point to be watched. Where nobody is there, its radius is 0 and its height [`POINT_HEIGHT_M`].
    pub track: TargetTrack,
    /// Wishes and limits, adapted.
    pub config: MucoConfig,
    /// Places that draw the drone, and how strongly.
    pub meetings: Vec<(Meeting, f64)>,
}

impl Mission {
    /// The request to the planner in a town.
    pub fn request<'a>(
        &'a self,
        exact: &'a dyn SpatialQuery,
        planning_boxes: &'a [OrientedBox],
        ground: &'a dyn Fn(f64, f64) -> f64,
    ) -> PlanRequest<'a> {
        let mut request = PlanRequest::new(&self.track, exact, planning_boxes, ground, &self.config);
        let term =
            |(meeting, weight): &(Meeting, f64)| WeightedTerm { term: Box::new(meeting.clone()), weight: *weight };
        request.extra_terms = self.meetings.iter().map(term).collect();
        request
    }

    /// Part of the mission from `frame` on, at most `frames` long.
    pub fn part(&self, frame: usize, frames: usize) -> Self {
        let end = frame.saturating_add(frames).min(self.track.len());
        let states = self.track.states.get(frame..end).unwrap_or_default().to_vec();
        let meetings = self.meetings.iter().map(|(meeting, weight)| (meeting.part(frame, end), *weight));
        Self {
            track: TargetTrack { states, ..self.track.clone() },
            config: self.config.clone(),
            meetings: meetings.collect(),
        }
    }
}
