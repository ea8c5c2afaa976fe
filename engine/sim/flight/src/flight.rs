//! One flight of an expert: its mission, its companions, and how it is planned, from its beginning or from any state.

use crate::aim::take_aim;
use crate::companions::NamedTrack;
use crate::plugins::{DrawnReference, FlightPlugins};
use crate::world::World;
use cosfly_domain::{ObstacleKind, OrientedBox, PlanOutcome, Trajectory};
use cosfly_frames::{DVec2, DVec3, Seed, TargetTrack};
use cosfly_objectives::inspect::{self, Inspection};
use cosfly_objectives::patrol::{self, MET_M, Patrol};
use cosfly_objectives::{Mission, Objective, ObjectiveConfig, Site, reference, track};
use cosfly_pilot::aim::AimConfig;
use cosfly_planner::{MucoConfig, StartState, plan_request};
use cosfly_surroundings::exact::ExactMap;
use cosfly_surroundings::ground::GroundGrid;
use cosfly_surroundings::moving::{OtherDrones, drone_boxes, hides};
use cosfly_surroundings::visibility::body_points;
use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

/// Flights of up to so many frames sample the ground once for all states that ask for a way on; along longer ones the samples would
/// lie too far apart.
const SHARED_GROUND_FRAMES: usize = 4096;

/// Bodies that move around a flight. The walker's own body is in none of the lists beside it.
#[derive(Clone, Debug, Default)]
pub struct MovingBodies {
    /// Walk that is followed; `None` for objectives that follow nobody.
    pub walk: Option<TargetTrack>,
    /// Further walks to be seen.
    pub companions: Vec<NamedTrack>,
    /// Boxes of everybody else who matters, frame by frame of the walk, world frame: kept clear of and looked past. Between
    /// frames they move evenly and turn the shorter way.
    pub movers: Vec<Vec<OrientedBox>>,
}

enum Purpose {
    Followed,
    Walls(Box<Inspection>),
    Waypoints(Box<Patrol>),
    Reference(Box<DrawnReference>),
}

/// One flight that can be planned, from its beginning or from any state.
pub struct Flight {
    /// Task of the planner.
    pub mission: Mission,
    companion_ids: Vec<String>,
    companions: Vec<TargetTrack>,
    /// Boxes that move, one list per mover; the last movers are the other drones.
    movers: Vec<Vec<OrientedBox>>,
    /// Number of other drones.
    drones: usize,
    purpose: Purpose,
    objective: ObjectiveConfig,
    /// Aim at a walker; `None` where the flight follows nobody.
    aim: Option<AimConfig>,
    plugins: Arc<dyn FlightPlugins>,
    seed: Seed,
    /// The ground around the whole flight, once a state asks for a way on.
    ground: OnceLock<GroundGrid>,
}

impl Flight {
    /// Flight behind the walk of `bodies` and its companions, or one that the objective draws from `seed`, among the movers, as
    /// `config` and `objective` ask; see [`Self::aiming`].
    /// `Err` inside is the reason why there is nothing to fly.
    ///
    /// # Errors
    /// Failures of a plugin.
    pub fn of(
        (config, objective): (&MucoConfig, &ObjectiveConfig),
        world: &Arc<World>,
        bodies: MovingBodies,
        seed: Seed,
        plugins: Arc<dyn FlightPlugins>,
    ) -> cosfly_diagnose::Result<Result<Self, String>> {
        let drawn = if objective.objective == Objective::Plugin {
            let (low, high) = bounds(world);
            match plugins.draw_reference(world, config, [low.x, low.y, high.x, high.y], seed)? {
                Ok(drawn) => Some(drawn),
                Err(reason) => return Ok(Err(reason)),
            }
        } else {
            None
        };
        Ok(Self::drawn_or_behind((config, objective), world, bodies, seed, plugins, drawn))
    }

