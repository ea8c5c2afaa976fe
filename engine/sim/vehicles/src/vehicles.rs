//! [`Vehicles`]: the population of simulated vehicles.

use crate::config::VehicleConfig;
use crate::driver::Driver;
use crate::error::VehicleError;
use crate::junctions::{Junctions, stop_m};
use crate::network::Network;
use crate::outlines::{blocked_lanes, meet};
use crate::parking::Parking;
use crate::paved::Paved;
use crate::vehicle::{Doing, Vehicle};
use crate::{parked, start};
use cosfly_domain::{BodyPlan, Town};
use cosfly_frames::{Seed, TargetState};
use cosfly_world::{Clock, Population, Present, Snapshot};

/// Vehicles keep this distance from each other when they move, metres.
const APART_M: f64 = 0.05;
/// Distance that they keep from people and other bodies, beyond the way that these can go in a step, metres.
const APART_FROM_OTHERS_M: f64 = 0.3;
/// People may go this fast in a step, m/s.
const PEOPLE_MPS: f64 = 2.5;

/// Vehicles that drive on the lanes of a town, and cars that are parked.
///
/// No two of them ever overlap: a vehicle that would touch another one does not move in that step. Such steps are counted in
/// the notes; following and junctions leave few of them. Vehicles leave where their lane ends, and do not come back.
pub struct Vehicles {
    network: Network,
    junctions: Junctions,
    vehicles: Vec<Vehicle>,
    headway_s: f64,
    first_number: u32,
    accelerations_mps2: Vec<f64>,
    near: Vec<Present>,
    notes: Vec<String>,
    held_steps: u64,
    steps: u64,
}

impl Vehicles {
    /// Vehicles as `config` asks for, at places that `seed` draws.
    ///
    /// # Errors
    /// A broken rule of the config; a town without lanes, or without room for any vehicle.
    pub fn new(town: &Town, config: &VehicleConfig, clock: Clock, seed: Seed) -> Result<Self, VehicleError> {
        let _ = clock;
        config.validate().map_err(VehicleError::Config)?;
        if town.lanes.is_empty() && config.count > 0 {
            return Err(VehicleError::NoLanes { town: town.name.clone() });
        }
        let mut network = Network::new(town);
        let paved = Paved::new(town);
        let parking = Parking::new(&network, &paved, config.parked_share, seed);
        network.close(&parking.taken);
        let blocked = blocked_lanes(&mut network, town);
        network.close(&blocked);
        let closed: Vec<u32> = parking.taken.iter().chain(&blocked).copied().collect();
        let mut vehicles = start::driving(&network, town, config, &closed, seed);
        if vehicles.is_empty() && config.count > 0 {
            return Err(VehicleError::NoRoom { lanes: town.lanes.len(), asked: config.count });
        }
        let mut notes = vec![];
        if vehicles.len() < config.count as usize {
            notes.push(format!("{} of {} vehicles: the lanes have no room for more", vehicles.len(), config.count));
        }
        if !blocked.is_empty() {
            notes.push(format!("{} lanes are closed: solid things stand on them", blocked.len()));
        }
        let driving = vehicles.len();
        parked::park(&network, town, (&parking, &paved), config.area_m, seed, &mut vehicles);
        notes.push(format!("{driving} vehicles drive, {} are parked", vehicles.len() - driving));
        let mut junctions = Junctions::new(&network);
        vehicles.iter().filter(|vehicle| vehicle.drives()).for_each(|vehicle| junctions.begin(vehicle));
        let mut all = Self {
            accelerations_mps2: vec![0.0; vehicles.len()],
            network,
            junctions,
            vehicles,
            headway_s: config.headway_s,
            first_number: 0,
            near: vec![],
            notes,
            held_steps: 0,
            steps: 0,
        };
        for vehicle in all.vehicles.iter_mut().filter(|vehicle| vehicle.drives()) {
            let needed_m = vehicle.needed_m();
            vehicle.route.extend(&all.network, vehicle.way_m, needed_m, &mut vehicle.random);
        }
        all.begin_rolling();
        Ok(all)
    }

    /// Lets everybody begin at a speed from which nobody has to brake hard.
    fn begin_rolling(&mut self) {
        let present = (0u32..).zip(&self.vehicles).map(|(k, it)| Snapshot::present(k, &it.plan, it.state));
        let everybody = Snapshot::new(present.collect());
        for number in 0..self.vehicles.len() {
            let vehicle = &self.vehicles[number];
            if vehicle.drives() {
                let driver = driver_of(vehicle, &self.network, number as u32, self.headway_s);
                let speed_mps = driver.calm_speed_mps(&everybody, &mut self.near);
                let vehicle = &mut self.vehicles[number];
                (vehicle.speed_mps, vehicle.state.speed_mps) = (speed_mps, speed_mps);
            }
        }
    }

