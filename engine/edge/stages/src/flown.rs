//! What came of planning a flight, and the aim of its pilot.

use crate::flight::Flight;
use crate::world::World;
use cosfly_domain::{PlanOutcome, Trajectory};
use cosfly_frames::{DVec3, Seed, TargetTrack};
use cosfly_objectives::config::DT_S;
use cosfly_pilot::aim::{AimConfig, aimed};
use cosfly_planner::certificate::view_rates_deg_s;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Turns the views of a planned flight behind `track`, whose first frame is `first_frame` of the track, as a pilot aims, within
/// the flight's limits; the certificate states the rates of the result.
pub fn take_aim(flight: &mut Trajectory, first_frame: usize, aim: &AimConfig, track: &TargetTrack, seed: Seed) {
    let limits = &flight.certificate.limits;
    let fastest = aim.max_rate_deg_s.min(limits.yaw_rate_deg_s).min(limits.pitch_rate_deg_s);
    let aim = AimConfig { max_rate_deg_s: fastest, ..aim.clone() };
    let positions: Vec<DVec3> = flight.poses_in_world.iter().map(|pose| pose.position_in_world).collect();
    flight.poses_in_world = aimed(&positions, track, first_frame, None, &aim, seed.child("aim", 0));
    let [yaw, pitch] = view_rates_deg_s(&flight.poses_in_world, track.dt_s);
    (flight.certificate.max_yaw_rate_deg_s, flight.certificate.max_pitch_rate_deg_s) = (yaw, pitch);
}

/// What came of a flight, with notes by name and warnings.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Flown {
    /// The flight, or the reason why there is none.
    pub outcome: PlanOutcome,
    /// Notes, by name.
    pub notes: BTreeMap<String, String>,
    /// Warnings.
    pub warnings: Vec<String>,
}

impl Flown {
    /// Plans a flight.
    ///
    /// # Errors
    /// Failures of a plugin.
    pub fn of(flight: &Flight, world: &Arc<World>) -> cosfly_diagnose::Result<Self> {
        let (outcome, said) = flight.plan(world)?;
        let (notes, mut warnings) = match &outcome {
            PlanOutcome::Planned(trajectory) => flight.findings(world, trajectory),
            PlanOutcome::Rejected { .. } => Default::default(),
        };
        warnings.extend(said);
        Ok(Self { outcome, notes, warnings })
    }

    /// No flight, for a reason.
    pub fn none(reason: &str) -> Self {
        let track = TargetTrack { dt_s: DT_S, height_m: 0.0, radius_m: 0.0, states: vec![] };
        let outcome = PlanOutcome::Rejected { track, reason: reason.to_owned() };
        Self { outcome, notes: BTreeMap::new(), warnings: vec![] }
    }
}
