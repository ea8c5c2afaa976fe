//! Sets of numbers that are joined pair by pair (union-find with path compression).

/// Disjoint sets of the numbers 0..n.
#[derive(Clone, Debug)]
pub struct DisjointSets(Vec<u32>);

impl DisjointSets {
    /// A set for each of `count` numbers.
    pub fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    /// Smallest number in the set of `at`.
    pub fn smallest(&mut self, at: usize) -> usize {
        let mut at = at;
        while self.0[at] as usize != at {
            // Each second number on the way is moved up: ways are halved with each call.
            self.0[at] = self.0[self.0[at] as usize];
            at = self.0[at] as usize;
        }
        at
    }

    /// Joins the sets of both numbers.
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.smallest(a), self.smallest(b));
        self.0[a.max(b)] = a.min(b) as u32;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joined_numbers_have_the_same_smallest_one_in_any_order_of_joining() {
        for pairs in [[(1, 4), (4, 7), (2, 9)], [(9, 2), (7, 4), (4, 1)]] {
            let mut sets = DisjointSets::new(10);
            pairs.iter().for_each(|(a, b)| sets.join(*a, *b));
            let found: Vec<usize> = (0..10).map(|at| sets.smallest(at)).collect();
            assert_eq!(found, [0, 1, 2, 3, 1, 5, 6, 1, 8, 2]);
        }
    }

    #[test]
    fn a_long_chain_is_found_in_a_moment() {
        let mut sets = DisjointSets::new(1_000_000);
        (1..1_000_000).rev().for_each(|at| sets.join(at, at - 1));
        assert!((0..1_000_000).all(|at| sets.smallest(at) == 0));
    }
}
