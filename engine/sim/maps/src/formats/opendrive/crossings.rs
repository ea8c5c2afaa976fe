//! Crossings: the file's crosswalks with their stripes, joints to the pavements, and unmarked crossings at junctions.

use super::network::{LaneSection, Road, RoadLaneKind, RoadObject};
use super::object_kind::{ObjectKind, kind_of};
use super::objects::outline_in_map;
use super::refuges::Walkway;
use super::road_geometry::LaneSpan;
use super::road_marks::PAINT_ABOVE_M;
use super::walkable::without_repeats;
use cosfly_domain::{SemanticLabel, WalkableKind, WalkablePolygon};
use cosfly_frames::{DVec2, DVec3, real};
use cosfly_town::GroundIndex;
use cosfly_town::mesh::MeshBuilder;
use cosfly_town::polygons::{PolygonIndex, clipped_to_band, triangulated, twice_area_m2};
use cosfly_town::world::WorldFromMap;

/// Painted stripes of a crossing, and the gaps between them, metres.
const STRIPE_M: f64 = 0.5;
/// Most stripes of one crossing.
const MOST_STRIPES: f64 = 200.0;
/// Stripes end where the road ends: they are looked at in this many strips, in cells of this length, metres.
const STRIPS: u32 = 4;
const CELL_M: f64 = 0.25;
const MOST_CELLS: f64 = 400.0;
/// Stripes with less than this share of a whole one's area on road are left out.
const LEAST_SHARE: f64 = 0.7;
/// A crossing that ends this close to a pavement is joined to it, metres.
const JOINT_REACH_M: f64 = 4.0;
/// Lane lines end this far before a crossing and beyond its ends at the kerbs, metres.
const LINES_END_BEFORE_M: f64 = 1.0;
const LINES_END_BESIDE_M: f64 = 0.5;
/// Between a crossing and a junction this close there are no lane lines, metres.
const JUNCTION_WITHIN_M: f64 = 10.0;
/// Width of an unmarked crossing, metres.
const UNMARKED_WIDTH_M: f64 = 3.0;
/// A junction arm with a marked crossing within this distance gets no unmarked one, metres.
const MARKED_WITHIN_M: f64 = 15.0;

/// A crosswalk of the file.
#[derive(Clone, Debug)]
pub(super) struct Crosswalk {
    pub(super) outline_in_world: Vec<DVec3>,
    /// Unit vector in which pedestrians cross, in plan.
    across: DVec2,
    /// Unit vector of the road, and the distances to the junctions against and along it, as far as they are near, metres.
    along_road: DVec2,
    to_junctions_m: [Option<f64>; 2],
}

/// The crosswalk objects of a road.
pub(super) fn crosswalks(road: &Road, world: &WorldFromMap) -> Vec<Crosswalk> {
    let objects = road.objects.iter().filter(|object| kind_of(object) == ObjectKind::Crosswalk);
    objects.filter_map(|object| crosswalk(road, object, world)).collect()
}

fn crosswalk(road: &Road, object: &RoadObject, world: &WorldFromMap) -> Option<Crosswalk> {
    let heading_rad = road.plan_point(object.at.s_m).heading_rad + object.heading_rad;
    let corners: Vec<DVec3> = match object.outlines.iter().find(|outline| outline.corners.len() >= 3) {
        Some(outline) => outline_in_map(road, object, outline).into_iter().map(|(foot, _)| foot).collect(),
        None => rectangle(road, object, heading_rad)?,
    };
    let outline_in_world = without_repeats(corners.into_iter().map(|corner| world.point(corner)).collect());
    // Pedestrians cross along the axis of the object that is closer to the road's normal.
    let road_yaw_rad = world.yaw_rad(road.plan_point(object.at.s_m).heading_rad);
    let own_yaw_rad = world.yaw_rad(heading_rad);
    let axes = [own_yaw_rad, own_yaw_rad + real::FRAC_PI_2];
    let across_rad = if real::sin(axes[0] - road_yaw_rad).abs() >= real::sin(axes[1] - road_yaw_rad).abs() {
        axes[0]
    } else {
        axes[1]
    };
    let (sin, cos) = real::sin_cos(across_rad);
    let (road_sin, road_cos) = real::sin_cos(road_yaw_rad);
    let to_ends_m = [object.at.s_m, road.length_m - object.at.s_m];
    let to_junctions_m = core::array::from_fn(|end| {
        (road.meets_junction[end] && to_ends_m[end] <= JUNCTION_WITHIN_M).then_some(to_ends_m[end])
    });
    let (across, along_road) = (DVec2::new(cos, sin), DVec2::new(road_cos, road_sin));
    (outline_in_world.len() >= 3).then_some(Crosswalk { outline_in_world, across, along_road, to_junctions_m })
}

