//! Smallest, largest, mean, deviation and quantiles of every feature, gathered frame by frame in bounded memory.

use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

/// Quantiles, LeRobot's.
const QUANTILES: [f64; 5] = [0.01, 0.1, 0.5, 0.9, 0.99];
/// Names of all figures, in the order of [`Figures::numbers`].
pub const FIGURES: [&str; 9] = ["min", "max", "mean", "std", "q01", "q10", "q50", "q90", "q99"];
/// Largest number of values that quantiles are taken from; even.
const KEPT: usize = 1 << 15;

/// Statistics of all features.
#[derive(Clone, Debug, Default)]
pub struct Statistics {
    features: BTreeMap<String, Vec<Moments>>,
    pictures: BTreeMap<&'static str, Picture>,
}

/// Statistics of a feature.
#[derive(Clone, Debug, PartialEq)]
pub struct Figures {
    /// [`FIGURES`] of each of its numbers.
    pub numbers: Vec<Vec<f64>>,
    /// Frames behind them.
    pub count: u64,
    /// Whether the numbers are those of a picture's channels.
    pub is_picture: bool,
}

/// Statistics of the channels of pictures.
#[derive(Clone, Debug)]
struct Picture {
    channels: Vec<Histogram>,
    /// Steps of a value in a unit.
    per_unit: f64,
    count: u64,
}

/// Statistics of one number. Mean and deviation by Welford's update; quantiles from every `step`-th value.
#[derive(Clone, Debug)]
struct Moments {
    count: u64,
    min: f64,
    max: f64,
    mean: f64,
    squares: f64,
    step: u64,
    kept: Vec<f64>,
}

impl Default for Moments {
    fn default() -> Self {
        Self { count: 0, min: f64::INFINITY, max: f64::NEG_INFINITY, mean: 0.0, squares: 0.0, step: 1, kept: vec![] }
    }
}

impl Moments {
    fn push(&mut self, value: f64) {
        if self.count.is_multiple_of(self.step) {
            self.kept.push(value);
        }
        if self.kept.len() == KEPT {
            let mut place = 0;
            self.kept.retain(|_| {
                place += 1;
                place % 2 == 1
            });
            self.step *= 2;
        }
        self.count += 1;
        (self.min, self.max) = (self.min.min(value), self.max.max(value));
        let gap = value - self.mean;
        self.mean += gap / self.count as f64;
        self.squares += gap * (value - self.mean);
    }

    /// min, max, mean, deviation, quantiles.
    fn figures(&self) -> Vec<f64> {
        let mut sorted = self.kept.clone();
        sorted.sort_by(f64::total_cmp);
        let deviation = (self.squares / self.count.max(1) as f64).sqrt();
        let mut figures = vec![self.min, self.max, self.mean, deviation];
        let at = |rank: u64| sorted.get(rank as usize).copied().unwrap_or_default();
        figures.extend(QUANTILES.map(|share| quantile(share, sorted.len() as u64, at)));
        figures
    }
}

/// Counts of whole values.
#[derive(Clone, Debug, Default)]
struct Histogram(Vec<u64>);

impl Histogram {
    fn push(&mut self, value: usize) {
        if value >= self.0.len() {
            self.0.resize(value + 1, 0);
        }
        self.0[value] += 1;
    }

    /// min, max, mean, deviation, quantiles, in units of so many steps.
    fn figures(&self, per_unit: f64) -> Vec<f64> {
        let count: u64 = self.0.iter().sum();
        let sum = |of: &dyn Fn(f64) -> f64| {
            let terms = self.0.iter().enumerate().map(|(value, count)| *count as f64 * of(value as f64 / per_unit));
            terms.sum::<f64>() / count.max(1) as f64
        };
        let at = |rank: u64| {
            let mut seen = 0u64;
            let value = self.0.iter().position(|count| {
                seen += count;
                seen > rank
            });
            value.unwrap_or_default() as f64 / per_unit
        };
        let mean = sum(&|value| value);
        let deviation = sum(&|value| (value - mean) * (value - mean)).sqrt();
        let mut figures = vec![at(0), at(count.saturating_sub(1)), mean, deviation];
        figures.extend(QUANTILES.map(|share| quantile(share, count, at)));
        figures
    }
}

/// A quantile of `count` sorted values, linear between neighbours, as NumPy's.
fn quantile(share: f64, count: u64, at: impl Fn(u64) -> f64) -> f64 {
    let place = share * count.saturating_sub(1) as f64;
    let below = at(place.floor() as u64);
    below + (place - place.floor()) * (at(place.ceil() as u64) - below)
}

