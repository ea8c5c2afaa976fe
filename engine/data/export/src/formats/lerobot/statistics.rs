//! Smallest, largest, mean and deviation of every feature, gathered frame by frame.

use super::tables::PICTURE;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Statistics of all features.
#[derive(Clone, Debug, Default)]
pub struct Statistics {
    features: BTreeMap<String, Vec<Moments>>,
    pictures: [Moments; 3],
    picture_count: u64,
}

/// Statistics of one number. Mean and deviation by Welford's update.
#[derive(Clone, Copy, Debug)]
struct Moments {
    count: f64,
    min: f64,
    max: f64,
    mean: f64,
    squares: f64,
}

impl Default for Moments {
    fn default() -> Self {
        Self { count: 0.0, min: f64::INFINITY, max: f64::NEG_INFINITY, mean: 0.0, squares: 0.0 }
    }
}

impl Moments {
    fn push(&mut self, value: f64) {
        self.count += 1.0;
        (self.min, self.max) = (self.min.min(value), self.max.max(value));
        let gap = value - self.mean;
        self.mean += gap / self.count;
        self.squares += gap * (value - self.mean);
    }

    fn deviation(&self) -> f64 {
        (self.squares / self.count.max(1.0)).sqrt()
    }
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

    /// Counts every `step`-th pixel of a row-major RGB picture, as shares of full brightness.
    pub fn push_picture(&mut self, rgb: &[u8], step: usize) {
        self.picture_count += 1;
        for pixel in rgb.chunks_exact(3).step_by(step.max(1)) {
            self.pictures.iter_mut().zip(pixel).for_each(|(moments, value)| moments.push(f64::from(*value) / 255.0));
        }
    }

    /// The content of `meta/stats.json`.
    pub fn to_json(&self) -> Value {
        let of = |moments: &[Moments], wrap: fn(f64) -> Value, count: u64| {
            let list = |number: fn(&Moments) -> f64| moments.iter().map(|it| wrap(number(it))).collect::<Vec<Value>>();
            json!({
                "min": list(|it| it.min), "max": list(|it| it.max), "mean": list(|it| it.mean),
                "std": list(Moments::deviation), "count": [count],
            })
        };
        let mut all: BTreeMap<&str, Value> = self
            .features
            .iter()
            .map(|(name, moments)| {
                let count = moments.first().map_or(0.0, |it| it.count) as u64;
                (name.as_str(), of(moments, |number| json!(number), count))
            })
            .collect();
        all.insert(PICTURE, of(&self.pictures, |number| json!([[number]]), self.picture_count));
        json!(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_those_of_the_population() {
        let mut statistics = Statistics::default();
        [[1.0, 5.0], [2.0, 5.0], [6.0, 5.0]].iter().for_each(|values| statistics.push("a", values));
        statistics.push_picture(&[255, 0, 51, 255, 0, 51], 1);
        let json = statistics.to_json();
        assert_eq!(
            (&json["a"]["mean"], &json["a"]["max"], &json["a"]["count"]),
            (&json!([3.0, 5.0]), &json!([6.0, 5.0]), &json!([3]))
        );
        assert!((json["a"]["std"][0].as_f64().unwrap() - (14.0f64 / 3.0).sqrt()).abs() < 1e-12);
        assert_eq!(json[PICTURE]["mean"], json!([[[1.0]], [[0.0]], [[0.2]]]));
    }
}
