//! Comparison of planners: others on the walks of published flights, among the same bodies, measured like them.

use crate::world::World;
use cosfly_domain::{Around, Certificate, Limits, OrientedBox, PlanOutcome, Trajectory};
use cosfly_frames::{DVec3, TargetTrack};
use cosfly_planner::baselines::{Baseline, BaselineInput, BaselinePath, flyable::made_flyable, plan_baseline};
use cosfly_planner::certificate::{certify, term_costs};
use cosfly_planner::problem::Problem;
use cosfly_planner::terms::built_in_terms;
use cosfly_planner::{MucoConfig, PlanRequest, Walk, WeightedTerm, plan_request};
use cosfly_surroundings::exact::ExactMap;
use cosfly_surroundings::ground::GroundGrid;
use cosfly_surroundings::local::LocalObstacles;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Frames of a walk that are planned again, as many as the paper has on average: A* takes a second on so many.
const MOST_FRAMES: usize = 200;
/// Length of a walk below which the person stands, metres.
const LEAST_WAY_M: f64 = 1.0;

/// Other planners, and their names in the table.
const OTHERS: [(Other, &str); 5] = [
    (Other::Behind, "straight behind, blind"),
    (Other::Astar, "A*"),
    (Other::AstarSmoothed, "A*, smoothed"),
    (Other::Lattice, "lattice alone"),
    (Other::Cosfly, "cosfly, defaults"),
];

#[derive(Clone, Copy, PartialEq, Eq)]
enum Other {
    Behind,
    Astar,
    AstarSmoothed,
    Lattice,
    Cosfly,
}

/// A published flight, for the comparison.
pub struct ComparedFlight {
    /// The flight.
    pub trajectory: Trajectory,
    /// Bodies around its target.
    pub around: Around,
    /// Digest of its town and name of its walk: equal for flights behind the same walk.
    pub walk: (String, String),
    /// Town that it was planned in.
    pub world: Arc<World>,
    /// Name of the stage that planned it.
    pub planner: String,
}

/// Figures of one planner.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannerFigures {
    /// Name.
    pub planner: String,
    /// Number of walks.
    pub asked: u64,
    /// Number of flights that were found.
    pub planned: u64,
    /// Number of flights that keep all limits.
    pub sound: u64,
    /// Means over the flights; `None` without one.
    pub means: Option<Means>,
    /// Weighted cost of each term per frame.
    pub costs: Vec<(String, f64)>,
    /// Reason of the first walk without a flight.
    pub refusal: Option<String>,
}

/// Means and extremes over flights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Means {
    /// Mean visibility, 0..=1.
    pub visible: f64,
    /// Share of frames with at least half of the target visible, 0..=1.
    pub half_visible: f64,
    /// Mean distance to the target, metres.
    pub distance_m: f64,
    /// Mean length of the way, metres.
    pub length_m: f64,
    /// Smallest distance of a swept way to an obstacle, metres.
    pub nearest_m: f64,
    /// Largest acceleration, m/s^2.
    pub acceleration_mps2: f64,
    /// Largest jerk, m/s^3.
    pub jerk_mps3: f64,
}

/// Rows for the published flights and for other planners on their walks, all measured against the unsimplified town of
/// each flight and the bodies of traffic around it. Others have the default weights and the limits of the flight's certificate.
pub fn compared(flights: &[ComparedFlight]) -> Vec<PlannerFigures> {
    let mut published: Vec<Column> = vec![];
    let mut others: Vec<Column> = OTHERS.iter().map(|(_, name)| Column::new((*name).to_owned())).collect();
    let mut followed = BTreeSet::new();
    for flight in flights.iter().filter(|it| walks(&it.trajectory)) {
        let name = format!("as published (`{}`)", flight.planner);
        let place = published.iter().position(|column| column.name == name).unwrap_or(published.len());
        if place == published.len() {
            published.push(Column::new(name));
        }
        let task = Task::new(flight);
        let positions = flight.trajectory.poses_in_world.iter().map(|pose| pose.position_in_world);
        published[place].add(&task, Ok(positions.take(task.track.len()).collect()));
        if !followed.insert(&flight.walk) {
            continue;
        }
        let astar = task.baseline(Baseline::AstarFast);
        for ((other, _), column) in OTHERS.iter().zip(&mut others) {
            column.add(&task, task.by(*other, &astar));
        }
    }
    let published: Vec<PlannerFigures> = published.into_iter().map(Column::row).collect();
    let anew = others.into_iter().map(Column::row);
    let way = |row: &PlannerFigures| row.means.map(|means| (means.length_m, means.visible));
    // Published flights of the default planner are the same when they are planned again.
    let is_new = |row: &PlannerFigures| published.iter().all(|it| way(it) != way(row));
    let anew: Vec<PlannerFigures> = anew.filter(is_new).collect();
    let rows = [published, anew].concat();
    if rows.iter().all(|row| row.asked == 0) { vec![] } else { rows }
}

