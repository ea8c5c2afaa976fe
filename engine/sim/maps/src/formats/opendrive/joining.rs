//! Joins separate parts of the walkable ground by short straight strips, nearest parts first.
//!
//! Files often leave out the pavement at junction corners, or give an arm pavement on one side only; pedestrians
//! walk there all the same. Every strip is synthetic.

use cosfly_disjoint_sets::DisjointSets;
use cosfly_domain::{Obstacle, SemanticLabel, WalkableKind, WalkablePolygon};
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::GroundIndex;
use cosfly_town::mesh::MeshBuilder;
use cosfly_town::polygons::PolygonIndex;
use std::collections::BTreeMap;

/// Longest strip, metres.
const LONGEST_M: f64 = 25.0;
/// Width of a strip, metres.
const WIDTH_M: f64 = 2.5;
/// Overlap of a strip and the ground that it joins, metres.
const OVERLAP_M: f64 = 0.8;
/// Corners closer than this, in plan and in height, touch, metres.
const TOUCHING_M: [f64; 2] = [0.05, 0.6];
/// Distance between the outline points that are looked for in other polygons, metres.
const FINE_M: f64 = 0.6;
/// Distance between the points at which strips may begin, metres.
const SPACING_M: f64 = 1.0;
/// Depth of a strip's surface and of the lower edges of its faces, metres.
const SUNK_M: f64 = 0.01;
const FACE_M: f64 = 0.3;
/// Steepest strip, rise over run.
const STEEPEST: f64 = 0.15;

/// Most points along all outlines, and most pairs of points that are looked at: bounds for absurd maps.
const MOST_SAMPLES: f64 = 2e6;
const MOST_PAIRS: usize = 50_000_000;

/// Points along the outlines; each knows its polygon.
struct Sample {
    point: DVec3,
    polygon: usize,
}

/// Strips that join the parts of `walkable`, as far as they are near each other, on level ground and free of
/// obstacles. Strips beyond the lanes also get a surface.
pub(super) fn joining_strips(
    walkable: &[WalkablePolygon],
    obstacles: &[Obstacle],
    ground: &GroundIndex,
    meshes: &mut MeshBuilder,
) -> Vec<WalkablePolygon> {
    let perimeter_m: f64 = walkable.iter().map(perimeter_m).sum();
    if perimeter_m / FINE_M > MOST_SAMPLES {
        return Vec::new();
    }
    let mut parts = DisjointSets::new(walkable.len());
    let fine = samples(walkable, FINE_M);
    unite_touching(&mut parts, &fine, walkable);
    let blocked = footprints(obstacles);
    let mut strips = Vec::new();
    for (a, b) in candidates(&mut parts, &samples(walkable, SPACING_M)) {
        if parts.smallest(a.polygon) == parts.smallest(b.polygon) {
            continue;
        }
        if let Some(strip) = strip(a.point, b.point, &blocked, ground, meshes) {
            parts.join(a.polygon, b.polygon);
            strips.push(strip);
        }
    }
    strips
}

fn perimeter_m(polygon: &WalkablePolygon) -> f64 {
    let plan = polygon.plan();
    (0..plan.len()).map(|i| plan[i].distance(plan[(i + 1) % plan.len()])).sum()
}

fn samples(walkable: &[WalkablePolygon], spacing_m: f64) -> Vec<Sample> {
    let mut out = Vec::new();
    for (polygon, area) in walkable.iter().enumerate() {
        let outline = &area.outline_in_world;
        for i in 0..outline.len() {
            let (a, b) = (outline[i], outline[(i + 1) % outline.len()]);
            let steps = ((b - a).truncate().length() / spacing_m).ceil().clamp(1.0, 1e4) as usize;
            out.extend((0..steps).map(|step| Sample { point: a.lerp(b, step as f64 / steps as f64), polygon }));
        }
    }
    out
}

type Cells = BTreeMap<(i64, i64), Vec<usize>>;

fn cells(samples: &[Sample], cell_m: f64) -> Cells {
    let mut cells = Cells::new();
    for (number, sample) in samples.iter().enumerate() {
        cells.entry(cell(sample.point, cell_m)).or_default().push(number);
    }
    cells
}

fn cell(point: DVec3, cell_m: f64) -> (i64, i64) {
    ((point.x / cell_m).floor() as i64, (point.y / cell_m).floor() as i64)
}

