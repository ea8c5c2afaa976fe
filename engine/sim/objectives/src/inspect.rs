//! `inspect`: the facades of a building, covered from a stand-off distance.
//!
//! A building of sensible size is drawn. The point to be watched runs row by row over each side that has room in front
//! of it, to and fro, a little in front of the wall, and from side to side round corners or over the roof; opposite it,
//! at the stand-off distance, is the place that draws the drone.

use super::config::{DT_S, InspectionConfig};
use super::facade::{FacadeCoverage, FacadeSide, coverage, hull, is_free, sides};
use super::meeting::Meeting;
use super::mission::{Mission, POINT_HEIGHT_M, Site, agile};
use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec2, DVec3, TargetState, TargetTrack, real};
use cosfly_planner::MucoConfig;
use cosfly_random::Seed;

/// The watched point is this far in front of the wall, metres.
const OUT_M: f64 = 0.8;
/// The drone is this far above the watched point, in stand-off distances.
const ABOVE_SHARE: f64 = 0.2;
/// Lowest row above the ground, and distance of the highest from the top, metres.
const LOWEST_M: f64 = 2.5;
const BELOW_TOP_M: f64 = 1.0;
/// Smallest side and largest of a building that is chosen, metres.
const SIDES_M: (f64, f64) = (4.0, 90.0);
/// Share of the places opposite a side that must be free.
const ROOM_SHARE: f64 = 0.7;
/// Round a corner the drone turns in steps of about this angle.
const CORNER_STEP_RAD: f64 = 0.26;
/// Weight of being opposite the watched point.
const WEIGHT: f64 = 0.4;

/// A building and the flight around it.
#[derive(Clone, Debug)]
pub struct Inspection {
    /// The planner's request.
    pub mission: Mission,
    /// Index of the building in [`Site::structures`].
    pub structure: usize,
    /// Number of the building's four sides that are flown along.
    pub sides: usize,
}

impl Inspection {
    /// Share of the walls that a flight has seen.
    pub fn coverage(
        &self,
        site: &Site<'_>,
        poses: &[cosfly_frames::Pose],
        config: &InspectionConfig,
    ) -> FacadeCoverage {
        coverage(site, &site.structures[self.structure], poses, config.standoff_m)
    }
}

/// Draws a building and lays the way over its facades.
///
/// # Errors
/// When no building of the town fits, with how many there are and why they do not.
pub fn mission(
    site: &Site<'_>,
    wanted: &InspectionConfig,
    config: &MucoConfig,
    seed: Seed,
) -> Result<Inspection, String> {
    let mut stream = seed.stream("structure");
    let mut left: Vec<usize> = (0..site.structures.len()).collect();
    let (mut of_size, mut with_room) = (0, 0);
    while !left.is_empty() {
        let structure = left.swap_remove(stream.index(left.len()));
        let Some(shape) = hull(&site.structures[structure]).filter(|shape| has_size(shape, wanted)) else { continue };
        of_size += 1;
        let open = open_sides(site, &shape, wanted, config.limits.clearance_m);
        if open.len() < wanted.min_sides as usize {
            continue;
        }
        with_room += 1;
        let stops = way(&open, &shape, wanted);
        if let Some(mission) = timed(&stops, wanted, config) {
            return Ok(Inspection { mission, structure, sides: open.len() });
        }
    }
    Err(format!(
        "none of the town's {} buildings can be inspected: {of_size} are of the wanted size, {with_room} of these have room \
         for a drone {} m from at least {} of their sides, and none of these takes less than {} s",
        site.structures.len(),
        wanted.standoff_m,
        wanted.min_sides,
        wanted.max_duration_s
    ))
}

fn has_size(shape: &OrientedBox, wanted: &InspectionConfig) -> bool {
    let size = 2.0 * shape.half_extents_m;
    let is_side = |length: f64| (SIDES_M.0..=SIDES_M.1).contains(&length);
    (wanted.min_height_m..=wanted.max_height_m).contains(&size.z) && is_side(size.x) && is_side(size.y)
}

/// A side and the heights of its rows, metres.
struct Wall {
    /// Number of the side, 0 to 3 round the building.
    number: usize,
    side: FacadeSide,
    rows_m: Vec<f64>,
}