fn walks(flight: &Trajectory) -> bool {
    let track = &flight.track;
    track.height_m > 0.0 && track.length_m() > LEAST_WAY_M
}

/// A walk to be followed in a town.
struct Task<'a> {
    track: TargetTrack,
    walk: Walk,
    config: MucoConfig,
    terms: Vec<WeightedTerm>,
    ground: GroundGrid,
    /// Boxes of everybody around the target, frame by frame.
    movers: Vec<Vec<OrientedBox>>,
    world: &'a World,
}

impl<'a> Task<'a> {
    fn new(flight: &'a ComparedFlight) -> Self {
        let world: &World = &flight.world;
        let mut track = flight.trajectory.track.clone();
        track.states.truncate(MOST_FRAMES);
        let mut config = MucoConfig::default();
        let Limits { clearance_m, speed_mps, acceleration_mps2, jerk_mps3, yaw_rate_deg_s, pitch_rate_deg_s } =
            flight.trajectory.certificate.limits;
        let told = |limit: f64, default: f64| if limit.is_finite() && limit > 0.0 { limit } else { default };
        let limits = &mut config.limits;
        limits.clearance_m = told(clearance_m, limits.clearance_m);
        limits.speed_mps = told(speed_mps, limits.speed_mps);
        limits.acceleration_mps2 = told(acceleration_mps2, limits.acceleration_mps2);
        limits.jerk_mps3 = told(jerk_mps3, limits.jerk_mps3);
        limits.yaw_rate_deg_s = Some(yaw_rate_deg_s).filter(|limit| limit.is_finite() && *limit > 0.0);
        limits.pitch_rate_deg_s = Some(pitch_rate_deg_s).filter(|limit| limit.is_finite() && *limit > 0.0);
        let terms = built_in_terms(&config.resolved_weights());
        let reach_m = config.search.filter_radius_m + 10.0;
        let ground = GroundGrid::sample(&track, &|x, y| world.ground.ground_height_m(x, y).unwrap_or(0.0), reach_m);
        let mut movers = flight.around.boxes();
        movers.iter_mut().for_each(|places| places.truncate(track.len()));
        Self { walk: Walk::of(&track), track, config, terms, ground, movers, world }
    }

    fn problem(&self) -> Problem<'_> {
        Problem {
            track: &self.track,
            view: &self.config.view,
            walk: &self.walk,
            terms: &self.terms,
            built_in: self.terms.len(),
            first_frame: 0,
        }
    }

    fn input<'b>(&'b self, problem: &'b Problem<'b>) -> BaselineInput<'b> {
        BaselineInput {
            problem,
            planning_boxes: &self.world.town.planning_boxes,
            exact: &self.world.exact,
            movers: &self.movers,
            ground: &self.ground,
            config: &self.config,
        }
    }

    fn baseline(&self, kind: Baseline) -> Result<BaselinePath, String> {
        plan_baseline(kind, &self.input(&self.problem())).map_err(|reason| reason.to_string())
    }

    /// One waypoint per frame, or the reason why there are none. The result of A* is given.
    fn by(&self, other: Other, astar: &Result<BaselinePath, String>) -> Result<Vec<DVec3>, String> {
        match other {
            Other::Behind => Ok(self.straight_behind()),
            Other::Astar => Ok(astar.clone()?.waypoints),
            Other::AstarSmoothed => Ok(made_flyable(&self.input(&self.problem()), astar.clone()?).waypoints),
            Other::Lattice => Ok(self.baseline(Baseline::Dp)?.waypoints),
            Other::Cosfly => {
                let ground = |x: f64, y: f64| self.world.ground.ground_height_m(x, y).unwrap_or(0.0);
                let boxes = &self.world.town.planning_boxes;
                let mut request = PlanRequest::new(&self.track, &self.world.exact, boxes, &ground, &self.config);
                request.movers = &self.movers;
                match plan_request(request) {
                    PlanOutcome::Planned(flight) => {
                        Ok(flight.poses_in_world.iter().map(|pose| pose.position_in_world).collect())
                    }
                    PlanOutcome::Rejected { reason, .. } => Err(reason),
                }
            }
        }
    }

    /// Waypoints at the best distance and pitch behind the walker, through any obstacle.
    fn straight_behind(&self) -> Vec<DVec3> {
        let (sin, cos) = cosfly_frames::real::sin_cos(self.config.view.pitch_deg.to_radians());
        let mut back = DVec3::NEG_X;
        let places = self.track.states.iter().zip(&self.walk.direction).map(|(state, direction)| {
            if direction.length_squared() > 0.0 {
                back = -direction.extend(0.0);
            }
            state.feet_in_world + self.config.view.distance_m * (cos * back + sin * DVec3::Z)
        });
        places.collect()
    }
}

