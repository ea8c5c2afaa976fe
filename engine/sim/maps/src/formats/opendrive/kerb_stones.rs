//! Kerbs that a file marks at the edge of a carriageway where no pavement lies beyond: a row of stones above the road.

use super::network::{LaneSection, RoadMark};
use super::stations::CrossSection;
use super::surfaces::DEFAULT_KERB_M;
use cosfly_domain::SemanticLabel;
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::GroundIndex;
use cosfly_town::mesh::MeshBuilder;
use cosfly_town::world::WorldFromMap;

/// Width of the stones from above, and the depth of their faces below the road, metres.
const WIDTH_M: f64 = 0.2;
const BELOW_ROAD_M: f64 = 0.3;
/// Distance of the places along an edge that are looked at, metres, and most of them between two cross-sections.
const STEP_M: f64 = 1.0;
const MOST_STEPS: f64 = 1000.0;
/// Places beyond an edge where there must be neither carriageway nor pavement, metres.
const FREE_M: [f64; 3] = [0.05, 0.2, 0.8];
/// Ground this far above or below the road is of another level, metres.
const LEVEL_M: f64 = 1.0;

/// A piece of a kerb's line in the world, at the height of the road.
pub(super) struct Kerb {
    ends: [DVec3; 2],
    /// Unit vector away from the carriageway.
    outward: DVec2,
}

/// The kerbs of a section beyond which it has no lane.
pub(super) fn kerbs(section: &LaneSection, rows: &[CrossSection], world: &WorldFromMap) -> Vec<Kerb> {
    let mut kerbs = vec![];
    for (side, (_, lanes)) in section.sides().into_iter().enumerate() {
        let Some(last) = lanes.len().checked_sub(1) else { continue };
        let edge = |row: &CrossSection, outer: usize| row.points[side][last][outer];
        add(&mut kerbs, section, &lanes[last].marks, rows, |row| {
            [edge(row, 0), edge(row, 1)].map(|at| world.point(at))
        });
        if section.sides()[1 - side].1.is_empty() {
            let edge = |row: &CrossSection, outer: usize| row.points[side][0][outer];
            let inwards = |row: &CrossSection| [edge(row, 1), edge(row, 0)].map(|at| world.point(at));
            add(&mut kerbs, section, &section.center_marks, rows, inwards);
        }
    }
    kerbs
}

/// Adds the marked kerbs of one line; `across` gives a place of the lane beside it and the place of the line.
fn add(
    kerbs: &mut Vec<Kerb>,
    section: &LaneSection,
    marks: &[RoadMark],
    rows: &[CrossSection],
    across: impl Fn(&CrossSection) -> [DVec3; 2],
) {
    for (index, mark) in marks.iter().enumerate().filter(|(_, mark)| mark.is_kerb) {
        let to_s_m = marks.get(index + 1).map_or(section.end_s_m, |next| next.s_m);
        for pair in rows.windows(2) {
            let [low, high] = [&pair[0], &pair[1]];
            let (from_s_m, to_s_m) = (low.s_m.max(mark.s_m), high.s_m.min(to_s_m));
            if to_s_m - from_s_m < 0.01 {
                continue;
            }
            let ([inner, from], [_, to]) = (across(low), across(high));
            let share = |s_m: f64| (s_m - low.s_m) / (high.s_m - low.s_m);
            let ends = [from_s_m, to_s_m].map(|s_m| from.lerp(to, share(s_m)));
            let side = (to - from).truncate().perp().normalize_or_zero();
            let outward = if side.dot((from - inner).truncate()) < 0.0 { -side } else { side };
            kerbs.push(Kerb { ends, outward });
        }
    }
}

/// Lays the stones as far as the ground beyond is free and gives their length, metres; `ground` is all ground so far.
pub(super) fn lay(builder: &mut MeshBuilder, ground: &GroundIndex, kerbs: &[Kerb]) -> f64 {
    kerbs.iter().map(|kerb| kerb.lay(builder, ground)).sum()
}

