//! Arrows and stop lines on asphalt before junctions: where lanes lead, told from the lanes that follow them.
//!
//! An arrow has the ways that its lane has through the junction. A lane too short, too narrow or too crooked for one has none, nor has a
//! lane alone without a choice, lanes side by side that all go straight on, or a lane of a slow street.

use cosfly_domain::{Lane, LaneKind, ObstacleKind, SemanticLabel, SurfaceMesh, Town, WalkableKind};
use cosfly_frames::{DVec2, DVec3, real};
use cosfly_town::GroundIndex;
use cosfly_town::mesh::MeshBuilder;
use cosfly_town::polygons::PolygonIndex;
use std::collections::BTreeMap;

/// Paint lies this far above the road, and is left out where the road is farther below or above it, metres.
const ABOVE_M: f64 = 0.02;
const UNEVEN_M: f64 = 0.025;
/// Length of an arrow of one way, of several, and the distance from the stop line, metres.
const ARROW_M: f64 = 5.0;
const COMBINED_M: f64 = 6.2;
const BEFORE_STOP_M: f64 = 3.0;
/// Lanes are looked at this far before a junction; arrows begin at least so far behind the place where their lane begins, metres.
const LOOK_BACK_M: f64 = 45.0;
const AFTER_BEGIN_M: f64 = 4.0;
/// Middles of two arrows are farther apart, metres.
const APART_M: f64 = 2.2;
/// On roads of several lanes arrows come again after this length, metres.
const AGAIN_M: f64 = 24.0;
/// Lanes that are narrower have no arrows, and roads with lower limits neither.
const NARROWEST_M: f64 = 2.4;
const SLOWEST_MPS: f64 = 31.0 / 3.6;
/// A crossing that begins this close to a lane's end or behind it is crossed before the junction, metres.
const CROSSING_M: [f64; 2] = [14.0, 6.0];
/// Stop lines: their length along the road, and the distance from a crossing, metres.
const STOP_M: f64 = 0.4;
const BEFORE_CROSSING_M: f64 = 1.0;
/// Lanes that end this near a traffic light have a stop line, metres.
const LIGHT_M: f64 = 32.0;
/// Turns by less are straight on, by more are no ways that arrows show, radians.
const STRAIGHT_RAD: f64 = 0.6;
const BACK_RAD: f64 = 2.5;
/// Most lanes one after the other within a junction.
const MOST_WITHIN: usize = 8;

/// Ways on: left, straight, right.
type Ways = [bool; 3];

/// Arrows and stop lines of a town; `None` where it has no lanes that lead to junctions.
pub fn lane_marks(town: &Town) -> Option<SurfaceMesh> {
    let approaches = approaches(&town.lanes);
    if approaches.is_empty() {
        return None;
    }
    let crossings = town.walkable.iter().filter(|area| area.kind == WalkableKind::Crossing);
    let lights = town.obstacles.iter().filter(|it| it.kind == ObstacleKind::TrafficLight);
    let painter = Painter {
        ground: GroundIndex::new(town),
        crossings: PolygonIndex::new(crossings.map(|area| area.plan()).collect()),
        lights: lights.map(|it| it.shape.center_in_world.truncate()).collect(),
    };
    let (mut builder, mut arrows) = (MeshBuilder::default(), vec![]);
    for approach in &approaches {
        painter.paint(&mut builder, &mut arrows, approach);
    }
    builder.finish().pop()
}

/// A lane before a junction.
struct Approach {
    /// Its middle, back from its end, and where it goes on, metres.
    back: Vec<DVec3>,
    beyond: Vec<DVec3>,
    width_m: f64,
    ways: Ways,
    /// Whether an arrow says something, and lanes lie side by side.
    has_arrow: bool,
    has_neighbours: bool,
}