fn around(cells: &Cells, (x, y): (i64, i64)) -> impl Iterator<Item = usize> + '_ {
    (-1..=1)
        .flat_map(move |dx| (-1..=1).map(move |dy| (x + dx, y + dy)))
        .filter_map(|key| cells.get(&key))
        .flatten()
        .copied()
}

/// Polygons touch when outline points are close or lie inside the other polygon, at about the same height.
fn unite_touching(parts: &mut DisjointSets, fine: &[Sample], walkable: &[WalkablePolygon]) {
    let [near_m, level_m] = TOUCHING_M;
    let cell_m = 2.0 * near_m;
    let grid = cells(fine, cell_m);
    let mut pairs = 0;
    for sample in fine {
        if pairs > MOST_PAIRS {
            break;
        }
        for other in around(&grid, cell(sample.point, cell_m)).map(|number| &fine[number]) {
            let offset = (other.point - sample.point).abs();
            pairs += 1;
            if offset.z < level_m && offset.truncate().length() < near_m {
                parts.join(sample.polygon, other.polygon);
            }
        }
    }
    let index = PolygonIndex::new(walkable.iter().map(WalkablePolygon::plan).collect());
    for sample in fine {
        for other in index.at(sample.point.truncate()) {
            if (walkable[other].mean_height_m() - sample.point.z).abs() < level_m {
                parts.join(sample.polygon, other);
            }
        }
    }
}

/// One point of each part in each square of one spacing.
fn thinned<'s>(parts: &mut DisjointSets, samples: &'s [Sample]) -> Vec<&'s Sample> {
    let mut kept = BTreeMap::new();
    for sample in samples {
        kept.entry((parts.smallest(sample.polygon), cell(sample.point, SPACING_M))).or_insert(sample);
    }
    kept.into_values().collect()
}

