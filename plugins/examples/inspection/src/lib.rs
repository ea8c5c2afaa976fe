//! `inspection`: the faces of a building are covered from a stand-off distance, the viewpoints ordered by a tour.
//!
//! Viewpoints stand opposite a grid of points on the four sides of the building's box. Those without room or sight are left out.
//! The rest is ordered by a short tour: nearest neighbour, then turned round wherever that is shorter (2-opt). Distances are taken on
//! the unrolled surface, along the building and up, because the drone flies round it and not through it.

use cosfly_plugin::{Metadata, Objective, Plan, Point, Random, Site, libm, params, town, town::BuildingBox};

params! {
    /// How a building is inspected.
    pub struct Params {
        /// Number of the building among those that fit, counted on beyond the last from the first again; drawn when below 0.
        building: f64 = -1.0, [-1.0, 100000.0];
        /// Distance kept from the wall, metres.
        standoff_m: f64 = 10.0, [4.0, 60.0];
        /// Distance of the watched points, along the wall and up, metres.
        step_m: f64 = 6.0, [1.0, 30.0];
        /// Speed along the tour, m/s.
        speed_mps: f64 = 2.5, [0.3, 8.0];
        /// Lowest building that is chosen, metres.
        min_height_m: f64 = 6.0, [3.0, 200.0];
        /// Highest building that is chosen, metres.
        max_height_m: f64 = 30.0, [3.0, 300.0];
        /// Smallest share of the viewpoints that must have room and sight.
        min_share: f64 = 0.5, [0.05, 1.0];
    }
}

/// The watched point is this far in front of the wall, metres.
const OUT_M: f64 = 0.8;
/// The drone is this far above the watched point, in stand-off distances.
const ABOVE: f64 = 0.2;
/// How much it matters to be at the place.
const PULL: f64 = 0.02;
/// Largest side of a building that is chosen, metres.
const MAX_SIDE_M: f64 = 70.0;

/// See the crate.
pub struct Inspection(Params);

/// The outside of a box unrolled: along the wall and up.
struct Walls {
    center: Point,
    half: Point,
    axes: [[f64; 2]; 2],
    /// Bends round the corners with this radius, metres.
    standoff: f64,
}

/// A viewpoint on the unrolled walls.
#[derive(Clone, Copy, Debug, PartialEq)]
struct View {
    along: f64,
    up: f64,
}

impl Objective for Inspection {
    type Params = Params;

    fn describe() -> Metadata {
        let summary = "Covers the faces of a building from a stand-off distance, ordered by a tour.";
        Metadata { name: "inspection", version: "0.1.0", summary }
    }

    fn new(params: Params) -> Result<Self, String> {
        if params.min_height_m > params.max_height_m {
            return Err("`min_height_m` must not be above `max_height_m`".to_owned());
        }
        Ok(Self(params))
    }

    fn produce(&self, site: &Site) -> Result<Plan, String> {
        let mut buildings = hulls(&town::buildings());
        let all = buildings.len();
        buildings.retain(|it| self.fits(it));
        if buildings.is_empty() {
            return Err(format!("none of the town's {all} buildings is of the wanted size"));
        }
        let first = if self.0.building >= 0.0 {
            self.0.building as usize % buildings.len()
        } else {
            Random::new(site.seed).index(buildings.len())
        };
        let mut most = 0.0_f64;
        for turn in 0..buildings.len() {
            let walls = Walls::of(&buildings[(first + turn) % buildings.len()], self.0.standoff_m);
            let wanted = self.grid(&walls);
            let views: Vec<View> = self.open(&walls, &wanted, site.clearance);
            let share = views.len() as f64 / wanted.len().max(1) as f64;
            most = most.max(share);
            if share < self.0.min_share || views.len() < 2 {
                continue;
            }
            let mut plan = self.along(&walls, &tour(&views, walls.round()), site);
            if (8..=site.max_steps).contains(&plan.len()) {
                plan.note("viewpoints", format!("{} of {}", views.len(), wanted.len()));
                return Ok(plan);
            }
        }
        Err(format!(
            "none of the {} buildings of the wanted size has room for {:.0} % of the viewpoints; the best one for {:.0} %: a \
             smaller `standoff_m` or `min_share` helps",
            buildings.len(),
            100.0 * self.0.min_share,
            100.0 * most
        ))
    }
}

impl Inspection {
    fn fits(&self, hull: &BuildingBox) -> bool {
        let height = 2.0 * hull.half[2];
        let sides = 2.0 * hull.half[0].min(hull.half[1])..=2.0 * hull.half[0].max(hull.half[1]);
        (self.0.min_height_m..=self.0.max_height_m).contains(&height)
            && *sides.start() >= 4.0
            && *sides.end() <= MAX_SIDE_M
    }