fn open_sides(site: &Site<'_>, shape: &OrientedBox, wanted: &InspectionConfig, clearance_m: f64) -> Vec<Wall> {
    let walls = sides(shape).into_iter().enumerate().map(|(number, side)| {
        let foot = side.point(0.5 * side.length_m, 0.0, OUT_M);
        let ground = (site.ground)(foot.x, foot.y);
        let low = if ground.is_finite() { ground.max(side.corner_in_world.z) } else { side.corner_in_world.z };
        let (first, last) = (low + LOWEST_M, side.corner_in_world.z + side.height_m - BELOW_TOP_M);
        let gaps = ((last - first) / wanted.row_m).ceil().max(0.0);
        let row = |k: usize| if gaps > 0.0 { first + (last - first) * k as f64 / gaps } else { first.max(last) };
        Wall { number, side, rows_m: (0..=gaps as usize).map(row).collect() }
    });
    walls.filter(|wall| has_room(site, wall, wanted, clearance_m)).collect()
}

fn has_room(site: &Site<'_>, wall: &Wall, wanted: &InspectionConfig, clearance_m: f64) -> bool {
    let columns = (wall.side.length_m / 4.0).ceil().max(2.0) as usize;
    let (mut free, mut all) = (0_usize, 0_usize);
    for z in &wall.rows_m {
        for column in 0..=columns {
            let along = wall.side.length_m * column as f64 / columns as f64;
            let stop = Stop::opposite(&wall.side, along, *z, wanted.standoff_m);
            all += 1;
            let is_open = site.exact.nearest(stop.point, 0.5 * OUT_M).is_none();
            free += usize::from(is_open && is_free(site, stop.place, clearance_m + 0.5));
        }
    }
    free as f64 >= ROOM_SHARE * all as f64
}

/// A point to be watched and the place to watch it from.
#[derive(Clone, Copy, Debug)]
struct Stop {
    point: DVec3,
    place: DVec3,
}

impl Stop {
    fn opposite(side: &FacadeSide, along_m: f64, z_m: f64, standoff_m: f64) -> Self {
        let point = side.point(along_m, z_m, OUT_M);
        Self { point, place: place_of(point, side.normal, standoff_m) }
    }
}

fn place_of(point: DVec3, normal: DVec2, standoff_m: f64) -> DVec3 {
    point + ((standoff_m - OUT_M) * normal).extend(ABOVE_SHARE * standoff_m)
}

/// All rows of all walls, to and fro, each wall begun at the nearest of its ends.
fn way(walls: &[Wall], shape: &OrientedBox, wanted: &InspectionConfig) -> Vec<Stop> {
    let mut left: Vec<&Wall> = walls.iter().collect();
    let mut stops: Vec<Stop> = Vec::new();
    let mut last: Option<&Wall> = None;
    while !left.is_empty() {
        let here = stops.last().copied();
        let rows = |wall: &Wall, (upward, forward): (bool, bool)| serpentine(wall, upward, forward, wanted.standoff_m);
        let starts = (0..left.len())
            .flat_map(|k| [(true, true), (true, false), (false, true), (false, false)].map(|how| (k, how)));
        // Neighbouring walls first; a way over the roof only when there is none.
        let cost = |(k, how): &(usize, (bool, bool))| {
            let is_opposite = last.is_some_and(|last: &Wall| (last.number + 2) % 4 == left[*k].number);
            let gap = here.map_or(0.0, |here: Stop| rows(left[*k], *how)[0].place.distance(here.place));
            gap + if is_opposite { 1e6 } else { 0.0 }
        };
        let Some((k, how)) = starts.min_by(|a, b| cost(a).total_cmp(&cost(b))) else { break };
        let wall = left.swap_remove(k);
        let next = rows(wall, how);
        if let (Some(here), Some(last)) = (here, last) {
            lead_over(&mut stops, here, last, next[0], wall, shape, wanted);
        }
        stops.extend(next);
        last = Some(wall);
    }
    stops
}

fn serpentine(wall: &Wall, upward: bool, forward: bool, standoff_m: f64) -> Vec<Stop> {
    let rows: Vec<f64> = if upward { wall.rows_m.clone() } else { wall.rows_m.iter().rev().copied().collect() };
    let ends = [0.0, wall.side.length_m];
    let stop = |(row, z): (usize, f64)| {
        let turned = (row % 2 == 0) != forward;
        let (from, to) = if turned { (ends[1], ends[0]) } else { (ends[0], ends[1]) };
        [from, to].map(|along| Stop::opposite(&wall.side, along, z, standoff_m))
    };
    rows.into_iter().enumerate().flat_map(stop).collect()
}

