//! Action records: what an action made, with a check line so that a torn or edited record is never believed.

use cosfly_fingerprint::{Digest, canonical_json};
use cosfly_stage::{BlobRef, Produced};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;

const SCHEMA: &str = "cosfly.action-record/1";

/// What an action made.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ActionRecord {
    /// Its blobs by name.
    pub outputs: BTreeMap<String, BlobRef>,
    /// Its notes, warnings and rejection.
    pub produced: Produced,
    schema: String,
}

impl ActionRecord {
    /// A record of these outputs.
    pub fn new(outputs: BTreeMap<String, BlobRef>, produced: Produced) -> Self {
        Self { outputs, produced, schema: SCHEMA.to_owned() }
    }

    /// Bytes of all blobs together.
    pub fn bytes(&self) -> u64 {
        self.outputs.values().fold(0, |sum, blob| sum.saturating_add(blob.bytes))
    }
}

/// What a finished task came to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finished {
    /// Key over the contents of its inputs.
    pub action: Digest,
    /// What it made.
    pub record: Arc<ActionRecord>,
}

/// The file of a record: canonical JSON, then its digest.
pub(crate) fn encode(record: &ActionRecord) -> Vec<u8> {
    let json = canonical_json(record);
    let check = Digest::of(json.as_bytes());
    format!("{json}\n{check}\n").into_bytes()
}

/// Reads the file of a record; nothing when it is not exactly what [`encode`] wrote.
pub(crate) fn decode(bytes: &[u8]) -> Option<ActionRecord> {
    let text = std::str::from_utf8(bytes).ok()?;
    let (json, check) = text.strip_suffix('\n')?.split_once('\n')?;
    if check.parse::<Digest>().ok()? != Digest::of(json.as_bytes()) {
        return None;
    }
    let record: ActionRecord = serde_json::from_str(json).ok()?;
    (record.schema == SCHEMA).then_some(record)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_with_any_byte_changed_is_not_believed() {
        let blob = BlobRef { digest: Digest::of(b"x"), bytes: 1 };
        let produced = Produced { warnings: vec!["w\n\"".to_owned()], ..Produced::default() };
        let record = ActionRecord::new(BTreeMap::from([("a".to_owned(), blob)]), produced);
        let bytes = encode(&record);
        assert_eq!(decode(&bytes).unwrap(), record);
        for position in 0..bytes.len() {
            let mut changed = bytes.clone();
            changed[position] ^= 1;
            assert!(decode(&changed).is_none(), "byte {position}");
            assert!(decode(&bytes[..position]).is_none(), "length {position}");
        }
    }
}
