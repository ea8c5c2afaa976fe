//! The assignment problem: pairs of rows and columns with the largest sum of scores.

/// Pairs of a row and a column with the largest sum of `scores`, which are finite and whose rows have one length. There are as many pairs as
/// the smaller side has members, by row.
///
/// Shortest augmenting paths after Crouse, "On implementing 2D rectangular assignment algorithms" (2016). Among equal sums it chooses as
/// scipy's `linear_sum_assignment` does.
pub fn best_pairs(scores: &[Vec<f64>]) -> Vec<(usize, usize)> {
    let (rows, columns) = (scores.len(), scores.first().map_or(0, Vec::len));
    if rows <= columns {
        let cost = |row: usize, column: usize| -scores[row][column];
        return Matching::of(rows, columns, &cost).pairs().collect();
    }
    let cost = |column: usize, row: usize| -scores[row][column];
    let mut pairs: Vec<(usize, usize)> =
        Matching::of(columns, rows, &cost).pairs().map(|(column, row)| (row, column)).collect();
    pairs.sort_unstable();
    pairs
}

/// A matching of all rows so far, and its dual prices.
struct Matching<'a> {
    cost: &'a dyn Fn(usize, usize) -> f64,
    column_of: Vec<Option<usize>>,
    row_of: Vec<Option<usize>>,
    row_price: Vec<f64>,
    column_price: Vec<f64>,
}

/// A shortest path from a row without a column to a column without a row.
struct Path {
    end: usize,
    length: f64,
    /// Row before each column, and the length of the path to it.
    before: Vec<usize>,
    lengths: Vec<f64>,
    rows: Vec<usize>,
    columns: Vec<usize>,
}

impl<'a> Matching<'a> {
    /// The cheapest matching of all rows; there are at least as many columns.
    fn of(rows: usize, columns: usize, cost: &'a dyn Fn(usize, usize) -> f64) -> Self {
        let mut matching = Self {
            cost,
            column_of: vec![None; rows],
            row_of: vec![None; columns],
            row_price: vec![0.0; rows],
            column_price: vec![0.0; columns],
        };
        for row in 0..rows {
            if let Some(path) = matching.shortest_path(row) {
                matching.price(row, &path);
                matching.augment(row, &path);
            }
        }
        matching
    }

    fn pairs(self) -> impl Iterator<Item = (usize, usize)> {
        self.column_of.into_iter().enumerate().filter_map(|(row, column)| Some((row, column?)))
    }

    fn shortest_path(&self, start: usize) -> Option<Path> {
        let columns = self.row_of.len();
        // Backwards, so that equal costs give the identity.
        let mut open: Vec<usize> = (0..columns).rev().collect();
        let (mut before, mut lengths) = (vec![start; columns], vec![f64::INFINITY; columns]);
        let (mut row, mut length, mut rows, mut closed) = (start, 0.0, vec![], vec![]);
        loop {
            rows.push(row);
            let (mut nearest, mut shortest) = (None, f64::INFINITY);
            for (place, column) in open.iter().copied().enumerate() {
                let reached = length + (self.cost)(row, column) - self.row_price[row] - self.column_price[column];
                if reached < lengths[column] {
                    (before[column], lengths[column]) = (row, reached);
                }
                let is_end = self.row_of[column].is_none();
                if lengths[column] < shortest || (lengths[column] == shortest && is_end) {
                    (nearest, shortest) = (Some(place), lengths[column]);
                }
            }
            length = shortest;
            let column = open.swap_remove(nearest?);
            closed.push(column);
            match self.row_of[column] {
                None => return Some(Path { end: column, length, before, lengths, rows, columns: closed }),
                Some(next) => row = next,
            }
        }
    }

    /// Changes the prices so that the path costs nothing.
    fn price(&mut self, start: usize, path: &Path) {
        self.row_price[start] += path.length;
        for row in &path.rows {
            if let Some(column) = self.column_of[*row] {
                self.row_price[*row] += path.length - path.lengths[column];
            }
        }
        for column in &path.columns {
            self.column_price[*column] -= path.length - path.lengths[*column];
        }
    }

    /// Gives the rows along the path their next columns.
    fn augment(&mut self, start: usize, path: &Path) {
        let mut column = path.end;
        loop {
            let row = path.before[column];
            self.row_of[column] = Some(row);
            let freed = self.column_of[row].replace(column);
            match freed {
                Some(next) if row != start => column = next,
                _ => return,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn sum(scores: &[Vec<f64>], pairs: &[(usize, usize)]) -> f64 {
        pairs.iter().map(|(row, column)| scores[*row][*column]).sum()
    }

    /// The largest sum over all ways to give the rows from `row` on a free column, or none.
    fn by_trial(scores: &[Vec<f64>], row: usize, taken: &mut Vec<bool>) -> f64 {
        let Some(own) = scores.get(row) else { return 0.0 };
        let mut best = by_trial(scores, row + 1, taken);
        for column in 0..own.len() {
            if !taken[column] {
                taken[column] = true;
                best = best.max(own[column] + by_trial(scores, row + 1, taken));
                taken[column] = false;
            }
        }
        best
    }

    proptest! {
        #[test]
        fn no_other_pairs_have_a_larger_sum(
            columns in 0_usize..6,
            cells in proptest::collection::vec(proptest::collection::vec(0_u8..6, 6), 0..6),
        ) {
            let scores: Vec<Vec<f64>> =
                cells.iter().map(|row| row[..columns].iter().map(|cell| f64::from(*cell)).collect()).collect();
            let pairs = best_pairs(&scores);
            prop_assert_eq!(pairs.len(), scores.len().min(columns));
            let mut used: Vec<usize> = pairs.iter().map(|(_, column)| *column).collect();
            used.sort_unstable();
            used.dedup();
            prop_assert_eq!(used.len(), pairs.len());
            prop_assert!(pairs.windows(2).all(|pair| pair[0].0 < pair[1].0));
            prop_assert_eq!(sum(&scores, &pairs), by_trial(&scores, 0, &mut vec![false; columns]));
        }
    }

    #[test]
    fn equal_scores_pair_the_same_places() {
        assert_eq!(best_pairs(&vec![vec![1.0; 3]; 3]), [(0, 0), (1, 1), (2, 2)]);
        assert_eq!(best_pairs(&[]), []);
        assert_eq!(best_pairs(&[vec![], vec![]]), []);
    }
}