/// A crosswalk without an outline, from its length and width.
fn rectangle(road: &Road, object: &RoadObject, heading_rad: f64) -> Option<Vec<DVec3>> {
    let half = 0.5 * DVec2::new(object.size.length_m, object.size.width_m);
    let origin = road.point(object.at.s_m, object.at.t_m, object.at.z_offset_m);
    let (sin, cos) = real::sin_cos(heading_rad);
    let corner = |u: f64, v: f64| origin + DVec3::new(cos * u - sin * v, sin * u + cos * v, 0.0);
    let corners =
        vec![corner(half.x, half.y), corner(-half.x, half.y), corner(-half.x, -half.y), corner(half.x, -half.y)];
    (half.min_element() > 0.1).then_some(corners)
}

impl Crosswalk {
    pub(super) fn plan(&self) -> Vec<DVec2> {
        self.outline_in_world.iter().map(|corner| corner.truncate()).collect()
    }

    fn center(&self) -> DVec3 {
        self.outline_in_world.iter().sum::<DVec3>() / self.outline_in_world.len() as f64
    }

    /// The ground to walk on.
    pub(super) fn polygon(&self) -> WalkablePolygon {
        WalkablePolygon {
            kind: WalkableKind::Crossing,
            outline_in_world: self.outline_in_world.clone(),
            synthetic: false,
        }
    }

    /// The ground without lane lines: that of the crossing, some before it, and up to a near junction.
    pub(super) fn line_free_outline(&self) -> Vec<DVec2> {
        let (plan, along) = (self.plan(), self.across.perp());
        let ([left, right], [mut low, mut high]) = (span(&plan, self.across), span(&plan, along));
        (low, high) = (low - LINES_END_BEFORE_M, high + LINES_END_BEFORE_M);
        let middle = self.center().truncate();
        for (to_junction_m, sign) in self.to_junctions_m.into_iter().zip([-1.0, 1.0]) {
            let Some(end_m) = to_junction_m.map(|m| (middle + sign * m * self.along_road).dot(along)) else { continue };
            (low, high) = (low.min(end_m), high.max(end_m));
        }
        let (left, right) = (left - LINES_END_BESIDE_M, right + LINES_END_BESIDE_M);
        [[left, low], [right, low], [right, high], [left, high]].map(|[u, v]| u * self.across + v * along).to_vec()
    }

    /// The ground to walk on and its direction.
    pub(super) fn walkway(&self) -> Walkway {
        Walkway::new(&self.outline_in_world, self.across)
    }

