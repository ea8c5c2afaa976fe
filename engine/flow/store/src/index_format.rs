//! The bytes of an index: times of folders, then results by their plan digests, each decoded when it is asked for.
//!
//! ```text
//! header  digest of all that follows  run  times of 2 x 256 folders  count  plan digests, sorted  ends of entries  entries
//! ```

use crate::records::{ActionRecord, Finished};
use cosfly_blobs::BlobRef;
use cosfly_fingerprint::{Digest, DigestOfPieces};
use cosfly_stage::{Blobs, Produced};
use std::sync::Arc;

/// Magic bytes of the file.
const HEADER: &[u8] = b"cosfly-index 3\n";
/// Folders of an area.
pub(crate) const SHARDS: usize = 256;
const DIGEST: usize = 32;
const NUMBER: usize = 8;

/// Times of last change of the folders of an area, nanoseconds since 1970; 0 where they are not reliable.
pub(crate) type Stamps = Vec<u64>;

/// Times of last change of the folders of `done` and `cas`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FolderTimes {
    pub(crate) done: Stamps,
    pub(crate) blobs: Stamps,
}

/// An indexed result.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Entry {
    pub(crate) finished: Finished,
    /// Whether all blobs were there when the index was written, those that may be removed as well.
    pub(crate) whole: bool,
}

/// The file of an index in memory.
#[derive(Default)]
pub(crate) struct Index {
    pub(crate) run: Option<Digest>,
    pub(crate) times: FolderTimes,
    bytes: Vec<u8>,
    /// Number of entries.
    count: usize,
    /// Places of the plan digests, of the ends of entries and of the entries.
    plans: usize,
    ends: usize,
    entries: usize,
    /// First entry of each pair of first bytes of a digest, and the number of all; empty without an entry.
    firsts: Vec<u32>,
}

/// Pieces of the bytes of an index of sorted entries, which are many megabytes.
pub(crate) fn encode<'e>(
    run: &Digest,
    times: &FolderTimes,
    entries: impl Iterator<Item = (&'e Digest, &'e Finished, bool)>,
) -> [Vec<u8>; 5] {
    let (mut plans, mut ends, mut body) = (vec![], vec![], vec![]);
    for (plan, finished, whole) in entries {
        plans.extend(plan.0);
        put_entry(&mut body, finished, whole);
        put_count(&mut ends, body.len());
    }
    let mut head = run.0.to_vec();
    times.done.iter().chain(&times.blobs).for_each(|time| head.extend(time.to_le_bytes()));
    put_count(&mut head, plans.len() / DIGEST);
    let mut digest = DigestOfPieces::default();
    [&head, &plans, &ends, &body].iter().for_each(|piece| digest.add(piece));
    [[HEADER, &digest.digest().0].concat(), head, plans, ends, body]
}

fn put_entry(bytes: &mut Vec<u8>, finished: &Finished, whole: bool) {
    bytes.extend(finished.action.0);
    bytes.push(u8::from(whole));
    let record = &finished.record;
    put_count(bytes, record.outputs.len());
    for (name, blob) in record.outputs.iter() {
        put_text(bytes, name);
        bytes.extend(blob.digest.0);
        bytes.extend(blob.bytes.to_le_bytes());
    }
    put_count(bytes, record.produced.notes.len());
    record.produced.notes.iter().for_each(|(key, value)| {
        put_text(bytes, key);
        put_text(bytes, value);
    });
    put_count(bytes, record.produced.warnings.len());
    record.produced.warnings.iter().for_each(|warning| put_text(bytes, warning));
    put_count(bytes, record.produced.rejected.iter().count());
    record.produced.rejected.iter().for_each(|reason| put_text(bytes, reason));
}

fn put_count(bytes: &mut Vec<u8>, count: usize) {
    bytes.extend((count as u64).to_le_bytes());
}

fn put_text(bytes: &mut Vec<u8>, text: &str) {
    put_count(bytes, text.len());
    bytes.extend(text.as_bytes());
}

