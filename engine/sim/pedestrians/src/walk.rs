//! One pedestrian's walk: a person, a chain of goals, a smooth path, and its frames.

use crate::goal::{
    GOAL_ATTEMPTS, LONGEST_LEG_M, LONGEST_TURN_M, TURN_NODES, draw_goal, draw_start, draw_turn, roomy_pieces,
};
use crate::kinds::OfKind;
use crate::motion::{self, ArcPath};
use crate::route::{LONE_COSTS, RouteSearch, TASTE_SHARE};
use crate::smooth::smooth;
use crate::{PedestrianConfig, PedestrianError, PedestrianPath, SpeedConfig, WalkableGrid};
use cosfly_domain::{BodyKind, WalkableKind};
use cosfly_frames::{DVec2, RandomStream, Seed, TargetState, TargetTrack, real};

/// Shortest straight distance to the next goal, metres.
const SHORTEST_LEG_M: f64 = 15.0;

/// Last nodes of the route that a new leg avoids.
const BEHIND_NODES: usize = 60;

/// A route that begins by going back this many steps is given up for another goal, at most so many times.
const TURNING_BACK_STEPS: usize = 6;
const TURNING_BACK_REFUSALS: usize = 3;

/// Smoothing cuts corners; routes are made longer by this.
const SPARE: f64 = 1.12;

/// Attempts to find a place for a chair, and how closed the ground around it is: a length of [`WalkableGrid::away_from_edge`].
const SEAT_ATTEMPTS: usize = 400;
const SEAT_EDGE: f64 = 0.5;

/// Rounds of making a route longer.
const ROUNDS: usize = 6;

/// Walks one pedestrian over the grid for exactly `steps` frames.
///
/// The seed decides the person ([`crate::KindShares::draw`] says of which kind), the start, every goal, the preferences, the speeds and the stops. Every point
/// between two frames lies on walkable ground, at least the largest body radius from every obstacle. A walk whose
/// goal is near goes on to another; it ends standing only where no route leads on.
///
/// # Errors
/// When the config breaks its rules or no connected piece of ground is `min_route_m` across.
pub fn walk(grid: &WalkableGrid, config: &PedestrianConfig, seed: Seed) -> Result<PedestrianPath, PedestrianError> {
    config.check()?;
    let (person, config) = Person::drawn(config, seed);
    let config = &config;
    if person.kind == BodyKind::Sitter {
        return seated(grid, config, &person, seed);
    }
    let fastest_mps = (person.cruise_mps * (1.0 + config.speed_variation_share)).min(config.speed.max_mps);
    let needed_m = fastest_mps * config.dt_s * f64::from(config.frames) + 1.0;
    let mut chain = GoalChain::new(grid, config, seed)?;
    let mut wanted_m = SPARE * needed_m;
    let mut points = vec![];
    for round in 0..ROUNDS {
        let route = chain.route(wanted_m);
        points = smooth(grid, &route, config.simplify_m);
        let path = ArcPath::new(points.clone());
        if path.length_m() >= needed_m || chain.ended || round + 1 == ROUNDS {
            break;
        }
        wanted_m *= 1.05 * (needed_m / path.length_m().max(1.0)).clamp(1.0, 2.0);
    }
    let path = ArcPath::new(points);
    Ok(timed(grid, config, &person, &path, seed))
}

