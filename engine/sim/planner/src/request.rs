//! The request for a flight: track, map, wishes, start, companions, moving occluders.

use crate::config::muco::MucoConfig;
use crate::error::PlanError;
use crate::terms::term::WeightedTerm;
use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec3, TargetTrack};
use cosfly_geometry::SpatialQuery;
use cosfly_surroundings::exact::ExactMap;
use cosfly_surroundings::ground::GroundGrid;
use cosfly_surroundings::moving::OtherDrones;

/// Inputs of a flight. [`PlanRequest::new`] sets the usual ones; the other fields are set by name.
pub struct PlanRequest<'a> {
    /// The target to follow. The camera looks at it.
    pub track: &'a TargetTrack,
    /// All unsimplified boxes; the certificate is measured against them.
    pub exact: &'a dyn SpatialQuery,
    /// Boxes that the solver avoids and looks past (simplified or the same).
    pub planning_boxes: &'a [OrientedBox],
    /// Height of the ground at (x, y), metres; where it is not finite the target's height is taken.
    pub ground: &'a dyn Fn(f64, f64) -> f64,
    /// Wishes and limits.
    pub config: &'a MucoConfig,
    /// Cost terms beside the paper's nine; they join the search, the refinement and the costs in the output. Tracks of
    /// more than 4,096 frames are planned in stretches, each of which terms see as a track of its own.
    pub extra_terms: Vec<WeightedTerm>,
    /// Position and velocity of the drone at the first frame; `None` leaves both to the planner.
    pub start: Option<StartState>,
    /// A valid flight behind `track`, one waypoint per frame, world frame, metres: from `start`, the drone joins it where it can,
    /// and a new flight is planned only where it cannot. Without `start` it is not read.
    pub flight: Option<&'a [DVec3]>,
    /// Further targets to be seen, as long as `track` and with its time step; see
    /// [`SeveralTargets`](crate::config::targets::SeveralTargets).
    pub companions: &'a [TargetTrack],
    /// Boxes that move: each one's place frame by frame, as long as `track`. Between frames they go evenly and turn the shorter
    /// way. One around the target's middle is the target itself, which hides nothing of it.
    pub movers: &'a [Vec<OrientedBox>],
    /// Those of them that are other drones.
    pub drones: OtherDrones,
    /// Ground around `track`, or around a longer track that it is a part of, as [`Self::sampled_ground`] samples it; `None`: it is
    /// sampled anew. Those who ask again and again along one track sample once.
    pub ground_grid: Option<&'a GroundGrid>,
    /// Number that reasons give the track's first frame, for tracks that are parts of longer ones. Usually 0.
    pub first_frame: i64,
}

/// Position and velocity of a drone, world frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StartState {
    /// Metres.
    pub position_in_world: DVec3,
    /// Metres per second, taken to have been the same in the two frames before.
    pub velocity_in_world: DVec3,
}

impl<'a> PlanRequest<'a> {
    /// A flight behind `track` with nothing further asked.
    pub fn new(
        track: &'a TargetTrack,
        exact: &'a dyn SpatialQuery,
        planning_boxes: &'a [OrientedBox],
        ground: &'a dyn Fn(f64, f64) -> f64,
        config: &'a MucoConfig,
    ) -> Self {
        let (extra_terms, companions, movers) = (Vec::new(), &[] as &[_], &[] as &[_]);
        let (start, flight, ground_grid, first_frame) = (None, None, None, 0);
        Self {
            track,
            exact,
            planning_boxes,
            ground,
            config,
            extra_terms,
            start,
            flight,
            companions,
            movers,
            drones: OtherDrones::default(),
            ground_grid,
            first_frame,
        }
    }

    /// The unsimplified map with what moves.
    pub fn map(&self) -> ExactMap<'a> {
        let clearance_m = self.config.limits.clearance_m;
        ExactMap { query: self.exact, movers: self.movers, drones: self.drones, clearance_m }
    }

    /// The ground around the track, as far as the planner asks for it.
    pub fn sampled_ground(&self) -> GroundGrid {
        GroundGrid::sample(self.track, self.ground, self.config.search.filter_radius_m + 10.0)
    }

    /// Checks that the parts of the request fit each other.
    ///
    /// # Errors
    /// [`PlanError::Request`] with the contradiction in words.
    pub fn validate(&self) -> Result<(), PlanError> {
        let frames = self.track.len();
        for (index, companion) in self.companions.iter().enumerate() {
            if companion.len() != frames || companion.dt_s != self.track.dt_s {
                return Err(PlanError::Request(format!(
                    "companion {index} has {} frames of {} s; the target has {frames} of {} s",
                    companion.len(),
                    companion.dt_s,
                    self.track.dt_s
                )));
            }
            if let Some(frame) = companion.states.iter().position(|state| !state.feet_in_world.is_finite()) {
                return Err(PlanError::Request(format!("companion {index} is not at a finite place at frame {frame}")));
            }
        }
        for (index, places) in self.movers.iter().enumerate() {
            if places.len() != frames {
                return Err(PlanError::Request(format!(
                    "moving box {index} has {} places; the target has {frames} frames",
                    places.len()
                )));
            }
            let finite = |shape: &OrientedBox| {
                let sizes = shape.half_extents_m;
                shape.center_in_world.is_finite()
                    && sizes.is_finite()
                    && sizes.min_element() >= 0.0
                    && shape.yaw_rad.is_finite()
            };
            if let Some(frame) = places.iter().position(|shape| !finite(shape)) {
                return Err(PlanError::Request(format!("moving box {index} is not a finite box at frame {frame}")));
            }
        }
        if let Some(flight) = self.flight.filter(|flight| flight.len() != frames) {
            return Err(PlanError::Request(format!(
                "the flight to join has {} waypoints; the target has {frames} frames",
                flight.len()
            )));
        }
        self.check_start()
    }

    fn check_start(&self) -> Result<(), PlanError> {
        let Some(start) = self.start else { return Ok(()) };
        let (at, speed) = (start.position_in_world, start.velocity_in_world.length());
        if !at.is_finite() || !speed.is_finite() {
            return Err(PlanError::Request("the start state is not finite".to_owned()));
        }
        let limits = &self.config.limits;
        if speed > limits.speed_mps {
            return Err(PlanError::Request(format!(
                "the start state moves at {speed:.2} m/s; the limit is {} m/s",
                limits.speed_mps
            )));
        }
        let clearance = self.map().nearest(0, at, limits.clearance_m).map_or(limits.clearance_m, |near| near.0);
        let above = at.z - (self.ground)(at.x, at.y);
        let clearance = if above.is_finite() { clearance.min(above) } else { clearance };
        if clearance < limits.clearance_m {
            return Err(PlanError::Request(format!(
                "the start state is {clearance:.2} m from an obstacle or the ground; the limit is {} m",
                limits.clearance_m
            )));
        }
        Ok(())
    }
}
