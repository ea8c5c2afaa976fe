//! [`PlanRegion`]: rings around ground, and what is left of them outside a convex shape.

use crate::polygons::{contains, twice_area_m2};
use cosfly_frames::DVec2;

/// Rings of less area are nothing, square metres.
const SMALLEST_M2: f64 = 1e-6;

/// Ground between rings, plan view, metres. Outer rings turn from x towards y, holes the other way round.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlanRegion {
    rings: Vec<Vec<DVec2>>,
}

impl PlanRegion {
    /// Region of an outer ring and its holes, each either way round; sides must not cross.
    pub fn new(outer: &[DVec2], holes: &[Vec<DVec2>]) -> Self {
        let holes = holes.iter().map(|hole| turned(hole, false));
        Self { rings: core::iter::once(turned(outer, true)).chain(holes).collect() }
    }

    /// Outer rings, and holes.
    pub fn rings(&self) -> (Vec<&[DVec2]>, Vec<&[DVec2]>) {
        self.rings.iter().map(Vec::as_slice).partition(|ring| twice_area_m2(ring) > 0.0)
    }

    /// Whether a point lies in the region.
    pub fn contains(&self, point: DVec2) -> bool {
        self.rings.iter().filter(|ring| contains(ring, point)).count() % 2 == 1
    }

    /// The parts of the region outside a convex shape, corners in order, either way round; none overlaps another. `None`
    /// where rings cross so that no cut holds.
    pub fn outside(&self, shape: &[DVec2]) -> Option<Vec<Self>> {
        let shape = turned(shape, true);
        let mut parts = Vec::new();
        let mut left = self.clone();
        for (index, corner) in shape.iter().enumerate() {
            let along = shape[(index + 1) % shape.len()] - *corner;
            let inward = along.perp();
            let outside = left.cut(*corner, -inward)?;
            left = left.cut(*corner, inward)?;
            if !outside.rings.is_empty() {
                parts.push(outside);
            }
        }
        Some(parts)
    }

    /// The part on the side of a line through `point` to which `inward` points.
    fn cut(&self, point: DVec2, inward: DVec2) -> Option<Self> {
        let is_inside = |corner: DVec2| (corner - point).dot(inward) >= 0.0;
        let mut out = Self::default();
        let mut chains = Vec::new();
        for ring in &self.rings {
            match ring.iter().position(|corner| !is_inside(*corner)) {
                None => out.rings.push(ring.clone()),
                Some(first) => chains.extend(chains_of(ring, first, point, inward)),
            }
        }
        out.rings.extend(closed(chains, inward.perp())?);
        Some(out)
    }
}

/// The ring with its corners from x towards y, or the other way round.
fn turned(ring: &[DVec2], is_positive: bool) -> Vec<DVec2> {
    let mut ring = ring.to_vec();
    if (twice_area_m2(&ring) > 0.0) != is_positive {
        ring.reverse();
    }
    ring
}

/// Stretches of a ring inside a line, from where the ring enters to where it leaves; `first` is a corner outside.
fn chains_of(ring: &[DVec2], first: usize, point: DVec2, inward: DVec2) -> Vec<Vec<DVec2>> {
    let depth = |corner: DVec2| (corner - point).dot(inward);
    let mut chains: Vec<Vec<DVec2>> = Vec::new();
    for step in 0..ring.len() {
        let (from, to) = (ring[(first + step) % ring.len()], ring[(first + step + 1) % ring.len()]);
        let (in_from, in_to) = (depth(from), depth(to));
        let crossing = || from.lerp(to, in_from / (in_from - in_to));
        match (in_from >= 0.0, in_to >= 0.0) {
            (false, true) => chains.push(vec![crossing(), to]),
            (true, true) => chains.last_mut().into_iter().for_each(|chain| chain.push(to)),
            (true, false) => chains.last_mut().into_iter().for_each(|chain| chain.push(crossing())),
            (false, false) => {}
        }
    }
    chains
}

