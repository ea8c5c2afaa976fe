//! Closed slabs of ground: their undersides are no ground.

use super::level::is_level;
use super::parts::Part;
use super::plan_index::PlanIndex;
use super::solid::height_at;
use cosfly_disjoint_sets::DisjointSets;
use cosfly_frames::DVec3;

/// A face this near to where a vertical line begins is the face that it begins on, metres.
const SAME_CROSSING_M: f64 = 1e-6;
/// Where vertical lines meet a triangle: off its middle, so that they meet no edge of a regular mesh. A line along an edge counts both
/// faces of the edge; most of the lines decide.
const SHOTS: [[f64; 3]; 3] = [[0.3137, 0.3571, 0.3292], [0.2713, 0.3169, 0.4118], [0.3967, 0.2741, 0.3292]];
/// Most pairs of triangles that are compared in a scene; the undersides of finer ones stay.
pub const MOST_WORK: usize = 200_000_000;

/// Takes the faces away that are seen from below only: level faces of closed solids, above which the solid is. The windings of faces
/// do not matter. Ends when `work`, pairs of triangles, is used up.
pub fn drop_undersides(part: &mut Part, work: &mut usize) {
    let mut is_underside = vec![false; part.triangles.len()];
    for solid in closed_solids(part) {
        let faces: Vec<[DVec3; 3]> = solid.iter().map(|at| part.corners(part.triangles[*at])).collect();
        let index = PlanIndex::of(&faces);
        for at in (0..solid.len()).filter(|at| is_level(&faces[*at])) {
            is_underside[solid[at]] = is_below_its_solid(&faces[at], &faces, &index, work);
        }
    }
    let mut next = is_underside.iter();
    part.triangles.retain(|_| !next.next().is_some_and(|it| *it));
}

/// Whether a vertical line from the triangle upwards leaves the solid: it crosses an odd number of faces above.
fn is_below_its_solid(triangle: &[DVec3; 3], faces: &[[DVec3; 3]], index: &PlanIndex, work: &mut usize) -> bool {
    let mut crosses_odd = |shot: &[f64; 3]| {
        let from: DVec3 = triangle.iter().zip(shot).map(|(corner, share)| *share * *corner).sum();
        let over = index.over(from);
        let Some(left) = work.checked_sub(over.len()) else { return false };
        *work = left;
        let heights_m = over.iter().filter_map(|face| height_at(&faces[*face as usize], from.truncate()));
        heights_m.filter(|height_m| *height_m > from.z + SAME_CROSSING_M).count() % 2 == 1
    };
    SHOTS.iter().filter(|shot| crosses_odd(shot)).count() >= 2
}

/// Triangles of each piece that hangs together and has no open edge.
fn closed_solids(part: &Part) -> Vec<Vec<usize>> {
    let merged = part.merged_corners();
    let corners = |triangle: &[u32; 3]| triangle.map(|corner| merged[corner as usize]);
    let mut sets = DisjointSets::new(merged.len());
    let mut edges = Vec::with_capacity(3 * part.triangles.len());
    for [a, b, c] in part.triangles.iter().map(corners) {
        sets.join(a, b);
        sets.join(b, c);
        // A triangle without an area has two equal corners, and closes nothing.
        if a != b && b != c && c != a {
            edges.extend([[a.min(b), a.max(b)], [b.min(c), b.max(c)], [c.min(a), c.max(a)]]);
        }
    }
    edges.sort_unstable();
    let mut is_open = vec![false; merged.len()];
    for same in edges.chunk_by(|a, b| a == b).filter(|same| same.len() % 2 == 1) {
        is_open[sets.smallest(same[0][0])] = true;
    }
    let mut place = vec![usize::MAX; merged.len()];
    let mut solids: Vec<Vec<usize>> = Vec::new();
    for (at, triangle) in part.triangles.iter().enumerate() {
        let top = sets.smallest(corners(triangle)[0]);
        if is_open[top] {
            continue;
        }
        if place[top] == usize::MAX {
            place[top] = solids.len();
            solids.push(Vec::new());
        }
        solids[place[top]].push(at);
    }
    solids
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Boxes from corner to corner, faces turned inside out where asked for.
    fn boxes(boxes: &[([f64; 3], [f64; 3])], is_flipped: bool) -> Part {
        const SIDES: [[u32; 4]; 6] =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let mut part = Part::default();
        for (low, high) in boxes {
            let first = part.vertices.len() as u32;
            let side = |at: usize, axis: usize| if at >> axis & 1 == 0 { low[axis] } else { high[axis] };
            part.vertices.extend((0..8).map(|at| DVec3::new(side(at, 0), side(at, 1), side(at, 2))));
            for [a, b, c, d] in SIDES.map(|side| side.map(|corner| first + corner)) {
                let two = [[a, b, c], [a, c, d]];
                part.triangles.extend(if is_flipped { two.map(|[a, b, c]| [a, c, b]) } else { two });
            }
        }
        part
    }

    fn level_heights(mut part: Part) -> Vec<f64> {
        drop_undersides(&mut part, &mut MOST_WORK.clone());
        let level = part.triangles.iter().map(|it| part.corners(*it)).filter(is_level);
        let mut heights: Vec<f64> = level.map(|[a, ..]| a.z).collect();
        heights.sort_by(f64::total_cmp);
        heights
    }

    #[test]
    fn slabs_keep_their_tops_however_their_faces_are_wound() {
        let slab = ([0.0, 0.0, 0.0], [9.0, 4.0, 0.5]);
        let deep = ([20.0, 0.0, -6.0], [29.0, 4.0, 0.1]);
        for is_flipped in [false, true] {
            assert_eq!(level_heights(boxes(&[slab, deep], is_flipped)), [0.1, 0.1, 0.5, 0.5]);
        }
        let mixed = Part { triangles: Vec::new(), ..boxes(&[slab], false) };
        let triangles = boxes(&[slab], false).triangles.into_iter().enumerate();
        let turned = triangles.map(|(at, [a, b, c])| if at % 3 == 0 { [a, c, b] } else { [a, b, c] }).collect();
        assert_eq!(level_heights(Part { triangles: turned, ..mixed }), [0.5, 0.5]);
    }

    #[test]
    fn of_stacked_slabs_the_upper_top_stays_and_open_sheets_stay_whole() {
        let stack = [([0.0, 0.0, 0.0], [9.0, 4.0, 0.5]), ([0.0, 0.0, 0.5], [9.0, 4.0, 1.0])];
        assert_eq!(level_heights(boxes(&stack, false)), [1.0, 1.0]);
        let mut sheets = boxes(&stack[..1], false);
        sheets.triangles.truncate(4);
        assert_eq!(level_heights(sheets), [0.0, 0.0, 0.5, 0.5]);
    }
}