/// Speeds, stops and frames over a finished path.
fn timed(
    grid: &WalkableGrid,
    config: &PedestrianConfig,
    person: &Person,
    path: &ArcPath,
    seed: Seed,
) -> PedestrianPath {
    let may_stand =
        |s_m: f64| !matches!(grid.feet_at(path.at(s_m)).1, Some(WalkableKind::Crossing | WalkableKind::Road));
    let speeds = motion::knot_speeds(path, config, person.cruise_mps, seed);
    let stops = motion::random_stops(path.length_m(), config, seed, &may_stand);
    let frames = motion::frames(path, &speeds, &stops, config, true).unwrap_or_default();
    let mut states = Vec::with_capacity(frames.len());
    let mut ground = Vec::with_capacity(frames.len());
    for frame in &frames {
        let (feet_in_world, kind) = grid.feet_at(frame.position);
        states.push(TargetState { feet_in_world, heading_rad: frame.heading_rad, speed_mps: frame.speed_mps });
        ground.push(kind.or(ground.last().copied()).unwrap_or(WalkableKind::Sidewalk));
    }
    let standing = frames.iter().map(|frame| frame.standing).collect();
    PedestrianPath { track: person.track(config, states), ground, standing }
}

/// Somebody who sits at an edge of the walkable ground and faces away from it.
fn seated(
    grid: &WalkableGrid,
    config: &PedestrianConfig,
    person: &Person,
    seed: Seed,
) -> Result<PedestrianPath, PedestrianError> {
    let (mut stream, roomy) = (seed.stream("goals"), roomy_pieces(grid, config.min_route_m)?);
    let mut place = (DVec2::ZERO, DVec2::X);
    for _ in 0..SEAT_ATTEMPTS {
        let at = grid.center(draw_start(grid, &roomy, &mut stream).1);
        place = (at, grid.away_from_edge(at));
        if place.1.length() >= SEAT_EDGE {
            break;
        }
    }
    let (feet_in_world, kind) = grid.feet_at(place.0);
    let state = TargetState { feet_in_world, heading_rad: real::atan2(place.1.y, place.1.x), speed_mps: 0.0 };
    let frames = config.frames as usize;
    let ground = vec![kind.unwrap_or(WalkableKind::Sidewalk); frames];
    Ok(PedestrianPath { track: person.track(config, vec![state; frames]), ground, standing: vec![true; frames] })
}

/// Kind, body and cruise speed of the person who walks.
struct Person {
    kind: BodyKind,
    cruise_mps: f64,
    height_m: f64,
    radius_m: f64,
}

impl Person {
    /// The person, and the config with the limits of the kind's speed.
    fn drawn(config: &PedestrianConfig, seed: Seed) -> (Self, PedestrianConfig) {
        let mut stream = seed.stream("person");
        let SpeedConfig { mean_mps, deviation_mps, min_mps, max_mps } = config.speed;
        let cruise_mps = stream.normal(mean_mps, deviation_mps).clamp(min_mps, max_mps);
        let height_m = stream.uniform(config.height.min_m, config.height.max_m);
        let radius_m = stream.uniform(config.radius.min_m, config.radius.max_m);
        let kind = config.kinds.draw(&seed);
        let OfKind { pace, height_m, radius_m } = OfKind::drawn(kind, &seed, height_m, radius_m);
        let speed = SpeedConfig { min_mps: pace * min_mps, max_mps: pace * max_mps, ..config.speed.clone() };
        let person = Self { kind, cruise_mps: cruise_mps * pace, height_m, radius_m };
        (person, PedestrianConfig { speed, ..config.clone() })
    }

    fn track(&self, config: &PedestrianConfig, states: Vec<TargetState>) -> TargetTrack {
        TargetTrack { dt_s: config.dt_s, height_m: self.height_m, radius_m: self.radius_m, states }
    }
}

/// A route that grows goal by goal.
struct GoalChain<'a> {
    grid: &'a WalkableGrid,
    search: RouteSearch<&'a WalkableGrid>,
    stream: RandomStream,
    component: u32,
    nodes: Vec<u32>,
    length_m: f64,
    /// Whether the person turns about every few metres.
    restless: bool,
    /// No route leads on.
    ended: bool,
}

