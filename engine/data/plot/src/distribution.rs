//! Distributions of numbers that are counted value by value and can be merged.

use std::collections::BTreeMap;

/// Most different values that are told apart exactly.
const EXACT: usize = 1 << 15;
/// Bits of a number that are dropped where there are more values: 11 bits of the fraction stay, 0.05 % of a value.
const DROPPED_BITS: u32 = 12;

/// How often each value occurs. The content depends on the values alone, not on their order or on how parts were merged.
///
/// Up to 32,768 different values are exact; more are rounded to 11 bits of their fraction, so that memory is bounded.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Distribution {
    /// Numbers of values by their rank among all 32-bit floats.
    counts: BTreeMap<u32, u64>,
    is_rounded: bool,
}

impl Distribution {
    /// A distribution without values.
    pub const EMPTY: Self = Self { counts: BTreeMap::new(), is_rounded: false };

    /// Counts a value; those that are not finite are left out.
    pub fn add(&mut self, value: f32) {
        if value.is_finite() {
            self.count(rank_of(value), 1);
        }
    }

    /// Counts all values of another distribution.
    pub fn merge(&mut self, other: &Self) {
        if other.is_rounded {
            self.round();
        }
        other.counts.iter().for_each(|(rank, count)| self.count(*rank, *count));
    }

    /// Number of values.
    pub fn len(&self) -> u64 {
        self.counts.values().sum()
    }

    /// Whether there is no value.
    pub fn is_empty(&self) -> bool {
        self.counts.is_empty()
    }

    /// Values in ascending order, with how often each occurs.
    pub fn values(&self) -> impl DoubleEndedIterator<Item = (f64, u64)> {
        self.counts.iter().map(|(rank, count)| (f64::from(value_of(*rank)), *count))
    }

    /// The value below which a share `at` of all lies; 0 without any.
    pub fn quantile(&self, at: f64) -> f64 {
        let place = (at * self.len().saturating_sub(1) as f64).round() as u64;
        let mut before = 0;
        let found = self.values().find(|(_, count)| {
            before += count;
            before > place
        });
        found.or_else(|| self.values().next_back()).map_or(0.0, |(value, _)| value)
    }

    /// Numbers for a file: whether values are rounded, then rank and count of each.
    pub fn to_parts(&self) -> (bool, Vec<(u32, u64)>) {
        (self.is_rounded, self.counts.iter().map(|(rank, count)| (*rank, *count)).collect())
    }

    /// The distribution of some [`Self::to_parts`].
    pub fn from_parts((is_rounded, counts): (bool, Vec<(u32, u64)>)) -> Self {
        let mut found = Self { counts: BTreeMap::new(), is_rounded };
        counts.into_iter().for_each(|(rank, count)| found.count(rank, count));
        found
    }

    fn count(&mut self, rank: u32, count: u64) {
        let rank = if self.is_rounded { rounded(rank) } else { rank };
        *self.counts.entry(rank).or_default() += count;
        if !self.is_rounded && self.counts.len() > EXACT {
            self.round();
        }
    }

    fn round(&mut self) {
        if !self.is_rounded {
            self.is_rounded = true;
            for (rank, count) in std::mem::take(&mut self.counts) {
                *self.counts.entry(rounded(rank)).or_default() += count;
            }
        }
    }
}

/// Rank of a number among all floats: larger numbers have larger ranks.
fn rank_of(value: f32) -> u32 {
    let bits = (value + 0.0).to_bits();
    if bits >> 31 == 1 { !bits } else { bits | 1 << 31 }
}

fn value_of(rank: u32) -> f32 {
    f32::from_bits(if rank >> 31 == 1 { rank & !(1 << 31) } else { !rank })
}

/// The rank in the middle of those that are not told apart; 0 stays 0.
fn rounded(rank: u32) -> u32 {
    let zero = rank_of(0.0);
    if rank == zero { zero } else { rank >> DROPPED_BITS << DROPPED_BITS | 1 << (DROPPED_BITS - 1) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics;

    fn numbers(count: u32) -> Vec<f32> {
        (0..count).map(|i| (i.wrapping_mul(2_654_435_761) as f32 / 1e7) - 150.0).collect()
    }

    fn of(numbers: &[f32]) -> Distribution {
        let mut found = Distribution::default();
        numbers.iter().for_each(|it| found.add(*it));
        found
    }

    #[test]
    fn quantiles_of_few_values_are_exact_and_of_many_nearly() {
        for (count, error) in [(1, 0.0), (1000, 0.0), (200_000, 5e-4)] {
            let numbers = numbers(count);
            let mut sorted: Vec<f64> = numbers.iter().map(|it| f64::from(*it)).collect();
            sorted.sort_by(f64::total_cmp);
            let found = of(&numbers);
            for at in [0.0, 0.05, 0.5, 0.95, 0.995, 1.0] {
                let expected = statistics::quantile(&sorted, at);
                assert!((found.quantile(at) - expected).abs() <= error * expected.abs(), "{count} {at}");
            }
            assert_eq!(found.len(), u64::from(count));
        }
        assert_eq!(of(&[0.0, -0.0, f32::NAN]).values().collect::<Vec<_>>(), [(0.0, 2)]);
    }

    #[test]
    fn parts_merge_to_the_same_in_any_order_and_survive_a_file() {
        let numbers = numbers(100_000);
        let whole = of(&numbers);
        for size in [7_000, 33_000] {
            let parts: Vec<Distribution> = numbers.chunks(size).map(of).collect();
            let merged = |parts: &mut dyn Iterator<Item = &Distribution>| {
                parts.fold(Distribution::default(), |mut sum, part| {
                    sum.merge(part);
                    sum
                })
            };
            assert!(merged(&mut parts.iter()) == whole && merged(&mut parts.iter().rev()) == whole);
        }
        assert!(Distribution::from_parts(whole.to_parts()) == whole && whole.to_parts().1.len() < 2 * EXACT);
    }
}
