//! Walks that repeat each other, found through an index of the cells that walks enter.
//!
//! A walk repeats another one in a cell when it enters the cell, or one beside it, in about the same direction, or in the
//! opposite one where that counts. The share
//! of a walk's cells that another one repeats is their overlap. Memory is linear in the number of entered cells.

use super::route::{Route, back, near};
use cosfly_disjoint_sets::DisjointSets;
use cosfly_schema::config::OverlapDirection;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Walks looked at before the sets are joined for the first time; twice as many each time after.
const FIRST_BLOCK: usize = 256;
/// Walks looked at together by one thread.
const TOGETHER: usize = 64;

/// Pairs of walks with different colours that overlap.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overlaps {
    /// The first pairs (smaller number first), with the larger of their two overlaps.
    pub kept: Vec<(usize, usize, f64)>,
    /// Number of all pairs.
    pub found: usize,
}

/// Pairs of routes of the same place with different colours that overlap by more than `least` in the directions `counted`.
/// Keeps the first `limit` pairs of those that `is_judged` accepts.
pub fn overlaps(
    routes: &[(usize, &Route)],
    colours: &[u32],
    (least, counted): (f64, OverlapDirection),
    is_judged: &(dyn Fn(usize, usize) -> bool + Sync),
    limit: usize,
) -> Overlaps {
    let mut index = CellIndex::of(routes, counted);
    index.sort(colours);
    let mut kept: BTreeMap<(usize, usize), f64> = BTreeMap::new();
    let mut found = 0;
    let mut first = 0;
    while first < routes.len() {
        let block = first..routes.len().min(first + FIRST_BLOCK.max(routes.len() / 16));
        first = block.end;
        let pairs: Vec<Overlaps> = block
            .into_par_iter()
            .with_min_len(TOGETHER)
            .map_init(
                || Counter::new(routes.len()),
                |counter, at| {
                    let mut of_route = Overlaps::default();
                    for (other, share) in counter.repeated(&index, at, colours, least, false) {
                        let back = index.share(other, at);
                        // Each pair is counted once, by the smaller number where both find it.
                        if is_judged(at.min(other), at.max(other)) && (at < other || back <= least) {
                            of_route.found += 1;
                            of_route.kept.push((at.min(other), at.max(other), share.max(back)));
                        }
                    }
                    of_route
                },
            )
            .collect();
        for of_route in pairs {
            found += of_route.found;
            for (a, b, share) in of_route.kept {
                kept.insert((a, b), share);
                if kept.len() > limit {
                    kept.pop_last();
                }
            }
        }
    }
    Overlaps { kept: kept.into_iter().map(|((a, b), share)| (a, b, share)).collect(), found }
}

/// Joins the owners of all routes of the same place that overlap by more than `least` in the directions `counted`.
///
/// Most walks of a dense town are soon in one set, and walks of the same set are not compared any more: the index keeps
/// the members of a set side by side and skips them.
pub fn join_overlapping(
    routes: &[(usize, &Route)],
    owners: &[usize],
    (least, counted): (f64, OverlapDirection),
    sets: &mut DisjointSets,
) {
    let mut index = CellIndex::of(routes, counted);
    let (mut first, mut size) = (0, FIRST_BLOCK);
    while first < routes.len() {
        let colours: Vec<u32> = owners.iter().map(|owner| sets.smallest(*owner) as u32).collect();
        index.sort(&colours);
        let block = first..routes.len().min(first + size);
        (first, size) = (block.end, 2 * size);
        let joined: Vec<(usize, usize)> = block
            .into_par_iter()
            .with_min_len(TOGETHER)
            .map_init(
                || Counter::new(routes.len()),
                |counter, at| {
                    let of_route = counter.repeated(&index, at, &colours, least, true);
                    of_route.into_iter().map(|(other, _)| (at, other)).collect::<Vec<_>>()
                },
            )
            .flatten_iter()
            .collect();
        joined.into_iter().for_each(|(a, b)| sets.join(owners[a], owners[b]));
    }
}

