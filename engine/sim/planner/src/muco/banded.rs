//! Symmetric banded systems of half-bandwidth three: the normal equations of differences up to the third.

use cosfly_frames::DVec3;

/// Coefficients of differences by order; order 0 is the value itself.
pub const DIFFERENCES: [&[f64]; 4] = [&[1.0], &[-1.0, 1.0], &[1.0, -2.0, 1.0], &[-1.0, 3.0, -3.0, 1.0]];

/// Row i holds the entries (i, i), (i, i-1), (i, i-2), (i, i-3).
pub struct Banded {
    rows: Vec<[f64; 4]>,
}

impl Banded {
    /// A diagonal matrix.
    pub fn diagonal(values: &[f64]) -> Self {
        Self { rows: values.iter().map(|&value| [value, 0.0, 0.0, 0.0]).collect() }
    }

    /// Adds `weight * D^T D`, D the matrix of differences of the given order (0 to 3).
    pub fn add_differences(&mut self, order: usize, weight: f64) {
        let coefficients = DIFFERENCES[order];
        for start in 0..self.rows.len().saturating_sub(order) {
            for (a, ca) in coefficients.iter().enumerate() {
                for (b, cb) in coefficients[..=a].iter().enumerate() {
                    self.rows[start + a][a - b] += weight * ca * cb;
                }
            }
        }
    }

    /// The L D L^T factors, in place of the matrix. It must be positive definite.
    pub fn factor(mut self) -> Factor {
        for i in 0..self.rows.len() {
            for k in (1..=3.min(i)).rev() {
                let j = i - k;
                let mut sum = self.rows[i][k];
                for m in k + 1..=3.min(i) {
                    sum -= self.rows[i][m] * self.rows[i - m][0] * self.rows[j][m - k];
                }
                self.rows[i][k] = sum / self.rows[j][0];
            }
            let lost: f64 = (1..=3.min(i)).map(|k| self.rows[i][k] * self.rows[i][k] * self.rows[i - k][0]).sum();
            self.rows[i][0] -= lost;
        }
        for row in &mut self.rows {
            row[0] = 1.0 / row[0];
        }
        Factor { rows: self.rows }
    }
}

/// A factored matrix: the inverse of D and the rows of L.
pub struct Factor {
    rows: Vec<[f64; 4]>,
}

impl Factor {
    /// Solves for three right-hand sides at once (x, y, z), in place.
    pub fn solve(&self, x: &mut [DVec3]) {
        let (mut a, mut b, mut c) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        for (x, row) in x.iter_mut().zip(&self.rows) {
            // The three values before, the nearest first; rows at the start have zeros for what is not there.
            *x = *x - row[2] * b - row[3] * c - row[1] * a;
            (c, b, a) = (b, a, *x);
        }
        let (mut a, mut b, mut c) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        let (mut la, mut lb, mut lc) = (0.0, 0.0, 0.0);
        for (i, x) in x.iter_mut().enumerate().rev() {
            let row = &self.rows[i];
            *x = row[0] * *x - lb * b - lc * c - la * a;
            (c, b, a) = (b, a, *x);
            let below = |k: usize| self.rows.get(i + k - 1).map_or(0.0, |row| row[k]);
            (la, lb, lc) = (row[1], below(2), below(3));
        }
    }
}

/// Differences of the given order of `x` into `out` (shorter by the order).
pub fn differences(order: usize, x: &[DVec3], out: &mut Vec<DVec3>) {
    let coefficients = DIFFERENCES[order];
    out.clear();
    out.extend(x.windows(order + 1).map(|w| w.iter().zip(coefficients).map(|(v, c)| *v * *c).sum::<DVec3>()));
}

/// Adds `weight * D^T y`.
pub fn add_transposed(order: usize, y: &[DVec3], weight: f64, out: &mut [DVec3]) {
    for (i, value) in y.iter().enumerate() {
        for (k, c) in DIFFERENCES[order].iter().enumerate() {
            out[i + k] += weight * *c * *value;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_solution_satisfies_its_system() {
        for n in [1_usize, 2, 3, 4, 9, 60] {
            let build = || {
                let mut matrix = Banded::diagonal(&(0..n).map(|i| 0.5 + 0.01 * i as f64).collect::<Vec<_>>());
                matrix.add_differences(1, 0.7);
                matrix.add_differences(2, 2.0);
                matrix.add_differences(3, 5.0);
                matrix
            };
            let right: Vec<DVec3> = (0..n).map(|i| DVec3::new(i as f64, 1.0, (i * i) as f64 % 7.0)).collect();
            let mut x = right.clone();
            build().factor().solve(&mut x);
            let matrix = build();
            for (i, right) in right.iter().enumerate() {
                let near = i.saturating_sub(3)..(i + 4).min(n);
                let left: DVec3 = near.map(|j| matrix.rows[i.max(j)][i.abs_diff(j)] * x[j]).sum();
                assert!((left - right).length() < 1e-8, "n {n} row {i}");
            }
        }
    }
}
