//! Histograms and quantiles.

use crate::distribution::Distribution;

/// The value below which a share `at` of the sorted values lies; 0 without any.
pub fn quantile(sorted: &[f64], at: f64) -> f64 {
    let place = (at * sorted.len().saturating_sub(1) as f64).round() as usize;
    sorted.get(place).copied().unwrap_or_default()
}

/// Largest step of bins and marks. Larger numbers are no measurements, and are drawn at its edge.
const LARGEST_STEP: f64 = 1e300;
/// Part of a number that a step from it is at least, so that every edge is a number of its own.
const FINEST: f64 = 1e-12;

/// Edges of about `wanted` equal bins at round numbers that hold everything from `low` to `high`: at most `wanted` and
/// three, whatever the numbers are. What is not a number counts as 0.
pub fn edges(low: f64, high: f64, wanted: usize) -> Vec<f64> {
    let (low, high) = (bounded(low), bounded(high));
    let finest = FINEST * low.abs().max(high.abs());
    let step = round_step(((high - low).max(1e-9) / wanted.max(1) as f64).max(finest));
    let (first, last) = ((low / step).floor(), (high / step).ceil());
    let bins = (last - first).max(1.0) as u32;
    (0..=bins).map(|bin| (first + f64::from(bin)) * step).collect()
}

fn bounded(value: f64) -> f64 {
    if value.is_nan() { 0.0 } else { value.clamp(-LARGEST_STEP, LARGEST_STEP) }
}

/// The least 1, 2 or 5 times a power of ten, from 1e-9, that is not less than `least`; for what no such step reaches, the
/// largest one.
pub fn round_step(least: f64) -> f64 {
    let mut power = 1e-9;
    while power < LARGEST_STEP {
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
        for (least, step) in [(3e16, 5e16), (0.9e30, 1e30), (2e200, 2e200)] {
            assert!((round_step(least) / step - 1.0).abs() < 1e-9, "{least}");
        }
        assert!(round_step(f64::NAN).is_finite() && round_step(f64::INFINITY).is_finite());
    }

    #[test]
    fn bins_are_few_and_ascend_whatever_the_numbers_are() {
        let numbers =
            [0.0, -0.0, 1e-300, 3e-9, 1.0, 1.0 + 1e-15, 1e9, 1e15, 1e24, 1e300, f64::MAX, f64::INFINITY, f64::NAN];
        let signed: Vec<f64> = numbers.into_iter().flat_map(|number| [number, -number]).collect();
        for low in &signed {
            for high in &signed {
                for wanted in [0, 1, 6, 16] {
                    let edges = edges(*low, *high, wanted);
                    assert!((2..=wanted.max(1) + 3).contains(&edges.len()), "{low} {high} {wanted}: {edges:?}");
                    assert!(edges.iter().all(|edge| edge.is_finite()), "{low} {high} {wanted}: {edges:?}");
                    assert!(edges.is_sorted_by(|a, b| a < b), "{low} {high} {wanted}: {edges:?}");
                }
            }
        }
    }
}
