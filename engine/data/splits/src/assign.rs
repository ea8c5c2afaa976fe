//! Groups of flights that stay together, their splits, and nested subsets.

use super::area;
use super::facts::FlightFacts;
use super::overlap::join_overlapping;
use super::places::Places;
use super::route;
use cosfly_disjoint_sets::DisjointSets;
use cosfly_frames::Seed;
use cosfly_schema::Split;
use cosfly_schema::config::{OverlapDirection, SplitBy, SplitShares};
use std::collections::BTreeMap;

/// Assignment of each flight, in the order of the facts.
#[derive(Clone, Debug, PartialEq)]
pub struct Assignment {
    /// Split of each flight.
    pub splits: Vec<Split>,
    /// Split group of each flight.
    pub groups: Vec<String>,
    /// Rank drawn from the pedestrian's id, 0..1: flights below 0.25 are a quarter of all, and part of those below 0.5.
    pub subset_ranks: Vec<f64>,
}

/// Assigns all flights. Pedestrians of a town whose walks overlap by more than `max_route_overlap` are one group; the
/// split is a draw from the first pedestrian of a group. More pedestrians or towns move old ones only where a new walk
/// joins two groups. A place goes to one split as a whole where the shares say so for all places or for this one, and
/// where it has several names: the draw is then from its ground plan. Kinds are shared out instead of drawn. With areas, a
/// flight goes to the split of the area that holds its walk; [`area::left_out`] names those that no area holds.
pub fn assign(facts: &[FlightFacts], shares: &SplitShares) -> Assignment {
    let mut places = Places::of(facts, shares);
    match shares.by {
        SplitBy::Area => return of_areas(facts, shares, &places),
        SplitBy::Kind => share_out(&mut places, shares),
        SplitBy::Pedestrian | SplitBy::Town => {}
    }
    let representatives = representatives(facts, &places, (shares.max_route_overlap, shares.overlap_direction));
    let drawn = |id: &str| shares.split_of(draw(shares.seed, "split", id));
    let assigned = |(at, it): (usize, &FlightFacts)| {
        let place = &places.all[places.of_flight[at]];
        match place.split {
            Some(split) => (split, place.name.clone()),
            None if place.is_whole => (drawn(&place.name), place.name.clone()),
            None => (drawn(&representatives[at]), format!("{}/{}", it.layout.short(), representatives[at])),
        }
    };
    let (splits, groups) = facts.iter().enumerate().map(assigned).unzip();
    Assignment { splits, groups, subset_ranks: subset_ranks(facts, shares) }
}

/// Gives each kind without a split the one that lacks most flights: large kinds first, those of about one size as they are
/// drawn.
fn share_out(places: &mut Places, shares: &SplitShares) {
    let mut flights = vec![0_usize; places.all.len()];
    places.of_flight.iter().for_each(|place| flights[*place] += 1);
    let is_open = |at: &usize| flights[*at] > 0 && places.all[*at].split.is_none();
    let mut open: Vec<usize> = (0..flights.len()).filter(is_open).collect();
    let drawn = |at: usize| draw(shares.seed, "split", &places.all[at].name).to_bits();
    open.sort_by_cached_key(|at| (flights[*at].leading_zeros(), drawn(*at)));
    let total: usize = open.iter().map(|at| flights[*at]).sum();
    let mut lacking = shares.asked().map(|share| share * total as f64);
    for at in open {
        let most = (1..3).fold(0, |most, split| if lacking[split] > lacking[most] { split } else { most });
        lacking[most] -= flights[at] as f64;
        places.all[at].split = Some(Split::ALL[most]);
    }
}

fn draw(seed: u64, purpose: &str, id: &str) -> f64 {
    Seed::of_item(seed, purpose, id).stream(purpose).unit()
}

fn subset_ranks(facts: &[FlightFacts], shares: &SplitShares) -> Vec<f64> {
    facts.iter().map(|it| draw(shares.seed, "subset", &it.pedestrian_id)).collect()
}

/// Splits by the area of each walk; an area is a group.
fn of_areas(facts: &[FlightFacts], shares: &SplitShares, places: &Places) -> Assignment {
    let shares = area::resolved(facts, shares);
    let split = |(it, place): (&FlightFacts, &usize)| {
        let given = places.all[*place].split;
        let in_area = || shares.areas.get(&it.town).and_then(|cut| area::split_of(cut, shares.guard_m, &it.route));
        let split = given.or_else(in_area).unwrap_or(Split::Train);
        (split, format!("{}/{}", it.layout.short(), split.name()))
    };
    let (splits, groups) = facts.iter().zip(&places.of_flight).map(split).unzip();
    Assignment { splits, groups, subset_ranks: subset_ranks(facts, &shares) }
}

/// Representative of each flight's group: the first pedestrian of the group in that place.
fn representatives(facts: &[FlightFacts], places: &Places, rule: (f64, OverlapDirection)) -> Vec<String> {
    let mut walkers: BTreeMap<(usize, &str), usize> = BTreeMap::new();
    for (it, place) in facts.iter().zip(&places.of_flight) {
        walkers.entry((*place, &it.pedestrian_id)).or_default();
    }
    // In the order of their ids, so that the smallest of a group represents it.
    let ids: Vec<&str> = walkers.keys().map(|(_, id)| *id).collect();
    walkers.values_mut().zip(0..).for_each(|(number, next)| *number = next);
    let mut sets = DisjointSets::new(ids.len());
    let routes = distinct_routes(facts, places);
    let given: Vec<(usize, &route::Route)> = routes.iter().map(|((place, _), route)| (*place, *route)).collect();
    let owners: Vec<usize> = routes.iter().map(|(walker, _)| walkers[walker]).collect();
    join_overlapping(&given, &owners, rule, &mut sets);
    let walker = |(it, place): (&FlightFacts, &usize)| walkers[&(*place, it.pedestrian_id.as_str())];
    facts.iter().zip(&places.of_flight).map(|it| ids[sets.smallest(walker(it))].to_owned()).collect()
}