/// Entered cells of all places, and the routes that enter each.
struct CellIndex {
    /// Cell numbers of each route: from one offset to the next.
    of_route: Vec<u32>,
    route_offsets: Vec<usize>,
    /// Numbers of the entered cells near each cell.
    near: Vec<u32>,
    near_offsets: Vec<usize>,
    /// Colour and number of the routes in each cell, sorted.
    entered: Vec<(u32, u32)>,
    cell_offsets: Vec<usize>,
}

impl CellIndex {
    fn of(routes: &[(usize, &Route)], counted: OverlapDirection) -> Self {
        let mut cells: Vec<(usize, u64)> =
            routes.iter().flat_map(|(place, route)| route.cells().iter().map(move |cell| (*place, *cell))).collect();
        cells.par_sort_unstable();
        cells.dedup();
        let mut index = Self {
            of_route: vec![],
            route_offsets: vec![0],
            near: vec![],
            near_offsets: vec![0],
            entered: vec![],
            cell_offsets: vec![0; cells.len() + 1],
        };
        for (place, route) in routes {
            for cell in route.cells() {
                let number = cells.binary_search(&(*place, *cell)).expect("all cells are in the list");
                index.of_route.push(number as u32);
                index.cell_offsets[number + 1] += 1;
            }
            index.route_offsets.push(index.of_route.len());
        }
        for (place, cell) in &cells {
            let opposite = (counted == OverlapDirection::Either).then(|| near(back(*cell)));
            let all = near(*cell).chain(opposite.into_iter().flatten());
            let entered = all.filter_map(|it| cells.binary_search(&(*place, it)).ok());
            index.near.extend(entered.map(|number| number as u32));
            index.near_offsets.push(index.near.len());
        }
        for at in 1..index.cell_offsets.len() {
            index.cell_offsets[at] += index.cell_offsets[at - 1];
        }
        index.entered = vec![(0, 0); index.of_route.len()];
        index
    }

    /// Sorts the routes in each cell by colour.
    fn sort(&mut self, colours: &[u32]) {
        let mut next = self.cell_offsets.clone();
        for (route, colour) in colours.iter().enumerate() {
            for cell in &self.of_route[self.route_offsets[route]..self.route_offsets[route + 1]] {
                self.entered[next[*cell as usize]] = (*colour, route as u32);
                next[*cell as usize] += 1;
            }
        }
        let mut rest = &mut self.entered[..];
        for pair in self.cell_offsets.windows(2) {
            let (cell, others) = rest.split_at_mut(pair[1] - pair[0]);
            cell.sort_unstable();
            rest = others;
        }
    }

    fn cells(&self, route: usize) -> &[u32] {
        &self.of_route[self.route_offsets[route]..self.route_offsets[route + 1]]
    }

    fn near(&self, cell: u32) -> &[u32] {
        &self.near[self.near_offsets[cell as usize]..self.near_offsets[cell as usize + 1]]
    }

    fn entered(&self, cell: u32) -> &[(u32, u32)] {
        &self.entered[self.cell_offsets[cell as usize]..self.cell_offsets[cell as usize + 1]]
    }

    /// Share of the cells of `route` that `other` repeats.
    fn share(&self, route: usize, other: usize) -> f64 {
        let others = self.cells(other);
        let is_repeated = |cell: &&u32| self.near(**cell).iter().any(|it| others.binary_search(it).is_ok());
        let cells = self.cells(route);
        cells.iter().filter(is_repeated).count() as f64 / cells.len().max(1) as f64
    }
}

/// Counts repeated cells; the room of one thread.
struct Counter {
    /// Cells of the present route that each other route repeats.
    counts: Vec<u32>,
    /// Last cell that was counted for each route.
    last: Vec<u64>,
    /// Last route that each colour was found to overlap with.
    done: Vec<u64>,
    cell: u64,
}