    /// Flight of [`Self::of`], with the reference that a plugin drew.
    fn drawn_or_behind(
        (config, objective): (&MucoConfig, &ObjectiveConfig),
        world: &World,
        bodies: MovingBodies,
        seed: Seed,
        plugins: Arc<dyn FlightPlugins>,
        drawn: Option<DrawnReference>,
    ) -> Result<Self, String> {
        let MovingBodies { walk, companions, movers } = bodies;
        let ground = |x: f64, y: f64| world.ground.ground_height_m(x, y).unwrap_or(0.0);
        let structures = if objective.objective == Objective::Inspect { buildings(world) } else { Vec::new() };
        let site = Site { exact: &world.exact, structures: &structures, ground: &ground, bounds: bounds(world) };
        let (mission, purpose) = match (objective.objective, walk) {
            (Objective::Track, Some(walk)) => (track::mission(walk, config), Purpose::Followed),
            (Objective::Track, None) => return Err("there is no walk to follow".to_owned()),
            (Objective::Inspect, _) => {
                let inspection = inspect::mission(&site, &objective.inspect, config, seed)?;
                (inspection.mission.clone(), Purpose::Walls(Box::new(inspection)))
            }
            (Objective::Patrol, _) => {
                let patrol = patrol::mission(&site, &objective.patrol, config, seed)?;
                (patrol.mission.clone(), Purpose::Waypoints(Box::new(patrol)))
            }
            (Objective::Plugin, _) => {
                let drawn = drawn.ok_or("there is no reference to fly along")?;
                (reference::mission(&drawn.reference, config), Purpose::Reference(Box::new(drawn)))
            }
        };
        let (companion_ids, companions) = companions.into_iter().unzip();
        let (objective, ground) = (objective.clone(), OnceLock::new());
        Ok(Self {
            mission,
            companion_ids,
            companions,
            movers,
            drones: 0,
            purpose,
            objective,
            aim: None,
            plugins,
            seed,
            ground,
        })
    }

    /// Flight with a pilot who aims at the walker as `aim` says; flights that follow nobody stay as they are.
    pub fn aiming(mut self, aim: &AimConfig) -> Self {
        self.aim = matches!(self.purpose, Purpose::Followed).then(|| aim.clone());
        self
    }

    /// Adds another drone behind the same walker, to be kept apart from: its places, frame by frame, world frame, metres.
    pub fn beside(&mut self, places: Vec<DVec3>) {
        self.movers.push(drone_boxes(&places));
        self.drones += 1;
    }

    fn others(&self) -> OtherDrones {
        OtherDrones { count: self.drones, separation_m: self.mission.config.drones.separation_m }
    }

    /// The first frame in which a drone is between the target and another drone, as a reason; `None` where none is.
    fn hidden_by_a_drone(&self, flight: &Trajectory) -> Option<String> {
        let places: Vec<DVec3> = flight.poses_in_world.iter().map(|pose| pose.position_in_world).collect();
        let own = drone_boxes(&places);
        let others = &self.movers[self.movers.len() - self.drones..];
        flight.track.states.iter().enumerate().find_map(|(frame, state)| {
            let points = body_points(state, flight.track.height_m);
            let hides = |one: &OrientedBox, other: &OrientedBox| {
                points.iter().any(|point| hides(one, *point, other.center_in_world))
            };
            let is_between = |other: &Vec<OrientedBox>| {
                let other = &other[frame];
                hides(&own[frame], other) || hides(other, &own[frame])
            };
            let number = others.iter().position(is_between)? + 1;
            Some(format!("at frame {frame} this drone or drone {number} hides the target from the other one"))
        })
    }

    /// The whole flight, and warnings of plugins for users.
    ///
    /// # Errors
    /// Failures of a plugin.
    pub fn plan(&self, world: &Arc<World>) -> cosfly_diagnose::Result<(PlanOutcome, Vec<String>)> {
        let (mut outcome, warnings) =
            self.plan_mission(world, &self.mission, (&self.companions, &self.movers), None)?;
        self.take_aim(&mut outcome, 0);
        if let PlanOutcome::Planned(flight) = &outcome
            && let Some(reason) = self.hidden_by_a_drone(flight)
        {
            outcome = PlanOutcome::Rejected { track: flight.track.clone(), reason };
        }
        if let (PlanOutcome::Planned(flight), Purpose::Walls(inspection)) = (&mut outcome, &self.purpose) {
            let ground = |x: f64, y: f64| world.ground.ground_height_m(x, y).unwrap_or(0.0);
            let structures = buildings(world);
            let site = Site { exact: &world.exact, structures: &structures, ground: &ground, bounds: bounds(world) };
            flight.coverage = inspection.coverage(&site, &flight.poses_in_world, &self.objective.inspect).gained();
        }
        Ok((outcome, warnings))
    }

