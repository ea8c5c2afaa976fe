//! Acceleration of a driver: the intelligent driver model, bends, people on crossings.

use crate::network::{Crossing, Network};
use crate::outlines::{LEVEL_M, to_outline};
use crate::route::Route;
use crate::vehicle::{BEFORE_JUNCTION_M, STANDING_GAP_M};
use cosfly_domain::Driving;
use cosfly_frames::DVec2;
use cosfly_town::polygons::contains;
use cosfly_world::{Present, Snapshot};

/// Hardest braking, m/s^2.
const HARDEST_MPS2: f64 = 8.0;
/// Braking for people that no driver refuses, m/s^2.
const FOR_PEOPLE_MPS2: f64 = 5.0;
/// Time in which a driver who is too fast slows down, seconds.
const TOO_FAST_S: f64 = 0.5;
/// Room beside the vehicle that must be free ahead: of vehicles, of people, metres.
const BESIDE_M: [f64; 2] = [0.2, 0.5];
/// Distance between the places ahead that are looked at, metres.
const SPACING_M: f64 = 1.0;
/// People are expected to go on for this long, seconds.
const EXPECTED_S: [f64; 5] = [0.5, 1.0, 1.5, 2.0, 2.5];
/// People on a crossing matter within this distance of the lane's middle, metres.
const NEAR_LANE_M: f64 = 4.5;
/// Vehicles stop this far before a crossing, metres.
const BEFORE_CROSSING_M: f64 = 1.0;

/// One driver and where the vehicle is.
pub(crate) struct Driver<'a> {
    pub network: &'a Network,
    pub route: &'a Route,
    pub limits: &'a Driving,
    /// Share of the speed limit that the driver takes.
    pub speed_share: f64,
    pub headway_s: f64,
    pub number: u32,
    pub way_m: f64,
    pub speed_mps: f64,
    pub length_m: f64,
    pub width_m: f64,
    /// Way at which the vehicle must stop, if any.
    pub stop_m: Option<f64>,
}

/// Something ahead: the gap to it, and its speed along the route.
#[derive(Clone, Copy)]
struct Ahead {
    gap_m: f64,
    speed_mps: f64,
}