    /// Stripes across the walking direction, just above the road, as far as there is road.
    pub(super) fn paint(&self, builder: &mut MeshBuilder, ground: &GroundIndex) {
        let plan = self.plan();
        let [low, high] = span(&plan, self.across);
        let z_m = self.center().z;
        let below = |corner: DVec2| ground.ground_below(corner.extend(z_m), 0.4);
        let is_road = |corner: DVec2| {
            below(corner).is_some_and(|ground| {
                matches!(ground.label, SemanticLabel::Roads | SemanticLabel::RoadLine | SemanticLabel::Bridge)
            })
        };
        let stripes = ((high - low) / (2.0 * STRIPE_M)).round().clamp(1.0, MOST_STRIPES) as usize;
        let period_m = (high - low) / stripes as f64;
        let area = |outline: &[DVec2]| twice_area_m2(outline).abs();
        let bands = (0..stripes).map(|stripe| {
            let from = low + (stripe as f64 + 0.25) * period_m;
            [from, from + 0.5 * period_m]
        });
        let stripes: Vec<_> =
            bands.map(|[from, to]| ([from, to], clipped_to_band(&plan, self.across, from, to))).collect();
        let whole = stripes.iter().map(|(_, outline)| area(outline)).fold(0.0, f64::max);
        for (band, outline) in stripes {
            let pieces = self.on_road(outline, band, is_road);
            if pieces.iter().map(|piece| area(piece)).sum::<f64>() < LEAST_SHARE * whole {
                continue;
            }
            for outline in pieces {
                let vertex = |corner: &DVec2| {
                    let height_m = below(*corner).map_or(z_m, |ground| ground.height_m);
                    let place = DVec2::new(corner.dot(self.across.perp()), corner.dot(self.across));
                    (corner.extend(height_m + PAINT_ABOVE_M), place)
                };
                let vertices: Vec<(DVec3, DVec2)> = outline.iter().map(vertex).collect();
                builder.polygon(SemanticLabel::RoadLine, false, &vertices, &triangulated(&outline));
            }
        }
    }

    /// The pieces of a stripe that lie on road: the whole stripe, or strips of it without the cells that reach beyond.
    fn on_road(&self, stripe: Vec<DVec2>, [from, to]: [f64; 2], is_road: impl Fn(DVec2) -> bool) -> Vec<Vec<DVec2>> {
        let along = self.across.perp();
        let [low, high] = span(&stripe, along);
        let cells = ((high - low) / CELL_M).ceil().clamp(1.0, MOST_CELLS);
        let (cell_m, strip_m) = ((high - low) / cells, (to - from) / f64::from(STRIPS));
        let corner = |strip: u32, cell: u32| {
            is_road((low + f64::from(cell) * cell_m) * along + (from + f64::from(strip) * strip_m) * self.across)
        };
        let is_free = |strip: u32, cell: u32| {
            corner(strip, cell) && corner(strip, cell + 1) && corner(strip + 1, cell) && corner(strip + 1, cell + 1)
        };
        let cells = cells as u32;
        if (0..STRIPS).all(|strip| (0..cells).all(|cell| is_free(strip, cell))) {
            return vec![stripe];
        }
        // Runs of free cells; strips with the same run are one piece.
        let mut pieces: Vec<([u32; 2], [u32; 2])> = Vec::new();
        for strip in 0..STRIPS {
            let mut cell = 0;
            while cell < cells {
                let end = (cell..cells).find(|at| !is_free(strip, *at)).unwrap_or(cells);
                match pieces.iter_mut().find(|(run, strips)| *run == [cell, end] && strips[1] == strip) {
                    Some((_, strips)) => strips[1] += 1,
                    None if end > cell => pieces.push(([cell, end], [strip, strip + 1])),
                    None => {}
                }
                cell = end + 1;
            }
        }
        let piece = |(run, strips): &([u32; 2], [u32; 2])| {
            let [start, end] = strips.map(|strip| from + f64::from(strip) * strip_m);
            let [first, last] = run.map(|cell| low + f64::from(cell) * cell_m);
            clipped_to_band(&clipped_to_band(&stripe, self.across, start, end), along, first, last)
        };
        pieces.iter().map(piece).filter(|outline| outline.len() >= 3).collect()
    }

    /// Short pieces that lead from the ends of the crossing onto pavements that do not quite touch it.
    pub(super) fn joints(&self, pavements: &PolygonIndex, heights_m: &[f64]) -> Vec<WalkablePolygon> {
        let center = self.center();
        let plan = self.plan();
        let along = self.across.perp();
        let middle = center.truncate();
        let half_width_m = 0.8 * plan.iter().map(|p| (*p - middle).dot(along).abs()).fold(f64::INFINITY, f64::min);
        let mut out = Vec::new();
        for sign in [-1.0, 1.0] {
            let direction = sign * self.across;
            let end_m = plan.iter().map(|p| (*p - middle).dot(direction)).fold(0.0, f64::max);
            let Some((reach_m, pavement)) = first_pavement(pavements, middle + end_m * direction, direction) else {
                continue;
            };
            let half_m = half_width_m.clamp(0.4, 1.5);
            let (from, to) = (middle + (end_m - 0.8) * direction, middle + (end_m + reach_m + 0.8) * direction);
            let outline_in_world = vec![
                (from - half_m * along).extend(center.z),
                (to - half_m * along).extend(heights_m[pavement]),
                (to + half_m * along).extend(heights_m[pavement]),
                (from + half_m * along).extend(center.z),
            ];
            out.push(WalkablePolygon { kind: WalkableKind::Crossing, outline_in_world, synthetic: true });
        }
        out
    }
}