/// Rings of stretches that all begin and end on one line: along the line two neighbouring ends are joined.
fn closed(chains: Vec<Vec<DVec2>>, along: DVec2) -> Option<Vec<Vec<DVec2>>> {
    // Place on the line, the stretch, whether it is the beginning of the stretch.
    let mut ends: Vec<(f64, usize, bool)> = Vec::with_capacity(2 * chains.len());
    for (number, chain) in chains.iter().enumerate() {
        ends.push((chain.first()?.dot(along), number, true));
        ends.push((chain.last()?.dot(along), number, false));
    }
    ends.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut next = vec![usize::MAX; chains.len()];
    for pair in ends.chunks_exact(2) {
        match (pair[0], pair[1]) {
            ((_, end, false), (_, begin, true)) | ((_, begin, true), (_, end, false)) => next[end] = begin,
            _ => return None,
        }
    }
    let mut is_used = vec![false; chains.len()];
    let mut rings = Vec::new();
    for start in 0..chains.len() {
        let (mut ring, mut at) = (Vec::new(), start);
        while !core::mem::replace(&mut is_used[at], true) {
            ring.extend(&chains[at]);
            at = next[at];
        }
        ring.dedup();
        if twice_area_m2(&ring).abs() > 2.0 * SMALLEST_M2 {
            rings.push(ring);
        }
    }
    Some(rings)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::Seed;

    fn ring(points: &[(f64, f64)]) -> Vec<DVec2> {
        points.iter().map(|(x, y)| DVec2::new(*x, *y)).collect()
    }

    fn area_m2(region: &PlanRegion) -> f64 {
        region.rings.iter().map(|ring| 0.5 * twice_area_m2(ring)).sum()
    }

    #[test]
    fn parts_outside_a_shape_hold_what_the_shape_does_not() {
        let outer = ring(&[
            (0.0, 0.0),
            (0.0, 20.0),
            (30.0, 20.0),
            (30.0, 0.0),
            (20.0, 0.0),
            (20.0, 8.0),
            (9.0, 8.0),
            (9.0, 0.0),
        ]);
        let hole = ring(&[(3.0, 12.0), (3.0, 16.0), (26.0, 17.0), (26.0, 12.0)]);
        let region = PlanRegion::new(&outer, &[hole]);
        let mut stream = Seed::of_item(3, "regions", "cuts").stream("shapes");
        for _ in 0..300 {
            let corner = DVec2::new(stream.uniform(-5.0, 35.0), stream.uniform(-5.0, 25.0));
            let along = DVec2::new(stream.uniform(-30.0, 30.0), stream.uniform(-30.0, 30.0));
            let across = stream.uniform(0.5, 6.0) * along.perp().normalize_or_zero();
            let shape = [corner, corner + along, corner + along + across, corner + across];
            let parts = region.outside(&shape).unwrap();
            let mut inside = 0;
            for _ in 0..200 {
                let point = DVec2::new(stream.uniform(-2.0, 32.0), stream.uniform(-2.0, 22.0));
                let held = parts.iter().filter(|part| part.contains(point)).count();
                let is_left = region.contains(point) && !contains(&shape, point);
                assert_eq!(held, usize::from(is_left), "{point} {shape:?}");
                inside += held;
            }
            let left_m2: f64 = parts.iter().map(area_m2).sum();
            assert!(left_m2 <= area_m2(&region) + 1e-6 && (inside == 0 || left_m2 > 0.0));
        }
    }

    #[test]
    fn a_cut_through_two_prongs_leaves_nothing_between_them() {
        let fork =
            ring(&[(0.0, 0.0), (9.0, 0.0), (9.0, 8.0), (6.0, 8.0), (6.0, 3.0), (3.0, 3.0), (3.0, 8.0), (0.0, 8.0)]);
        let parts =
            PlanRegion::new(&fork, &[]).outside(&ring(&[(-1.0, 5.0), (10.0, 5.0), (10.0, 6.0), (-1.0, 6.0)])).unwrap();
        let rings: Vec<usize> = parts.iter().map(|part| part.rings.len()).collect();
        assert_eq!(rings, [1, 2], "the root, and two tips that are apart");
        assert!((parts.iter().map(area_m2).sum::<f64>() - (57.0 - 6.0)).abs() < 1e-9);
    }
}