fn approaches(lanes: &[Lane]) -> Vec<Approach> {
    let mut before: Vec<Vec<usize>> = vec![vec![]; lanes.len()];
    for (number, lane) in lanes.iter().enumerate() {
        let followers = lane.successors.iter().filter(|it| (**it as usize) < lanes.len());
        followers.for_each(|it| before[*it as usize].push(number));
    }
    let next = |lane: &Lane| lane.successors.iter().filter_map(|it| lanes.get(*it as usize)).collect::<Vec<_>>();
    let leads_in = |lane: &Lane| {
        let is_finite = lane.middle_in_world.iter().all(|point| point.is_finite());
        lane.kind == LaneKind::Driving && !lane.in_junction && is_finite && next(lane).iter().any(|it| it.in_junction)
    };
    let (numbers, leading): (Vec<usize>, Vec<&Lane>) = lanes.iter().enumerate().filter(|(_, it)| leads_in(it)).unzip();
    let ways: Vec<Ways> = leading.iter().map(|lane| ways(lane, lanes)).collect();
    let neighbours = neighbours(&leading);
    let approach = |(number, lane): (usize, &&Lane)| {
        let beside = &neighbours[number];
        // One lane alone has an arrow where there is a choice, lanes side by side where any of them turns.
        let has_choice = ways[number].iter().filter(|it| **it).count() > 1;
        let turns = |number: &usize| ways[*number][0] || ways[*number][2];
        let tells = if beside.is_empty() { has_choice } else { beside.iter().chain([&number]).any(turns) };
        Approach {
            back: back_from(numbers[number], lanes, &before),
            beyond: next(lane).iter().find(|it| it.in_junction).map_or(vec![], |it| it.middle_in_world.clone()),
            width_m: lane.width_m,
            ways: ways[number],
            has_arrow: tells
                && ways[number] != [false; 3]
                && lane.width_m >= NARROWEST_M
                && lane.speed_limit_mps > SLOWEST_MPS,
            has_neighbours: !beside.is_empty(),
        }
    };
    leading.iter().enumerate().map(approach).collect()
}

/// The ways that a lane has through a junction.
fn ways(lane: &Lane, lanes: &[Lane]) -> Ways {
    let (mut ways, from) = ([false; 3], last_direction(lane));
    let inner = |lane: &Lane| -> Vec<&Lane> {
        lane.successors.iter().filter_map(|it| lanes.get(*it as usize)).filter(|it| it.in_junction).collect()
    };
    let mut open = inner(lane);
    for _ in 0..MOST_WITHIN {
        let mut further = vec![];
        for within in open {
            let on = inner(within);
            if on.is_empty() {
                // The world's y points to the right of x.
                let to = last_direction(within);
                let turn_rad = real::atan2(from.perp_dot(to), from.dot(to));
                if turn_rad.abs() < BACK_RAD {
                    ways[1 + usize::from(turn_rad > STRAIGHT_RAD) - usize::from(turn_rad < -STRAIGHT_RAD)] = true;
                }
            }
            further.extend(on);
        }
        open = further;
        open.truncate(64);
    }
    ways
}

fn last_direction(lane: &Lane) -> DVec2 {
    let line = &lane.middle_in_world;
    (line[line.len() - 1] - line[line.len() - 2]).truncate().normalize_or_zero()
}

/// Lanes that end beside each lane, in the same direction.
fn neighbours(leading: &[&Lane]) -> Vec<Vec<usize>> {
    const CELL_M: f64 = 8.0;
    let ends: Vec<(DVec3, DVec2)> = leading
        .iter()
        .map(|lane| (lane.middle_in_world[lane.middle_in_world.len() - 1], last_direction(lane)))
        .collect();
    let cell = |at: DVec3| [at.x, at.y].map(|it| (it / CELL_M).floor() as i64);
    let mut cells: BTreeMap<[i64; 2], Vec<usize>> = BTreeMap::new();
    ends.iter().enumerate().for_each(|(number, (at, _))| cells.entry(cell(*at)).or_default().push(number));
    let beside = |(number, (at, along)): (usize, &(DVec3, DVec2))| {
        let [x, y] = cell(*at);
        let around = (x - 1..=x + 1).flat_map(|x| (y - 1..=y + 1).map(move |y| [x, y]));
        let near = around.filter_map(|it| cells.get(&it)).flatten().copied();
        near.filter(|other| {
            let (there, its) = ends[*other];
            let away = (there - *at).truncate();
            *other != number
                && its.dot(*along) > 0.95
                && away.dot(*along).abs() < 4.0
                && (1.5..CELL_M).contains(&along.perp_dot(away).abs())
        })
        .collect()
    };
    ends.iter().enumerate().map(beside).collect()
}