    /// Rest of the flight from `frame` on, at most `frames` long, of a drone that is at `start` then. It joins `flown`, the
    /// whole flight as it is published (one position per frame; empty where there is none), wherever it can.
    ///
    /// # Errors
    /// Failures of a plugin.
    pub fn plan_from(
        &self,
        world: &Arc<World>,
        frame: usize,
        frames: usize,
        start: StartState,
        flown: &[DVec3],
    ) -> cosfly_diagnose::Result<PlanOutcome> {
        let mission = self.mission.part(frame, frames);
        let end = frame + mission.track.len();
        let part = |companion: &TargetTrack| TargetTrack {
            states: companion.states.get(frame..end).unwrap_or_default().to_vec(),
            ..companion.clone()
        };
        let companions: Vec<TargetTrack> = self.companions.iter().map(part).collect();
        let movers: Vec<Vec<OrientedBox>> =
            self.movers.iter().map(|places| places.get(frame..end).unwrap_or_default().to_vec()).collect();
        let known = flown.get(frame..end);
        let bodies = (companions.as_slice(), movers.as_slice());
        let mut outcome = self.plan_mission(world, &mission, bodies, Some((frame, start, known)))?.0;
        self.take_aim(&mut outcome, frame);
        Ok(outcome)
    }

    fn take_aim(&self, outcome: &mut PlanOutcome, first_frame: usize) {
        if let (PlanOutcome::Planned(flight), Some(aim)) = (outcome, &self.aim) {
            take_aim(flight, first_frame, aim, &self.mission.track, self.seed);
        }
    }

    fn plan_mission(
        &self,
        world: &Arc<World>,
        mission: &Mission,
        (companions, movers): (&[TargetTrack], &[Vec<OrientedBox>]),
        start: Option<(usize, StartState, Option<&[DVec3]>)>,
    ) -> cosfly_diagnose::Result<(PlanOutcome, Vec<String>)> {
        let ground = |x: f64, y: f64| world.ground.ground_height_m(x, y).unwrap_or(0.0);
        let mut request = mission.request(&world.exact, &world.town.planning_boxes, &ground);
        (request.companions, request.movers, request.drones) = (companions, movers, self.others());
        if let Some((frame, state, known)) = start {
            (request.start, request.flight) = (Some(state), known);
            request.first_frame = i64::try_from(frame).unwrap_or(i64::MAX);
            if self.mission.track.len() <= SHARED_GROUND_FRAMES {
                let whole = || self.mission.request(&world.exact, &world.town.planning_boxes, &ground).sampled_ground();
                request.ground_grid = Some(self.ground.get_or_init(whole));
            }
        }
        let opened = self.plugins.open_terms(world, self.seed)?;
        request.extra_terms.extend(opened.terms);
        let outcome = plan_request(request);
        Ok((outcome, (opened.warnings)()?))
    }

