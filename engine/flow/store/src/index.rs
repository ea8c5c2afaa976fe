//! A cache of finished tasks in one file, so that a run with everything cached reads one file instead of thousands.
//!
//! The index holds the records of the latest run of a recipe and the time of last change of each folder of `done` and `cas`. A
//! folder unchanged since then has lost no file, so its files need not be checked one by one. (Damage inside a file is
//! found when the file is read.)

use crate::fault::Step;
use crate::layout::{Area, Layout};
use crate::present::Present;
use crate::records::{ActionRecord, Finished};
use crate::store::Store;
use cosfly_blobs::BlobRef;
use cosfly_diagnose::Result;
use cosfly_fingerprint::Digest;
use cosfly_stage::Produced;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Magic bytes of the file; the digest of the body and the body follow.
const HEADER: &[u8] = b"cosfly-index 2\n";
const SHARDS: usize = 256;
/// Resolution of the file system's clock: a folder that changed within this time may change again with the same time
/// stamp.
const CLOCK_STEP: Duration = Duration::from_millis(20);
/// Number of changed folders above which a new index is written.
const MOST_CHANGED: usize = SHARDS / 4;

/// Times of last change of the folders of an area, nanoseconds since 1970; 0 where they are not reliable.
type Stamps = Vec<u64>;

/// Finished tasks, from the index of a recipe and from the records themselves.
pub struct KnownTasks<'s> {
    store: &'s Store,
    run: Option<Digest>,
    /// Results sorted by plan digest.
    entries: Vec<(Digest, Entry)>,
    /// First entry of each pair of first bytes of a digest, and the number of all.
    firsts: Vec<u32>,
    /// Per folder: whether no file went missing since the index was written.
    done_is_whole: Vec<bool>,
    blobs_are_whole: Vec<bool>,
    /// Names in the folders of `done`, each read on demand.
    done: Vec<OnceLock<Vec<Digest>>>,
    missed: AtomicBool,
}

/// An indexed result.
#[derive(Clone, Debug, PartialEq)]
struct Entry {
    finished: Finished,
    /// Whether all blobs were there when the index was written, those that may be removed as well.
    whole: bool,
}

/// A finished task.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Known {
    /// Result of the task.
    pub finished: Finished,
    /// Whether all blobs are there, those that may be removed as well.
    pub whole: bool,
}

#[derive(Default)]
struct Index {
    run: Option<Digest>,
    done_stamps: Stamps,
    blob_stamps: Stamps,
    entries: Vec<(Digest, Entry)>,
}

impl Store {
    /// Finished tasks; fast for those of the latest run of `recipe`.
    pub fn known_tasks(&self, recipe: &str) -> KnownTasks<'_> {
        let bytes = fs::read(self.layout.folder("index").join(recipe)).unwrap_or_default();
        let mut index = decode(&bytes).unwrap_or_default();
        // They are sorted already: a file with others was edited.
        index.entries.sort_by_key(|(plan, _)| *plan);
        let whole = |area, old: &Stamps| -> Vec<bool> {
            if old.len() != SHARDS {
                return vec![false; SHARDS];
            }
            let now = stamps(&self.layout, area);
            old.iter().zip(now).map(|(old, now)| *old != 0 && *old == now).collect()
        };
        KnownTasks {
            store: self,
            run: index.run,
            done_is_whole: whole(Area::Done, &index.done_stamps),
            blobs_are_whole: whole(Area::Blobs, &index.blob_stamps),
            firsts: firsts(&index.entries),
            entries: index.entries,
            done: (0..SHARDS).map(|_| OnceLock::new()).collect(),
            missed: AtomicBool::new(false),
        }
    }

    /// Replaces the index of `recipe` by the finished tasks of its run `run`, each with the names of blobs that may be
    /// removed.
    pub fn write_index<'e>(
        &self,
        recipe: &str,
        run: &Digest,
        entries: impl Iterator<Item = (&'e Digest, &'e Finished, &'e [&'e str])>,
    ) -> Result<()> {
        // The times are read before the files: a file that goes missing in between changes a time.
        let now = self.file_system_time()?;
        let reliable = |stamps: Stamps| -> Stamps {
            let limit = now.saturating_sub(nanoseconds(CLOCK_STEP));
            stamps.into_iter().map(|stamp| if stamp < limit { stamp } else { 0 }).collect()
        };
        let done_stamps = reliable(stamps(&self.layout, Area::Done));
        let blob_stamps = reliable(stamps(&self.layout, Area::Blobs));
        // Folders are listed, which costs a tenth of a look at each file. Sizes are checked where blobs are read.
        let (done, blobs) = (Present::of(self, Area::Done)?, Present::of(self, Area::Blobs)?);
        let there = |(plan, finished, removable): (&'e Digest, &'e Finished, &'e [&'e str])| {
            let (mut lasts, mut whole) = (done.holds(plan), true);
            for (name, blob) in finished.record.outputs.iter() {
                if !blobs.holds(&blob.digest) && !self.remote_holds(&blob.digest) {
                    whole = false;
                    lasts &= removable.contains(&name.as_str());
                }
            }
            lasts.then_some((plan, finished, whole))
        };
        let mut entries: Vec<_> = entries.filter_map(there).collect();
        entries.sort_unstable_by_key(|(plan, ..)| **plan);
        let bytes = encode(run, &done_stamps, &blob_stamps, entries.into_iter());
        self.write_file(&self.layout.folder("index").join(recipe), &bytes, Step::WriteRun, Step::RenameRun)
    }

    /// Current time by the clock of the store's file system.
    fn file_system_time(&self) -> Result<u64> {
        let probe = self.write_temporary(b"", 0o644, Step::WriteRun)?;
        let now = stamp(&probe);
        let _ = fs::remove_file(&probe);
        Ok(now)
    }
}