impl<'a> GoalChain<'a> {
    fn new(grid: &'a WalkableGrid, config: &PedestrianConfig, seed: Seed) -> Result<Self, PedestrianError> {
        let mut stream = seed.stream("goals");
        let roomy = roomy_pieces(grid, config.min_route_m)?;
        let start = draw_start(grid, &roomy, &mut stream);
        Ok(Self {
            grid,
            search: RouteSearch::new(grid, config.edge_distance_m, LONE_COSTS, TASTE_SHARE, seed),
            stream,
            component: start.0,
            nodes: vec![start.1],
            length_m: 0.0,
            restless: seed.stream("restless").unit() < config.restless_share,
            ended: false,
        })
    }

    /// The route of about `wanted_m`, longer by goals until it is, then cut.
    fn route(&mut self, wanted_m: f64) -> Vec<DVec2> {
        while self.length_m < wanted_m && !self.ended {
            self.ended = !self.grow((wanted_m - self.length_m).clamp(SHORTEST_LEG_M, LONGEST_LEG_M));
        }
        let mut route: Vec<DVec2> = vec![];
        let mut length_m = 0.0;
        for &node in &self.nodes {
            let center = self.grid.center(node);
            length_m += route.last().map_or(0.0, |last| (center - *last).length());
            route.push(center);
            if length_m > wanted_m {
                break;
            }
        }
        route
    }

    /// Adds the route to one more goal; false when none was found.
    fn grow(&mut self, leg_m: f64) -> bool {
        (self.restless && self.turn_about()) || self.go_on(leg_m)
    }

    /// Adds a few metres to the side or back; false when no such way was found.
    fn turn_about(&mut self) -> bool {
        let here = self.nodes[self.nodes.len() - 1];
        let before = self.nodes.len().checked_sub(1 + TURN_NODES).map(|place| self.nodes[place]);
        for _ in 0..GOAL_ATTEMPTS {
            let goal = draw_turn(self.grid, self.component, (here, before), &mut self.stream);
            let way = goal.and_then(|goal| self.search.find_within(here, goal, &[], LONGEST_TURN_M));
            if let Some(way) = way.filter(|way| way.len() > 1) {
                self.add(&way);
                return true;
            }
        }
        false
    }

    /// Adds the route to a goal ahead.
    fn go_on(&mut self, leg_m: f64) -> bool {
        let here = self.nodes[self.nodes.len() - 1];
        let mut refusals = 0;
        for attempt in 0..GOAL_ATTEMPTS {
            let before = self.nodes.len().checked_sub(BEHIND_NODES / 2).map(|place| self.nodes[place]);
            let Some(goal) = draw_goal(self.grid, self.component, (here, before), leg_m, attempt, &mut self.stream)
            else {
                continue;
            };
            let behind = &self.nodes[self.nodes.len().saturating_sub(BEHIND_NODES)..self.nodes.len() - 1];
            if let Some(way) = self.search.find(here, goal, behind)
                && way.len() > 1
            {
                let turns_back = way.get(TURNING_BACK_STEPS).is_some_and(|node| behind.contains(node));
                if turns_back && refusals < TURNING_BACK_REFUSALS {
                    refusals += 1;
                    continue;
                }
                self.add(&way);
                return true;
            }
        }
        false
    }

