//! A cache of finished tasks in one file, so that a run with everything cached reads one file and not thousands.
//! Every entry carries its own check; what does not fit is passed over and read from `done` and `ac`.

use crate::fault::Step;
use crate::records::{self, Finished};
use crate::store::Store;
use cosfly_diagnose::Result;
use cosfly_fingerprint::Digest;
use std::fs;
use std::sync::Arc;

/// Before the entries: the name and version of the format.
const HEADER: &[u8] = b"cosfly-index 1\n";

impl Store {
    /// The finished tasks in the index of `recipe`, sorted by plan digest. Still to be held against
    /// [`Store::done`]: the index may know tasks that were forgotten since.
    pub fn read_index(&self, recipe: &str) -> Vec<(Digest, Finished)> {
        let bytes = fs::read(self.layout.folder("index").join(recipe)).unwrap_or_default();
        let mut rest = bytes.strip_prefix(HEADER).unwrap_or_default();
        let mut entries = Vec::new();
        while let Some((entry, after)) = split_entry(rest) {
            rest = after;
            entries.extend(decode_entry(entry));
        }
        entries.sort_unstable_by_key(|(plan, _)| *plan);
        entries
    }

    /// Replaces the index of `recipe`.
    pub fn write_index<'e>(
        &self,
        recipe: &str,
        entries: impl Iterator<Item = (&'e Digest, &'e Finished)>,
    ) -> Result<()> {
        let mut bytes = HEADER.to_vec();
        for (plan, finished) in entries {
            let record = records::encode(&finished.record);
            let Ok(length) = u32::try_from(64 + record.len()) else { continue };
            bytes.extend(length.to_le_bytes());
            bytes.extend(plan.0);
            bytes.extend(finished.action.0);
            bytes.extend(record);
        }
        self.write_file(&self.layout.folder("index").join(recipe), &bytes, Step::WriteRun, Step::RenameRun)
    }
}

fn split_entry(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let (length, rest) = bytes.split_first_chunk()?;
    rest.split_at_checked(u32::from_le_bytes(*length) as usize)
}

fn decode_entry(entry: &[u8]) -> Option<(Digest, Finished)> {
    let (plan, rest) = entry.split_first_chunk()?;
    let (action, record) = rest.split_first_chunk()?;
    let record = Arc::new(records::decode(record)?);
    Some((Digest(*plan), Finished { action: Digest(*action), record }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ActionRecord;
    use cosfly_stage::{BlobRef, Produced};
    use std::collections::BTreeMap;

    #[test]
    fn an_index_that_was_cut_or_edited_gives_only_true_entries() {
        let root = tempfile::tempdir().unwrap();
        let store = Store::open(root.path()).unwrap();
        let mut entries: Vec<(Digest, Finished)> = (0..5_u8)
            .map(|n| {
                let blob = BlobRef { digest: Digest::of(&[n, 1]), bytes: 7 };
                let record = ActionRecord::new(BTreeMap::from([("a".to_owned(), blob)]), Produced::default());
                (Digest::of(&[n]), Finished { action: Digest::of(&[n, 2]), record: Arc::new(record) })
            })
            .collect();
        entries.sort_unstable_by_key(|(plan, _)| *plan);
        store.write_index("r", entries.iter().map(|(plan, finished)| (plan, finished))).unwrap();
        assert_eq!(store.read_index("r"), entries);
        let path = root.path().join("index/r");
        let bytes = fs::read(&path).unwrap();
        for cut in (0..bytes.len()).step_by(7) {
            fs::write(&path, &bytes[..cut]).unwrap();
            assert!(store.read_index("r").iter().all(|entry| entries.contains(entry)));
        }
        assert!(store.read_index("absent").is_empty());
    }
}