/// Place and id of a pedestrian.
type PedestrianInTown<'a> = (usize, &'a str);

/// Pedestrian and route, once for all flights behind a walk.
fn distinct_routes<'a>(facts: &'a [FlightFacts], places: &Places) -> Vec<(PedestrianInTown<'a>, &'a route::Route)> {
    let mut routes: Vec<(PedestrianInTown<'a>, &route::Route)> = vec![];
    let mut known: BTreeMap<PedestrianInTown<'a>, Vec<usize>> = BTreeMap::new();
    for (it, place) in facts.iter().zip(&places.of_flight) {
        let walker = (*place, it.pedestrian_id.as_str());
        let of_walker = known.entry(walker).or_default();
        if of_walker.iter().all(|at| *routes[*at].1 != it.route) {
            of_walker.push(routes.len());
            routes.push((walker, &it.route));
        }
    }
    routes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::facts::fixture::behind;
    use cosfly_frames::DVec3;
    use cosfly_schema::TownLayout;
    use std::sync::Arc;

    fn walker(id: usize, street: f64, from: f64) -> FlightFacts {
        let feet: Vec<DVec3> = (0..50).map(|k| DVec3::new(from + f64::from(k), street, 0.0)).collect();
        behind(id, &feet)
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
    fn there_and_back_go_to_the_same_split_where_the_recipe_says_so() {
        let way = |id: usize| {
            let feet = (0..50).map(|k| if id.is_multiple_of(2) { k } else { 49 - k });
            let feet: Vec<DVec3> = feet.map(|k| DVec3::new(f64::from(k), 40.0 * (id / 2) as f64, 0.0)).collect();
            behind(id, &feet)
        };
        let facts: Vec<FlightFacts> = (0..400).map(way).collect();
        let either = SplitShares { overlap_direction: OverlapDirection::Either, ..SplitShares::default() };
        assert!(assign(&facts, &either).splits.chunks(2).all(|pair| pair[0] == pair[1]));
        let same = assign(&facts, &SplitShares::default());
        assert!(same.splits.chunks(2).any(|pair| pair[0] != pair[1]));
    }

    fn in_town(town: &str, digest: &str, mut facts: Vec<FlightFacts>) -> Vec<FlightFacts> {
        for it in &mut facts {
            it.town = town.into();
            it.layout = Arc::new(TownLayout { digest: digest.repeat(32), sketch: vec![] });
        }
        facts
    }

    #[test]
    fn pedestrians_of_other_towns_join_no_group_and_move_nobody() {
        let walkers = |count| (0..count).map(|id| walker(id, 0.0, 60.0 * id as f64)).collect::<Vec<_>>();
        let alone = assign(&walkers(40), &SplitShares::default());
        let other = in_town("other", "cd", (0..40).map(|id| walker(id, 5.0, 60.0 * (id / 40) as f64)).collect());
        let both = assign(&[walkers(40), other].concat(), &SplitShares::default());
        assert_eq!((&both.splits[..40], &both.groups[..40]), (&alone.splits[..], &alone.groups[..]));
        assert!(both.groups[40..].iter().all(|group| *group == format!("{}/p00000", "cd".repeat(6))));
    }

    #[test]
    fn named_towns_and_towns_with_two_names_go_to_one_split() {
        let of = |town, digest| in_town(town, digest, (0..60).map(|id| walker(id, 40.0 * id as f64, 0.0)).collect());
        let facts = [of("north", "ab"), of("south", "cd"), of("south_copy", "cd")].concat();
        let found = assign(&facts, &SplitShares::default());
        assert!(found.splits[..60].contains(&Split::Train) && found.splits[..60].iter().any(|it| *it != Split::Train));
        assert!(found.splits[60..].iter().all(|split| *split == found.splits[60]));
        let towns = BTreeMap::from([("south_copy".to_owned(), Split::Val)]);
        let found = assign(&facts, &SplitShares { towns, ..SplitShares::default() });
        assert!(found.splits[60..].iter().all(|split| *split == Split::Val));
        assert!(found.groups[60..].iter().all(|group| *group == "cd".repeat(6)));
    }

    #[test]
    fn kinds_go_to_one_split_each_and_meet_the_shares_with_any_seed() {
        let town = |name: String, number: usize| {
            in_town(&name, &format!("{number:02x}"), (0..4).map(|id| walker(id, 40.0 * id as f64, 0.0)).collect())
        };
        // Thirteen kinds, of which the first three have two towns.
        let names = ('a'..='m').map(|kind| format!("{kind}_1")).chain(('a'..='c').map(|kind| format!("{kind}_2")));
        let facts: Vec<FlightFacts> = names.zip(0..).flat_map(|(name, number)| town(name, number)).collect();
        let assigned = |seed| {
            let shares =
                SplitShares { by: SplitBy::Kind, seed, train: 0.75, val: 0.1, test: 0.15, ..SplitShares::default() };
            assign(&facts, &shares)
        };
        for seed in 0..20 {
            let found = assigned(seed);
            let of = |split| found.splits.iter().filter(|it| **it == split).count();
            assert_eq!((of(Split::Train), of(Split::Val), of(Split::Test)), (48, 8, 8));
            assert!(facts.iter().zip(&found.groups).all(|(it, group)| it.town.starts_with(group.as_str())));
            assert_eq!(found.splits[..12], found.splits[52..]);
        }
        assert!((1..20).any(|seed| assigned(seed).splits != assigned(0).splits));
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
