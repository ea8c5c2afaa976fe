//! Action and done records, each bound to its key by a check line: a torn, edited or exchanged record is detected.

use crate::hex::{push_digest, push_quoted};
use cosfly_fingerprint::{Digest, canonical_json};
use cosfly_stage::{Blobs, Produced};
use serde::{Deserialize, Deserializer, Serialize};
use std::fmt::Write as _;
use std::sync::{Arc, LazyLock};

/// Output of an action.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ActionRecord {
    /// Blobs by name.
    pub outputs: Arc<Blobs>,
    /// Notes, warnings and rejection; most items have none of them and share this.
    #[serde(deserialize_with = "shared_produced")]
    pub produced: Arc<Produced>,
    schema: Schema,
}

/// Version of the record, without a place in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum Schema {
    #[serde(rename = "cosfly.action-record/1")]
    First,
}

impl ActionRecord {
    /// Creates a record.
    pub fn new(outputs: impl Into<Blobs>, produced: Produced) -> Self {
        Self { outputs: Arc::new(outputs.into()), produced: shared(produced), schema: Schema::First }
    }

    /// Total number of bytes of all blobs.
    pub fn bytes(&self) -> u64 {
        self.outputs.values().fold(0, |sum, blob| sum.saturating_add(blob.bytes))
    }
}

/// One copy of an empty [`Produced`] for all items.
fn shared(produced: Produced) -> Arc<Produced> {
    static NOTHING: LazyLock<Arc<Produced>> = LazyLock::new(Arc::default);
    if produced == **NOTHING { Arc::clone(&NOTHING) } else { Arc::new(produced) }
}

fn shared_produced<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Arc<Produced>, D::Error> {
    Produced::deserialize(deserializer).map(shared)
}

/// Result of a finished task.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finished {
    /// Key over the contents of the task's inputs.
    pub action: Digest,
    /// Output of the task.
    pub record: Arc<ActionRecord>,
}

/// File of an action record: canonical JSON, the action's key, then the digest of both.
pub(crate) fn encode(action: &Digest, record: &ActionRecord) -> Vec<u8> {
    let mut text = canonical(record);
    let _ = writeln!(text, "\n{action}");
    with_check(text)
}

/// The record as canonical JSON. A dataset of a hundred thousand files is an output of as many blobs, so that no tree of
/// values is built.
fn canonical(record: &ActionRecord) -> String {
    let mut text = "{\"outputs\":{".to_owned();
    for (index, (name, blob)) in record.outputs.iter().enumerate() {
        text.push_str(if index == 0 { "" } else { "," });
        push_quoted(&mut text, name);
        let _ = write!(text, ":{{\"bytes\":{},\"digest\":\"", blob.bytes);
        push_digest(&mut text, &blob.digest);
        text.push_str("\"}");
    }
    let (produced, schema) = (canonical_json(&record.produced), canonical_json(&record.schema));
    let _ = write!(text, "}},\"produced\":{produced},\"schema\":{schema}}}");
    text
}

/// File of a done record: the action's key, the task's plan digest, then the digest of both.
pub(crate) fn encode_done(plan: &Digest, action: &Digest) -> Vec<u8> {
    with_check(format!("{action}\n{plan}\n"))
}

/// File of an answer, one line: the answer, the key of its question, then the digest of both.
pub(crate) fn encode_answer(question: &Digest, answer: &str) -> Vec<u8> {
    debug_assert!(!answer.contains('\n'));
    with_check(format!("{answer}\n{question}\n"))
}

fn with_check(mut body: String) -> Vec<u8> {
    let check = Digest::of(body.as_bytes());
    let _ = writeln!(body, "{check}");
    body.into_bytes()
}

/// Text before the key and the check line; `None` where the file is incomplete or belongs to another key.
pub(crate) fn content_for<'b>(key: &Digest, bytes: &'b [u8]) -> Option<&'b str> {
    let lines = std::str::from_utf8(bytes).ok()?.strip_suffix('\n')?;
    let (body, check) = lines.split_at(lines.rfind('\n')? + 1);
    if check.parse::<Digest>().ok()? != Digest::of(body.as_bytes()) {
        return None;
    }
    let (content, written_key) = body.strip_suffix('\n')?.split_once('\n')?;
    (written_key.parse::<Digest>().ok()? == *key).then_some(content)
}

/// Parses the record of `action`; `None` where it is not exactly as [`encode`] wrote it.
pub(crate) fn decode(action: &Digest, bytes: &[u8]) -> Option<ActionRecord> {
    serde_json::from_str(content_for(action, bytes)?).ok()
}

/// Parses the done record of `plan`; `None` where it is not exactly as [`encode_done`] wrote it.
pub(crate) fn decode_done(plan: &Digest, bytes: &[u8]) -> Option<Digest> {
    content_for(plan, bytes)?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_blobs::BlobRef;
    use std::collections::BTreeMap;

    #[test]
    fn a_record_with_any_byte_changed_is_not_believed() {
        let blob = BlobRef { digest: Digest::of(b"x"), bytes: 1 };
        let produced = Produced { warnings: vec!["w\n\"".to_owned()], ..Produced::default() };
        let record = ActionRecord::new(BTreeMap::from([("a\"".to_owned(), blob), ("b".to_owned(), blob)]), produced);
        assert_eq!(canonical(&record), canonical_json(&record));
        let action = Digest::of(b"action");
        let bytes = encode(&action, &record);
        assert_eq!(decode(&action, &bytes).unwrap(), record);
        for position in 0..bytes.len() {
            let mut changed = bytes.clone();
            changed[position] ^= 1;
            assert!(decode(&action, &changed).is_none(), "byte {position}");
            assert!(decode(&action, &bytes[..position]).is_none(), "length {position}");
        }
    }

    #[test]
    fn a_record_of_another_key_and_one_of_the_older_shape_are_not_believed() {
        let (one, other) = (Digest::of(b"one"), Digest::of(b"other"));
        let record = ActionRecord::new(BTreeMap::new(), Produced::default());
        assert!(decode(&one, &encode(&other, &record)).is_none());
        let json = canonical_json(&record);
        let older = format!("{json}\n{}\n", Digest::of(json.as_bytes()));
        assert!(decode(&one, older.as_bytes()).is_none());
        assert_eq!(decode_done(&one, &encode_done(&one, &other)), Some(other));
        assert_eq!(decode_done(&other, &encode_done(&one, &other)), None);
        assert_eq!(decode_done(&one, format!("{other}\n").as_bytes()), None);
    }
}
