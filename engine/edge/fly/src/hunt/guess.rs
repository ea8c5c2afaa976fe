//! [`Guess`]: how likely a policy fails in an episode: a line through what is known of the episode, fitted to the failures so far.
//!
//! The line begins with the weights that the scouts give. Each flight moves the weights (ridge regression towards the first ones), so the
//! hunt learns which scouts and which values of the recipe tell of this policy.

/// Flights that each first weight is worth. A policy that fails seldom gives few failures in a hunt; a line that trusts them more follows
/// chance.
const FIRST: f64 = 2.4;

/// A line through the features of episodes.
pub struct Guess {
    weights: Vec<f64>,
}

impl Guess {
    /// Fits the line to flights: features, and whether the policy failed. `first` has a weight for each feature.
    pub fn of(flights: &[(&[f64], bool)], first: &[f64]) -> Self {
        let first: Vec<f64> = first.iter().copied().chain([0.0]).collect();
        let size = first.len();
        let mut matrix = vec![vec![0.0; size + 1]; size];
        for (at, row) in matrix.iter_mut().enumerate() {
            row[at] = FIRST;
            row[size] = FIRST * first[at];
        }
        for (features, failed) in flights {
            let known: Vec<f64> = features.iter().copied().chain([1.0]).collect();
            for (row, left) in matrix.iter_mut().zip(&known) {
                row.iter_mut().zip(&known).for_each(|(cell, right)| *cell += left * right);
                row[size] += left * f64::from(u8::from(*failed));
            }
        }
        Self { weights: solved(matrix) }
    }

    /// The value of the line: the larger, the likelier the policy fails.
    pub fn at(&self, features: &[f64]) -> f64 {
        self.weights.iter().zip(features.iter().chain([&1.0])).map(|(weight, feature)| weight * feature).sum()
    }
}

/// Solution of equations with a positive definite matrix, whose last column is the right side (Gauss).
fn solved(mut rows: Vec<Vec<f64>>) -> Vec<f64> {
    for at in 0..rows.len() {
        let pivot = rows[at].clone();
        for row in rows.iter_mut().skip(at + 1) {
            let factor = row[at] / pivot[at];
            row.iter_mut().zip(&pivot).skip(at).for_each(|(cell, above)| *cell -= factor * above);
        }
    }
    let mut solution = vec![0.0; rows.len()];
    for (at, row) in rows.iter().enumerate().rev() {
        let known: f64 = (at + 1..rows.len()).map(|later| row[later] * solution[later]).sum();
        solution[at] = (row[rows.len()] - known) / row[at];
    }
    solution
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scouts_count_the_same_at_first_and_flights_say_which_one_tells() {
        let weights = [0.5, 0.5, 0.0];
        let first = Guess::of(&[], &weights);
        assert!((first.at(&[1.0, 0.0, 1.0]) - 0.5).abs() < 1e-9 && (first.at(&[0.0, 1.0, 0.0]) - 0.5).abs() < 1e-9);
        let flights: [(&[f64], bool); 4] =
            [(&[1.0, 0.0, 0.0], true), (&[0.0, 1.0, 0.0], false), (&[1.0, 1.0, 1.0], true), (&[0.0, 0.0, 1.0], false)];
        let taught = Guess::of(&flights.repeat(50), &weights);
        assert!(taught.at(&[1.0, 0.0, 0.0]) > 0.8 && taught.at(&[0.0, 1.0, 0.0]) < 0.2);
    }

    #[test]
    fn equations_are_solved() {
        let found = solved(vec![vec![4.0, 1.0, 6.0], vec![1.0, 3.0, 7.0]]);
        assert!((found[0] - 1.0).abs() < 1e-12 && (found[1] - 2.0).abs() < 1e-12);
    }
}