/// The middle of a lane from its end back, over lanes that alone lead to it.
fn back_from(mut number: usize, lanes: &[Lane], before: &[Vec<usize>]) -> Vec<DVec3> {
    let mut line: Vec<DVec3> = lanes[number].middle_in_world.iter().rev().copied().collect();
    let mut length_m = lanes[number].length_m();
    while let ([only], true) = (&before[number][..], length_m < LOOK_BACK_M) {
        let earlier = &lanes[*only];
        if earlier.in_junction || earlier.successors.len() != 1 || earlier.length_m() < 0.1 {
            break;
        }
        line.extend(earlier.middle_in_world.iter().rev().filter(|point| point.is_finite()));
        (length_m, number) = (length_m + earlier.length_m(), *only);
    }
    line
}

struct Painter {
    ground: GroundIndex,
    crossings: PolygonIndex,
    lights: Vec<DVec2>,
}

impl Painter {
    fn paint(&self, builder: &mut MeshBuilder, arrows: &mut Vec<DVec3>, approach: &Approach) {
        let crossing_m = self.crossing_m(approach);
        let end = approach.back[0].truncate();
        let has_light = self.lights.iter().any(|light| light.distance(end) < LIGHT_M);
        let stop_m = crossing_m.map_or(0.2, |before_end_m| (before_end_m + BEFORE_CROSSING_M).max(0.2));
        let side_m = 0.5 * approach.width_m - 0.15;
        let has_stop = (crossing_m.is_some() || has_light) && approach.width_m >= NARROWEST_M;
        if has_stop {
            let half = |side_m: f64| vec![[0.0, 0.0], [0.0, side_m], [STOP_M, side_m], [STOP_M, 0.0]];
            self.add(builder, approach, stop_m + STOP_M, STOP_M, &[half(-side_m), half(side_m)]);
        }
        // One lane alone has an arrow where it also has a stop line.
        if !approach.has_arrow || !(approach.has_neighbours || has_stop) {
            return;
        }
        let (length_m, shape) = arrow(approach.ways, (approach.width_m / 3.2).clamp(0.75, 1.1));
        let first_m = stop_m + STOP_M + BEFORE_STOP_M + length_m;
        for tail_m in [first_m, first_m + AGAIN_M].into_iter().take(1 + usize::from(approach.has_neighbours)) {
            let middle = place(&approach.back, tail_m - 0.5 * length_m).map_or(DVec3::INFINITY, |(at, _)| at);
            // Lanes that run into each other have one arrow.
            let is_free = arrows.iter().all(|other| other.distance(middle) > APART_M);
            if is_free && self.add(builder, approach, tail_m, length_m, &shape) {
                arrows.push(middle);
            }
        }
    }

    /// Where the crossing before the junction begins, metres before the lane's end; less than 0 behind it.
    fn crossing_m(&self, approach: &Approach) -> Option<f64> {
        const STEP_M: f64 = 0.25;
        let [before_m, behind_m] = CROSSING_M;
        let is_crossing = |at_m: f64| {
            let line = if at_m >= 0.0 { &approach.back } else { &approach.beyond };
            let Some((at, along)) = place(line, at_m.abs()) else { return false };
            let middle = at.truncate();
            [-0.4, 0.0, 0.4]
                .iter()
                .any(|aside| self.crossings.at(middle + *aside * approach.width_m * along.perp()).next().is_some())
        };
        let steps = ((before_m + behind_m) / STEP_M) as usize;
        (0..steps).map(|step| before_m - STEP_M * step as f64).find(|at_m| is_crossing(*at_m))
    }