    /// Notes by name, and warnings, about the whole flight.
    pub fn findings(&self, world: &World, flight: &Trajectory) -> (BTreeMap<String, String>, Vec<String>) {
        let mut notes = BTreeMap::new();
        let mut warnings = Vec::new();
        match &self.purpose {
            Purpose::Followed => {}
            Purpose::Walls(inspection) => {
                notes.insert("coverage".to_owned(), format!("{:.3}", flight.coverage.iter().sum::<f64>()));
                notes.insert("sides".to_owned(), format!("{} of 4", inspection.sides));
            }
            Purpose::Waypoints(patrol) => {
                tell_met(&patrol.shortfalls_m(&flight.poses_in_world), &mut notes, &mut warnings);
            }
            Purpose::Reference(drawn) => {
                notes.extend(drawn.notes.iter().cloned());
                warnings.extend(drawn.warnings.iter().cloned());
                let shortfalls = drawn.reference.shortfalls_m(&flight.poses_in_world);
                if !shortfalls.is_empty() {
                    tell_met(&shortfalls, &mut notes, &mut warnings);
                }
            }
        }
        if self.drones > 0 {
            notes.insert("drones before".to_owned(), self.drones.to_string());
        }
        if !self.companions.is_empty() {
            notes.insert("companions".to_owned(), self.companion_ids.join(", "));
            let map = ExactMap::among(&world.exact, &self.movers);
            let seen = self.companions.iter().map(|companion| companion_visibility(map, companion, flight));
            let mean = seen.sum::<f64>() / self.companions.len() as f64;
            notes.insert("visibility of companions".to_owned(), format!("{mean:.3}"));
        }
        let certificate = &flight.certificate;
        let occlusion = &self.mission.config.occlusion;
        if occlusion.count > 0 {
            let reached = certificate.occlusion_reached_s;
            notes.insert("occlusion".to_owned(), format!("{reached} of {} s", certificate.occlusion_ordered_s));
            let least = f64::from(occlusion.count) * occlusion.min_s;
            if reached < least {
                warnings.push(format!("the target was to be lost for {least} s at least and is lost for {reached} s"));
            }
        }
        (notes, warnings)
    }
}

/// Notes the number of waypoints that are met, and warns about the others.
fn tell_met(shortfalls: &[f64], notes: &mut BTreeMap<String, String>, warnings: &mut Vec<String>) {
    let worst = shortfalls.iter().copied().fold(0.0, f64::max);
    let met = shortfalls.iter().filter(|miss| **miss <= MET_M).count();
    let words = format!("{met} of {} within {MET_M} m, worst {worst:.2} m", shortfalls.len());
    notes.insert("waypoints".to_owned(), words);
    for (index, miss) in shortfalls.iter().enumerate().filter(|(_, miss)| **miss > MET_M) {
        warnings.push(format!("waypoint {index} is missed by {miss:.1} m at its time"));
    }
}

fn companion_visibility(map: ExactMap<'_>, companion: &TargetTrack, flight: &Trajectory) -> f64 {
    let pairs = companion.states.iter().zip(&flight.poses_in_world).enumerate();
    let seen = pairs.map(|(i, (state, pose))| map.visibility(i, pose.position_in_world, state, companion.height_m));
    seen.sum::<f64>() / companion.len().max(1) as f64
}

/// Boxes of each building, by the building's number.
fn buildings(world: &World) -> Vec<Vec<OrientedBox>> {
    let mut boxes: BTreeMap<u32, Vec<OrientedBox>> = BTreeMap::new();
    for obstacle in world.town.obstacles.iter().filter(|obstacle| obstacle.kind == ObstacleKind::Building) {
        boxes.entry(obstacle.object_id).or_default().push(obstacle.shape);
    }
    boxes.into_values().collect()
}

