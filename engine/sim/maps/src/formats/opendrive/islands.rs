//! Islands: medians and enclosed pieces of grass between carriageways stand above the road, with a kerb around them.
//!
//! Files say where they are and rarely how high. Each is found cell by cell from a place in it; its outline then follows the edges
//! of the carriageways.

use super::island_outline::{CELL_M, Cell, Closed, middle, outline};
use super::network::{LaneSection, RoadLaneKind};
use super::stations::CrossSection;
use super::surfaces::DEFAULT_KERB_M;
use cosfly_domain::SemanticLabel;
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::GroundIndex;
use cosfly_town::mesh::MeshBuilder;
use cosfly_town::polygons::{PolygonIndex, contains, triangulated_up_to, twice_area_m2};
use cosfly_town::world::WorldFromMap;
use std::collections::BTreeMap;

/// Most cells of an island; larger pieces of grass are land, not islands.
const MOST_CELLS: usize = 22_000;
/// Smallest island, square metres, and the least mean width, metres.
const SMALLEST_M2: f64 = 3.0;
const NARROWEST_M: f64 = 0.6;
/// Least share of carriageway around an island.
const ROAD_SHARE: f64 = 0.5;
/// Ground this far above or below is of another level, metres.
const LEVEL_M: f64 = 1.0;
/// Width of the kerb stones from above, and of their part that stands on the road, where the outline is not exact, metres.
const KERB_M: f64 = 0.2;
const ON_ROAD_M: f64 = 0.05;
/// Kerb faces reach this far below the road, metres.
const BELOW_ROAD_M: f64 = 0.05;
/// Most corners of an outline.
const MOST_CORNERS: usize = 400;

/// Raises the islands around some places and gives their number; `ground` is all ground so far, `walkways` are the
/// crossings, which stay level.
pub(super) fn raise(
    builder: &mut MeshBuilder,
    ground: &GroundIndex,
    walkways: &PolygonIndex,
    places: &[DVec3],
) -> usize {
    let site = FillSite { ground, walkways };
    let mut seen = BTreeMap::new();
    let mut islands = Vec::new();
    for (number, place) in places.iter().enumerate() {
        let Some(cells) = site.island_at(*place, number, &mut seen) else { continue };
        let rim = outline(&cells, &|at, height_m| site.closed(at, height_m));
        islands.extend(rim.filter(|rim| is_island(rim)).and_then(Island::within));
    }
    remove_grass_below(builder, &islands);
    islands.iter().for_each(|island| island.add(builder));
    islands.len()
}

/// Places on the lanes of a section that are medians and have no height in the file, world frame.
pub(super) fn places_on_medians(section: &LaneSection, rows: &[CrossSection], world: &WorldFromMap) -> Vec<DVec3> {
    let mut places = vec![];
    for (side, (_, lanes)) in section.sides().into_iter().enumerate() {
        for (index, lane) in lanes.iter().enumerate() {
            if lane.kind == RoadLaneKind::Median && lane.heights.is_empty() {
                let middle = |row: &CrossSection| 0.5 * (row.points[side][index][0] + row.points[side][index][1]);
                places.extend(rows.windows(2).map(|pair| world.point(0.5 * (middle(&pair[0]) + middle(&pair[1])))));
            }
        }
    }
    places
}

/// The ground on which islands are looked for.
struct FillSite<'a> {
    ground: &'a GroundIndex,
    walkways: &'a PolygonIndex,
}

impl FillSite<'_> {
    /// Ground that bounds an island at a place; `None` for grass and holes.
    fn closed(&self, at: DVec2, height_m: f64) -> Option<Closed> {
        let near = self.ground.ground_seen(at.extend(height_m), LEVEL_M);
        if let Some(near) = near.filter(|near| near.label != SemanticLabel::Terrain) {
            return Some(Closed { height_m: near.height_m, is_road: near.label == SemanticLabel::Roads });
        }
        self.walkways.at(at).next().map(|_| Closed { height_m: near.map_or(height_m, |it| it.height_m), is_road: true })
    }

    /// The cells of grass around a place, each with a height of the road nearby; `None` where they were seen before or reach too far.
    fn island_at(&self, place: DVec3, number: usize, seen: &mut BTreeMap<Cell, usize>) -> Option<BTreeMap<Cell, f64>> {
        let [column, row] = (place.truncate() / CELL_M).floor().to_array().map(|at| at as i64);
        if seen.contains_key(&(column, row)) || self.closed(middle((column, row)), place.z).is_some() {
            return None;
        }
        let mut cells = BTreeMap::from([((column, row), place.z)]);
        let mut next = vec![(column, row)];
        while let Some(cell) = next.pop() {
            let height_m = cells[&cell];
            // Cells of another place: the two are the same land, which was too large.
            if cells.len() > MOST_CELLS || seen.insert(cell, number).is_some_and(|before| before != number) {
                return None;
            }
            for beside in [(cell.0 - 1, cell.1), (cell.0 + 1, cell.1), (cell.0, cell.1 - 1), (cell.0, cell.1 + 1)] {
                if cells.contains_key(&beside) || self.closed(middle(beside), height_m).is_some() {
                    continue;
                }
                let own = self.ground.ground_seen(middle(beside).extend(height_m), LEVEL_M);
                cells.insert(beside, own.map_or(height_m, |own| own.height_m));
                next.push(beside);
            }
        }
        Some(cells)
    }
}