impl KnownTasks<'_> {
    /// A task that is finished and has all its blobs but those named in `removable`.
    pub fn finished(&self, plan: &Digest, removable: &[&str]) -> Option<Known> {
        let shard = usize::from(plan.0[0]);
        let indexed = self.indexed(plan);
        let is_done =
            (indexed.is_some() && self.done_is_whole[shard]) || self.done_in(shard).binary_search(plan).is_ok();
        if !is_done && self.store.remote.is_none() {
            return None;
        }
        if let Some(known) = indexed.and_then(|entry| self.known(entry, removable)) {
            return Some(known);
        }
        let finished = self.store.finished(plan)?;
        if !self.store.holds_lasting(&finished.record, removable) {
            return None;
        }
        self.missed.store(true, Ordering::Relaxed);
        let whole = removable.is_empty() || self.store.holds(&finished.record);
        Some(Known { finished, whole })
    }

    /// Whether the index is of the run `run` and as good as a new one.
    pub fn is_current(&self, run: &Digest) -> bool {
        let changed = |whole: &[bool]| whole.iter().filter(|whole| !**whole).count() > MOST_CHANGED;
        self.run.as_ref() == Some(run)
            && !self.missed.load(Ordering::Relaxed)
            && !changed(&self.done_is_whole)
            && !changed(&self.blobs_are_whole)
    }

    fn indexed(&self, plan: &Digest) -> Option<&Entry> {
        let first = usize::from(u16::from_be_bytes([plan.0[0], plan.0[1]]));
        let alike = &self.entries[self.firsts[first] as usize..self.firsts[first + 1] as usize];
        alike.iter().find(|(known, _)| known == plan).map(|(_, entry)| entry)
    }

    /// State of an indexed result; `None` where a lasting blob is missing.
    fn known(&self, Entry { finished, whole }: &Entry, removable: &[&str]) -> Option<Known> {
        let is_unchanged = |blob: &BlobRef| self.blobs_are_whole[usize::from(blob.digest.0[0])];
        let holds = |blob: &BlobRef| is_unchanged(blob) || self.store.holds_blob(blob);
        if !*whole && removable.is_empty() {
            return None;
        }
        let outputs = &finished.record.outputs;
        let may_go = |name: &String| removable.contains(&name.as_str());
        if !outputs.iter().all(|(name, blob)| may_go(name) || holds(blob)) {
            return None;
        }
        let removable = || outputs.iter().filter(|(name, _)| may_go(name)).map(|(_, blob)| blob);
        let whole = match whole {
            true => removable().all(holds),
            // One was missing when the index was written, and no file came into these folders since.
            false if removable().all(is_unchanged) => false,
            false => removable().all(|blob| self.store.holds_blob(blob)),
        };
        Some(Known { finished: finished.clone(), whole })
    }

    fn done_in(&self, shard: usize) -> &[Digest] {
        // An unreadable folder counts as empty.
        self.done[shard].get_or_init(|| self.store.layout.list_shard(Area::Done, shard as u8).unwrap_or_default())
    }
}

