//! Undersides of ground that a file gives as solids: people stand on the upper faces.

use super::faces::Face;
use crate::slabs::inner_point;
use cosfly_disjoint_sets::DisjointSets;
use cosfly_frames::DVec2;
use cosfly_town::polygons::contains;
use std::collections::BTreeMap;

/// Corners in the same cube of this side are one, metres.
const SAME_M: f64 = 1e-3;
/// Faces that lean more are walls, vertical part of the unit normal.
const STEEPEST_NORMAL: f64 = 0.3;
/// Most pairs of faces of an object that are compared; the undersides of finer ones stay.
const MOST_WORK: usize = 20_000_000;

/// For each face whether it is an underside: a level face of a closed solid under an odd number of its other faces. The order of
/// corners does not matter.
pub(super) fn undersides(faces: &[Face]) -> Vec<bool> {
    let mut out = vec![false; faces.len()];
    for solid in closed_solids(faces) {
        let level: Vec<(usize, Vec<Vec<DVec2>>)> = solid
            .iter()
            .filter(|face| faces[**face].level_share() >= STEEPEST_NORMAL)
            .map(|face| (*face, faces[*face].plan_above(f64::NEG_INFINITY)))
            .collect();
        if level.len().saturating_mul(level.len()) > MOST_WORK {
            continue;
        }
        for (face, plan) in &level {
            let rings: Vec<&[DVec2]> = plan.iter().map(Vec::as_slice).collect();
            let Some(at) = inner_point(&rings) else { continue };
            let own_m = faces[*face].height_m(at);
            let is_above = |(other, plan): &&(usize, Vec<Vec<DVec2>>)| {
                let is_inside = plan.iter().filter(|ring| contains(ring, at)).count() % 2 == 1;
                other != face && is_inside && faces[*other].height_m(at) > own_m + SAME_M
            };
            out[*face] = level.iter().filter(is_above).count() % 2 == 1;
        }
    }
    out
}

/// Faces of each piece that hangs together and has no open edge.
fn closed_solids(faces: &[Face]) -> Vec<Vec<usize>> {
    let mut numbers: BTreeMap<[i64; 3], usize> = BTreeMap::new();
    let mut rings: Vec<(usize, Vec<usize>)> = Vec::new();
    for (face, ring) in faces.iter().enumerate().flat_map(|(face, it)| it.rings.iter().map(move |ring| (face, ring))) {
        let number = |corner: &cosfly_frames::DVec3| {
            let next = numbers.len();
            *numbers.entry((*corner / SAME_M).round().as_i64vec3().to_array()).or_insert(next)
        };
        rings.push((face, ring.iter().map(number).collect()));
    }
    let mut sets = DisjointSets::new(numbers.len());
    let mut edges = Vec::new();
    for (_, ring) in &rings {
        for (at, from) in ring.iter().enumerate() {
            let to = ring[(at + 1) % ring.len()];
            sets.join(*from, to);
            if *from != to {
                edges.push([to.min(*from), to.max(*from)]);
            }
        }
    }
    edges.sort_unstable();
    let mut is_open = vec![false; numbers.len()];
    for same in edges.chunk_by(|a, b| a == b).filter(|same| same.len() % 2 == 1) {
        is_open[sets.smallest(same[0][0])] = true;
    }
    let mut solids: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (face, ring) in &rings {
        let Some(first) = ring.first().map(|first| sets.smallest(*first)).filter(|first| !is_open[*first]) else {
            continue;
        };
        let solid = solids.entry(first).or_default();
        if solid.last() != Some(face) {
            solid.push(*face);
        }
    }
    solids.into_values().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::DVec3;

    fn slab(base_m: f64, top_m: f64) -> Vec<Face> {
        let corner = |at: usize| DVec3::new([0.0, 9.0][at & 1], [0.0, 4.0][at >> 1 & 1], [base_m, top_m][at >> 2]);
        let sides = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
        sides.map(|side| Face { rings: vec![side.map(corner).to_vec()] }).to_vec()
    }

    #[test]
    fn only_the_lower_faces_of_closed_solids_are_undersides() {
        assert_eq!(undersides(&slab(0.0, 0.5)), [true, false, false, false, false, false]);
        let stack = [slab(0.0, 0.5), slab(0.5, 4.0)].concat();
        assert_eq!(undersides(&stack).iter().filter(|it| **it).count(), 3);
        assert!(!undersides(&stack)[7], "the top of the upper one");
        assert_eq!(undersides(&slab(0.0, 0.5)[..5]), [false; 5]);
    }
}