/// From wall to wall: round the corner, or over the roof to the opposite side.
fn lead_over(
    stops: &mut Vec<Stop>,
    here: Stop,
    last: &Wall,
    there: Stop,
    wall: &Wall,
    shape: &OrientedBox,
    wanted: &InspectionConfig,
) {
    if (last.number + 2) % 4 == wall.number {
        let roof = shape.center_in_world.z + shape.half_extents_m.z + 1.0;
        for (stop, side) in [(here, &last.side), (there, &wall.side)] {
            let point = stop.point.with_z(roof);
            stops.push(Stop { point, place: place_of(point, side.normal, wanted.standoff_m).with_z(roof + 5.0) });
        }
        return;
    }
    let (from, to) = (angle(last.side.normal), angle(wall.side.normal));
    let turn = real::wrap_angle_rad(to - from);
    let steps = (turn.abs() / CORNER_STEP_RAD).ceil().max(1.0);
    for step in 1..steps as usize {
        let t = step as f64 / steps;
        let (sin, cos) = real::sin_cos(from + t * turn);
        let point = here.point.lerp(there.point, t);
        stops.push(Stop { point, place: place_of(point, DVec2::new(cos, sin), wanted.standoff_m) });
    }
}

fn angle(normal: DVec2) -> f64 {
    real::atan2(normal.y, normal.x)
}

/// The way at the wanted speed of the point or of its place, whichever is faster; `None` when it takes too long.
fn timed(stops: &[Stop], wanted: &InspectionConfig, config: &MucoConfig) -> Option<Mission> {
    let step_m = wanted.speed_mps * DT_S;
    let most = (wanted.max_duration_s / DT_S) as usize;
    let mut frames: Vec<Stop> = stops.first().copied().into_iter().collect();
    let mut left = step_m;
    for pair in stops.windows(2) {
        let length = pair[1].point.distance(pair[0].point).max(pair[1].place.distance(pair[0].place));
        let mut done = left;
        while done <= length && frames.len() <= most {
            let t = done / length;
            frames.push(Stop {
                point: pair[0].point.lerp(pair[1].point, t),
                place: pair[0].place.lerp(pair[1].place, t),
            });
            done += step_m;
        }
        left = done - length;
    }
    if frames.len() > most || frames.len() < 4 {
        return None;
    }
    let state = |(k, stop): (usize, &Stop)| {
        let next = frames.get(k + 1).unwrap_or(stop);
        let inward = stop.point - stop.place;
        TargetState {
            feet_in_world: stop.point,
            heading_rad: real::atan2(inward.y, inward.x),
            speed_mps: next.point.distance(stop.point) / DT_S,
        }
    };
    let states = frames.iter().enumerate().map(state).collect();
    let track = TargetTrack { dt_s: DT_S, height_m: POINT_HEIGHT_M, radius_m: 0.0, states };
    let opposite = Meeting::new("standoff", frames.iter().map(|stop| (stop.place, 1.0)).collect());
    Some(Mission { track, config: wishes(wanted, config), meetings: vec![(opposite, WEIGHT)] })
}