    /// Adds convex polygons in the coordinates of a lane: ahead of a place before its end, and to the right, metres. Nothing where there
    /// is no even asphalt, where the lane bends, or begins or has a crossing too soon.
    fn add(
        &self,
        builder: &mut MeshBuilder,
        approach: &Approach,
        tail_m: f64,
        length_m: f64,
        polygons: &[Vec<[f64; 2]>],
    ) -> bool {
        let is_long = place(&approach.back, tail_m + if length_m > STOP_M { AFTER_BEGIN_M } else { 0.0 }).is_some();
        let (Some((tail, _)), Some((tip, _))) =
            (place(&approach.back, tail_m), place(&approach.back, tail_m - length_m))
        else {
            return false;
        };
        let (Some((_, along)), true) = (place(&approach.back, tail_m - 0.5 * length_m), is_long) else { return false };
        let ahead = -along;
        let is_straight = (tip - tail).truncate().dot(ahead) > 0.995 * length_m
            && ahead.perp_dot((tip - tail).truncate()).abs() < 0.2;
        let road = |at: DVec2| {
            let ground = self.ground.ground_seen(at.extend(0.5 * (tail.z + tip.z)), 0.5 + 0.2 * length_m)?;
            let is_asphalt = matches!(ground.label, SemanticLabel::Roads | SemanticLabel::Bridge);
            (is_asphalt && self.crossings.at(at).next().is_none()).then(|| at.extend(ground.height_m + ABOVE_M))
        };
        let corner = |[u, v]: [f64; 2]| road(tail.truncate() + u * ahead + v * ahead.perp());
        let placed: Option<Vec<Vec<DVec3>>> =
            polygons.iter().map(|polygon| polygon.iter().copied().map(corner).collect()).collect();
        let is_even = |polygon: &Vec<DVec3>| {
            let middle = polygon.iter().sum::<DVec3>() / polygon.len() as f64;
            road(middle.truncate()).is_some_and(|ground| (ground.z - middle.z).abs() < UNEVEN_M)
        };
        let Some(placed) = placed.filter(|placed| is_straight && placed.iter().all(is_even)) else { return false };
        for (shape, polygon) in polygons.iter().zip(placed) {
            let vertices: Vec<(DVec3, DVec2)> =
                polygon.into_iter().zip(shape).map(|(point, uv)| (point, DVec2::from(*uv))).collect();
            let fan: Vec<[u32; 3]> = (2..vertices.len() as u32).map(|k| [0, k - 1, k]).collect();
            builder.polygon(SemanticLabel::RoadLine, true, &vertices, &fan);
        }
        true
    }
}

/// The place so far along a line, and the line's direction there.
fn place(line: &[DVec3], at_m: f64) -> Option<(DVec3, DVec2)> {
    let mut left_m = at_m;
    for pair in line.windows(2) {
        let step = (pair[1] - pair[0]).truncate();
        let length_m = step.length();
        if left_m <= length_m && length_m > 0.0 {
            return Some((pair[0].lerp(pair[1], left_m / length_m), step / length_m));
        }
        left_m -= length_m;
    }
    None
}