/// Lowest and highest place of points along a unit vector.
fn span(points: &[DVec2], along: DVec2) -> [f64; 2] {
    let places = || points.iter().map(|point| point.dot(along));
    [places().fold(f64::INFINITY, f64::min), places().fold(f64::NEG_INFINITY, f64::max)]
}

/// Distance from a point to the first pavement in a direction, metres, and its number; `None` when the point is on one.
fn first_pavement(pavements: &PolygonIndex, from: DVec2, direction: DVec2) -> Option<(f64, usize)> {
    let step_m = 0.2;
    let steps = (JOINT_REACH_M / step_m) as usize;
    (0..=steps)
        .map(|step| step as f64 * step_m)
        .find_map(|reach_m| pavements.at(from + reach_m * direction).next().map(|number| (reach_m, number)))
        .filter(|(reach_m, _)| *reach_m > 0.0)
}

/// Crossings of the carriageway where a road with pavements on both sides meets a junction and no marked crossing
/// is near: pedestrians of such towns cross there, too.
pub(super) fn unmarked_crossings(
    road: &Road,
    marked: &[Crosswalk],
    shoulders: bool,
    world: &WorldFromMap,
) -> Vec<WalkablePolygon> {
    if road.junction.is_some() || road.length_m < UNMARKED_WIDTH_M {
        return Vec::new();
    }
    let ends = [(road.meets_junction[0], 0.0, 1.0), (road.meets_junction[1], road.length_m, -1.0)];
    ends.into_iter()
        .filter(|(meets, _, _)| *meets)
        .filter_map(|(_, s_m, inwards)| {
            unmarked_crossing(road, s_m, s_m + inwards * UNMARKED_WIDTH_M, marked, shoulders, world)
        })
        .collect()
}

fn unmarked_crossing(
    road: &Road,
    end_s_m: f64,
    inner_s_m: f64,
    marked: &[Crosswalk],
    shoulders: bool,
    world: &WorldFromMap,
) -> Option<WalkablePolygon> {
    let near = world.point(road.point(end_s_m, 0.0, 0.0));
    if marked.iter().any(|crosswalk| crosswalk.center().distance(near) < MARKED_WITHIN_M) {
        return None;
    }
    let section = &road.sections[road.section_at(0.5 * (end_s_m + inner_s_m))];
    let far_edges = |s_m: f64| -> Option<[DVec3; 2]> {
        let left = far_pavement_edge(road, section, 0, s_m, shoulders)?;
        let right = far_pavement_edge(road, section, 1, s_m, shoulders)?;
        Some([left, right].map(|(t_m, z_m)| world.point(road.plan_position(s_m, t_m).extend(z_m))))
    };
    let ([a, b], [d, c]) = (far_edges(end_s_m)?, far_edges(inner_s_m)?);
    let outline_in_world = without_repeats(vec![a, b, c, d]);
    (outline_in_world.len() == 4).then_some(WalkablePolygon {
        kind: WalkableKind::Road,
        outline_in_world,
        synthetic: true,
    })
}