/// Measurements for one row.
struct Column {
    name: String,
    asked: u64,
    measured: Vec<Measure>,
    refusal: Option<String>,
}

/// Measurement of one flight.
struct Measure {
    certificate: Certificate,
    costs: Vec<(String, f64)>,
}

impl Column {
    fn new(name: String) -> Self {
        Self { name, asked: 0, measured: vec![], refusal: None }
    }

    fn add(&mut self, task: &Task<'_>, path: Result<Vec<DVec3>, String>) {
        self.asked += 1;
        let waypoints = match path {
            Ok(waypoints) if waypoints.len() == task.track.len() => waypoints,
            Ok(_) => return,
            Err(reason) => {
                self.refusal.get_or_insert(reason);
                return;
            }
        };
        let ground = |x: f64, y: f64| task.world.ground.ground_height_m(x, y).unwrap_or(0.0);
        let exact = ExactMap::among(&task.world.exact, &task.movers);
        let certificate = certify(&task.track, &waypoints, 0, exact, &ground, &task.config).certificate;
        let search = &task.config.search;
        let influence_m = task.config.view.safety_influence_m;
        let boxes = &task.world.town.planning_boxes;
        let mut obstacles =
            LocalObstacles::filter(&task.track, boxes, &task.ground, search.filter_radius_m, influence_m)
                .with_movers(&task.movers);
        obstacles.focus_on(&waypoints);
        let frames = task.track.len().max(1) as f64;
        let costs = term_costs(&task.terms, &waypoints, &task.problem().context(&obstacles));
        let costs = costs.into_iter().map(|term| (term.name, term.weight * term.sum / frames)).collect();
        self.measured.push(Measure { certificate, costs });
    }

    fn row(self) -> PlannerFigures {
        let count = self.measured.len();
        let all = || self.measured.iter().map(|it| &it.certificate);
        let mean = |of: fn(&Certificate) -> f64| all().map(of).sum::<f64>() / count.max(1) as f64;
        let most = |of: fn(&Certificate) -> f64| all().map(of).fold(f64::NEG_INFINITY, f64::max);
        let means = (count > 0).then(|| Means {
            visible: mean(|it| it.mean_visibility),
            half_visible: mean(|it| it.frames_half_visible),
            distance_m: mean(|it| it.mean_distance_m),
            length_m: mean(|it| it.length_m),
            nearest_m: -most(|it| -it.min_clearance_m),
            acceleration_mps2: most(|it| it.max_acceleration_mps2),
            jerk_mps3: most(|it| it.max_jerk_mps3),
        });
        let mut costs: Vec<(String, f64)> = self.measured.first().map_or(vec![], |it| it.costs.clone());
        for (place, cost) in costs.iter_mut().enumerate() {
            cost.1 = self.measured.iter().map(|it| it.costs[place].1).sum::<f64>() / count.max(1) as f64;
        }
        PlannerFigures {
            means,
            sound: self.measured.iter().filter(|it| it.certificate.holds).count() as u64,
            planned: count as u64,
            asked: self.asked,
            costs,
            refusal: self.refusal,
            planner: self.name,
        }
    }
}