impl Statistics {
    /// Counts the values of a feature in one frame.
    pub fn push(&mut self, feature: &str, values: &[f64]) {
        if !self.features.contains_key(feature) {
            self.features.insert(feature.to_owned(), vec![Moments::default(); values.len()]);
        }
        let moments = self.features.get_mut(feature).into_iter().flatten();
        moments.zip(values).for_each(|(moments, value)| moments.push(*value));
    }

    /// Counts the pixels of a picture, whole numbers of `per_unit` steps in a unit.
    pub fn push_picture<const N: usize>(
        &mut self,
        feature: &'static str,
        per_unit: f64,
        pixels: impl Iterator<Item = [usize; N]>,
    ) {
        let new = || Picture { channels: vec![Histogram::default(); N], per_unit, count: 0 };
        let picture = self.pictures.entry(feature).or_insert_with(new);
        picture.count += 1;
        for pixel in pixels {
            picture.channels.iter_mut().zip(pixel).for_each(|(histogram, value)| histogram.push(value));
        }
    }

    /// Figures of every feature, by its name; those of pictures are of their channels.
    pub fn features(&self) -> BTreeMap<&str, Figures> {
        let vectors = self.features.iter().map(|(name, moments)| {
            let (numbers, count) =
                (moments.iter().map(Moments::figures).collect(), moments.first().map_or(0, |it| it.count));
            (name.as_str(), Figures { numbers, count, is_picture: false })
        });
        let pictures = self.pictures.iter().map(|(name, it)| {
            let numbers = it.channels.iter().map(|channel| channel.figures(it.per_unit)).collect();
            (*name, Figures { numbers, count: it.count, is_picture: true })
        });
        vectors.chain(pictures).collect()
    }

    /// The content of `meta/stats.json`.
    pub fn to_json(&self) -> Value {
        let entry = |(feature, figures): (&str, Figures)| {
            let wrap = |number: f64| if figures.is_picture { json!([[number]]) } else { json!(number) };
            let of_figure = |(at, name): (usize, &&str)| {
                ((*name).to_owned(), figures.numbers.iter().map(|it| wrap(it[at])).collect())
            };
            let mut entry: Map<String, Value> = FIGURES.iter().enumerate().map(of_figure).collect();
            entry.insert("count".into(), json!([figures.count]));
            (feature.to_owned(), Value::Object(entry))
        };
        Value::Object(self.features().into_iter().map(entry).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_those_of_the_population() {
        let mut statistics = Statistics::default();
        [[1.0, 5.0], [2.0, 5.0], [6.0, 5.0]].iter().for_each(|values| statistics.push("a", values));
        statistics.push_picture("rgb", 255.0, [[255, 0, 51]; 2].into_iter());
        statistics.push_picture("depth", 1000.0, [[1500], [200_000], [2500]].into_iter());
        let json = statistics.to_json();
        assert_eq!(
            (&json["a"]["mean"], &json["a"]["max"], &json["a"]["count"]),
            (&json!([3.0, 5.0]), &json!([6.0, 5.0]), &json!([3]))
        );
        assert!((json["a"]["std"][0].as_f64().unwrap() - (14.0f64 / 3.0).sqrt()).abs() < 1e-12);
        assert_eq!((&json["a"]["q50"], &json["a"]["q90"][1]), (&json!([2.0, 5.0]), &json!(5.0)));
        assert!((json["a"]["q90"][0].as_f64().unwrap() - 5.2).abs() < 1e-12, "between 2 and 6");
        assert_eq!(json["rgb"]["mean"], json!([[[1.0]], [[0.0]], [[0.2]]]));
        assert_eq!(json["rgb"]["q99"], json!([[[1.0]], [[0.0]], [[0.2]]]));
        assert_eq!((&json["depth"]["mean"], &json["depth"]["q50"]), (&json!([[[68.0]]]), &json!([[[2.5]]])));
        assert_eq!((&json["depth"]["max"], &json["depth"]["count"]), (&json!([[[200.0]]]), &json!([1])));
    }

    #[test]
    fn quantiles_of_many_values_are_those_of_an_even_choice() {
        let mut statistics = Statistics::default();
        (0..100_000).for_each(|value| statistics.push("a", &[f64::from(value)]));
        let json = statistics.to_json();
        for (name, share) in FIGURES[4..].iter().zip(QUANTILES) {
            let found = json["a"][*name][0].as_f64().unwrap();
            assert!((found - share * 100_000.0).abs() < 10.0, "{name}: {found}");
        }
        assert!(statistics.features["a"][0].kept.len() < KEPT);
    }
}