/// Pairs of points of different parts, nearest first; for each point the nearest one of each other part.
fn candidates<'s>(parts: &mut DisjointSets, samples: &'s [Sample]) -> Vec<(&'s Sample, &'s Sample)> {
    let samples = thinned(parts, samples);
    let roots: Vec<usize> = samples.iter().map(|sample| parts.smallest(sample.polygon)).collect();
    if roots.windows(2).all(|pair| pair[0] == pair[1]) {
        return Vec::new();
    }
    let mut grid = Cells::new();
    for (number, sample) in samples.iter().enumerate() {
        grid.entry(cell(sample.point, LONGEST_M)).or_default().push(number);
    }
    let mut looked_at = 0;
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for (number, sample) in samples.iter().enumerate() {
        let mut nearest: BTreeMap<usize, (f64, usize)> = BTreeMap::new();
        if looked_at > MOST_PAIRS {
            break;
        }
        for other in around(&grid, cell(sample.point, LONGEST_M)).filter(|other| roots[*other] > roots[number]) {
            looked_at += 1;
            let offset = samples[other].point - sample.point;
            let distance_m = offset.truncate().length();
            if distance_m <= LONGEST_M && offset.z.abs() <= STEEPEST * distance_m + 0.3 {
                let best = nearest.entry(roots[other]).or_insert((distance_m, other));
                if distance_m < best.0 {
                    *best = (distance_m, other);
                }
            }
        }
        pairs.extend(nearest.into_values().map(|(distance_m, other)| (distance_m, number, other)));
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    pairs.into_iter().map(|(_, a, b)| (samples[a], samples[b])).collect()
}

/// Footprints of everything a pedestrian would run into.
fn footprints(obstacles: &[Obstacle]) -> PolygonIndex {
    let standing = obstacles.iter().filter(|obstacle| cosfly_town::terrain::stands_on_ground(obstacle.kind));
    let outlines = standing.map(|obstacle| {
        let corners = obstacle.shape.corners_in_world();
        [0, 1, 3, 2].map(|corner| corners[corner].truncate()).to_vec()
    });
    PolygonIndex::new(outlines.collect())
}

/// The strip between two points, when nothing stands in its way and no road passes far above or below.
fn strip(
    from: DVec3,
    to: DVec3,
    blocked: &PolygonIndex,
    ground: &GroundIndex,
    meshes: &mut MeshBuilder,
) -> Option<WalkablePolygon> {
    let length_m = (to - from).truncate().length();
    let along = (to - from).truncate().normalize_or(DVec2::X);
    let across = 0.5 * WIDTH_M * along.perp();
    let steps = (length_m / 0.5).ceil().max(1.0) as usize;
    let mut on_road = false;
    let mut off_lanes = vec![false; steps + 1];
    for (step, is_off) in off_lanes.iter_mut().enumerate() {
        let point = from.lerp(to, step as f64 / steps as f64);
        let plan = point.truncate();
        if [plan, plan + across, plan - across].iter().any(|place| blocked.at(*place).next().is_some()) {
            return None;
        }
        match ground.ground_near(point) {
            Some(near) if (near.height_m - point.z).abs() > 0.8 => return None,
            Some(near) => on_road |= near.label == SemanticLabel::Roads,
            None => *is_off = true,
        }
    }
    let reach = OVERLAP_M * along;
    let corner = |end: DVec3, side: DVec2, reach: DVec2| (end.truncate() + side + reach).extend(end.z);
    let outline = |from: DVec3, to: DVec3, reaches: [DVec2; 2]| {
        let [before, after] = reaches;
        [
            corner(from, across, -before),
            corner(to, across, after),
            corner(to, -across, after),
            corner(from, -across, -before),
        ]
    };
    let at = |step: usize| from.lerp(to, step as f64 / steps as f64);
    for run in (0..=steps).collect::<Vec<_>>().chunk_by(|a, b| off_lanes[*a] == off_lanes[*b]) {
        let (first, last) = (run[0].saturating_sub(1), (run[run.len() - 1] + 1).min(steps));
        if off_lanes[run[0]] {
            let reaches = [(first, 0), (last, steps)].map(|(end, edge)| if end == edge { reach } else { DVec2::ZERO });
            add_slab(meshes, outline(at(first), at(last), reaches));
        }
    }
    let outline_in_world = outline(from, to, [reach, reach]).to_vec();
    let kind = if on_road { WalkableKind::Road } else { WalkableKind::Sidewalk };
    Some(WalkablePolygon { kind, outline_in_world, synthetic: true })
}

/// A piece of pavement with faces around it, just below the pavements that it meets, so that the two do not fight for the same pixels.
fn add_slab(meshes: &mut MeshBuilder, corners: [DVec3; 4]) {
    let at = |corner: usize, below_m: f64| (corners[corner % 4] - below_m * DVec3::Z, corners[corner % 4].truncate());
    meshes.quad(SemanticLabel::SideWalks, true, [0, 1, 2, 3].map(|corner| at(corner, SUNK_M)));
    for side in 0..4 {
        let face = [at(side, SUNK_M), at(side + 1, SUNK_M), at(side + 1, FACE_M), at(side, FACE_M)];
        meshes.quad(SemanticLabel::SideWalks, true, face);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, z: f64) -> WalkablePolygon {
        let outline = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)];
        let outline_in_world = outline.iter().map(|(u, v)| DVec3::new(x + u, *v, z)).collect();
        WalkablePolygon { kind: WalkableKind::Sidewalk, outline_in_world, synthetic: false }
    }

    fn strips(walkable: &[WalkablePolygon]) -> usize {
        let ground = GroundIndex::of_surfaces(&[], |_| true);
        joining_strips(walkable, &[], &ground, &mut MeshBuilder::default()).len()
    }

    #[test]
    fn only_near_and_level_parts_are_joined() {
        assert_eq!(strips(&[square(0.0, 0.0), square(4.03, 0.0)]), 0, "they touch");
        assert_eq!(strips(&[square(0.0, 0.0), square(4.1, 0.0)]), 1, "a walker's grid may miss the gap");
        assert_eq!(strips(&[square(0.0, 0.0), square(12.0, 0.0), square(24.0, 0.0)]), 2, "two gaps");
        assert_eq!(strips(&[square(0.0, 0.0), square(40.0, 0.0)]), 0, "too far");
        assert_eq!(strips(&[square(0.0, 0.0), square(9.0, 5.0)]), 0, "another level");
        assert_eq!(strips(&[square(0.0, 0.0), square(1.0, 6.0)]), 0, "a bridge above");
        assert_eq!(strips(&[]), 0, "nothing");
    }
}