fn is_island(rim: &[(DVec2, Closed)]) -> bool {
    let plan: Vec<DVec2> = rim.iter().map(|(at, _)| *at).collect();
    let area_m2 = 0.5 * twice_area_m2(&plan);
    let sides = || (0..rim.len()).map(|k| (plan[k].distance(plan[(k + 1) % rim.len()]), rim[k].1.is_road));
    let length_m: f64 = sides().map(|(length_m, _)| length_m).sum();
    let road_m: f64 = sides().filter(|(_, is_road)| *is_road).map(|(length_m, _)| length_m).sum();
    area_m2 >= SMALLEST_M2 && 2.0 * area_m2 >= NARROWEST_M * length_m && road_m >= ROAD_SHARE * length_m
}

/// A kerb around a top.
struct Island {
    rim: Vec<(DVec2, Closed)>,
    /// Corners of the top, those of the rim further in; the rim itself where there is no room for grass.
    top: Vec<DVec2>,
    triangles: Vec<[u32; 3]>,
    is_lawn: bool,
}

impl Island {
    fn within(mut rim: Vec<(DVec2, Closed)>) -> Option<Self> {
        let outer = inset(&mut rim, -ON_ROAD_M)?;
        rim.iter_mut().zip(outer).for_each(|(corner, at)| corner.0 = at);
        let inner = inset(&mut rim, KERB_M)?;
        if let Some(triangles) = whole(&inner) {
            return Some(Self { rim, top: inner, triangles, is_lawn: true });
        }
        let top: Vec<DVec2> = rim.iter().map(|(at, _)| *at).collect();
        whole(&top).map(|triangles| Self { rim, top, triangles, is_lawn: false })
    }

    fn add(&self, builder: &mut MeshBuilder) {
        let top_m = |closed: &Closed| closed.height_m + if closed.is_road { DEFAULT_KERB_M } else { 0.0 };
        let at = |place: DVec2, height_m: f64| (place.extend(height_m), place);
        let label = if self.is_lawn { SemanticLabel::Terrain } else { SemanticLabel::SideWalks };
        let corners = self.top.iter().zip(&self.rim);
        let vertices: Vec<_> = corners.map(|(place, (_, closed))| at(*place, top_m(closed))).collect();
        builder.polygon(label, false, &vertices, &self.triangles);
        for k in 0..self.rim.len() {
            let next = (k + 1) % self.rim.len();
            let [(a, of_a), (b, of_b)] = [self.rim[k], self.rim[next]];
            let edge = [at(a, top_m(&of_a)), at(b, top_m(&of_b))];
            if self.is_lawn {
                let inner = [at(self.top[next], top_m(&of_b)), at(self.top[k], top_m(&of_a))];
                builder.quad(SemanticLabel::SideWalks, false, [edge[0], edge[1], inner[0], inner[1]]);
            }
            let foot = [at(a, of_a.height_m - BELOW_ROAD_M), at(b, of_b.height_m - BELOW_ROAD_M)];
            builder.quad(SemanticLabel::SideWalks, false, [edge[0], edge[1], foot[1], foot[0]]);
        }
    }
}

/// Triangles over an outline, if they cover it.
fn whole(outline: &[DVec2]) -> Option<Vec<[u32; 3]>> {
    let area = twice_area_m2(outline);
    let triangles = triangulated_up_to(outline, MOST_CORNERS);
    let covered: f64 = triangles.iter().map(|it| twice_area_m2(&it.map(|corner| outline[corner as usize])).abs()).sum();
    (area > 0.0 && (covered - area).abs() <= 1e-3 * area).then_some(triangles)
}

