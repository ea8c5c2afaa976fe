//! [`Crowd`]: people who walk the town's ground together.
//!
//! Each step is made from one snapshot of everybody: companies decide on route and stops, then each person chooses a velocity
//! ([`steering`]) and takes the step nearest to it that keeps bodies apart and feet on free ground ([`limits`]).

mod company;
mod config;
mod limits;
mod one_way;
mod pace;
mod person;
mod placing;
mod pursuit;
mod roads;
mod steering;
mod surroundings;

use crate::route::RouteSearch;
use crate::{PedestrianError, WalkableGrid};
use company::Company;
pub use config::{CrowdConfig, CrowdStopConfig, GroundCostConfig, GroupConfig, SideConfig};
use cosfly_domain::{BodyPlan, Town};
use cosfly_frames::{DVec2, Seed, TargetState};
use cosfly_world::{Clock, Population, Present, Snapshot};
use limits::Limits;
use person::{HARDEST_MPS2, Person};
use roads::Right;
use std::ops::Range;
use std::sync::Arc;
use steering::Steering;
use surroundings::Surroundings;

/// Time in which people adapt their velocity, seconds.
const RELAXATION_S: f64 = 0.5;

/// Time in which they do on a road before a vehicle, seconds.
const ESCAPE_S: f64 = 0.2;

/// Haste of the searches for routes: a metre of pavement beside an edge costs about so much.
const HASTE: f32 = 1.4;

/// People look for the place to walk towards once in so many steps.
const PURSUIT_STEPS: usize = 4;

/// People who walk the town's ground together.
pub struct Crowd {
    config: CrowdConfig,
    grid: Arc<WalkableGrid>,
    clock: Clock,
    people: Vec<Person>,
    companies: Vec<Company>,
    search: RouteSearch<Arc<WalkableGrid>>,
    steering: Steering,
    first_number: u32,
    steps: usize,
    scratch: Scratch,
}

/// Room that every step uses again.
#[derive(Default)]
struct Scratch {
    surroundings: Surroundings,
    limits: Limits,
    /// Places of the people at the snapshot.
    places: Vec<DVec2>,
    vehicles: Vec<Present>,
}

impl Crowd {
    /// Draws the people and places them on the ground. `grid` is built by [`Crowd::grid`] from the same config.
    ///
    /// # Errors
    /// When the config breaks its rules, no connected piece of ground is `min_route_m` across, or the people do not find room.
    pub fn new(
        grid: Arc<WalkableGrid>,
        config: &CrowdConfig,
        clock: Clock,
        seed: Seed,
    ) -> Result<Self, PedestrianError> {
        Self::beside(grid, config, clock, seed, &[])
    }

    /// Crowd apart from bodies that are there in the first frame: their places in plan and radii, metres.
    ///
    /// # Errors
    /// See [`Crowd::new`].
    pub fn beside(
        grid: Arc<WalkableGrid>,
        config: &CrowdConfig,
        clock: Clock,
        seed: Seed,
        others: &[(DVec2, f64)],
    ) -> Result<Self, PedestrianError> {
        config.check()?;
        let costs = &config.ground_cost;
        let costs = [1.0, 1.0, costs.crossing as f32, costs.shoulder as f32, costs.road as f32];
        let mut crowd = Self {
            search: RouteSearch::new(grid.clone(), config.edge_distance_m, costs, 0.0, seed).with_haste(HASTE),
            config: config.clone(),
            grid,
            clock,
            people: vec![],
            companies: vec![],
            steering: Steering::default(),
            first_number: 0,
            steps: 0,
            scratch: Scratch::default(),
        };
        crowd.fill(seed, others)?;
        Ok(crowd)
    }

    /// The walkable grid of a town for such people.
    ///
    /// # Errors
    /// When the config breaks its rules or the town has no walkable ground.
    pub fn grid(town: &Town, config: &CrowdConfig) -> Result<WalkableGrid, PedestrianError> {
        config.check()?;
        WalkableGrid::build(town, &config.body_and_grid())
    }