impl Index {
    /// Parses an index; `None` where it is not exactly as [`encode`] wrote it.
    pub(crate) fn decode(bytes: Vec<u8>) -> Option<Self> {
        let (digest, body) = bytes.strip_prefix(HEADER)?.split_first_chunk()?;
        if Digest::of(body) != Digest(*digest) {
            return None;
        }
        let mut reader = Reader(body);
        let run = Some(reader.digest()?);
        let mut stamps = || (0..SHARDS).map(|_| reader.number()).collect::<Option<_>>();
        let times = FolderTimes { done: stamps()?, blobs: stamps()? };
        let count = usize::try_from(reader.number()?).ok()?;
        let plans = bytes.len() - reader.0.len();
        let ends = plans.checked_add(count.checked_mul(DIGEST)?)?;
        let entries = ends.checked_add(count.checked_mul(NUMBER)?)?;
        let firsts = firsts(bytes.get(plans..ends)?);
        (entries <= bytes.len()).then_some(Self { run, times, bytes, count, plans, ends, entries, firsts })
    }

    /// Number of an entry; `None` where the task is not indexed.
    pub(crate) fn number_of(&self, plan: &Digest) -> Option<usize> {
        let first = usize::from(u16::from_be_bytes([plan.0[0], plan.0[1]]));
        let alike = *self.firsts.get(first)? as usize..*self.firsts.get(first + 1)? as usize;
        alike.into_iter().find(|number| self.plan(*number) == Some(plan.0))
    }

    /// The result of an entry; `None` where it is not as it was written.
    pub(crate) fn entry(&self, number: usize) -> Option<Entry> {
        let end = |number: usize| Reader(self.bytes.get(self.ends + number * NUMBER..)?).number();
        let first = if number == 0 { 0 } else { end(number - 1)? };
        let places = usize::try_from(first).ok()?..usize::try_from(end(number)?).ok()?;
        let mut reader = Reader(self.bytes.get(self.entries..)?.get(places)?);
        let entry = reader.entry()?;
        reader.0.is_empty().then_some(entry)
    }

    fn plan(&self, number: usize) -> Option<[u8; DIGEST]> {
        Reader(self.bytes.get(self.plans + number * DIGEST..)?).take().filter(|_| number < self.count)
    }

    /// All entries with their plan digests.
    #[cfg(test)]
    pub(crate) fn all(&self) -> Vec<(Digest, Entry)> {
        (0..self.count).map(|number| (Digest(self.plan(number).unwrap()), self.entry(number).unwrap())).collect()
    }
}

/// First entry of each pair of first bytes of a digest, and the number of all digests, which are sorted.
fn firsts(plans: &[u8]) -> Vec<u32> {
    let mut counts = vec![0_u32; 1 << 16];
    for [first, second, ..] in plans.as_chunks::<DIGEST>().0 {
        counts[usize::from(u16::from_be_bytes([*first, *second]))] += 1;
    }
    let mut firsts = vec![0];
    firsts.extend(counts.into_iter().scan(0, |sum, count| {
        *sum += count;
        Some(*sum)
    }));
    firsts
}

struct Reader<'b>(&'b [u8]);

impl<'b> Reader<'b> {
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (head, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*head)
    }

    fn digest(&mut self) -> Option<Digest> {
        self.take().map(Digest)
    }

    fn number(&mut self) -> Option<u64> {
        self.take().map(u64::from_le_bytes)
    }

    fn text(&mut self) -> Option<&'b str> {
        let length = usize::try_from(self.number()?).ok()?;
        let (text, rest) = self.0.split_at_checked(length)?;
        self.0 = rest;
        std::str::from_utf8(text).ok()
    }

    fn entry(&mut self) -> Option<Entry> {
        let action = self.digest()?;
        let whole = self.take::<1>()? == [1];
        let (mut names, mut blobs) = (vec![], vec![]);
        for _ in 0..self.number()? {
            names.push(self.text()?);
            blobs.push(BlobRef { digest: self.digest()?, bytes: self.number()? });
        }
        let mut produced = Produced::default();
        for _ in 0..self.number()? {
            produced.notes.insert(self.text()?.to_owned(), self.text()?.to_owned());
        }
        for _ in 0..self.number()? {
            produced.warnings.push(self.text()?.to_owned());
        }
        for _ in 0..self.number()? {
            produced.rejected = Some(self.text()?.to_owned());
        }
        let record = ActionRecord::new(Blobs::in_order(&names, blobs)?, produced);
        Some(Entry { finished: Finished { action, record: Arc::new(record) }, whole })
    }
}