impl Counter {
    fn new(routes: usize) -> Self {
        Self { counts: vec![0; routes], last: vec![0; routes], done: vec![], cell: 0 }
    }

    /// Routes of other colours that repeat more than `least` of route `at`, with the share, in ascending order; of each
    /// colour only one where `once` is set.
    fn repeated(&mut self, index: &CellIndex, at: usize, colours: &[u32], least: f64, once: bool) -> Vec<(usize, f64)> {
        let cells = index.cells(at);
        let share = |count: u32| f64::from(count) / cells.len().max(1) as f64;
        let mut touched: Vec<u32> = vec![];
        let mut found: Vec<u32> = vec![];
        let route = at as u64 + 1;
        for cell in cells {
            self.cell += 1;
            for near in index.near(*cell) {
                let mut entered = index.entered(*near);
                while let Some((colour, _)) = entered.first() {
                    let (same, others) = entered.split_at(entered.partition_point(|it| it.0 == *colour));
                    entered = others;
                    if *colour == colours[at] || once && self.is_done(*colour, route) {
                        continue;
                    }
                    for (_, other) in same {
                        let number = *other as usize;
                        if std::mem::replace(&mut self.last[number], self.cell) == self.cell {
                            continue;
                        }
                        if self.counts[number] == 0 {
                            touched.push(*other);
                        }
                        self.counts[number] += 1;
                        if once && share(self.counts[number]) > least {
                            found.push(*other);
                            self.set_done(*colour, route);
                            break;
                        }
                    }
                }
            }
        }
        if !once {
            found.extend(touched.iter().filter(|other| share(self.counts[**other as usize]) > least));
        }
        found.sort_unstable();
        let found = found.into_iter().map(|other| (other as usize, share(self.counts[other as usize]))).collect();
        touched.into_iter().for_each(|other| self.counts[other as usize] = 0);
        found
    }

    fn is_done(&self, colour: u32, route: u64) -> bool {
        self.done.get(colour as usize) == Some(&route)
    }

