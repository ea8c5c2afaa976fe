//! Towns whose things are kilometres apart: parts that were placed by two origins.

use super::leaks::Trace;
use cosfly_episodes::Flag;
use cosfly_metrics::spread::{APART_M, widest_gap_m};
use std::collections::BTreeMap;

/// Checks each town: `things` are the places of its objects (x and y, metres) by town; walks count, too.
pub fn of_towns(traces: &[Trace], mut things: BTreeMap<String, Vec<[f64; 2]>>) -> Vec<Flag> {
    for trace in traces.iter().filter(|trace| !trace.town().is_empty()) {
        things.entry(trace.town().to_owned()).or_default().extend(trace.places());
    }
    things
        .iter()
        .filter_map(|(town, points)| {
            let gap_m = widest_gap_m(points);
            (gap_m > APART_M).then(|| {
                let message = format!(
                    "the things of the town are {:.0} km apart: two parts of it were placed by different origins or projections",
                    gap_m / 1000.0
                );
                Flag::damage("town-apart", town, message)
            })
        })
        .collect()
}