/// t and height of the outer edge of the outermost pavement on one side.
fn far_pavement_edge(road: &Road, section: &LaneSection, side: usize, s_m: f64, shoulders: bool) -> Option<(f64, f64)> {
    let mut spans: Vec<LaneSpan> = Vec::new();
    road.lane_spans(section, side, s_m, &mut spans);
    let lanes = section.sides()[side].1;
    let is_walkable =
        |kind: RoadLaneKind| kind == RoadLaneKind::Sidewalk || shoulders && kind == RoadLaneKind::Shoulder;
    let found = lanes
        .iter()
        .zip(&spans)
        .rev()
        .find(|(lane, span)| is_walkable(lane.kind) && (span.t_m[1] - span.t_m[0]).abs() > 0.3);
    found.map(|(_, span)| (span.t_m[1], span.z_m[1]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::SurfaceMesh;

    /// A crossing of 6 m by 3 m over a road 4 m wide along y.
    fn crosswalk() -> Crosswalk {
        let corners = [[-3.0, 0.0], [3.0, 0.0], [3.0, 3.0], [-3.0, 3.0]];
        let outline_in_world = corners.map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec();
        Crosswalk { outline_in_world, across: DVec2::X, along_road: DVec2::Y, to_junctions_m: [None, Some(6.0)] }
    }

    #[test]
    fn no_lane_line_is_on_a_crossing_or_between_it_and_a_near_junction() {
        let outline = crosswalk().line_free_outline();
        let spans = [DVec2::X, DVec2::Y].map(|along| span(&outline, along));
        assert_eq!(spans, [[-3.5, 3.5], [-1.0, 7.5]]);
    }

    #[test]
    fn a_stripe_of_which_the_kerb_covers_most_is_left_out() {
        let painted_m2 = |half_road_m: f64| {
            let corners = [[-half_road_m, -9.0], [half_road_m, -9.0], [half_road_m, 9.0], [-half_road_m, 9.0]];
            let mut builder = MeshBuilder::default();
            let at = corners.map(|[x, y]| (DVec3::new(x, y, 0.0), DVec2::ZERO));
            builder.quad(SemanticLabel::Roads, false, at);
            let side = corners.map(|[x, y]| (DVec3::new(x + 2.0 * half_road_m, y, 0.15), DVec2::ZERO));
            builder.quad(SemanticLabel::SideWalks, false, side);
            let ground = GroundIndex::of_surfaces(&builder.finish(), |_| true);
            let mut builder = MeshBuilder::default();
            crosswalk().paint(&mut builder, &ground);
            let corner = |mesh: &SurfaceMesh, k: u32| mesh.vertices_in_world[k as usize].truncate();
            let meshes = builder.finish();
            let areas = meshes.iter().flat_map(|mesh| mesh.triangles.iter().map(|it| it.map(|k| corner(mesh, k))));
            areas.map(|it| 0.5 * twice_area_m2(&it).abs()).sum::<f64>()
        };
        // Six stripes of 0.5 m by 3 m, the outer ones from 2.25 m to 2.75 m.
        assert!((painted_m2(3.0) - 9.0).abs() < 1e-9);
        assert!((painted_m2(2.76) - 9.0).abs() < 1e-9, "{}", painted_m2(2.76));
        assert!((painted_m2(2.55) - 6.0).abs() < 1e-9, "{}", painted_m2(2.55));
    }

    #[test]
    fn stripes_end_where_the_road_ends() {
        let crossing = crosswalk();
        let stripe = |from: f64| clipped_to_band(&crossing.plan(), DVec2::X, from, from + 0.5);
        let pieces =
            |from: f64, is_road: &dyn Fn(DVec2) -> bool| crossing.on_road(stripe(from), [from, from + 0.5], is_road);
        assert_eq!(pieces(-1.0, &|at| at.x.abs() <= 2.0), [stripe(-1.0)]);
        assert!(pieces(-2.75, &|at| at.x.abs() <= 2.0).is_empty());
        // Half of the stripe lies on the pavement.
        let half = pieces(1.75, &|at| at.x.abs() <= 2.0);
        assert!(half.len() == 1 && half.iter().flatten().all(|corner| corner.x <= 2.0 + 1e-9), "{half:?}");
        assert!((twice_area_m2(&half[0]).abs() - 2.0 * 0.25 * 3.0).abs() < 1e-9);
        // An island in the middle of the road.
        let around = pieces(0.0, &|at| (at.y - 1.5).abs() > 0.4);
        assert!(around.len() == 2 && around.iter().flatten().all(|corner| (corner.y - 1.5).abs() > 0.4), "{around:?}");
    }
}