    fn grid(&self, walls: &Walls) -> Vec<View> {
        let height = 2.0 * walls.half[2];
        let rows = libm::ceil((height - 3.0) / self.0.step_m).max(1.0) as usize;
        let mut views = Vec::new();
        for side in 0..4 {
            let length = walls.side(side);
            let columns = libm::ceil(length / self.0.step_m).max(1.0) as usize;
            for row in 0..rows {
                for column in 0..columns {
                    let along = walls.start(side) + length * (column as f64 + 0.5) / columns as f64;
                    views.push(View { along, up: 2.0 + (height - 3.0) * (row as f64 + 0.5) / rows as f64 });
                }
            }
        }
        views
    }

    /// Views with room for the drone and a free line of sight.
    fn open(&self, walls: &Walls, views: &[View], clearance: f64) -> Vec<View> {
        let (points, places): (Vec<Point>, Vec<Point>) = views.iter().map(|view| walls.stand(*view)).unzip();
        let room = town::distances(&places, clearance + 1.0);
        let sight = town::rays(&places, &points);
        let ground = town::ground(&places.iter().map(|place| [place[0], place[1]]).collect::<Vec<_>>());
        let is_open = |k: &usize| {
            let above = !ground[*k].is_finite() || places[*k][2] - ground[*k] > clearance + 1.0;
            room[*k] > clearance + 0.5 && sight[*k].is_infinite() && above
        };
        (0..views.len()).filter(is_open).map(|k| views[k]).collect()
    }

    /// The tour at even speed, round corners where it goes from side to side.
    fn along(&self, walls: &Walls, tour: &[View], site: &Site) -> Plan {
        let mut plan = Plan::default();
        let mut push = |view: View, pull: f64| {
            let (point, place) = walls.stand(view);
            plan.push(point, place, pull);
        };
        // Soft, since the tour bends: the camera passes every viewpoint, it does not stop there.
        let step = self.0.speed_mps.min(0.5 * site.max_speed) * site.dt;
        let mut left = 0.0;
        for pair in tour.windows(2) {
            let (across, up) = (wrapped(pair[1].along - pair[0].along, walls.round()), pair[1].up - pair[0].up);
            let way = libm::hypot(across, up);
            let mut done = left;
            while done < way {
                let share = done / way;
                push(View { along: pair[0].along + share * across, up: pair[0].up + share * up }, PULL);
                done += step;
            }
            left = done - way;
        }
        push(tour[tour.len() - 1], PULL);
        plan
    }
}

/// One box around the boxes of each building, turned like the largest of them.
fn hulls(boxes: &[BuildingBox]) -> Vec<BuildingBox> {
    let volume = |it: &BuildingBox| it.half[0] * it.half[1] * it.half[2];
    let mut hulls = Vec::new();
    for group in boxes.chunk_by(|a, b| a.building == b.building) {
        let largest =
            group.iter().copied().fold(group[0], |best, it| if volume(&it) > volume(&best) { it } else { best });
        let (sin, cos) = (libm::sin(largest.yaw), libm::cos(largest.yaw));
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for part in group {
            let (s, c) = (libm::sin(part.yaw), libm::cos(part.yaw));
            for corner in 0..8 {
                let sign = |bit: usize| if corner >> bit & 1 == 1 { 1.0 } else { -1.0 };
                let (a, b) = (sign(0) * part.half[0], sign(1) * part.half[1]);
                let (x, y) = (part.center[0] + c * a - s * b, part.center[1] + s * a + c * b);
                let turned = [cos * x + sin * y, cos * y - sin * x, part.center[2] + sign(2) * part.half[2]];
                for axis in 0..3 {
                    low[axis] = low[axis].min(turned[axis]);
                    high[axis] = high[axis].max(turned[axis]);
                }
            }
        }
        let middle = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), 0.5 * (low[2] + high[2])];
        hulls.push(BuildingBox {
            center: [cos * middle[0] - sin * middle[1], sin * middle[0] + cos * middle[1], middle[2]],
            half: [0.5 * (high[0] - low[0]), 0.5 * (high[1] - low[1]), 0.5 * (high[2] - low[2])],
            ..largest
        });
    }
    hulls
}

impl Walls {
    fn of(hull: &BuildingBox, standoff: f64) -> Self {
        let (sin, cos) = (libm::sin(hull.yaw), libm::cos(hull.yaw));
        Self { center: hull.center, half: hull.half, axes: [[cos, sin], [-sin, cos]], standoff }
    }

    fn side(&self, side: usize) -> f64 {
        2.0 * self.half[if side % 2 == 0 { 1 } else { 0 }]
    }

    /// The way round a corner.
    fn bend(&self) -> f64 {
        0.5 * core::f64::consts::PI * self.standoff
    }

    fn start(&self, side: usize) -> f64 {
        (0..side).map(|before| self.side(before) + self.bend()).sum()
    }

    /// Once round the building.
    fn round(&self) -> f64 {
        self.start(4)
    }

