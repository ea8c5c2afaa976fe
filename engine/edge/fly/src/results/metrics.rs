//! Metrics of episodes, their means and intervals.
//!
//! To add one, add an entry to [`METRICS`].

use crate::flight::Row;
use cosfly_env::End;
use cosfly_metrics::bootstrap::{RESAMPLES, resampled};
use std::collections::BTreeMap;

/// Seed of the resamples.
const SEED: u64 = 1;

/// A number of an episode.
pub struct Metric {
    /// Name in tables and files.
    pub name: &'static str,
    /// Title of the column, with the unit.
    pub title: &'static str,
    /// Description.
    pub doc: &'static str,
    /// Decimals in tables.
    pub decimals: usize,
    /// The number; `None` where it is not defined.
    pub of: fn(&Row) -> Option<f64>,
}

/// All metrics, in the order of tables.
pub const METRICS: &[Metric] = &[
    Metric {
        name: "tracking_rate",
        title: "tracking rate",
        doc: "share of all steps of the episode in which the target is tracked; steps after an early end are not tracked",
        decimals: 3,
        of: |row| Some(row.score.tracking_rate()),
    },
    Metric {
        name: "success",
        title: "success",
        doc: "share of episodes that reach the end of the walk and track the target in the last second",
        decimals: 3,
        of: |row| Some(f64::from(row.policy_failure.is_none() && row.score.success())),
    },
    Metric {
        name: "tracked_frames",
        title: "tracked frames",
        doc: "number of steps in which the target is tracked",
        decimals: 1,
        of: |row| Some(f64::from(row.score.tracked_steps)),
    },
    Metric {
        name: "collision",
        title: "collisions",
        doc: "share of episodes that end in a collision",
        decimals: 3,
        of: |row| Some(f64::from(row.score.end == Some(End::Collision))),
    },
    Metric {
        name: "lost",
        title: "lost",
        doc: "share of episodes that end because the target was not tracked for too long",
        decimals: 3,
        of: |row| Some(f64::from(row.score.end == Some(End::Lost))),
    },
    Metric {
        name: "policy_failure",
        title: "policy failed",
        doc: "share of episodes that end because the policy answered wrongly or not in time",
        decimals: 3,
        of: |row| Some(f64::from(row.policy_failure.is_some())),
    },
    Metric {
        name: "losses",
        title: "losses",
        doc: "number of stretches of at least half a second without tracking",
        decimals: 2,
        of: |row| Some(f64::from(row.score.losses)),
    },
    Metric {
        name: "time_to_reacquire_s",
        title: "reacquired after, s",
        doc: "mean length of the losses after which the target is tracked again; episodes without one are left out",
        decimals: 2,
        of: |row| row.score.time_to_reacquire_s(),
    },
    Metric {
        name: "visibility",
        title: "visibility",
        doc: "mean share of the target that an unoccluded ray reaches, in the picture or not, over the steps flown",
        decimals: 3,
        of: |row| (row.score.steps > 0).then(|| row.score.mean_visibility()),
    },
    Metric {
        name: "distance_m",
        title: "distance, m",
        doc: "mean distance from the target's feet over the steps flown",
        decimals: 1,
        of: |row| (row.score.steps > 0).then(|| row.score.distance_sum_m / f64::from(row.score.steps)),
    },
    Metric {
        name: "in_band",
        title: "in the band",
        doc: "share of all steps of the episode with a distance inside the wanted band",
        decimals: 3,
        of: |row| Some(f64::from(row.score.in_band_steps) / f64::from(row.score.planned_steps.max(1))),
    },
    Metric {
        name: "jerk_mps3",
        title: "jerk, m/s^3",
        doc: "mean jerk over the steps flown",
        decimals: 2,
        of: |row| (row.score.steps > 0).then(|| row.score.jerk_sum_mps3 / f64::from(row.score.steps)),
    },
    Metric {
        name: "from_expert_m",
        title: "from the expert, m",
        doc: "mean distance from the expert's flight at its waypoints, over the steps flown",
        decimals: 2,
        of: |row| row.from_expert_m,
    },
    Metric {
        name: "tracking_error_m",
        title: "tracking error, m",
        doc: "mean distance of a quadrotor from the setpoints of its controller",
        decimals: 3,
        of: |row| row.strain.and_then(|strain| strain.tracking_error_m),
    },
    Metric {
        name: "saturated",
        title: "saturated",
        doc: "share of the time in which a rotor is asked for more or less thrust than it has",
        decimals: 4,
        of: |row| row.strain.map(|strain| strain.saturated),
    },
    Metric {
        name: "latency_s",
        title: "latency, s",
        doc: "mean time that the policy took for an action, where latencies are measured",
        decimals: 3,
        of: |row| row.mean_latency_s,
    },
    Metric {
        name: "reward",
        title: "reward",
        doc: "sum of the weighted terms of the reward",
        decimals: 1,
        of: |row| Some(row.score.reward_sum),
    },
];

/// Mean of a metric and its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MetricSummary {
    /// Mean over the episodes where it is defined.
    pub mean: Option<f64>,
    /// 95 % interval over resamples of episodes; `None` with fewer than two.
    pub interval: Option<(f64, f64)>,
    /// Number of episodes where it is defined.
    pub count: usize,
}

/// Mean of numbers of which each counts as often as `times` says.
pub fn mean_of(values: &[Option<f64>], times: &[u32]) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0);
    for (value, times) in values.iter().zip(times) {
        if let Some(value) = value {
            sum += f64::from(*times) * value;
            count += f64::from(*times);
        }
    }
    (count > 0.0).then(|| sum / count)
}

/// All metrics of episodes, in the order of [`METRICS`].
pub fn summary(rows: &[&Row]) -> Vec<MetricSummary> {
    let values: Vec<Vec<Option<f64>>> =
        METRICS.iter().map(|metric| rows.iter().map(|row| (metric.of)(row)).collect()).collect();
    let intervals = resampled(rows.len(), RESAMPLES, SEED, METRICS.len(), &mut |times| {
        values.iter().map(|values| mean_of(values, times)).collect()
    });
    let once = vec![1; rows.len()];
    let of = |(values, interval): (&Vec<Option<f64>>, Option<(f64, f64)>)| MetricSummary {
        mean: mean_of(values, &once),
        interval,
        count: values.iter().flatten().count(),
    };
    values.iter().zip(intervals).map(of).collect()
}

/// Episodes by stratum.
pub fn strata(rows: &[Row]) -> BTreeMap<&str, Vec<&Row>> {
    let mut strata: BTreeMap<&str, Vec<&Row>> = BTreeMap::new();
    for row in rows {
        strata.entry(&row.stratum).or_default().push(row);
    }
    strata
}
