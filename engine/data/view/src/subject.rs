//! [`ViewSubject`]: what the page shows.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use serde_json::{Value, json};

/// Subject of the page: flights by their numbers from 0. All values are JSON; the page shows texts as texts.
pub trait ViewSubject: Send + Sync {
    /// Name, kind (`dataset`, `result` or `recipe`), channels, and `version`: another one where pictures are others.
    ///
    /// # Errors
    /// Files that cannot be read.
    fn about(&self) -> Result<Value>;

    /// The index of flights.
    ///
    /// # Errors
    /// Files that cannot be read.
    fn index(&self) -> Result<Index>;

    /// Frames, texts and relatives of a flight.
    ///
    /// # Errors
    /// `view-unknown`; files that cannot be read.
    fn flight(&self, number: usize) -> Result<Value>;

    /// Other bodies around a flight, frame by frame.
    ///
    /// # Errors
    /// `view-unknown`; files that cannot be read.
    fn bodies(&self, number: usize) -> Result<Value>;

    /// Boxes of the town of a flight.
    ///
    /// # Errors
    /// `view-unknown`; files that cannot be read.
    fn town(&self, number: usize) -> Result<Value>;

    /// Paths of all flights in the town of a flight: for each its number, and the numbers of [`FewPoints`].
    ///
    /// # Errors
    /// `view-unknown`; files that cannot be read.
    fn paths(&self, number: usize) -> Result<Value>;

    /// A picture of a flight.
    ///
    /// # Errors
    /// `view-unknown`; files that cannot be read.
    fn picture(&self, number: usize, frame: usize, channel: &str) -> Result<ViewedPicture>;

    /// Progress of what is being made; none of finished things.
    ///
    /// # Errors
    /// Files that cannot be read.
    fn progress(&self) -> Result<Option<Value>> {
        Ok(None)
    }
}

/// An image file that browsers show.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ViewedPicture {
    /// `image/jpeg` or `image/png`.
    pub media_type: &'static str,
    /// The file.
    pub bytes: Vec<u8>,
}

/// The index of flights, column by column.
#[derive(Clone, Debug, Default)]
pub struct Index {
    columns: Vec<Value>,
    len: usize,
    worst: Vec<usize>,
}

impl Index {
    /// Adds a column of texts.
    pub fn texts(&mut self, name: &str, doc: &str, texts: Vec<String>) {
        self.len = texts.len();
        self.columns.push(json!({ "name": name, "doc": doc, "texts": texts }));
    }

    /// Adds a column of numbers; those that are not finite are unknown.
    pub fn numbers(&mut self, name: &str, doc: &str, numbers: impl Iterator<Item = f64>) {
        let numbers: Vec<f64> = numbers.map(short).collect();
        self.len = numbers.len();
        self.columns.push(json!({ "name": name, "doc": doc, "numbers": numbers }));
    }

    /// Puts the flights in the order of their first numbers, the largest first, then of their second ones, the smallest first.
    pub fn rank(&mut self, numbers: &[[f64; 2]]) {
        self.worst = (0..numbers.len()).collect();
        let key = |at: &usize| numbers[*at];
        self.worst.sort_by(|a, b| key(b)[0].total_cmp(&key(a)[0]).then(key(a)[1].total_cmp(&key(b)[1])).then(a.cmp(b)));
    }

    /// Numbers of the flights, the worst first.
    pub fn worst(&self) -> &[usize] {
        &self.worst
    }

    /// Number of flights.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are no flights.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The index for the page.
    pub fn json(&self) -> Value {
        json!({ "flights": self.len, "columns": self.columns, "worst": self.worst })
    }
}

/// Most points of a path that stands for a flight among many, but for its end.
const MOST_POINTS: usize = 24;

/// A path in few points.
#[derive(Clone, Debug, Default)]
pub struct FewPoints {
    every: usize,
    frames: usize,
    seen: usize,
    least: f64,
    numbers: Vec<f64>,
}

impl FewPoints {
    /// The path of a flight of so many frames, none of which is there yet.
    pub fn of(frames: usize) -> Self {
        Self { every: frames.div_ceil(MOST_POINTS).max(1), frames, least: f64::INFINITY, ..Self::default() }
    }

    /// Adds the place (metres) and the visible share of the next frame.
    pub fn add(&mut self, [x, y, visible]: [f64; 3]) {
        self.least = self.least.min(visible);
        if self.seen.is_multiple_of(self.every) || self.seen + 1 == self.frames {
            self.numbers.extend([x, y, self.least].map(short));
            self.least = f64::INFINITY;
        }
        self.seen += 1;
    }

    /// For each point x, y and the smallest visible share since the point before.
    pub fn numbers(self) -> Vec<f64> {
        self.numbers
    }
}

/// A number with three decimals: millimetres and thousandths suffice to look at.
pub fn short(number: f64) -> f64 {
    (number * 1000.0).round() / 1000.0
}

/// The error for a flight, frame or channel that there is not.
pub fn unknown(what: impl std::fmt::Display) -> Box<Diagnostic> {
    Diagnostic::new("view-unknown", Fault::Input, format!("there is no {what}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_ends_with_the_flight_and_keeps_its_losses() {
        let path = |frames: usize| {
            let mut path = FewPoints::of(frames);
            (0..frames).for_each(|at| path.add([at as f64, 0.0, if at == 50 { 0.0 } else { 1.0 }]));
            path.numbers()
        };
        let long = path(102);
        assert!(long.len() <= 3 * (MOST_POINTS + 1));
        assert_eq!(long[long.len() - 3..], [101.0, 0.0, 1.0]);
        assert_eq!(long.iter().skip(2).step_by(3).filter(|share| **share == 0.0).count(), 1);
        assert_eq!(path(1), [0.0, 0.0, 1.0]);
    }

    #[test]
    fn the_longest_loss_is_worst_then_what_is_seen_least() {
        let mut index = Index::default();
        index.rank(&[[0.0, 0.9], [2.0, 0.8], [0.0, 0.4], [2.0, 0.8]]);
        assert_eq!(index.worst(), [1, 3, 2, 0]);
        index.numbers("a", "A.", [1.23456, f64::NAN].into_iter());
        assert_eq!(index.json()["columns"][0]["numbers"], json!([1.235, null]));
    }
}
