//! Errors of a method, added up by trajectory and stratum.

use crate::methods::Method;
use crate::settings::Settings;
use crate::strata::{COUNT, WindowStrata, is_seen, memberships};
use crate::windows::{Flights, WindowSet};
use cosfly_diagnose::Result;
use cosfly_metrics::{LastingErrors, Tally, errors};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Tallies of a method.
#[derive(Clone, Debug, PartialEq)]
pub struct MethodTallies {
    /// Tallies of all windows, one per cluster.
    pub overall: Vec<Tally>,
    /// Tallies of each stratum, for the clusters that have a window in it.
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

/// A method to score.
#[derive(Clone, Copy)]
pub struct Scored<'a> {
    /// The method.
    pub method: &'a Method<'a>,
    /// Its settings.
    pub settings: &'a Settings,
    /// Whether the strata are wanted, too: nine times the memory.
    pub by_stratum: bool,
}

/// Scores methods on the windows for which `wanted` holds. Tracks of some flights are in memory at a time. The sums are taken in the order of windows, whatever thread did what.
///
/// # Errors
/// Damage of the dataset.
pub fn score(
    methods: &[Scored<'_>],
    flights: &Flights,
    windows: &WindowSet,
    wanted: &(dyn Fn(usize) -> bool + Sync),
) -> Result<Vec<MethodTallies>> {
    let clusters = clusters(flights, windows);
    let seen = is_seen(flights);
    let mut sums: Vec<Sums> =
        methods.iter().map(|it| Sums::new(&clusters, windows.shape.horizon, it.by_stratum)).collect();
    let mut first = 0;
    for part in flights.parts(&windows.flights, &|entry| entry.0) {
        let chosen: Vec<usize> = part.iter().map(|entry| entry.0).collect();
        let loaded = flights.part(&chosen)?;
        let memberships = memberships(&loaded, windows, &seen, part);
        sums.par_iter_mut().zip(methods).for_each(|(sums, Scored { method, settings, .. })| {
            let of_flight = |(entry, memberships): (&(usize, usize), &Vec<WindowStrata>)| {
                tally(method, settings, &loaded, windows, *entry, memberships, wanted)
            };
            let by_flight: Vec<FlightTally> = part.par_iter().zip(&memberships).map(of_flight).collect();
            sums.add(&by_flight, &clusters[first..]);
        });
        first += part.len();
    }
    Ok(sums.into_iter().map(Sums::finished).collect())
}

/// The errors of a method in the windows of a flight.
fn tally(
    method: &Method<'_>,
    settings: &Settings,
    flights: &Flights,
    windows: &WindowSet,
    entry: (usize, usize),
    memberships: &[WindowStrata],
    wanted: &(dyn Fn(usize) -> bool + Sync),
) -> FlightTally {
    let mut sum = FlightTally {
        overall: Tally::default(),
        strata: [Tally::default(); COUNT],
        by_step_m: vec![0.0; windows.shape.horizon],
    };
    let (mut lasting, mut lasting_by_stratum) = (LastingErrors::default(), [LastingErrors::default(); COUNT]);
    for ((number, window), membership) in windows.of_flight(entry, flights.rows[entry.0].frames).zip(memberships) {
        let waypoints = if wanted(number) { method.waypoints(flights, window, number, settings) } else { None };
        let Some(waypoints) = waypoints else { continue };
        let truth = flights.truth(window, &windows.shape);
        let mut tally = Tally::default();
        let found = errors(&waypoints, &truth);
        tally.add_window(&found);
        lasting.add(&found);
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
            if membership & (1 << stratum) != 0 {
                total.add(&tally);
                lasting_by_stratum[stratum].add(&found);
            }
        }
        for ((sum, reached), truth) in sum.by_step_m.iter_mut().zip(&waypoints).zip(&truth) {
            *sum += (reached.position_in_world - truth.position_in_world).length();
        }
    }
    sum.overall.add_lasting(&lasting);
    sum.strata.iter_mut().zip(&lasting_by_stratum).for_each(|(total, lasting)| total.add_lasting(lasting));
    sum
}

/// Sums of a method, cluster by cluster; those of strata are empty where they are not wanted.
struct Sums {
    overall: Vec<Tally>,
    strata: [Vec<Tally>; COUNT],
    by_step_m: Vec<f64>,
}

impl Sums {
    fn new(clusters: &[usize], horizon: usize, by_stratum: bool) -> Self {
        let number = clusters.iter().max().map_or(0, |last| last + 1);
        let of_stratum = if by_stratum { number } else { 0 };
        Self {
            overall: vec![Tally::default(); number],
            strata: core::array::from_fn(|_| vec![Tally::default(); of_stratum]),
            by_step_m: vec![0.0; horizon],
        }
    }

    fn add(&mut self, by_flight: &[FlightTally], clusters: &[usize]) {
        for (flight, cluster) in by_flight.iter().zip(clusters) {
            self.overall[*cluster].add(&flight.overall);
            for (stratum, tally) in
                self.strata.iter_mut().zip(&flight.strata).filter(|(stratum, _)| !stratum.is_empty())
            {
                stratum[*cluster].add(tally);
            }
            self.by_step_m.iter_mut().zip(&flight.by_step_m).for_each(|(sum, more)| *sum += more);
        }
    }

    fn finished(mut self) -> MethodTallies {
        let windows: f64 = self.overall.iter().map(|tally| tally.windows).sum();
        self.by_step_m.iter_mut().for_each(|sum| *sum /= windows.max(1.0));
        for tallies in self.strata.iter_mut().chain([&mut self.overall]) {
            tallies.retain(|tally| tally.windows > 0.0);
        }
        MethodTallies { overall: self.overall, strata: self.strata, by_step_m: self.by_step_m }
    }
}

/// All tallies as one.
pub fn total(tallies: &[Tally]) -> Tally {
    let mut total = Tally::default();
    tallies.iter().for_each(|tally| total.add(tally));
    total
}