    /// Whether a vehicle may go on to a state: it touches no other one, nor anybody else.
    fn may_go(&self, number: usize, state: &TargetState, step_s: f64, everybody: &Snapshot) -> bool {
        let plan = &self.vehicles[number].plan;
        let others = self.vehicles.iter().enumerate();
        let is_clear = others.filter(|(other, it)| *other != number && it.doing != Doing::HasLeft).all(|(_, other)| {
            !meet(plan, state, &other.plan, &other.state, APART_M)
                // Those that touch already may part.
                || meet(plan, &self.vehicles[number].state, &other.plan, &other.state, APART_M)
                    && cosfly_world::gap_m(plan, state, &other.plan, &other.state)
                        > cosfly_world::gap_m(plan, &self.vehicles[number].state, &other.plan, &other.state)
                    && !meet(plan, state, &other.plan, &other.state, 0.0)
        });
        if !is_clear {
            return false;
        }
        let own = self.first_number..self.first_number + self.vehicles.len() as u32;
        let mut is_clear = true;
        let reach_m = plan.radius_m() + APART_FROM_OTHERS_M + 40.0 * step_s;
        everybody.near(state.feet_in_world.truncate(), reach_m, |body| {
            if own.contains(&body.number) || !is_clear {
                return;
            }
            let goes_m = step_s * body.state.speed_mps.max(if body.kind.is_person() { PEOPLE_MPS } else { 0.0 });
            let (kind, size_m) = (body.kind, body.size_m);
            let other = BodyPlan { source: String::new(), kind, size_m, looks: plan.looks, group: None };
            is_clear = !meet(plan, state, &other, &body.state, APART_FROM_OTHERS_M + goes_m);
        });
        is_clear
    }

    fn go(&mut self, number: usize, step_s: f64, everybody: &Snapshot) {
        let vehicle = &mut self.vehicles[number];
        let speed_mps = (vehicle.speed_mps + step_s * self.accelerations_mps2[number]).max(0.0);
        let way_m = vehicle.way_m + 0.5 * step_s * (vehicle.speed_mps + speed_mps);
        let needed_m = vehicle.needed_m();
        vehicle.route.extend(&self.network, way_m, needed_m, &mut vehicle.random);
        if way_m + 0.5 * vehicle.length_m() >= vehicle.route.end_m {
            vehicle.doing = Doing::HasLeft;
            self.junctions.release(&self.network, vehicle, true);
            return;
        }
        let state = vehicle.route.state(&self.network, way_m, speed_mps);
        self.steps += 1;
        let is_still = way_m <= self.vehicles[number].way_m;
        if is_still || self.may_go(number, &state, step_s, everybody) {
            let vehicle = &mut self.vehicles[number];
            (vehicle.way_m, vehicle.speed_mps, vehicle.state) = (way_m, speed_mps, state);
        } else {
            let vehicle = &mut self.vehicles[number];
            // Standing is no surprise; having to stand is.
            self.held_steps += u64::from(vehicle.speed_mps > 0.5);
            (vehicle.speed_mps, vehicle.state.speed_mps) = (0.0, 0.0);
        }
        self.junctions.release(&self.network, &mut self.vehicles[number], false);
    }
}

impl Population for Vehicles {
    fn plans(&self) -> Vec<BodyPlan> {
        self.vehicles.iter().map(|vehicle| vehicle.plan.clone()).collect()
    }

    fn begin(&mut self, first_number: u32) {
        self.first_number = first_number;
    }

    fn state(&self, body: usize) -> Option<TargetState> {
        let vehicle = &self.vehicles[body];
        (vehicle.doing != Doing::HasLeft).then_some(vehicle.state)
    }

    fn step(&mut self, time_s: f64, step_s: f64, everybody: &Snapshot) {
        self.junctions.grant(&self.network, time_s, &mut self.vehicles);
        for number in 0..self.vehicles.len() {
            let vehicle = &self.vehicles[number];
            if vehicle.drives() {
                let driver = driver_of(vehicle, &self.network, self.first_number + number as u32, self.headway_s);
                self.accelerations_mps2[number] = driver.acceleration(everybody, &mut self.near);
            }
        }
        for number in 0..self.vehicles.len() {
            if self.vehicles[number].drives() {
                self.go(number, step_s, everybody);
            }
        }
    }

    fn notes(&self) -> Vec<String> {
        let mut notes = self.notes.clone();
        if self.held_steps > 0 {
            let words = format!("vehicles were stopped at once in {} of {} steps", self.held_steps, self.steps);
            notes.push(format!("{words}: they would have touched somebody"));
        }
        notes
    }
}

/// Drivers of vehicles, and what is asked of them.
fn driver_of<'a>(vehicle: &'a Vehicle, network: &'a Network, number: u32, headway_s: f64) -> Driver<'a> {
    Driver {
        network,
        route: &vehicle.route,
        limits: vehicle.limits,
        speed_share: vehicle.speed_share,
        headway_s,
        number,
        way_m: vehicle.way_m,
        speed_mps: vehicle.speed_mps,
        length_m: vehicle.length_m(),
        width_m: vehicle.plan.size_m.y,
        stop_m: stop_m(network, vehicle),
    }
}
