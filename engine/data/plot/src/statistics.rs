//! Histograms and quantiles.

use crate::distribution::Distribution;

/// The value below which a share `at` of the sorted values lies; 0 without any.
pub fn quantile(sorted: &[f64], at: f64) -> f64 {
    let place = (at * sorted.len().saturating_sub(1) as f64).round() as usize;
    sorted.get(place).copied().unwrap_or_default()
}

/// Edges of about `wanted` equal bins at round numbers that hold everything from `low` to `high`.
pub fn edges(low: f64, high: f64, wanted: usize) -> Vec<f64> {
    let step = round_step((high - low).max(1e-9) / wanted as f64);
    let (first, last) = ((low / step).floor() as i64, (high / step).ceil() as i64);
    (first..=last.max(first + 1)).map(|i| i as f64 * step).collect()
}

/// The least 1, 2 or 5 times a power of ten that is not less than `least`.
pub fn round_step(least: f64) -> f64 {
    let mut power = 1e-9;
    while power < 1e15 {
        if let Some(step) =
            [1.0, 2.0, 5.0].map(|digit| digit * power).into_iter().find(|step| *step >= least * 0.999_999)
        {
            return step;
        }
        power *= 10.0;
    }
    power
}

/// Share of `values` in each bin; what lies outside counts to the outer bins.
pub fn shares(values: &Distribution, edges: &[f64]) -> Vec<f64> {
    let bins = edges.len().saturating_sub(1).max(1);
    let mut counts = vec![0_u64; bins];
    for (value, count) in values.values() {
        let bin = edges.partition_point(|edge| *edge <= value);
        counts[bin.saturating_sub(1).min(bins - 1)] += count;
    }
    let all = counts.iter().sum::<u64>().max(1) as f64;
    counts.into_iter().map(|count| count as f64 / all).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bins_are_round_and_hold_everything() {
        let edges = edges(0.3, 97.0, 10);
        assert_eq!(edges.first(), Some(&0.0));
        assert_eq!(edges.last(), Some(&100.0));
        let mut values = Distribution::default();
        [0.3, 10.0, 10.1, 97.0, 1e9].into_iter().for_each(|value| values.add(value));
        let shares = shares(&values, &edges);
        assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        assert_eq!((shares[0], shares[9]), (0.2, 0.4));
        assert_eq!(quantile(&[1.0, 2.0, 3.0], 0.5), 2.0);
        assert_eq!(round_step(0.3), 0.5);
    }
}