/// Length of an arrow, and its convex polygons: metres ahead of its tail and to the right, `wide` times as wide as usual.
fn arrow([left, straight, right]: Ways, wide: f64) -> (f64, Vec<Vec<[f64; 2]>>) {
    const STEM_M: f64 = 0.1;
    let turns = [(left, -1.0), (right, 1.0)];
    // Branches of an arrow that goes straight on, too, leave its stem sooner.
    let is_combined = straight && (left || right);
    let length_m = if is_combined { COMBINED_M } else { ARROW_M };
    let (sooner_m, stem_m) = if straight { (1.7, length_m - 1.75) } else { (0.0, 3.2) };
    let mut polygons = vec![vec![[0.0, -STEM_M], [0.0, STEM_M], [stem_m, STEM_M], [stem_m, -STEM_M]]];
    if straight {
        polygons.push(vec![[stem_m, -0.38], [stem_m, 0.38], [length_m, 0.0]]);
    }
    for (_, side) in turns.into_iter().filter(|(is_way, _)| *is_way) {
        let branch = [[2.35, STEM_M], [3.45, 0.4], [4.1, 0.4], [3.2, -STEM_M]];
        let head = [[2.9, 0.4], [4.7, 0.4], [4.05, 1.0]];
        let placed = |corners: &[[f64; 2]]| corners.iter().map(|[u, v]| [u - sooner_m, side * v]).collect();
        polygons.extend([placed(&branch), placed(&head)]);
    }
    polygons.iter_mut().flatten().for_each(|corner| corner[1] *= wide);
    (length_m, polygons)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::WalkablePolygon;
    use cosfly_town::lanes::link_lanes;

    fn lane(points: &[[f64; 2]], in_junction: bool) -> Lane {
        let points = points.iter().map(|[x, y]| DVec3::new(*x, *y, 0.0));
        Lane { in_junction, ..Lane::new(LaneKind::Driving, points, 3.2, 14.0).unwrap() }
    }

    /// A road along x whose lanes at y = 1.6 (and 4.8) end at x = 0 before a junction, 2 m behind a crossing.
    fn town(length_m: f64, ways: &[Ways]) -> Town {
        let mut builder = MeshBuilder::default();
        let square = [[-99.0, -30.0], [30.0, -30.0], [30.0, 30.0], [-99.0, 30.0]];
        builder.quad(SemanticLabel::Roads, false, square.map(|[x, y]| (DVec3::new(x, y, 0.0), DVec2::ZERO)));
        let mut town = Town { surfaces: builder.finish(), ..Town::default() };
        for (ways, y) in ways.iter().zip([1.6, 4.8]) {
            town.lanes.push(lane(&[[-length_m, y], [0.0, y]], false));
            let bends = [[6.0, -6.0], [12.0, 0.0], [6.0, 6.0]].iter().zip(ways).filter(|(_, is_way)| **is_way);
            town.lanes.extend(bends.map(|([x, aside], _)| {
                lane(&[[0.0, y], [0.5 * x, y], [*x, y + aside], [*x + 1e-3 * x, y + 1.2 * aside + 1e-3]], true)
            }));
        }
        let outline = [[-5.0, -30.0], [-2.0, -30.0], [-2.0, 30.0], [-5.0, 30.0]];
        let outline_in_world = outline.map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec();
        town.walkable = vec![WalkablePolygon { kind: WalkableKind::Crossing, outline_in_world, synthetic: false }];
        link_lanes(&mut town);
        town
    }

    /// Lowest and highest x and y of what is painted behind the stop line, and of all.
    fn painted(town: &Town) -> [[DVec2; 2]; 2] {
        let corners: Vec<DVec2> =
            lane_marks(town).iter().flat_map(|mesh| &mesh.vertices_in_world).map(|it| it.truncate()).collect();
        [-6.5, 99.0].map(|end_m| {
            let fold =
                |from, by: fn(DVec2, DVec2) -> DVec2| corners.iter().copied().filter(|it| it.x < end_m).fold(from, by);
            [fold(DVec2::INFINITY, DVec2::min), fold(DVec2::NEG_INFINITY, DVec2::max)]
        })
    }

    #[test]
    fn an_arrow_points_where_its_lane_leads_and_stands_before_the_stop_line() {
        let [[low, high], [_, last]] = painted(&town(60.0, &[[false, true, true]]));
        assert!((last.x + 6.0).abs() < 0.26, "the stop line ends a metre before the crossing: {last}");
        assert!((last.x - high.x - STOP_M - BEFORE_STOP_M).abs() < 1e-6, "{high}");
        assert!((high.x - low.x - COMBINED_M).abs() < 1e-6, "{low}");
        assert!(high.y - 1.6 > 0.9 && 1.6 - low.y < 0.5, "to the right alone: {low} {high}");
        let [[low, high], _] = painted(&town(60.0, &[[true, false, true]]));
        assert!(high.y - 1.6 > 0.9 && 1.6 - low.y > 0.9, "{low} {high}");
        let label = lane_marks(&town(60.0, &[[true; 3]])).map(|mesh| mesh.label);
        assert_eq!(label, Some(SemanticLabel::RoadLine));
    }

    #[test]
    fn a_lane_without_a_choice_or_too_short_has_a_stop_line_alone() {
        let arrows = |town: &Town| painted(town)[0][0].is_finite();
        assert!(arrows(&town(60.0, &[[true, true, false], [false, true, false]])));
        assert!(!arrows(&town(60.0, &[[false, true, false], [false, true, false]])), "all go straight on");
        assert!(!arrows(&town(60.0, &[[false, true, false]])), "no choice");
        assert!(arrows(&town(21.0, &[[true; 3]])) && !arrows(&town(17.0, &[[true; 3]])), "too short");
        let mut slow = town(60.0, &[[true; 3]]);
        slow.lanes[0].speed_limit_mps = 30.0 / 3.6;
        assert!(!arrows(&slow));
        assert!(painted(&slow)[1][0].is_finite(), "its stop line stays");
        slow.lanes.retain(|lane| !lane.in_junction);
        assert!(lane_marks(&slow).is_none());
    }

    #[test]
    fn nothing_is_painted_over_kerbs_or_crossings() {
        let mut town = town(60.0, &[[true; 3]]);
        let mut builder = MeshBuilder::from_meshes(town.surfaces.clone());
        let island = [[-16.0, 1.0], [-15.0, 1.0], [-15.0, 9.0], [-16.0, 9.0]];
        builder.quad(SemanticLabel::SideWalks, false, island.map(|[x, y]| (DVec3::new(x, y, 0.15), DVec2::ZERO)));
        town.surfaces = builder.finish();
        assert!(!painted(&town)[0][0].is_finite());
        let marks = lane_marks(&town).unwrap();
        assert!(marks.vertices_in_world.iter().all(|it| it.x < -5.0 && (it.z - ABOVE_M).abs() < 1e-9));
    }
}