/// First entry of each pair of first bytes of a digest, and the number of all entries, which are sorted.
fn firsts(entries: &[(Digest, Entry)]) -> Vec<u32> {
    let mut counts = vec![0_u32; 1 << 16];
    entries.iter().for_each(|(plan, _)| counts[usize::from(u16::from_be_bytes([plan.0[0], plan.0[1]]))] += 1);
    let mut firsts = vec![0];
    firsts.extend(counts.into_iter().scan(0, |sum, count| {
        *sum += count;
        Some(*sum)
    }));
    firsts
}

/// Times of last change of the folders of an area; 0 for absent ones.
fn stamps(layout: &Layout, area: Area) -> Stamps {
    let folder = layout.folder(area.folder());
    (0..SHARDS).map(|shard| stamp(&folder.join(format!("{shard:02x}")))).collect()
}

fn stamp(path: &Path) -> u64 {
    let changed = fs::symlink_metadata(path).and_then(|metadata| metadata.modified()).unwrap_or(UNIX_EPOCH);
    let since = changed.duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
    // A file system that stores whole seconds only is too coarse.
    if since.subsec_nanos() == 0 { 0 } else { nanoseconds(since) }
}

fn nanoseconds(duration: Duration) -> u64 {
    u64::try_from(duration.as_nanos()).unwrap_or(u64::MAX)
}

fn encode<'e>(
    run: &Digest,
    done: &Stamps,
    blobs: &Stamps,
    entries: impl Iterator<Item = (&'e Digest, &'e Finished, bool)>,
) -> Vec<u8> {
    let start = HEADER.len() + 32;
    let mut body = [HEADER, &[0; 32], &run.0].concat();
    done.iter().chain(blobs).for_each(|stamp| body.extend(stamp.to_le_bytes()));
    for (plan, finished, whole) in entries {
        body.extend(plan.0);
        body.extend(finished.action.0);
        body.push(u8::from(whole));
        let record = &finished.record;
        put_count(&mut body, record.outputs.len());
        for (name, blob) in record.outputs.iter() {
            put_text(&mut body, name);
            body.extend(blob.digest.0);
            body.extend(blob.bytes.to_le_bytes());
        }
        put_count(&mut body, record.produced.notes.len());
        record.produced.notes.iter().for_each(|(key, value)| {
            put_text(&mut body, key);
            put_text(&mut body, value);
        });
        put_count(&mut body, record.produced.warnings.len());
        record.produced.warnings.iter().for_each(|warning| put_text(&mut body, warning));
        put_count(&mut body, record.produced.rejected.iter().count());
        record.produced.rejected.iter().for_each(|reason| put_text(&mut body, reason));
    }
    let digest = Digest::of(&body[start..]);
    body[HEADER.len()..start].copy_from_slice(&digest.0);
    body
}

fn put_count(bytes: &mut Vec<u8>, count: usize) {
    bytes.extend((count as u64).to_le_bytes());
}

fn put_text(bytes: &mut Vec<u8>, text: &str) {
    put_count(bytes, text.len());
    bytes.extend(text.as_bytes());
}

/// Parses an index; `None` where it is not exactly as [`encode`] wrote it.
fn decode(bytes: &[u8]) -> Option<Index> {
    let (digest, body) = bytes.strip_prefix(HEADER)?.split_first_chunk()?;
    if Digest::of(body) != Digest(*digest) {
        return None;
    }
    let mut reader = Reader(body);
    let mut index = Index { run: Some(reader.digest()?), ..Index::default() };
    index.done_stamps = (0..SHARDS).map(|_| reader.number()).collect::<Option<_>>()?;
    index.blob_stamps = (0..SHARDS).map(|_| reader.number()).collect::<Option<_>>()?;
    while !reader.0.is_empty() {
        index.entries.push(reader.entry()?);
    }
    Some(index)
}

struct Reader<'b>(&'b [u8]);