    fn numbers(&self, range: &Range<usize>) -> Range<u32> {
        self.first_number + range.start as u32..self.first_number + range.end as u32
    }

    /// Moves one person on by a step.
    fn walk(&mut self, number: usize, step_s: f64, everybody: &Snapshot) {
        let own = self.numbers(&(0..self.people.len()));
        let company = &self.companies[self.people[number].company];
        let mates = self.numbers(&company.members);
        let Scratch { surroundings, limits, places, vehicles } = &mut self.scratch;
        let person = &mut self.people[number];
        if person.sits() {
            return;
        }
        person.wander(&self.config, step_s);
        if (self.steps + number).is_multiple_of(PURSUIT_STEPS) {
            person.target = pursuit::target(&self.grid, company, person, number, places);
        }
        let ahead = (person.target - person.at).try_normalize().unwrap_or(DVec2::ZERO);
        surroundings.look(everybody, own.start + number as u32, (person.at, person.radius_m, ahead), &own, &mates);
        let neighbours = &surroundings.neighbours;

        let right = roads::right(&self.grid, &self.config, company, person, ahead, vehicles);
        let ahead = pace::plan(&self.config, company, person, right, (places, ahead), step_s);
        let grid = &self.grid;
        let at = person.at;
        let has_ground = |direction: DVec2| grid.is_ground(at + 0.7 * direction);
        let way_on = person.way_on(ahead, step_s);
        let pace = (person.pace_mps.max(0.0), person.velocity_mps);
        let wanted = self.steering.intent(neighbours, way_on, pace, has_ground).velocity_mps;
        let uneven_mps = person.uneven_mps * (person.pace_mps / company.cruise_mps).clamp(0.0, 1.0);
        let mut change = (wanted + uneven_mps - person.velocity_mps) / RELAXATION_S
            + self.steering.push(neighbours, ahead)
            + self.grid.away_from_edge(at);
        // Nobody makes way or room for others before a vehicle.
        if let Right::Escape(_) = right {
            change = (wanted - person.velocity_mps) / ESCAPE_S;
        }
        if person.pace_mps <= 0.0 && change.length() < 0.8 {
            change = -person.velocity_mps / RELAXATION_S.max(step_s);
        }
        let velocity = person.velocity_mps + change.clamp_length_max(HARDEST_MPS2) * step_s;
        let velocity = velocity.clamp_length_max((1.25 * self.config.speed.max_mps).max(person.cruise_mps));
        limits.beside(neighbours, step_s, velocity.length() * step_s + 0.3);
        let step = limits.on_ground(&self.grid, person.frame_place, at, velocity * step_s);
        person.velocity_mps = step / step_s;
        person.at += step;
        person.z = self.grid.z_near(person.at).unwrap_or(person.z);
        person.turn(step_s);
    }
}

impl Population for Crowd {
    fn plans(&self) -> Vec<BodyPlan> {
        self.people.iter().map(|person| person.plan(self.companies[person.company].group)).collect()
    }

    fn begin(&mut self, first_number: u32) {
        self.first_number = first_number;
    }

    fn state(&self, body: usize) -> Option<TargetState> {
        self.people.get(body).map(Person::state)
    }

    fn step(&mut self, time_s: f64, step_s: f64, everybody: &Snapshot) {
        for company in &mut self.companies {
            let people = &mut self.people[company.members.clone()];
            company.decide(people, &mut self.search, &self.grid, &self.config, (time_s, step_s));
        }
        self.scratch.places.clear();
        self.scratch.places.extend(self.people.iter().map(|person| person.at));
        self.scratch.vehicles.clear();
        self.scratch.vehicles.extend(everybody.all().iter().filter(|body| !body.kind.is_person()));
        for number in 0..self.people.len() {
            self.walk(number, step_s, everybody);
        }
        self.steps += 1;
        if self.steps.is_multiple_of(self.clock.steps_per_frame as usize) {
            for person in &mut self.people {
                (person.at, person.z) = (person.at, self.grid.feet_at(person.at).0.z);
                person.frame_place = person.at;
            }
        }
    }
}
