//! [`Company`]: people who walk together, one or more: their route, their stops.

use crate::WalkableGrid;
use crate::crowd::CrowdConfig;
use crate::crowd::person::Person;
use crate::goal::{GOAL_ATTEMPTS, LONGEST_LEG_M, LONGEST_TURN_M, TURN_NODES, draw_goal, draw_turn};
use crate::route::RouteSearch;
use cosfly_domain::WalkableKind;
use cosfly_frames::{DVec2, RandomStream, Seed, real};
use std::ops::Range;
use std::sync::Arc;

/// A route whose end is nearer than this many nodes is led on.
const SPARE_NODES: usize = 40;
const SPARE_RESTLESS_NODES: usize = 14;

/// Nodes behind that are kept, and those that the way on avoids.
const KEPT_NODES: usize = 60;

/// Nodes ahead of the present one that may become the present one in a step.
const AHEAD_NODES: usize = 12;

/// Ways that cost more than so many metres of pavement are given up for another goal, in the first attempts.
const DEAR_M: f32 = 250.0;
const CHEAP_ATTEMPTS: usize = 20;

/// Who has not come so far in so long looks for another way, metres and seconds.
const STUCK_M: f64 = 0.7;
const STUCK_S: f64 = 12.0;

/// A way on that goes back within so many nodes is given up for another goal, at most so many times.
const TURNING_BACK_NODES: usize = 6;
const TURNING_BACK_REFUSALS: usize = 6;

/// Activity of a company.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Activity {
    /// Walks along the route.
    Walking,
    /// Slows down and stands until a time, seconds since frame 0.
    Standing { until_s: f64 },
}

/// People who walk together.
#[derive(Clone, Debug)]
pub(crate) struct Company {
    /// Members, as numbers within the crowd.
    pub members: Range<usize>,
    /// Number of the company among the groups of several people.
    pub group: Option<u32>,
    /// Nodes of the way behind and ahead.
    pub route: Vec<u32>,
    /// Free speed of the slowest member, m/s.
    pub cruise_mps: f64,
    /// Distance between neighbours, metres.
    pub abreast_m: f64,
    pub activity: Activity,
    /// Number of the piece of ground.
    pub piece: u32,
    stream: RandomStream,
    /// Turns about every few metres.
    pub restless: bool,
    /// Distance to the next stop, metres.
    until_stop_m: f64,
    /// Place of the first member and time when it was last seen to get on.
    seen: (DVec2, f64),
}

impl Company {
    /// A company that begins at a node.
    pub fn new(
        members: Range<usize>,
        group: Option<u32>,
        (piece, start): (u32, u32),
        config: &CrowdConfig,
        seed: Seed,
    ) -> Self {
        let mut stream = seed.stream("company");
        let stands = stream.chance(config.stops.standing_share);
        let mut company = Self {
            members,
            group,
            route: vec![start],
            cruise_mps: f64::INFINITY,
            abreast_m: config.groups.abreast_m,
            activity: if stands { Activity::Standing { until_s: f64::INFINITY } } else { Activity::Walking },
            piece,
            stream,
            restless: seed.stream("restless").unit() < config.restless_share,
            until_stop_m: 0.0,
            seen: (DVec2::ZERO, 0.0),
        };
        company.until_stop_m = company.way_to_stop_m(config);
        company
    }

    /// Brings the members' progress up to date, leads the route on, begins and ends stops.
    pub fn decide(
        &mut self,
        people: &mut [Person],
        search: &mut RouteSearch<Arc<WalkableGrid>>,
        grid: &WalkableGrid,
        config: &CrowdConfig,
        (time_s, step_s): (f64, f64),
    ) {
        for person in people.iter_mut() {
            self.follow(person, grid);
        }
        if let Activity::Standing { until_s } = self.activity {
            self.seen = (people[0].at, time_s);
            if time_s >= until_s {
                self.activity = Activity::Walking;
            }
            return;
        }
        if (people[0].at - self.seen.0).length() > STUCK_M {
            self.seen = (people[0].at, time_s);
        }
        // Nobody turns round in the middle of a road.
        if time_s - self.seen.1 > STUCK_S && people.iter().all(|person| self.is_off_roads(person, grid)) {
            self.turn_round(people, search, grid);
            self.seen = (people[0].at, time_s);
        }
        let hindmost = people.iter().map(|person| person.progress).min().unwrap_or_default();
        let spare = if self.restless { SPARE_RESTLESS_NODES } else { SPARE_NODES };
        if self.route.len() - hindmost < spare && !(self.restless && self.turn_about(search, grid)) {
            self.lead_on(search, grid);
        }
        if hindmost > 4 * KEPT_NODES {
            let gone = hindmost - KEPT_NODES;
            self.route.drain(..gone);
            people.iter_mut().for_each(|person| person.progress -= gone);
        }
        self.until_stop_m -= people[0].velocity_mps.length() * step_s;
        if self.until_stop_m <= 0.0 && people.iter().all(|person| self.may_stand(person, grid)) {
            let length_s = config.stops.median_s * real::exp(config.stops.log_deviation * self.stream.normal(0.0, 1.0));
            let slowing_s = self.cruise_mps / config.braking_mps2;
            self.activity = Activity::Standing { until_s: time_s + slowing_s + length_s.min(config.stops.max_s) };
            self.until_stop_m = self.way_to_stop_m(config);
        }
    }