impl Reader<'_> {
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

    fn text(&mut self) -> Option<String> {
        let length = usize::try_from(self.number()?).ok()?;
        let (text, rest) = self.0.split_at_checked(length)?;
        self.0 = rest;
        Some(std::str::from_utf8(text).ok()?.to_owned())
    }

    fn entry(&mut self) -> Option<(Digest, Entry)> {
        let (plan, action) = (self.digest()?, self.digest()?);
        let whole = self.take::<1>()? == [1];
        let mut outputs = BTreeMap::new();
        for _ in 0..self.number()? {
            outputs.insert(self.text()?, BlobRef { digest: self.digest()?, bytes: self.number()? });
        }
        let mut produced = Produced::default();
        for _ in 0..self.number()? {
            produced.notes.insert(self.text()?, self.text()?);
        }
        for _ in 0..self.number()? {
            produced.warnings.push(self.text()?);
        }
        for _ in 0..self.number()? {
            produced.rejected = Some(self.text()?);
        }
        let finished = Finished { action, record: Arc::new(ActionRecord::new(outputs, produced)) };
        Some((plan, Entry { finished, whole }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_blobs::OutputSink;

    fn finish(store: &Store, text: &str) -> (Digest, Finished) {
        let action = Digest::of(text.as_bytes());
        let mut sink = store.sink();
        sink.put("a", text.as_bytes()).unwrap();
        sink.put("means", format!("means of {text}").as_bytes()).unwrap();
        let produced = Produced {
            notes: BTreeMap::from([("boxes".to_owned(), text.to_owned())]),
            warnings: vec!["one".to_owned(), String::new()],
            rejected: (text == "3").then(|| "unreachable".to_owned()),
        };
        let record = sink.settle(&action, produced).unwrap().record;
        let document = format!("\"{text}\"");
        let plan = Digest::of(document.as_bytes());
        store.publish_done(&plan, &document, &action).unwrap();
        (plan, Finished { action, record })
    }

    const REMOVABLE: &[&str] = &["means"];

    fn store_with_index() -> (tempfile::TempDir, Vec<(Digest, Finished)>) {
        let root = tempfile::tempdir().unwrap();
        let store = Store::open(root.path()).unwrap();
        let entries: Vec<_> = (0..5).map(|n| finish(&store, &n.to_string())).collect();
        // Older than the step of the file system's clock, so that the index relies on the folders' times.
        std::thread::sleep(2 * CLOCK_STEP);
        store
            .write_index("r", &Digest::of(b"run"), entries.iter().map(|(plan, finished)| (plan, finished, REMOVABLE)))
            .unwrap();
        (root, entries)
    }

    #[test]
    fn the_index_knows_what_the_records_say() {
        let (root, entries) = store_with_index();
        let store = Store::open(root.path()).unwrap();
        for recipe in ["r", "another"] {
            let known = store.known_tasks(recipe);
            assert!(entries.iter().all(|(plan, finished)| {
                known.finished(plan, &[]) == Some(Known { finished: finished.clone(), whole: true })
            }));
            assert_eq!(known.finished(&Digest::of(b"unknown"), &[]), None);
            assert_eq!(known.missed.load(Ordering::Relaxed), recipe == "another");
        }
    }

    #[test]
    fn what_went_missing_after_the_index_was_written_is_not_known() {
        let (root, entries) = store_with_index();
        let store = Store::open(root.path()).unwrap();
        fs::remove_file(store.layout.file(Area::Done, &entries[0].0)).unwrap();
        fs::remove_file(store.blob_path(&entries[1].1.record.outputs["a"])).unwrap();
        let known = store.known_tasks("r");
        let finished: Vec<bool> = entries.iter().map(|(plan, _)| known.finished(plan, &[]).is_some()).collect();
        assert_eq!(finished, [false, false, true, true, true]);
    }

    #[test]
    fn a_removed_blob_is_missed_before_and_after_the_index_is_written() {
        let (root, entries) = store_with_index();
        let store = Store::open(root.path()).unwrap();
        let whole = |store: &Store| -> Vec<Option<bool>> {
            let known = store.known_tasks("r");
            entries.iter().map(|(plan, _)| known.finished(plan, REMOVABLE).map(|known| known.whole)).collect()
        };
        store.remove_blob(&entries[2].1.record.outputs["means"]).unwrap();
        let expected = [true, true, false, true, true].map(Some);
        assert_eq!(whole(&store), expected);
        std::thread::sleep(2 * CLOCK_STEP);
        let given = entries.iter().map(|(plan, finished)| (plan, finished, REMOVABLE));
        store.write_index("r", &Digest::of(b"run"), given).unwrap();
        assert_eq!(whole(&store), expected);
        assert_eq!(store.known_tasks("r").finished(&entries[2].0, &[]), None);
    }

    #[test]
    fn an_index_that_was_cut_or_edited_is_passed_over() {
        let (root, mut entries) = store_with_index();
        entries.sort_by_key(|(plan, _)| *plan);
        let path = root.path().join("index/r");
        let bytes = fs::read(&path).unwrap();
        let read = decode(&bytes).unwrap().entries;
        let read: Vec<_> = read.into_iter().map(|(plan, entry)| (plan, entry.finished)).collect();
        assert_eq!(read, entries);
        for position in (0..bytes.len()).step_by(11) {
            assert!(decode(&bytes[..position]).is_none());
            let mut changed = bytes.clone();
            changed[position] ^= 4;
            assert!(decode(&changed).is_none());
        }
    }
}
