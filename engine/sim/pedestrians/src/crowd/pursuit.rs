//! The place that a person walks towards: a little way ahead on the company's route, beside its middle.

use crate::WalkableGrid;
use crate::crowd::company::Company;
use crate::crowd::person::Person;
use cosfly_frames::DVec2;

/// Nodes ahead over which the route is averaged, far and near: (first, end).
const WINDOWS: [(usize, usize); 3] = [(4, 13), (2, 7), (1, 4)];

/// Shares of the distance beside the route that are tried, until the way there is free.
const SHARES: [f64; 4] = [1.0, 0.7, 0.4, 0.15];

/// Distance that people keep from the edge of the ground where there is room, metres.
const KERB_M: f64 = 0.3;

/// The farthest place ahead that the person can walk straight to.
pub(crate) fn target(
    grid: &WalkableGrid,
    company: &Company,
    person: &Person,
    number: usize,
    places: &[DVec2],
) -> DVec2 {
    let route = &company.route;
    let here = grid.center(route[person.progress]);
    // The ways of restless people are too short for the far one.
    for &(first, end) in &WINDOWS[usize::from(company.restless)..] {
        let window = (person.progress + first).min(route.len() - 1)..(person.progress + end).min(route.len());
        if window.is_empty() {
            continue;
        }
        let count = window.len() as f64;
        let middle = route[window].iter().map(|node| grid.center(*node)).sum::<DVec2>() / count;
        let Some(ahead) = (middle - here).try_normalize() else { continue };
        let right = DVec2::new(-ahead.y, ahead.x);
        let beside_m = person.side_m + person.sway_m + slot_m(company, person, number, places, right);
        for share in SHARES {
            let beside_m = share * beside_m;
            let place = middle + beside_m * right;
            let farther = place + KERB_M.copysign(beside_m) * right;
            if grid.step_is_free(person.at, farther) && grid.step_is_free(person.at, place) {
                return place;
            }
        }
        if grid.step_is_free(person.at, middle) {
            return middle;
        }
    }
    // The next node, or one behind, from where the route can be walked again.
    let near = [1, 0, -1, -2, 2, -3, -4];
    let nodes = near.iter().filter_map(|step| route.get(person.progress.checked_add_signed(*step)?));
    let mut places = nodes.map(|node| grid.center(*node));
    places.find(|place| grid.step_is_free(person.at, *place)).unwrap_or(here)
}

/// Place of a member in the row of a company, metres to the right; members keep the order in which they walk now.
fn slot_m(company: &Company, person: &Person, number: usize, places: &[DVec2], right: DVec2) -> f64 {
    let own = right.dot(person.at);
    let is_left = |mate: usize| {
        let other = right.dot(places[mate]);
        other < own || (other == own && mate < number)
    };
    let rank = company.members.clone().filter(|mate| *mate != number && is_left(*mate)).count();
    (rank as f64 - 0.5 * (company.members.len() - 1) as f64) * company.abreast_m
}

/// How far the person is behind the middle of the company, metres along the way.
pub(crate) fn lag_m(company: &Company, person: &Person, places: &[DVec2], ahead: DVec2) -> f64 {
    let members = &places[company.members.clone()];
    let middle = members.iter().sum::<DVec2>() / members.len() as f64;
    ahead.dot(middle - person.at)
}