/// The outline further in; corners of the rim that are too close for that are dropped.
fn inset(rim: &mut Vec<(DVec2, Closed)>, by_m: f64) -> Option<Vec<DVec2>> {
    while rim.len() >= 4 {
        let count = rim.len();
        let along = |k: usize| (rim[(k + 1) % count].0 - rim[k % count].0).normalize_or_zero();
        let inner: Vec<DVec2> = (0..count)
            .map(|k| {
                let [before, after] = [along(k + count - 1).perp(), along(k).perp()];
                let inward = (before + after).normalize_or(after);
                rim[k].0 + by_m / inward.dot(after).max(0.4) * inward
            })
            .collect();
        let flipped = (0..count).find(|k| (inner[(k + 1) % count] - inner[*k]).dot(along(*k)) <= 0.0);
        match flipped {
            Some(k) => _ = rim.remove(k),
            None => return Some(inner),
        }
    }
    None
}

/// Removes the grass at the level of the road that islands cover.
fn remove_grass_below(builder: &mut MeshBuilder, islands: &[Island]) {
    let outlines = islands.iter().map(|island| island.rim.iter().map(|(at, _)| *at).collect());
    let outlines = PolygonIndex::new(outlines.collect());
    let mut meshes = core::mem::take(builder).finish();
    for mesh in meshes.iter_mut().filter(|mesh| mesh.label == SemanticLabel::Terrain) {
        let vertices = &mesh.vertices_in_world;
        mesh.triangles.retain(|triangle| {
            let corners = triangle.map(|corner| vertices[corner as usize].truncate());
            let middle = corners.iter().sum::<DVec2>() / 3.0;
            // Corners lie on the outline, but for rounding.
            let is_within = |outline: &[DVec2]| corners.iter().all(|it| contains(outline, it.lerp(middle, 0.05)));
            !outlines.at(middle).any(|island| is_within(&outlines.outlines()[island]))
        });
    }
    *builder = MeshBuilder::from_meshes(meshes);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A carriageway of 20 m by 20 m around a strip of grass, and what lies in the middle of the strip and on its edge afterwards.
    fn with_a_strip(half_m: DVec2, walkway: &[DVec2]) -> (usize, [Option<(SemanticLabel, f64)>; 2]) {
        let mut builder = MeshBuilder::default();
        let mut quad = |label: SemanticLabel, low: DVec2, high: DVec2| {
            let corners = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
            builder.quad(label, false, corners.map(|corner| (corner.extend(3.0), corner)));
        };
        let out = DVec2::splat(10.0);
        quad(SemanticLabel::Roads, -out, DVec2::new(10.0, -half_m.y));
        quad(SemanticLabel::Roads, DVec2::new(-10.0, half_m.y), out);
        quad(SemanticLabel::Roads, DVec2::new(-10.0, -half_m.y), DVec2::new(-half_m.x, half_m.y));
        quad(SemanticLabel::Roads, DVec2::new(half_m.x, -half_m.y), DVec2::new(10.0, half_m.y));
        quad(SemanticLabel::Terrain, -half_m, half_m);
        let surfaces = builder.finish();
        let ground = GroundIndex::of_surfaces(&surfaces, |_| true);
        let mut builder = MeshBuilder::from_meshes(surfaces);
        let walkways = PolygonIndex::new(vec![walkway.to_vec()]);
        let count = raise(&mut builder, &ground, &walkways, &[DVec3::new(0.3, 0.0, 3.0), DVec3::new(-0.3, 0.1, 3.0)]);
        let ground = GroundIndex::of_surfaces(&builder.finish(), |_| true);
        let at = |y: f64| {
            let mut layers = vec![];
            ground.visit_at(0.3, y, |found| layers.push(found));
            assert_eq!(layers.len(), 1, "one layer: {layers:?}");
            layers.first().map(|found| (found.label, (found.height_m * 1e3).round() * 1e-3))
        };
        (count, [at(0.0), at(half_m.y - 0.1)])
    }

    #[test]
    fn a_median_is_a_lawn_above_the_road_with_stones_around_it() {
        let (count, [middle, edge]) = with_a_strip(DVec2::new(6.0, 1.5), &[]);
        assert_eq!(count, 1);
        assert_eq!(middle, Some((SemanticLabel::Terrain, 3.15)));
        assert_eq!(edge, Some((SemanticLabel::SideWalks, 3.15)));
    }

    #[test]
    fn a_thin_strip_and_a_crossing_stay_level() {
        assert_eq!(with_a_strip(DVec2::new(6.0, 0.2), &[]).0, 0);
        let walkway = [[-2.0, -9.0], [2.0, -9.0], [2.0, 9.0], [-2.0, 9.0]].map(DVec2::from);
        let (count, [middle, _]) = with_a_strip(DVec2::new(6.0, 1.5), &walkway);
        assert_eq!((count, middle), (0, Some((SemanticLabel::Terrain, 3.0))));
    }
}
