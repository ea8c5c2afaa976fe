//! Bootstrap intervals by resampling whole trajectories: windows of one flight overlap and are correlated, so
//! resampling windows would give too narrow intervals.

use crate::scores::{COUNT, Tally};
use cosfly_random::Seed;

/// Default number of resamples.
pub const RESAMPLES: usize = 1000;

/// Central 95 % of each score over resamples, `None` where it is not defined.
pub type Intervals = [Option<(f64, f64)>; COUNT];

/// 95 % percentile intervals of all scores. Every resample draws as many of `clusters` as there are, with replacement,
/// and computes the means over all windows of the drawn ones. The draws depend on `seed` and the number of clusters
/// only, so that methods scored on the same clusters are resampled alike.
pub fn intervals(clusters: &[Tally], resamples: usize, seed: u64) -> Intervals {
    let merged = merged(clusters);
    let found = resampled(merged.len(), resamples, seed, COUNT, &mut |times| {
        let mut drawn = Tally::default();
        for (cluster, times) in merged.iter().zip(times).filter(|(_, times)| **times > 0) {
            drawn.add_times(cluster, f64::from(*times));
        }
        drawn.means().to_vec()
    });
    let mut found = found.into_iter();
    core::array::from_fn(|_| found.next().flatten())
}

/// Most clusters that are resampled; further ones are merged, so that a million windows take no longer. The spread of
/// [`MOST_CLUSTERS`] sums of several clusters estimates the spread of the mean to some percent of its width.
pub const MOST_CLUSTERS: usize = 1000;

/// Merges tallies to at most [`MOST_CLUSTERS`] with the same total.
fn merged(clusters: &[Tally]) -> Vec<Tally> {
    let mut merged = clusters[..clusters.len().min(MOST_CLUSTERS)].to_vec();
    for (place, cluster) in clusters.iter().enumerate().skip(MOST_CLUSTERS) {
        merged[place % MOST_CLUSTERS].add(cluster);
    }
    merged
}

/// 95 % percentile intervals of `scores` numbers that `score` computes from how often each of `clusters` clusters was
/// drawn.
pub fn resampled(
    clusters: usize,
    resamples: usize,
    seed: u64,
    scores: usize,
    score: &mut dyn FnMut(&[u32]) -> Vec<Option<f64>>,
) -> Vec<Option<(f64, f64)>> {
    if clusters < 2 || resamples == 0 {
        return vec![None; scores];
    }
    let mut stream = Seed::of_item(seed, "evaluation", "bootstrap").stream("draws");
    let mut found = vec![Vec::with_capacity(resamples); scores];
    let mut times = vec![0; clusters];
    for _ in 0..resamples {
        times.fill(0);
        (0..clusters).for_each(|_| times[stream.index(clusters)] += 1);
        for (found, score) in found.iter_mut().zip(score(&times)) {
            found.extend(score);
        }
    }
    let interval = |mut scores: Vec<f64>| {
        scores.sort_by(f64::total_cmp);
        (!scores.is_empty()).then(|| (quantile(&scores, 0.025), quantile(&scores, 0.975)))
    };
    found.into_iter().map(interval).collect()
}

/// The `share` quantile of sorted values, linear between neighbours (numpy's default); 0 for an empty list.
pub fn quantile(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return 0.0 };
    let place = share.clamp(0.0, 1.0) * last as f64;
    let below = place.floor() as usize;
    let above = (below + 1).min(last);
    sorted[below] + (sorted[above] - sorted[below]) * (place - below as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{METRICS, WaypointErrors};

    fn fde(intervals: &Intervals) -> Option<(f64, f64)> {
        intervals[METRICS.iter().position(|metric| metric.key == "fde_m").unwrap()]
    }

    fn clusters(number: usize) -> Vec<Tally> {
        let mut stream = Seed::of_item(5, "test", "clusters").stream("errors");
        (0..number)
            .map(|_| {
                let mut tally = Tally::default();
                let fde_m = stream.normal(3.0, 0.5);
                (0..4).for_each(|_| tally.add_window(&WaypointErrors { fde_m, ..Default::default() }));
                tally
            })
            .collect()
    }

    #[test]
    fn an_interval_is_as_wide_as_the_spread_of_trajectories_says() {
        let (low, high) = fde(&intervals(&clusters(400), RESAMPLES, 1)).unwrap();
        let expected = 2.0 * 1.96 * 0.5 / 20.0;
        assert!(low < 3.0 && 3.0 < high && ((high - low) / expected - 1.0).abs() < 0.15, "{low} {high}");
    }

    #[test]
    fn the_same_seed_gives_the_same_interval_and_one_trajectory_gives_none() {
        let clusters = clusters(20);
        assert_eq!(intervals(&clusters, 50, 1), intervals(&clusters, 50, 1));
        assert_ne!(intervals(&clusters, 50, 1), intervals(&clusters, 50, 2));
        assert_eq!(fde(&intervals(&clusters[..1], 50, 1)), None);
    }

    #[test]
    fn quantiles_lie_between_neighbours() {
        assert_eq!(quantile(&[1.0, 2.0, 4.0], 0.75), 3.0);
        assert_eq!((quantile(&[7.0], 0.3), quantile(&[], 0.3)), (7.0, 0.0));
    }
}
