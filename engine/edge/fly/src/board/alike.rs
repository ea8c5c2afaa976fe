//! [`alike`]: entries that fly most episodes in the same way, to the last bit. Copies of an entry do not fill a board.

use crate::flight::Row;
use cosfly_fingerprint::Digest;
use std::collections::BTreeMap;

/// Likeness of an entry to others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Likeness {
    /// The first entry that it flies alike with, directly or by way of others; itself, where there is none.
    pub group: usize,
    /// Another entry that flies most of the same episodes alike, and the number of these episodes.
    pub closest: Option<(usize, usize)>,
}

/// Likeness of each entry to others: more than half of its episodes have the same rows, but for measured latencies.
pub fn alike(entries: &[&[Row]]) -> Vec<Likeness> {
    let mut owners: BTreeMap<Digest, Vec<usize>> = BTreeMap::new();
    for (entry, rows) in entries.iter().enumerate() {
        rows.iter().for_each(|row| owners.entry(fingerprint(row)).or_default().push(entry));
    }
    let mut common = vec![BTreeMap::<usize, usize>::new(); entries.len()];
    for owners in owners.values() {
        for &one in owners {
            owners.iter().filter(|&&other| other != one).for_each(|&other| *common[one].entry(other).or_default() += 1);
        }
    }
    let mut found: Vec<Likeness> = (0..entries.len()).map(|group| Likeness { group, closest: None }).collect();
    for (entry, shared) in common.iter().enumerate() {
        let most = |&(_, count): &(usize, usize)| 2 * count > entries[entry].len();
        for (other, count) in shared.iter().map(|(&other, &count)| (other, count)).filter(most) {
            if found[entry].closest.is_none_or(|(_, most)| count > most) {
                found[entry].closest = Some((other, count));
            }
            let (one, two) = (found[entry].group, found[other].group);
            if one != two {
                found.iter_mut().filter(|it| it.group == one.max(two)).for_each(|it| it.group = one.min(two));
            }
        }
    }
    found
}

/// Digest of an outcome, without the time that the policy took.
fn fingerprint(row: &Row) -> Digest {
    let timeless = Row { mean_latency_s: None, ..row.clone() };
    Digest::of(&serde_json::to_vec(&timeless).unwrap_or_default())
}
