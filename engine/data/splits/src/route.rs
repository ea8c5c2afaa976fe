//! Overlap of two walks: the share of the same ground in the same direction.

use cosfly_frames::{DVec3, real};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Edge of a cell, metres.
const CELL_M: f64 = 4.0;
/// Number of directions that are told apart.
const SECTORS: i64 = 8;
/// Shortest step that counts as walking, metres.
const LEAST_STEP_M: f64 = 0.05;

/// Cells and directions of a walk, packed and sorted; standing adds nothing.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Route(Vec<u64>);

impl Route {
    /// Route of a pedestrian whose feet are at `feet_in_map`, one position per frame, in the map file's coordinates.
    pub fn of(feet_in_map: &[DVec3]) -> Self {
        let mut cells: Vec<u64> = vec![];
        for pair in feet_in_map.windows(2) {
            let step = (pair[1] - pair[0]).truncate();
            let length_m = step.length();
            if !(LEAST_STEP_M..1e3).contains(&length_m) {
                continue;
            }
            let turn = real::atan2(step.y, step.x) / core::f64::consts::TAU * SECTORS as f64;
            let sector = (turn + 0.5).floor() as i64;
            let stops = (length_m / (0.5 * CELL_M)).ceil().max(1.0) as i64;
            cells.extend((0..stops).map(|stop| {
                let at = (pair[0].truncate() + step * (stop as f64 / stops as f64)) / CELL_M;
                packed(at.x.floor() as i64, at.y.floor() as i64, sector)
            }));
        }
        cells.sort_unstable();
        cells.dedup();
        Self(cells)
    }

    /// Cells within one cell and one direction of this route's.
    fn widened(&self) -> Vec<u64> {
        let near = |cell: &u64| {
            let (i, j, sector) = unpacked(*cell);
            (-1..=1).flat_map(move |di| {
                (-1..=1).flat_map(move |dj| (-1..=1).map(move |turn| packed(i + di, j + dj, sector + turn)))
            })
        };
        let mut cells: Vec<u64> = self.0.iter().flat_map(near).collect();
        cells.sort_unstable();
        cells.dedup();
        cells
    }
}

fn packed(i: i64, j: i64, sector: i64) -> u64 {
    let coordinate = |value: i64| (value.clamp(-(1 << 27), 1 << 27) + (1 << 28)) as u64;
    coordinate(i) << 34 | coordinate(j) << 4 | sector.rem_euclid(SECTORS) as u64
}

fn unpacked(cell: u64) -> (i64, i64, i64) {
    let coordinate = |bits: u64| (bits & ((1 << 30) - 1)) as i64 - (1 << 28);
    (coordinate(cell >> 34), coordinate(cell >> 4), (cell & 15) as i64)
}

/// Pairs of routes (smaller index first) with the share of the shorter one that the other repeats, where it exceeds
/// `least`. Only routes of the same `place` are compared.
pub fn overlaps(routes: &[(usize, &Route)], least: f64) -> Vec<(usize, usize, f64)> {
    let mut visits: Vec<(u64, usize)> =
        routes.iter().enumerate().flat_map(|(at, (_, route))| route.0.iter().map(move |cell| (*cell, at))).collect();
    visits.sort_unstable();
    let repeated = |at: usize| {
        let (place, route) = routes[at];
        let mut shared: BTreeMap<usize, usize> = BTreeMap::new();
        for cell in route.widened() {
            let first = visits.partition_point(|visit| visit.0 < cell);
            for (_, other) in visits[first..].iter().take_while(|visit| visit.0 == cell) {
                if *other != at && routes[*other].0 == place {
                    *shared.entry(*other).or_default() += 1;
                }
            }
        }
        let share = |other: usize, cells: usize| cells as f64 / routes[other].1.0.len().max(1) as f64;
        let shares = shared.into_iter().map(|(other, cells)| (at.min(other), at.max(other), share(other, cells)));
        shares.filter(|(_, _, share)| *share > least).collect::<Vec<_>>()
    };
    let found: Vec<_> = (0..routes.len()).into_par_iter().flat_map_iter(repeated).collect();
    let mut best: BTreeMap<(usize, usize), f64> = BTreeMap::new();
    for (a, b, share) in found {
        let most = best.entry((a, b)).or_default();
        *most = most.max(share);
    }
    best.into_iter().map(|((a, b), share)| (a, b, share)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn walk(from: (f64, f64), to: (f64, f64)) -> Route {
        let (from, to) = (DVec3::new(from.0, from.1, 0.0), DVec3::new(to.0, to.1, 0.0));
        let feet: Vec<DVec3> = (0..=100).map(|k| from + (to - from) * (f64::from(k) / 100.0)).collect();
        Route::of(&feet)
    }

    #[test]
    fn the_same_way_overlaps_and_the_way_back_or_another_street_does_not() {
        let there = walk((0.0, 0.0), (100.0, 0.0));
        for (other, expected) in [
            (walk((0.0, 1.5), (100.0, 1.5)), 1.0),
            (walk((60.0, 0.0), (160.0, 0.0)), 0.4),
            (walk((100.0, 0.0), (0.0, 0.0)), 0.0),
            (walk((0.0, 40.0), (100.0, 40.0)), 0.0),
        ] {
            let found = overlaps(&[(0, &there), (0, &other)], 0.0).first().map_or(0.0, |pair| pair.2);
            assert!((found - expected).abs() < 0.1, "{found} {expected}");
        }
        assert!(overlaps(&[(0, &there), (1, &there)], 0.0).is_empty(), "other towns are other places");
    }

    #[test]
    fn who_stands_or_jumps_has_no_route() {
        assert_eq!(Route::of(&[DVec3::ONE; 50]), Route::default());
        assert_eq!(Route::of(&[DVec3::ZERO, DVec3::splat(f64::NAN), DVec3::splat(1e9)]), Route::default());
        let (i, j, sector) = unpacked(packed(-7, 12, 9));
        assert_eq!((i, j, sector), (-7, 12, 1));
    }
}
