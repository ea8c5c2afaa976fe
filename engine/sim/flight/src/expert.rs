//! An expert: how flights are planned, for what, and how their pilots aim.

use crate::aim::take_aim;
use crate::flight::{Flight, MovingBodies};
use crate::flown::Flown;
use crate::plugins::{FlightPlugins, NoPlugins};
use crate::world::World;
use cosfly_domain::{PlanOutcome, Trajectory};
use cosfly_frames::Seed;
use cosfly_objectives::ObjectiveConfig;
use cosfly_pilot::aim::AimConfig;
use cosfly_planner::MucoConfig;
use std::sync::Arc;

/// An expert.
#[derive(Clone, Debug, Default)]
pub struct Expert {
    /// Weights and limits.
    pub config: MucoConfig,
    /// Objective of the flights.
    pub objective: ObjectiveConfig,
    /// Aim at a walker.
    pub aim: AimConfig,
}

impl Expert {
    /// Flight behind a walk and its companions, or one that the objective draws from `seed`, as [`Flight::of`].
    ///
    /// # Errors
    /// Failures of a plugin.
    pub fn flight(
        &self,
        world: &Arc<World>,
        bodies: MovingBodies,
        seed: Seed,
        plugins: Arc<dyn FlightPlugins>,
    ) -> cosfly_diagnose::Result<Result<Flight, String>> {
        let flight = Flight::of((&self.config, &self.objective), world, bodies, seed, plugins)?;
        Ok(flight.map(|flight| flight.aiming(&self.aim)))
    }

    /// Flights of all drones behind a walk, one after the other, each beside those before it; none of them aims (see
    /// [`Self::aim_of`]). Drones without a flight are in nobody's way.
    ///
    /// # Errors
    /// Failures of a plugin.
    pub fn formation(
        &self,
        world: &Arc<World>,
        bodies: MovingBodies,
        seed: Seed,
    ) -> cosfly_diagnose::Result<Vec<Flown>> {
        let all = (&self.config, &self.objective);
        let mut flight = match Flight::of(all, world, bodies, seed, Arc::new(NoPlugins))? {
            Ok(flight) => flight,
            Err(reason) => return Ok((0..self.config.drones.count).map(|_| Flown::none(&reason)).collect()),
        };
        let mut flown = vec![];
        for _ in 0..self.config.drones.count {
            let own = Flown::of(&flight, world)?;
            if let PlanOutcome::Planned(trajectory) = &own.outcome {
                flight.beside(trajectory.poses_in_world.iter().map(|pose| pose.position_in_world).collect());
            }
            flown.push(own);
        }
        Ok(flown)
    }

    /// Turns the views of a flight of [`Self::formation`] as its pilot aims.
    pub fn aim_of(&self, flight: &mut Trajectory, seed: Seed) {
        let track = flight.track.clone();
        take_aim(flight, 0, &self.aim, &track, seed);
    }

    /// Names of the variants of each walk's item, one per drone; none where there is one drone alone.
    pub fn drones(&self) -> Vec<String> {
        let count = self.config.drones.count;
        if count > 1 { (1..=count).map(|number| format!("d{number}")).collect() } else { vec![] }
    }
}