    fn set_done(&mut self, colour: u32, route: u64) {
        if self.done.len() <= colour as usize {
            self.done.resize(colour as usize + 1, 0);
        }
        self.done[colour as usize] = route;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::{DVec3, Seed};

    fn walk(from: (f64, f64), to: (f64, f64)) -> Route {
        let (from, to) = (DVec3::new(from.0, from.1, 0.0), DVec3::new(to.0, to.1, 0.0));
        let feet: Vec<DVec3> = (0..=100).map(|k| from + (to - from) * (f64::from(k) / 100.0)).collect();
        Route::of(&feet)
    }

    const SAME: OverlapDirection = OverlapDirection::Same;
    const EITHER: OverlapDirection = OverlapDirection::Either;

    fn all(routes: &[(usize, &Route)], least: f64, counted: OverlapDirection) -> Overlaps {
        let colours: Vec<u32> = (0..routes.len() as u32).collect();
        overlaps(routes, &colours, (least, counted), &|_, _| true, usize::MAX)
    }

    /// All pairs, compared cell by cell.
    fn by_force(routes: &[(usize, &Route)], least: f64, counted: OverlapDirection) -> Vec<(usize, usize, f64)> {
        let share = |a: usize, b: usize| {
            let enters = |cell: u64| near(cell).any(|it| routes[b].1.cells().contains(&it));
            let is_repeated = |cell: &&u64| enters(**cell) || counted == EITHER && enters(back(**cell));
            let cells = routes[a].1.cells();
            cells.iter().filter(is_repeated).count() as f64 / cells.len().max(1) as f64
        };
        let pairs = (0..routes.len()).flat_map(|a| (a + 1..routes.len()).map(move |b| (a, b)));
        let judged = pairs.filter(|(a, b)| routes[*a].0 == routes[*b].0);
        judged.map(|(a, b)| (a, b, share(a, b).max(share(b, a)))).filter(|pair| pair.2 > least).collect()
    }

    fn drawn(seed: u64, count: usize) -> Vec<(usize, Route)> {
        let mut random = Seed::of_item(seed, "test", "walks").stream("test");
        let mut corner = || (40.0 * (4.0 * random.unit()).floor(), 40.0 * (4.0 * random.unit()).floor());
        let walks: Vec<_> = (0..count).map(|at| (at % 3 / 2, corner(), corner())).collect();
        walks.into_iter().map(|(place, from, to)| (place, walk(from, to))).collect()
    }

    #[test]
    fn the_same_way_overlaps_and_the_way_back_or_another_street_does_not() {
        let there = walk((0.0, 0.0), (100.0, 0.0));
        for (other, expected, there_or_back) in [
            (walk((0.0, 1.5), (100.0, 1.5)), 1.0, 1.0),
            (walk((60.0, 0.0), (160.0, 0.0)), 0.4, 0.4),
            (walk((100.0, 0.0), (0.0, 0.0)), 0.0, 1.0),
            (walk((160.0, 1.0), (60.0, 1.0)), 0.0, 0.4),
            (walk((50.0, -50.0), (50.0, 50.0)), 0.0, 0.0),
            (walk((0.0, 40.0), (100.0, 40.0)), 0.0, 0.0),
        ] {
            for (counted, expected) in [(SAME, expected), (EITHER, there_or_back)] {
                let pairs = all(&[(0, &there), (0, &other)], 0.0, counted).kept;
                let found = pairs.first().map_or(0.0, |pair| pair.2);
                assert!((found - expected).abs() < 0.1, "{found} {expected} {counted:?}");
            }
        }
        assert!(all(&[(0, &there), (1, &there)], 0.0, EITHER).kept.is_empty(), "other towns are other places");
    }

    #[test]
    fn pairs_are_those_of_a_comparison_of_all_with_all() {
        for (seed, count, least, counted) in
            [(1, 90, 0.5, SAME), (2, 120, 0.2, EITHER), (3, 60, 0.0, SAME), (4, 200, 0.8, EITHER)]
        {
            let walks = drawn(seed, count);
            let routes: Vec<(usize, &Route)> = walks.iter().map(|(place, route)| (*place, route)).collect();
            let expected = by_force(&routes, least, counted);
            let found = all(&routes, least, counted);
            assert!(!expected.is_empty() && found.kept == expected && found.found == expected.len(), "{seed}");
            let rule = (least, counted);
            let few = overlaps(&routes, &(0..count as u32).collect::<Vec<_>>(), rule, &|_, _| true, 3);
            assert_eq!((&few.kept[..], few.found), (&expected[..3.min(expected.len())], expected.len()));
            let halves: Vec<u32> = (0..count as u32).map(|at| at % 2).collect();
            let apart: Vec<_> = expected.iter().copied().filter(|(a, b, _)| a % 2 != b % 2).collect();
            assert_eq!(overlaps(&routes, &halves, rule, &|_, _| true, usize::MAX).kept, apart);
        }
    }

    #[test]
    fn sets_are_those_of_all_pairs_whoever_owns_the_walks() {
        for (seed, count, least, counted) in [(5, 400, 0.5, SAME), (6, 40, 0.3, SAME), (7, 300, 0.9, EITHER)] {
            let walks = drawn(seed, count);
            let routes: Vec<(usize, &Route)> = walks.iter().map(|(place, route)| (*place, route)).collect();
            let owners: Vec<usize> = (0..count).map(|at| at / 2).collect();
            let (mut expected, mut found) = (DisjointSets::new(count), DisjointSets::new(count));
            by_force(&routes, least, counted).iter().for_each(|(a, b, _)| expected.join(owners[*a], owners[*b]));
            join_overlapping(&routes, &owners, (least, counted), &mut found);
            assert!((0..count).all(|at| expected.smallest(at) == found.smallest(at)), "{seed}");
        }
    }
}