    fn add(&mut self, way: &[u32]) {
        let steps = way.windows(2).map(|pair| (self.grid.center(pair[1]) - self.grid.center(pair[0])).length());
        self.length_m += steps.sum::<f64>();
        self.nodes.extend(&way[1..]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::test_towns::{rectangle, streets, town};
    use crate::{AreaConfig, AreaPicture, KindShares};
    use std::sync::Arc;

    fn seed(item: u32) -> Seed {
        Seed::of_item(11, "walkers", &format!("p{item}"))
    }

    /// The law of a walk, on the exact ground and the exact obstacles.
    fn check_walk(town: &cosfly_domain::Town, grid: &WalkableGrid, config: &PedestrianConfig, walked: &PedestrianPath) {
        let track = &walked.track;
        assert_eq!((track.len(), track.dt_s), (config.frames as usize, config.dt_s));
        assert_eq!((walked.ground.len(), walked.standing.len()), (track.len(), track.len()));
        for (i, state) in track.states.iter().enumerate() {
            let feet = state.feet_in_world;
            let (kind, z) = grid.ground().at(feet.truncate(), feet.z).unwrap();
            assert_eq!((kind, z), (walked.ground[i], feet.z));
            assert_eq!(walked.standing[i], state.speed_mps == 0.0);
            if !walked.standing[i] {
                assert!((config.speed.min_mps..=config.speed.max_mps).contains(&state.speed_mps));
            }
            for thing in &town.obstacles {
                let offset = feet.truncate() - thing.shape.center_in_world.truncate();
                assert_eq!(thing.shape.yaw_rad, 0.0);
                let outside = (offset.abs() - thing.shape.half_extents_m.truncate()).max(DVec2::ZERO);
                assert!(outside.length() >= track.radius_m, "frame {i} at {feet}");
            }
        }
        for (i, pair) in track.states.windows(2).enumerate() {
            let moved = (pair[1].feet_in_world - pair[0].feet_in_world).truncate().length();
            assert!(moved <= config.speed.max_mps * config.dt_s + 1e-9);
            if walked.standing[i] && walked.standing[i + 1] {
                assert_eq!((moved, pair[0].heading_rad), (0.0, pair[1].heading_rad));
            }
        }
    }

    #[test]
    fn forty_walks_keep_the_law() {
        let (town, config) = (streets(), PedestrianConfig::default());
        let grid = WalkableGrid::build(&town, &config).unwrap();
        let (mut crossed, mut stood) = (0, 0);
        for item in 0..40 {
            let walked = walk(&grid, &config, seed(item)).unwrap();
            check_walk(&town, &grid, &config, &walked);
            let asked = 0.6 * config.speed.min_mps * walked.track.duration_s();
            assert!(walked.track.length_m() > asked, "{}", walked.track.length_m());
            crossed += usize::from(walked.ground.contains(&WalkableKind::Crossing));
            stood += usize::from(walked.standing.contains(&true));
            assert!(!walked.standing[walked.standing.len() - 20..].iter().all(|standing| *standing));
        }
        assert!(crossed > 20 && stood > 15, "{crossed} crossed, {stood} stood");
    }

    #[test]
    fn every_point_between_frames_is_free_too() {
        let (town, config) = (streets(), PedestrianConfig::default());
        let grid = WalkableGrid::build(&town, &config).unwrap();
        for item in 0..10 {
            let mut chain = GoalChain::new(&grid, &config, seed(item)).unwrap();
            let points = smooth(&grid, &chain.route(200.0), config.simplify_m);
            for pair in points.windows(2) {
                let (a, b) = (pair[0].extend(0.0), pair[1].extend(0.0));
                assert!((b - a).length() <= crate::smooth::CHORD_M + 1e-9);
                assert!(grid.ground().covers(a, b), "{a} to {b}");
            }
        }
    }

    #[test]
    fn a_walk_depends_on_its_seed_alone() {
        let (town, config) = (streets(), PedestrianConfig::default());
        let grid = WalkableGrid::build(&town, &config).unwrap();
        let again = WalkableGrid::build(&town, &config).unwrap();
        let first = walk(&grid, &config, seed(1)).unwrap();
        walk(&grid, &config, seed(2)).unwrap();
        assert_eq!(first, walk(&again, &config, seed(1)).unwrap());
        assert_ne!(first, walk(&grid, &config, seed(2)).unwrap());
    }

    #[test]
    fn restless_people_turn_a_quarter_in_most_windows() {
        let (town, config) = (streets(), PedestrianConfig { restless_share: 1.0, ..PedestrianConfig::default() });
        let grid = WalkableGrid::build(&town, &config).unwrap();
        let turns_deg = (0..20).map(|item| {
            let walked = walk(&grid, &config, seed(item)).unwrap();
            check_walk(&town, &grid, &config, &walked);
            let headings: Vec<f64> = walked.track.states.iter().map(|state| state.heading_rad).collect();
            let turn = |pair: &[f64]| cosfly_frames::real::wrap_angle_rad(pair[1] - pair[0]).abs().to_degrees();
            let mut windows: Vec<f64> = headings.windows(10).map(|of| of.windows(2).map(turn).sum()).collect();
            windows.sort_by(f64::total_cmp);
            windows[windows.len() / 2]
        });
        let turns_deg: Vec<f64> = turns_deg.collect();
        println!("{turns_deg:.0?}");
        assert!(turns_deg.iter().all(|turn| *turn >= 90.0), "{turns_deg:.0?}");
    }

    #[test]
    fn areas_say_where_walks_begin_and_where_nobody_goes() {
        let area = |min: [f64; 2], max: [f64; 2], weight, closed| AreaConfig {
            polygon_m: vec![min, [max[0], min[1]], max, [min[0], max[1]]],
            weight,
            closed,
            ..AreaConfig::default()
        };
        let everywhere = area([-500.0, -500.0], [500.0, 500.0], 0.0, false);
        let (west, east) =
            (area([-1.0, -1.0], [41.0, 200.0], 1.0, false), area([60.3, -20.0], [70.7, 200.0], 1.0, true));
        let config = PedestrianConfig { areas: vec![everywhere.clone(), west, east], ..PedestrianConfig::default() };
        let town = streets();
        let grid = WalkableGrid::build(&town, &config).unwrap();
        let mut farthest_m = 0.0_f64;
        for item in 0..20 {
            let walked = walk(&grid, &config, seed(item)).unwrap();
            check_walk(&town, &grid, &config, &walked);
            assert!(walked.track.states[0].feet_in_world.x < 41.0);
            farthest_m = walked.track.states.iter().map(|state| state.feet_in_world.x).fold(farthest_m, f64::max);
        }
        assert!(farthest_m > 35.0 && farthest_m < 60.3, "{farthest_m}");
        // The same as pictures: white in the west, where walks begin, and closed in the east.
        let picture = |is_white: fn(usize) -> bool, closed| {
            let grey = (0..250_000).map(|pixel| if is_white(pixel % 500) { 255 } else { 0 }).collect();
            let (min_m, max_m) = (Some([-500.0; 2]), Some([500.0; 2]));
            let pixels = Some(Arc::new(AreaPicture { size: [500, 500], grey }));
            AreaConfig { picture: Some(String::new()), min_m, max_m, closed, pixels, ..AreaConfig::default() }
        };
        let areas = vec![picture(|column| column < 270, false), picture(|column| column >= 280, true)];
        let config = PedestrianConfig { areas, ..PedestrianConfig::default() };
        let grid = WalkableGrid::build(&town, &config).unwrap();
        farthest_m = 0.0;
        for item in 0..20 {
            let walked = walk(&grid, &config, seed(item)).unwrap();
            check_walk(&town, &grid, &config, &walked);
            assert!(walked.track.states[0].feet_in_world.x < 40.0);
            farthest_m = walked.track.states.iter().map(|state| state.feet_in_world.x).fold(farthest_m, f64::max);
        }
        assert!(farthest_m > 35.0 && farthest_m < 60.0, "{farthest_m}");
        let nowhere = PedestrianConfig { areas: vec![everywhere], ..PedestrianConfig::default() };
        let grid = WalkableGrid::build(&town, &nowhere).unwrap();
        let error = walk(&grid, &nowhere, seed(0)).unwrap_err();
        assert_eq!(error.to_string(), "`areas` give all walkable ground the weight 0, so no walk can begin");
    }

    #[test]
    fn a_small_ground_is_walked_to_and_fro_for_all_frames() {
        let config = PedestrianConfig::default();
        let town = town(vec![rectangle(WalkableKind::Sidewalk, (0.0, 0.0), (25.0, 2.0), 0.0)], vec![]);
        let grid = WalkableGrid::build(&town, &config).unwrap();
        let walked = walk(&grid, &config, seed(0)).unwrap();
        check_walk(&town, &grid, &config, &walked);
        assert!(walked.track.length_m() > 60.0, "{}", walked.track.length_m());
    }

    #[test]
    fn every_kind_has_its_size_pace_and_clearance_and_sitters_stay() {
        let town = streets();
        let share = |kinds: KindShares| PedestrianConfig { kinds, ..PedestrianConfig::default() };
        let mean = |kinds: KindShares| {
            let config = share(kinds);
            let grid = WalkableGrid::build(&town, &config).unwrap();
            let walks: Vec<_> = (0..6).map(|item| walk(&grid, &config, seed(item)).unwrap().track).collect();
            walks.iter().for_each(|track| assert_eq!(track.len(), config.frames as usize));
            let of_all = |of: fn(&TargetTrack) -> f64| walks.iter().map(of).sum::<f64>() / 6.0;
            [of_all(TargetTrack::length_m), of_all(|it| it.height_m), of_all(|it| it.radius_m)]
        };
        let grown = mean(KindShares::default());
        let runner = mean(KindShares { runner: 1.0, ..KindShares::default() });
        assert!(runner[0] > 1.5 * grown[0] && runner[1..] == grown[1..], "{runner:?} {grown:?}");
        let elder = mean(KindShares { elder: 1.0, ..KindShares::default() });
        assert!(elder[0] < 0.85 * grown[0] && elder[1] < grown[1], "{elder:?} {grown:?}");
        let push_chair = mean(KindShares { push_chair: 1.0, ..KindShares::default() });
        assert!(push_chair[0] > 30.0 && push_chair[2] == 0.75, "{push_chair:?}");
        let sitter = mean(KindShares { sitter: 1.0, ..KindShares::default() });
        assert!(sitter[0] == 0.0 && sitter[2] == 0.525, "{sitter:?}");
        let config = share(KindShares { child: 0.6, elder: 0.6, ..KindShares::default() });
        assert_eq!(WalkableGrid::build(&town, &config).unwrap_err().to_string().split('`').nth(1), Some("1.2"));
    }

    #[test]
    fn islands_too_small_for_a_walk_are_not_started_on() {
        let config = PedestrianConfig::default();
        let mut walkable: Vec<_> = (0..200)
            .map(|i| {
                rectangle(WalkableKind::Sidewalk, (5.0 * f64::from(i), 50.0), (5.0 * f64::from(i) + 4.0, 54.0), 0.0)
            })
            .collect();
        walkable.push(rectangle(WalkableKind::Sidewalk, (0.0, 0.0), (60.0, 2.0), 0.0));
        let grid = WalkableGrid::build(&town(walkable.clone(), vec![]), &config).unwrap();
        for item in 0..20 {
            let walked = walk(&grid, &config, seed(item)).unwrap();
            assert!(walked.track.states.iter().all(|state| state.feet_in_world.y < 2.0));
        }
        walkable.pop();
        let grid = WalkableGrid::build(&town(walkable, vec![]), &config).unwrap();
        let error = walk(&grid, &config, seed(0)).unwrap_err();
        assert_eq!(
            error.to_string(),
            "the largest connected piece of walkable ground is 4.9 m across; `min_route_m` asks for 20 m"
        );
        assert_eq!(error.hint(), "set `min_route_m` to 4 or less, or choose a map whose pavements are connected");
    }

    #[test]
    fn other_steps_and_time_steps_are_kept_exactly() {
        let town = streets();
        let mut config = PedestrianConfig { frames: 37, dt_s: 0.1, ..PedestrianConfig::default() };
        let grid = WalkableGrid::build(&town, &config).unwrap();
        check_walk(&town, &grid, &config, &walk(&grid, &config, seed(0)).unwrap());
        config.frames = 2000;
        config.dt_s = 0.5;
        check_walk(&town, &grid, &config, &walk(&grid, &config, seed(0)).unwrap());
    }
}