impl Kerb {
    fn lay(&self, builder: &mut MeshBuilder, ground: &GroundIndex) -> f64 {
        let [from, to] = self.ends;
        let steps = (from.distance(to) / STEP_M).ceil().clamp(1.0, MOST_STEPS) as usize;
        let at = |step: usize| from.lerp(to, step as f64 / steps as f64);
        let free: Vec<bool> = (0..steps).map(|step| self.is_free(ground, at(step).midpoint(at(step + 1)))).collect();
        let (mut length_m, mut first) = (0.0, 0);
        for run in free.chunk_by(|a, b| a == b) {
            let end = first + run.len();
            if run[0] {
                self.add_stones(builder, [at(first), at(end)]);
                length_m += at(first).distance(at(end));
            }
            first = end;
        }
        length_m
    }

    fn is_free(&self, ground: &GroundIndex, place: DVec3) -> bool {
        FREE_M.iter().all(|away_m| {
            let seen = ground.ground_seen((place.truncate() + away_m * self.outward).extend(place.z), LEVEL_M);
            seen.is_none_or(|it| it.label == SemanticLabel::Terrain && it.height_m < place.z + 0.5 * DEFAULT_KERB_M)
        })
    }

    fn add_stones(&self, builder: &mut MeshBuilder, ends: [DVec3; 2]) {
        let corner = |end: usize, away_m: f64, above_m: f64| {
            let plan = ends[end].truncate() + away_m * self.outward;
            (plan.extend(ends[end].z + above_m), plan)
        };
        let mut strip = |[a, b]: [[f64; 2]; 2]| {
            let corners = [corner(0, a[0], a[1]), corner(1, a[0], a[1]), corner(1, b[0], b[1]), corner(0, b[0], b[1])];
            builder.quad(SemanticLabel::SideWalks, false, corners);
        };
        let (front, back) = ([0.0, DEFAULT_KERB_M], [WIDTH_M, DEFAULT_KERB_M]);
        strip([[0.0, -BELOW_ROAD_M], front]);
        strip([front, back]);
        strip([back, [WIDTH_M, -BELOW_ROAD_M]]);
        for end in [0, 1] {
            let feet = [corner(end, WIDTH_M, -BELOW_ROAD_M), corner(end, 0.0, -BELOW_ROAD_M)];
            let tops = [corner(end, 0.0, DEFAULT_KERB_M), corner(end, WIDTH_M, DEFAULT_KERB_M)];
            builder.quad(SemanticLabel::SideWalks, false, [tops[0], tops[1], feet[0], feet[1]]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stones_lie_beside_grass_and_leave_mouths_of_roads_open() {
        let mut builder = MeshBuilder::default();
        let mut quad = |label: SemanticLabel, low: DVec2, high: DVec2| {
            let corners = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
            builder.quad(label, false, corners.map(|corner| (corner.extend(2.0), corner)));
        };
        quad(SemanticLabel::Roads, DVec2::new(0.0, -4.0), DVec2::new(40.0, 0.0));
        quad(SemanticLabel::Roads, DVec2::new(10.0, 0.0), DVec2::new(16.0, 9.0));
        quad(SemanticLabel::Terrain, DVec2::new(16.0, 0.0), DVec2::new(30.0, 9.0));
        let ground = GroundIndex::of_surfaces(&builder.finish(), |_| true);
        let kerb = Kerb { ends: [DVec3::new(0.0, 0.0, 2.0), DVec3::new(40.0, 0.0, 2.0)], outward: DVec2::Y };
        let mut builder = MeshBuilder::default();
        assert!((lay(&mut builder, &ground, &[kerb]) - 34.0).abs() < 1e-9);
        let stones = GroundIndex::of_surfaces(&builder.finish(), |_| true);
        let top = |x: f64| stones.ground_height_m(x, 0.1);
        assert_eq!((top(13.0), top(45.0)), (None, None));
        assert!([5.0, 20.0, 35.0].map(top).into_iter().flatten().all(|top_m| (top_m - 2.15).abs() < 1e-9));
    }
}