/// The drone is near the stand-off distance, a little above what it looks at; there is no "behind" of a wall.
fn wishes(wanted: &InspectionConfig, config: &MucoConfig) -> MucoConfig {
    let mut config = agile(config);
    let standoff = wanted.standoff_m;
    let view = &mut config.view;
    view.distance_m = standoff;
    view.pitch_deg = 12.0;
    view.min_altitude_m = 0.5;
    view.preferred_altitude_m = 2.0 * ABOVE_SHARE * standoff + 1.0;
    view.max_altitude_m = standoff + 1.0;
    view.min_radius_m = (0.5 * standoff).max(0.5);
    view.max_radius_m = 1.5 * standoff;
    (view.rear_sector_deg, view.start_sector_deg) = (180.0, 180.0);
    config.search.filter_radius_m = config.search.filter_radius_m.max(2.0 * standoff);
    config.weights.viewpoint = config.weights.viewpoint.or(Some(0.0));
    config
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::{PlanOutcome, Trajectory};
    use cosfly_geometry::BoxBvh;
    use cosfly_planner::plan_request;

    fn house(center: DVec3, half: DVec3) -> OrientedBox {
        OrientedBox { center_in_world: center, half_extents_m: half, yaw_rad: 0.3 }
    }

    fn flown(mission: &Mission, exact: &BoxBvh, boxes: &[OrientedBox]) -> Trajectory {
        match plan_request(mission.request(exact, boxes, &|_, _| 0.0)) {
            PlanOutcome::Planned(flight) => *flight,
            PlanOutcome::Rejected { reason, .. } => panic!("{reason}"),
        }
    }

    #[test]
    fn an_inspection_sees_nearly_all_walls_and_a_passing_flight_few() {
        let building = house(DVec3::new(0.0, 0.0, 8.0), DVec3::new(12.0, 8.0, 8.0));
        // Too low to be chosen.
        let kiosk = house(DVec3::new(60.0, 5.0, 1.5), DVec3::new(2.0, 2.0, 1.5));
        let structures = [vec![kiosk], vec![building]];
        let boxes = vec![kiosk, building];
        let exact = BoxBvh::build(boxes.clone());
        let bounds = (DVec2::splat(-80.0), DVec2::splat(80.0));
        let site = Site { exact: &exact, structures: &structures, ground: &|_, _| 0.0, bounds };
        let (wanted, config) = (InspectionConfig::default(), MucoConfig::default());
        let inspection = mission(&site, &wanted, &config, Seed::of_item(1, "inspect", "i")).expect("a building");
        assert_eq!((inspection.structure, inspection.sides), (1, 4));
        let flight = flown(&inspection.mission, &exact, &boxes);
        assert!(flight.certificate.holds, "{:?}", flight.certificate.violations);
        assert!(flight.certificate.mean_visibility > 0.97, "{}", flight.certificate.mean_visibility);
        let covered = inspection.coverage(&site, &flight.poses_in_world, &wanted).share();
        assert!(covered > 0.95, "{covered}");

        let walker = |k: usize| TargetState {
            feet_in_world: DVec3::new(-40.0 + 0.6 * k as f64, -14.0, 0.0),
            heading_rad: 0.0,
            speed_mps: 1.2,
        };
        let states = (0..130).map(walker).collect();
        let track = TargetTrack { dt_s: 0.5, height_m: 1.75, radius_m: 0.3, states };
        let passing = flown(&crate::track::mission(track, &config), &exact, &boxes);
        let passed = inspection.coverage(&site, &passing.poses_in_world, &wanted).share();
        assert!(passed < 0.5 * covered, "{passed} against {covered}");
    }

    #[test]
    fn a_row_house_is_inspected_in_front_and_behind_and_a_walled_in_one_is_refused() {
        let row: Vec<OrientedBox> = (-2..=2)
            .map(|k| OrientedBox {
                yaw_rad: 0.0,
                ..house(DVec3::new(12.0 * f64::from(k), 0.0, 6.0), DVec3::new(6.0, 5.0, 6.0))
            })
            .collect();
        let exact = BoxBvh::build(row.clone());
        let middle = [vec![row[2]]];
        let bounds = (DVec2::splat(-80.0), DVec2::splat(80.0));
        let site = Site { exact: &exact, structures: &middle, ground: &|_, _| 0.0, bounds };
        let (wanted, config) = (InspectionConfig::default(), MucoConfig::default());
        let inspection = mission(&site, &wanted, &config, Seed::of_item(1, "inspect", "i")).expect("a building");
        assert_eq!(inspection.sides, 2);
        let flight = flown(&inspection.mission, &exact, &row);
        let covered = inspection.coverage(&site, &flight.poses_in_world, &wanted);
        assert!(covered.share() > 0.9, "{covered:?}");

        let mut crowded = row.clone();
        crowded.extend([-14.0, 14.0].map(|y| house(DVec3::new(0.0, y, 9.0), DVec3::new(40.0, 5.0, 9.0))));
        let exact = BoxBvh::build(crowded);
        let site = Site { exact: &exact, ..site };
        let refused = mission(&site, &wanted, &config, Seed::of_item(1, "inspect", "i")).expect_err("no room");
        assert!(refused.contains("none of the town's 1 buildings"), "{refused}");
    }
}
