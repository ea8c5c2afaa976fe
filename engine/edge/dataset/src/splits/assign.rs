//! Which flights stay together, which split they go to, and how subsets nest.

use super::facts::FlightFacts;
use super::route;
use crate::config::{SplitBy, SplitShares};
use crate::publish::Split;
use cosfly_frames::Seed;
use std::collections::BTreeMap;

/// Where each flight goes, in the order of the facts.
#[derive(Clone, Debug, PartialEq)]
pub struct Assignment {
    /// The split.
    pub splits: Vec<Split>,
    /// Name of what stays together.
    pub groups: Vec<String>,
    /// A draw from the pedestrian's id, 0..1: rows below 0.25 are a quarter of all, and part of those below 0.5.
    pub subset_ranks: Vec<f64>,
}

/// Assigns all flights. Pedestrians whose ways overlap by more than `max_route_overlap` are one group; the split is a
/// draw from the first pedestrian of a group, or from the town's ground plan. More pedestrians move old ones only
/// where a new walk joins two groups.
pub fn assign(facts: &[FlightFacts], shares: &SplitShares) -> Assignment {
    let heads = match shares.by {
        SplitBy::Town => facts.iter().map(|it| it.layout.short().to_owned()).collect(),
        SplitBy::Pedestrian => heads(facts, shares.max_route_overlap),
    };
    let draw = |purpose: &str, id: &str| Seed::of_item(shares.seed, purpose, id).stream(purpose).unit();
    let group = |(it, head): (&FlightFacts, &String)| match shares.by {
        SplitBy::Town => head.clone(),
        SplitBy::Pedestrian => format!("{}/{head}", it.layout.short()),
    };
    Assignment {
        splits: heads.iter().map(|head| Split::of_draw(draw("split", head), shares)).collect(),
        groups: facts.iter().zip(&heads).map(group).collect(),
        subset_ranks: facts.iter().map(|it| draw("subset", &it.pedestrian_id)).collect(),
    }
}

/// The first pedestrian of each flight's group.
fn heads(facts: &[FlightFacts], max_overlap: f64) -> Vec<String> {
    let mut walkers: BTreeMap<&str, usize> = BTreeMap::new();
    for it in facts {
        walkers.entry(&it.pedestrian_id).or_default();
    }
    // In the order of their ids, so that the smallest of a group is its head.
    let ids: Vec<&str> = walkers.keys().copied().collect();
    walkers.values_mut().zip(0..).for_each(|(place, number)| *place = number);
    let mut parents: Vec<usize> = (0..ids.len()).collect();
    let routes = distinct_routes(facts);
    let given: Vec<(usize, &route::Route)> = routes.iter().map(|(_, place, route)| (*place, *route)).collect();
    for (a, b, _) in route::overlaps(&given, max_overlap) {
        let (a, b) = (head(&parents, walkers[routes[a].0]), head(&parents, walkers[routes[b].0]));
        parents[a.max(b)] = a.min(b);
    }
    facts.iter().map(|it| ids[head(&parents, walkers[it.pedestrian_id.as_str()])].to_owned()).collect()
}

/// Pedestrian, place and way, once for all flights behind a walk.
fn distinct_routes(facts: &[FlightFacts]) -> Vec<(&str, usize, &route::Route)> {
    let mut places: BTreeMap<&str, usize> = BTreeMap::new();
    let mut routes: Vec<(&str, usize, &route::Route)> = vec![];
    let mut last: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for it in facts {
        let number = places.len();
        let place = *places.entry(&it.layout.digest).or_insert(number);
        let of_pedestrian = last.entry(&it.pedestrian_id).or_default();
        if of_pedestrian.iter().all(|at| (routes[*at].1, routes[*at].2) != (place, &it.route)) {
            of_pedestrian.push(routes.len());
            routes.push((&it.pedestrian_id, place, &it.route));
        }
    }
    routes
}

fn head(parents: &[usize], mut at: usize) -> usize {
    while parents[at] != at {
        at = parents[at];
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::splits::TownLayout;
    use crate::splits::route::Route;
    use cosfly_frames::DVec3;
    use std::sync::Arc;

    fn walker(id: usize, street: f64, from: f64) -> FlightFacts {
        let feet: Vec<DVec3> = (0..50).map(|k| DVec3::new(from + f64::from(k), street, 0.0)).collect();
        FlightFacts {
            dataset: 0,
            trajectory_id: format!("expert-p{id:05}"),
            expert_id: None,
            pedestrian_id: format!("p{id:05}"),
            group: String::new(),
            split: String::new(),
            town: "town".into(),
            layout: Arc::new(TownLayout { digest: "ab".repeat(32), sketch: vec![] }),
            route: Route::of(&feet),
            windows: vec![],
        }
    }

    #[test]
    fn walks_along_the_same_way_go_to_the_same_split() {
        let facts: Vec<FlightFacts> = (0..400).map(|id| walker(id, 40.0 * (id / 2) as f64, 0.0)).collect();
        let found = assign(&facts, &SplitShares::default());
        assert!(found.groups.chunks(2).all(|pair| pair[0] == pair[1]));
        assert!(found.splits.chunks(2).all(|pair| pair[0] == pair[1]));
        let alone = assign(&facts, &SplitShares { max_route_overlap: 1.0, ..SplitShares::default() });
        assert!(alone.splits.chunks(2).any(|pair| pair[0] != pair[1]));
        let of_town = assign(&facts, &SplitShares { by: SplitBy::Town, ..SplitShares::default() });
        assert!(of_town.splits.iter().all(|split| *split == of_town.splits[0]));
    }

    #[test]
    fn without_overlap_more_walkers_move_no_old_one_and_subsets_nest() {
        let facts: Vec<FlightFacts> = (0..300).map(|id| walker(id, 40.0 * id as f64, 0.0)).collect();
        let (all, fewer) = (assign(&facts, &SplitShares::default()), assign(&facts[..200], &SplitShares::default()));
        assert_eq!(all.splits[..200], fewer.splits);
        assert_eq!(all.subset_ranks[..200], fewer.subset_ranks);
        let below = |share: f64| all.subset_ranks.iter().filter(|rank| **rank < share).count();
        assert!((50..100).contains(&below(0.25)) && (120..180).contains(&below(0.5)), "{} {}", below(0.25), below(0.5));
    }
}