    /// The watched point and the place of the drone: opposite the wall, or on a quarter circle round a corner.
    fn stand(&self, view: View) -> (Point, Point) {
        let mut along = view.along - self.round() * libm::floor(view.along / self.round());
        let mut side = 0;
        while side < 3 && along >= self.side(side) + self.bend() {
            along -= self.side(side) + self.bend();
            side += 1;
        }
        let turn = ((along - self.side(side)) / self.standoff).max(0.0);
        let normal_angle = core::f64::consts::FRAC_PI_2 * side as f64 + turn;
        let forward = core::f64::consts::FRAC_PI_2 * (side as f64 + 1.0);
        let local = |angle: f64| [libm::cos(angle), libm::sin(angle)];
        let (out, ahead, normal) =
            (local(core::f64::consts::FRAC_PI_2 * side as f64), local(forward), local(normal_angle));
        let (deep, wide) = if side % 2 == 0 { (self.half[0], self.half[1]) } else { (self.half[1], self.half[0]) };
        let on_wall = along.min(self.side(side)) - wide;
        let foot = [out[0] * deep + ahead[0] * on_wall, out[1] * deep + ahead[1] * on_wall];
        let z = self.center[2] - self.half[2] + view.up;
        let at = |distance: f64, height: f64| {
            let (x, y) = (foot[0] + normal[0] * distance, foot[1] + normal[1] * distance);
            let [u, v] = self.axes;
            [self.center[0] + u[0] * x + v[0] * y, self.center[1] + u[1] * x + v[1] * y, height]
        };
        (at(OUT_M, z), at(self.standoff, z + ABOVE * self.standoff))
    }
}

/// The shorter way round.
fn wrapped(along: f64, round: f64) -> f64 {
    along - round * libm::floor(along / round + 0.5)
}

/// A short open tour through all views.
fn tour(views: &[View], round: f64) -> Vec<View> {
    let gap = |a: View, b: View| libm::hypot(wrapped(b.along - a.along, round), b.up - a.up);
    let mut left = views.to_vec();
    let mut tour = vec![left.swap_remove(0)];
    while !left.is_empty() {
        let here = tour[tour.len() - 1];
        let next = (0..left.len()).min_by(|a, b| gap(here, left[*a]).total_cmp(&gap(here, left[*b]))).unwrap_or(0);
        tour.push(left.swap_remove(next));
    }
    for _ in 0..20 {
        let mut is_shorter = false;
        for from in 0..tour.len() - 1 {
            for to in from + 1..tour.len() - 1 {
                let before = gap(tour[from], tour[from + 1]) + gap(tour[to], tour[to + 1]);
                let after = gap(tour[from], tour[to]) + gap(tour[from + 1], tour[to + 1]);
                if after < before - 1e-9 {
                    tour[from + 1..=to].reverse();
                    is_shorter = true;
                }
            }
        }
        if !is_shorter {
            break;
        }
    }
    tour
}

cosfly_plugin::objective!(Inspection);

#[cfg(test)]
mod tests {
    use super::*;

    fn house() -> BuildingBox {
        BuildingBox { building: 1, center: [5.0, -3.0, 6.0], half: [10.0, 6.0, 6.0], yaw: 0.4 }
    }

    #[test]
    fn places_stand_off_the_walls_all_the_way_round_without_a_jump() {
        let walls = Walls::of(&house(), 10.0);
        let mut last = walls.stand(View { along: 0.0, up: 3.0 }).1;
        for step in 1..=2000 {
            let view = View { along: walls.round() * f64::from(step) / 2000.0, up: 3.0 };
            let (point, place) = walls.stand(view);
            assert!(cosfly_plugin::distance(place, last) < 0.2, "{step}");
            let gap = libm::hypot(place[0] - point[0], place[1] - point[1]);
            assert!((gap - 9.2).abs() < 1e-6, "{step} {gap}");
            last = place;
        }
    }

    #[test]
    fn the_tour_visits_every_view_once_and_is_no_longer_than_a_serpentine() {
        let walls = Walls::of(&house(), 10.0);
        let inspection = Inspection::new(Params::default()).unwrap();
        let views = inspection.grid(&walls);
        let tour = tour(&views, walls.round());
        assert_eq!(tour.len(), views.len());
        assert!(views.iter().all(|view| tour.contains(view)));
        let way: f64 = tour
            .windows(2)
            .map(|p| libm::hypot(wrapped(p[1].along - p[0].along, walls.round()), p[1].up - p[0].up))
            .sum();
        assert!(way < 2.3 * walls.round(), "{way} {}", walls.round());
    }

    #[test]
    fn a_building_of_two_boxes_has_one_hull() {
        let parts = [house(), BuildingBox { center: [5.0, -3.0, 14.0], half: [4.0, 4.0, 2.0], ..house() }];
        let hulls = hulls(&parts);
        assert_eq!(hulls.len(), 1);
        assert!((hulls[0].half[2] - 8.0).abs() < 1e-9 && (hulls[0].half[0] - 10.0).abs() < 1e-9);
    }
}