/// Corners of the walkable ground seen from above; of the whole town where there is none.
fn bounds(world: &World) -> (DVec2, DVec2) {
    let corners = world.town.walkable.iter().flat_map(|polygon| &polygon.outline_in_world);
    let around = corners.map(|corner| corner.truncate()).fold(None, |around, corner| {
        let (low, high) = around.unwrap_or((corner, corner));
        Some((corner.min(low), corner.max(high)))
    });
    around.unwrap_or((world.town.min_in_world.truncate(), world.town.max_in_world.truncate()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expert::Expert;
    use crate::flown::Flown;
    use crate::plugins::NoPlugins;
    use cosfly_domain::Town;
    use cosfly_frames::TargetState;
    use cosfly_planner::config::DronesConfig;

    #[test]
    fn movers_are_kept_clear_of_by_the_whole_flight_and_by_each_part_of_it() {
        let state = |x: f64| TargetState { feet_in_world: DVec3::new(x, 0.0, 0.0), heading_rad: 0.0, speed_mps: 1.0 };
        let states = (0..60).map(|i| state(0.5 * f64::from(i))).collect();
        let walk = TargetTrack { dt_s: 0.5, height_m: 1.75, radius_m: 0.3, states };
        let world = Arc::new(World::new(Town::default()));
        let fly = |movers: Vec<Vec<OrientedBox>>| {
            let bodies = MovingBodies { walk: Some(walk.clone()), movers, ..MovingBodies::default() };
            Expert::default().flight(&world, bodies, Seed([1; 32]), Arc::new(NoPlugins)).unwrap().unwrap()
        };
        let flown = |outcome: PlanOutcome| match outcome {
            PlanOutcome::Planned(flight) => flight.poses_in_world.iter().map(|it| it.position_in_world).collect(),
            PlanOutcome::Rejected { reason, .. } => panic!("{reason}"),
        };
        let alone: Vec<DVec3> = flown(fly(vec![]).plan(&world).unwrap().0);
        // A balloon crosses the way that the drone would take.
        let at = |i: usize| OrientedBox {
            center_in_world: alone[30] + DVec3::new(0.0, 0.5 * (i as f64 - 30.0), 0.0),
            half_extents_m: DVec3::splat(2.0),
            yaw_rad: 0.0,
        };
        let balloon: Vec<OrientedBox> = (0..60).map(at).collect();
        let flight = fly(vec![balloon.clone()]);
        let gap = |i: usize, place: DVec3| {
            let shape = &balloon[i];
            ((place - shape.center_in_world).abs() - shape.half_extents_m).max(DVec3::ZERO).length()
        };
        assert!(gap(30, alone[30]) < 1.5);
        let whole: Vec<DVec3> = flown(flight.plan(&world).unwrap().0);
        let start = StartState { position_in_world: alone[10], velocity_in_world: (alone[10] - alone[9]) / 0.5 };
        // The known flight would lead through the balloon: the answer has to leave it.
        let rest: Vec<DVec3> = flown(flight.plan_from(&world, 10, 40, start, &alone).unwrap());
        assert_eq!((whole.len(), rest.len()), (60, 40));
        assert!(whole.iter().enumerate().all(|(i, place)| gap(i, *place) >= 1.5));
        assert!(rest.iter().enumerate().all(|(i, place)| gap(i + 10, *place) >= 1.5));
    }

    #[test]
    fn each_drone_keeps_apart_from_those_before_it_and_knows_none_after_it() {
        let state = |x: f64| TargetState { feet_in_world: DVec3::new(x, 0.0, 0.0), heading_rad: 0.0, speed_mps: 1.0 };
        let states = (0..60).map(|i| state(0.5 * f64::from(i))).collect();
        let walk = TargetTrack { dt_s: 0.5, height_m: 1.75, radius_m: 0.3, states };
        let world = Arc::new(World::new(Town::default()));
        let fly = |count: u32| -> Vec<Vec<DVec3>> {
            let mut expert = Expert::default();
            expert.config.drones = DronesConfig { count, separation_m: 7.0 };
            let bodies = MovingBodies { walk: Some(walk.clone()), ..MovingBodies::default() };
            let places = |flown: Flown| match flown.outcome {
                PlanOutcome::Planned(flight) => flight.poses_in_world.iter().map(|it| it.position_in_world).collect(),
                PlanOutcome::Rejected { reason, .. } => panic!("{reason}"),
            };
            expert.formation(&world, bodies, Seed([1; 32])).unwrap().into_iter().map(places).collect()
        };
        let flown = fly(3);
        assert_eq!(flown[..2], fly(2));
        for (one, other) in [(0, 1), (0, 2), (1, 2)] {
            let apart = flown[one].iter().zip(&flown[other]).map(|(a, b)| a.distance(*b)).fold(f64::INFINITY, f64::min);
            assert!(apart >= 7.0, "{one} {other}: {apart}");
        }
    }
}
