//! Errors of a method, added up by trajectory and stratum.

use crate::methods::Method;
use crate::settings::Settings;
use crate::strata::{COUNT, Membership};
use crate::windows::{Flights, WindowSet};
use cosfly_metrics::{Tally, errors};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Tallies of a method.
#[derive(Clone, Debug, PartialEq)]
pub struct MethodTallies {
    /// Of all windows, one tally per cluster.
    pub overall: Vec<Tally>,
    /// Of each stratum: tallies of the clusters that have a window in it.
    pub strata: [Vec<Tally>; COUNT],
    /// Mean distance from the truth at each waypoint, metres.
    pub by_step_m: Vec<f64>,
}

/// Which flights are resampled together: all flights behind one pedestrian, in any weather.
pub fn clusters(flights: &Flights, windows: &WindowSet) -> Vec<usize> {
    let chosen: Vec<usize> = windows.flights.iter().map(|(flight, _)| *flight).collect();
    groups_of_flights(flights, &chosen)
}

/// The group of each flight of `chosen`: all flights behind one pedestrian, in any weather, are one.
pub fn groups_of_flights(flights: &Flights, chosen: &[usize]) -> Vec<usize> {
    let mut numbers: BTreeMap<(&str, &str), usize> = BTreeMap::new();
    let keys = chosen.iter().map(|flight| {
        let row = &flights.rows[*flight];
        (row.town.as_str(), row.pedestrian_id.as_str())
    });
    keys.map(|key| {
        let next = numbers.len();
        *numbers.entry(key).or_insert(next)
    })
    .collect()
}

#[derive(Clone)]
struct FlightTally {
    overall: Tally,
    strata: [Tally; COUNT],
    by_step_m: Vec<f64>,
}

/// Scores `method` on the windows for which `wanted` holds. The sums are taken in the order of windows, whatever
/// thread did what.
pub fn score(
    method: &Method<'_>,
    flights: &Flights,
    windows: &WindowSet,
    memberships: &[Membership],
    settings: &Settings,
    wanted: &(dyn Fn(usize) -> bool + Sync),
) -> MethodTallies {
    let empty = FlightTally {
        overall: Tally::default(),
        strata: [Tally::default(); COUNT],
        by_step_m: vec![0.0; windows.shape.horizon],
    };
    let of_flight = |entry: &(usize, usize)| {
        let mut sum = empty.clone();
        for (number, window) in windows.of_flight(*entry, flights.rows[entry.0].frames) {
            let waypoints = if wanted(number) { method.waypoints(flights, window, number, settings) } else { None };
            let Some(waypoints) = waypoints else { continue };
            let truth = flights.truth(window, &windows.shape);
            let mut tally = Tally::default();
            tally.add_window(&errors(&waypoints, &truth));
            let boxes = method.boxes(flights, window, number, settings);
            if !boxes.is_empty() {
                for (predicted, truth) in boxes.iter().zip(flights.true_boxes(window, &windows.shape)) {
                    if let Some(truth) = truth {
                        tally.add_box(predicted.as_ref(), &truth);
                    }
                }
            }
            sum.overall.add(&tally);
            for (stratum, total) in sum.strata.iter_mut().enumerate() {
                if memberships[number] & (1 << stratum) != 0 {
                    total.add(&tally);
                }
            }
            for ((sum, reached), truth) in sum.by_step_m.iter_mut().zip(&waypoints).zip(&truth) {
                *sum += (reached.position_in_world - truth.position_in_world).length();
            }
        }
        sum
    };
    let by_flight: Vec<FlightTally> = windows.flights.par_iter().map(of_flight).collect();
    gathered(&by_flight, &clusters(flights, windows), windows.shape.horizon)
}

fn gathered(by_flight: &[FlightTally], clusters: &[usize], horizon: usize) -> MethodTallies {
    let number = clusters.iter().max().map_or(0, |last| last + 1);
    let mut overall = vec![Tally::default(); number];
    let mut strata: [Vec<Tally>; COUNT] = core::array::from_fn(|_| vec![Tally::default(); number]);
    let mut by_step_m = vec![0.0; horizon];
    for (flight, cluster) in by_flight.iter().zip(clusters) {
        overall[*cluster].add(&flight.overall);
        for (stratum, tally) in strata.iter_mut().zip(&flight.strata) {
            stratum[*cluster].add(tally);
        }
        by_step_m.iter_mut().zip(&flight.by_step_m).for_each(|(sum, more)| *sum += more);
    }
    let windows: f64 = overall.iter().map(|tally| tally.windows).sum();
    by_step_m.iter_mut().for_each(|sum| *sum /= windows.max(1.0));
    for tallies in strata.iter_mut().chain([&mut overall]) {
        tallies.retain(|tally| tally.windows > 0.0);
    }
    MethodTallies { overall, strata, by_step_m }
}

/// All tallies as one.
pub fn total(tallies: &[Tally]) -> Tally {
    let mut total = Tally::default();
    tallies.iter().for_each(|tally| total.add(tally));
    total
}