impl Driver<'_> {
    fn front_m(&self) -> f64 {
        self.way_m + 0.5 * self.length_m
    }

    /// How far the driver looks, metres.
    fn look_m(&self) -> f64 {
        let braking_m = self.speed_mps * self.speed_mps / (2.0 * self.limits.brake_mps2);
        (braking_m + 2.0 * self.speed_mps + 12.0).min(100.0)
    }

    /// Acceleration, m/s^2. `near` is room for a list.
    pub fn acceleration(&self, everybody: &Snapshot, near: &mut Vec<Present>) -> f64 {
        let wanted_mps = self.wanted_mps().max(0.5);
        let Driving { accelerate_mps2, brake_mps2, .. } = *self.limits;
        let free = match self.speed_mps / wanted_mps {
            share if share <= 1.0 => accelerate_mps2 * (1.0 - share * share * share * share),
            _ => ((wanted_mps - self.speed_mps) / TOO_FAST_S).max(-1.5 * brake_mps2),
        };
        let towards = |ahead: Ahead| {
            let closing_mps = self.speed_mps - ahead.speed_mps;
            let braking_m = self.speed_mps * closing_mps / (2.0 * (accelerate_mps2 * brake_mps2).sqrt());
            let wanted_m = STANDING_GAP_M + (self.speed_mps * self.headway_s + braking_m).max(0.0);
            let share = wanted_m / ahead.gap_m.max(0.1);
            accelerate_mps2 * share * share
        };
        let mut worst = 0.0_f64;
        self.for_each_ahead(everybody, near, |ahead| worst = worst.max(towards(ahead)));
        (free - worst).max(-HARDEST_MPS2)
    }

    /// A speed from which the driver need not brake hard, m/s.
    pub fn calm_speed_mps(&self, everybody: &Snapshot, near: &mut Vec<Present>) -> f64 {
        let mut calm_mps = self.wanted_mps();
        self.for_each_ahead(everybody, near, |ahead| {
            let free_m = (ahead.gap_m - STANDING_GAP_M).max(0.0);
            calm_mps = calm_mps.min((self.limits.brake_mps2 * free_m).sqrt()).min(free_m / self.headway_s);
        });
        calm_mps
    }

    /// Speed by limits and bends, m/s.
    fn wanted_mps(&self) -> f64 {
        let Driving { top_mps, brake_mps2, sideways_mps2, .. } = *self.limits;
        let look_m = self.look_m();
        // Drivers do not slow down at once: they begin so much earlier than they need.
        let early_m = 2.0 * TOO_FAST_S * self.speed_mps;
        let mut wanted_mps = top_mps;
        let steps = (look_m / SPACING_M) as usize;
        for step in 0..=steps {
            let ahead_m = step as f64 * SPACING_M;
            let way_m = self.way_m + ahead_m;
            if way_m > self.route.end_m {
                break;
            }
            let (lane, _) = self.route.lane(self.network, way_m);
            let in_bend = (sideways_mps2 / self.route.curvature(way_m, SPACING_M).max(1e-6)).sqrt();
            let here_mps = in_bend.min(self.speed_share * lane.limit_mps);
            // Bends may be reached while braking; limits, too.
            let braking_m = (ahead_m - early_m).max(0.0);
            wanted_mps = wanted_mps.min((here_mps * here_mps + 2.0 * 0.7 * brake_mps2 * braking_m).sqrt());
        }
        wanted_mps
    }

    fn for_each_ahead(&self, everybody: &Snapshot, near: &mut Vec<Present>, mut visit: impl FnMut(Ahead)) {
        if let Some(stop_m) = self.stop_m {
            let gap_m = stop_m - self.front_m() + STANDING_GAP_M - BEFORE_JUNCTION_M;
            visit(Ahead { gap_m, speed_mps: 0.0 });
        }
        self.bodies_ahead(everybody, near, &mut visit);
        self.crossings_ahead(everybody, &mut visit);
    }

    /// Bodies on the strip that the vehicle will cover.
    fn bodies_ahead(&self, everybody: &Snapshot, near: &mut Vec<Present>, visit: &mut impl FnMut(Ahead)) {
        let look_m = self.look_m();
        let [from, to] = [0.0, look_m].map(|ahead| self.route.at(self.network, self.front_m() + ahead).0);
        let height_m = from.z;
        let (middle, radius_m) = (0.5 * (from + to).truncate(), 0.5 * (to - from).truncate().length());
        near.clear();
        everybody.near(middle, radius_m + 0.5 * look_m.min(30.0) + 3.0, |body| {
            if body.number != self.number && (body.state.feet_in_world.z - height_m).abs() < LEVEL_M + 0.05 * look_m {
                near.push(*body);
            }
        });
        if near.is_empty() {
            return;
        }
        let steps = (look_m / SPACING_M) as usize;
        let [beside_m, beside_people_m] = BESIDE_M.map(|margin_m| 0.5 * self.width_m + margin_m);
        for step in 0..=steps {
            let ahead_m = step as f64 * SPACING_M;
            let (point, along) = self.route.at(self.network, self.front_m() + ahead_m);
            near.retain(|body| {
                let is_person = body.kind.is_person();
                let reach_m = if is_person { beside_people_m } else { beside_m };
                let mut to_body = to_outline(point.truncate(), body);
                if is_person && to_body.length() >= reach_m {
                    let later = body.velocity_mps;
                    to_body = to_outline(point.truncate() - later, body);
                }
                if to_body.length() >= reach_m {
                    return true;
                }
                let gap_m = ahead_m + to_body.dot(along).max(0.0);
                let speed_mps = if is_person { 0.0 } else { body.velocity_mps.dot(along).max(0.0) };
                visit(Ahead { gap_m, speed_mps });
                false
            });
            if near.is_empty() {
                break;
            }
        }
    }

    /// Crossings with people on them or about to be.
    fn crossings_ahead(&self, everybody: &Snapshot, visit: &mut impl FnMut(Ahead)) {
        let (front_m, look_m) = (self.front_m(), self.look_m());
        let first = self.route.index(front_m);
        for index in first..self.route.lanes.len() {
            let start_m = self.route.starts_m[index];
            if start_m > front_m + look_m {
                break;
            }
            for crossing in &self.network.lanes[self.route.lanes[index] as usize].crossings {
                let gap_m = start_m + crossing.from_m - BEFORE_CROSSING_M - front_m;
                if gap_m < -BEFORE_CROSSING_M || gap_m > look_m {
                    continue;
                }
                let needed_mps2 = self.speed_mps * self.speed_mps / (2.0 * gap_m.max(0.1));
                if needed_mps2 < FOR_PEOPLE_MPS2 && is_taken(crossing, everybody) {
                    visit(Ahead { gap_m: gap_m + STANDING_GAP_M - 0.5, speed_mps: 0.0 });
                }
            }
        }
    }
}

/// Whether somebody is on a crossing near the lane, or will be soon.
fn is_taken(crossing: &Crossing, everybody: &Snapshot) -> bool {
    let is_on = |place: DVec2| {
        (place - crossing.middle).length_squared() < NEAR_LANE_M * NEAR_LANE_M && contains(&crossing.outline, place)
    };
    let mut is_taken = false;
    everybody.near(crossing.middle, NEAR_LANE_M + 5.0, |body| {
        if is_taken || !body.kind.is_person() {
            return;
        }
        let place = body.state.feet_in_world.truncate();
        is_taken = is_on(place) || EXPECTED_S.iter().any(|later_s| is_on(place + *later_s * body.velocity_mps));
    });
    is_taken
}
