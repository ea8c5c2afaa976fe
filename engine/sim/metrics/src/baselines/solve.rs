//! Solves symmetric positive definite systems by Cholesky's method.

/// Solves A X = B in place of `right`, for `matrix` A (n x n, its lower triangle is read) and B with rows of `columns`
/// numbers; `None` when A is not positive definite.
pub fn solve(matrix: &[f64], n: usize, right: &mut [f64], columns: usize) -> Option<()> {
    let mut lower = matrix.to_vec();
    for i in 0..n {
        for j in 0..=i {
            let known: f64 = (0..j).map(|k| lower[i * n + k] * lower[j * n + k]).sum();
            let rest = lower[i * n + j] - known;
            lower[i * n + j] = if i > j {
                rest / lower[j * n + j]
            } else if rest > 0.0 {
                rest.sqrt()
            } else {
                return None;
            };
        }
    }
    for column in 0..columns {
        for i in 0..n {
            let known: f64 = (0..i).map(|k| lower[i * n + k] * right[k * columns + column]).sum();
            right[i * columns + column] = (right[i * columns + column] - known) / lower[i * n + i];
        }
        for i in (0..n).rev() {
            let known: f64 = (i + 1..n).map(|k| lower[k * n + i] * right[k * columns + column]).sum();
            right[i * columns + column] = (right[i * columns + column] - known) / lower[i * n + i];
        }
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_system_is_solved_and_an_indefinite_one_refused() {
        let mut right = [8.0, 1.0, 7.0, 0.0];
        solve(&[4.0, 2.0, 2.0, 3.0], 2, &mut right, 2).unwrap();
        for (found, expected) in right.iter().zip([1.25, 0.375, 1.5, -0.25]) {
            assert!((found - expected).abs() < 1e-12);
        }
        assert_eq!(solve(&[1.0, 2.0, 2.0, 1.0], 2, &mut right, 2), None);
    }
}
