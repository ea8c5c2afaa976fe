//! [`Repeats`]: entries of a list that are there again.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// Entries that equal an earlier one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Repeats {
    count: usize,
    /// Place of the first of them, and of the entry that it equals, from 0.
    first: [usize; 2],
}

impl Repeats {
    /// Those of the entries with some keys; `None` without any.
    pub(super) fn of<K: Ord>(keys: impl Iterator<Item = K>) -> Option<Self> {
        let mut places: BTreeMap<K, usize> = BTreeMap::new();
        let mut found: Option<Self> = None;
        for (place, key) in keys.enumerate() {
            match places.entry(key) {
                Entry::Vacant(free) => _ = free.insert(place),
                Entry::Occupied(earlier) => {
                    found.get_or_insert(Self { count: 0, first: [place, *earlier.get()] }).count += 1;
                }
            }
        }
        found
    }

    /// A line on entries of the list `list`.
    pub(super) fn warning(self, list: &str) -> String {
        let Self { count, first: [again, earlier] } = self;
        format!(
            "{count} entries of `{list}` are there again, the first one `{list}[{again}]` as `{list}[{earlier}]`; all are kept: \
             leave them out where one thing is meant"
        )
    }
}