    /// Exponential distance to the next stop, metres; infinite without stops.
    fn way_to_stop_m(&mut self, config: &CrowdConfig) -> f64 {
        let way_m = -100.0 / config.stops.per_100m * real::ln(1.0 - self.stream.unit());
        if way_m.is_finite() { way_m } else { f64::INFINITY }
    }

    /// Whether the ground under and just ahead of a person is no road.
    fn may_stand(&self, person: &Person, grid: &WalkableGrid) -> bool {
        let ahead = person.progress..(person.progress + 5).min(self.route.len());
        self.route[ahead].iter().all(|node| !is_road(grid.nodes[*node as usize].kind))
    }

    /// Whether the ground under a person is no road.
    fn is_off_roads(&self, person: &Person, grid: &WalkableGrid) -> bool {
        !grid.kind_at(person.at).is_some_and(is_road)
    }

    /// The node of the route that the person is nearest to, searched around the last one.
    fn follow(&self, person: &mut Person, grid: &WalkableGrid) {
        let range = person.progress.saturating_sub(2)..(person.progress + AHEAD_NODES).min(self.route.len());
        let away = |place: &usize| (grid.center(self.route[*place]) - person.at).length_squared();
        person.progress = range.min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(person.progress);
    }

    /// Adds a few metres to the side or back; false where no such way was found.
    fn turn_about(&mut self, search: &mut RouteSearch<Arc<WalkableGrid>>, grid: &WalkableGrid) -> bool {
        let Some(&here) = self.route.last() else { return false };
        let before = self.route.len().checked_sub(1 + TURN_NODES).map(|place| self.route[place]);
        for _ in 0..GOAL_ATTEMPTS {
            let goal = draw_turn(grid, self.piece, (here, before), &mut self.stream);
            let way = goal.and_then(|goal| search.find_within(here, goal, &[], LONGEST_TURN_M));
            if let Some(way) = way.filter(|way| way.len() > 1) {
                self.route.extend(&way[1..]);
                return true;
            }
        }
        false
    }

    /// Adds the way to one more goal.
    fn lead_on(&mut self, search: &mut RouteSearch<Arc<WalkableGrid>>, grid: &WalkableGrid) {
        let Some(&here) = self.route.last() else { return };
        let before = self.route.len().checked_sub(KEPT_NODES / 2).map(|place| self.route[place]);
        let mut refusals = 0;
        for attempt in 0..GOAL_ATTEMPTS {
            let Some(goal) = draw_goal(grid, self.piece, (here, before), LONGEST_LEG_M, attempt, &mut self.stream)
            else {
                continue;
            };
            let behind = &self.route[self.route.len().saturating_sub(KEPT_NODES)..self.route.len() - 1];
            let most = if attempt < CHEAP_ATTEMPTS { DEAR_M } else { f32::INFINITY };
            if let Some(way) = search.find_within(here, goal, behind, most)
                && way.len() > 1
            {
                let turns_back = way.get(TURNING_BACK_NODES).is_some_and(|node| behind.contains(node));
                if turns_back && refusals < TURNING_BACK_REFUSALS {
                    refusals += 1;
                    continue;
                }
                self.route.extend(&way[1..]);
                return;
            }
        }
    }

    /// Begins a new route at the place of the first member, away from where it led.
    fn turn_round(&mut self, people: &mut [Person], search: &mut RouteSearch<Arc<WalkableGrid>>, grid: &WalkableGrid) {
        let ahead = self.route[(people[0].progress + 6).min(self.route.len() - 1)];
        let Some(here) = grid.node_near(people[0].at, self.piece, 4) else { return };
        self.route = vec![here];
        people.iter_mut().for_each(|person| person.progress = 0);
        for attempt in 0..GOAL_ATTEMPTS {
            let goal = draw_goal(grid, self.piece, (here, Some(ahead)), 0.5 * LONGEST_LEG_M, attempt, &mut self.stream);
            let most = if attempt < CHEAP_ATTEMPTS { DEAR_M } else { f32::INFINITY };
            if let Some(way) = goal.and_then(|goal| search.find_within(here, goal, &[ahead], most))
                && way.len() > 1
            {
                self.route = way;
                return;
            }
        }
    }
}

/// Whether vehicles have the right to be on this ground.
pub(crate) fn is_road(kind: WalkableKind) -> bool {
    matches!(kind, WalkableKind::Crossing | WalkableKind::Road)
}
