//! A cache of finished tasks in one file, so that a run with everything cached reads one file instead of thousands.
//!
//! The index holds the records of the latest run of a recipe and the time of last change of each folder of `done` and `cas`. A
//! folder unchanged since then has lost no file, so its files need not be checked one by one. (Damage inside a file is
//! found when the file is read.)

use crate::fault::PublishStep;
use crate::index_format::{Entry, FolderTimes, Index, SHARDS, Stamps, encode};
use crate::layout::{Area, Layout};
use crate::packs::pack_path;
use crate::present::Present;
use crate::records::Finished;
use crate::store::Store;
use cosfly_blobs::BlobRef;
use cosfly_diagnose::Result;
use cosfly_fingerprint::Digest;
use std::fs;
use std::path::Path;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Resolution of the file system's clock: a folder that changed within this time may change again with the same time
/// stamp.
const CLOCK_STEP: Duration = Duration::from_millis(20);
/// Number of changed folders above which a new index is written.
const MOST_CHANGED: usize = SHARDS / 4;

/// Finished tasks, from the index of a recipe and from the records themselves.
pub struct KnownTasks<'s> {
    store: &'s Store,
    index: Index,
    /// Per folder: whether no file went missing since the index was written.
    done_is_whole: Vec<bool>,
    blobs_are_whole: Vec<bool>,
    /// Names in the folders of `done`, each read on demand.
    done: Vec<OnceLock<Vec<Digest>>>,
    missed: AtomicBool,
}

/// A finished task for the index.
pub struct IndexedTask<'e> {
    /// Digest of the task's plan.
    pub plan: &'e Digest,
    /// Result of the task.
    pub finished: &'e Finished,
    /// Names of blobs that may be removed.
    pub removable: &'e [&'e str],
    /// Whether all blobs were there when the run was planned; `None` where the task was not finished then.
    pub was_whole: Option<bool>,
}

/// A finished task.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FinishedTask {
    /// Result of the task.
    pub finished: Finished,
    /// Whether all blobs are there, those that may be removed as well.
    pub whole: bool,
}

impl Store {
    /// Finished tasks; fast for those of the latest run of `recipe`.
    pub fn known_tasks(&self, recipe: &str) -> KnownTasks<'_> {
        let bytes = fs::read(self.layout.folder("index").join(recipe)).unwrap_or_default();
        let index = Index::decode(bytes).unwrap_or_default();
        let whole = |area, old: &Stamps| -> Vec<bool> {
            if old.len() != SHARDS {
                return vec![false; SHARDS];
            }
            let now = stamps(&self.layout, area);
            old.iter().zip(now).map(|(old, now)| *old != 0 && *old == now).collect()
        };
        KnownTasks {
            store: self,
            done_is_whole: whole(Area::Done, &index.times.done),
            blobs_are_whole: whole(Area::Blobs, &index.times.blobs),
            index,
            done: (0..SHARDS).map(|_| OnceLock::new()).collect(),
            missed: AtomicBool::new(false),
        }
    }

    /// Replaces the index of `recipe` by the finished tasks of its run `run`. `before` are the folders that had lost nothing when the
    /// run was planned: those that have not changed since need not be listed.
    pub fn write_index<'e>(
        &self,
        recipe: &str,
        run: &Digest,
        before: &FolderTimes,
        tasks: impl Iterator<Item = IndexedTask<'e>>,
    ) -> Result<()> {
        // Folders that changed a moment ago have times that can be relied on after a moment.
        std::thread::sleep(CLOCK_STEP + CLOCK_STEP / 4);
        // The times are read before the files: a file that goes missing in between changes a time.
        let now = self.file_system_time()?;
        let reliable = |area| -> Stamps {
            let limit = now.saturating_sub(nanoseconds(CLOCK_STEP));
            stamps(&self.layout, area).into_iter().map(|stamp| if stamp < limit { stamp } else { 0 }).collect()
        };
        let times = FolderTimes { done: reliable(Area::Done), blobs: reliable(Area::Blobs) };
        // Folders are listed, which costs a tenth of a look at each file. Sizes are checked where blobs are read.
        let list = |area, now: &Stamps, before: &Stamps| {
            // Of what is in the remote alone the folders know nothing.
            let may_have_changed = |shard: usize| now[shard] == 0 || before.get(shard) != Some(&now[shard]);
            Present::of(self, area, |shard| self.remote.is_some() || may_have_changed(shard))
        };
        let done = list(Area::Done, &times.done, &before.done)?;
        let blobs = list(Area::Blobs, &times.blobs, &before.blobs)?;
        let there = |task: IndexedTask<'e>| {
            let (mut lasts, mut whole) = (done.holds(task.plan).unwrap_or(true), true);
            for (name, blob) in task.finished.record.outputs.iter() {
                let may_go = task.removable.contains(&name.as_str());
                let unchanged = || !may_go || task.was_whole.unwrap_or_else(|| self.holds_blob(blob));
                if !blobs.holds(&blob.digest).unwrap_or_else(unchanged) && !self.remote_holds(&blob.digest) {
                    whole = false;
                    lasts &= may_go;
                }
            }
            lasts.then_some((task.plan, task.finished, whole))
        };
        let mut entries: Vec<_> = tasks.filter_map(there).collect();
        entries.sort_unstable_by_key(|(plan, ..)| **plan);
        let pieces = encode(run, &times, entries.into_iter());
        let path = self.layout.folder("index").join(recipe);
        self.write_pieces(&path, &pieces.each_ref().map(Vec::as_slice), PublishStep::WriteRun, PublishStep::RenameRun)
    }

    /// Current time by the clock of the store's file system.
    fn file_system_time(&self) -> Result<u64> {
        let probe = self.write_temporary(&[], 0o644, PublishStep::WriteRun)?;
        let now = stamp(&probe);
        let _ = fs::remove_file(&probe);
        Ok(now)
    }
}

impl KnownTasks<'_> {
    /// A task that is finished and has all its blobs but those named in `removable`.
    pub fn finished(&self, plan: &Digest, removable: &[&str]) -> Option<FinishedTask> {
        let shard = usize::from(plan.0[0]);
        let indexed = self.index.number_of(plan);
        let is_done =
            (indexed.is_some() && self.done_is_whole[shard]) || self.done_in(shard).binary_search(plan).is_ok();
        let is_done = is_done || self.store.is_packed(Area::Done, plan);
        if !is_done && self.store.remote.is_none() {
            return None;
        }
        if let Some(known) = indexed.and_then(|number| self.known(self.index.entry(number)?, removable)) {
            return Some(known);
        }
        let finished = self.store.finished(plan)?;
        if !self.store.holds_lasting(&finished.record, removable) {
            return None;
        }
        self.missed.store(true, Ordering::Relaxed);
        let whole = removable.is_empty() || self.store.holds(&finished.record);
        Some(FinishedTask { finished, whole })
    }

    /// Times of the folders that lost nothing since the index was written; 0 for the others.
    pub fn unchanged_folders(&self) -> FolderTimes {
        let times = |whole: &[bool], times: &Stamps| {
            whole.iter().zip(times).map(|(whole, time)| if *whole { *time } else { 0 }).collect()
        };
        FolderTimes {
            done: times(&self.done_is_whole, &self.index.times.done),
            blobs: times(&self.blobs_are_whole, &self.index.times.blobs),
        }
    }

    /// Whether the index is of the run `run` and as good as a new one.
    pub fn is_current(&self, run: &Digest) -> bool {
        let changed = |whole: &[bool]| whole.iter().filter(|whole| !**whole).count() > MOST_CHANGED;
        self.index.run.as_ref() == Some(run)
            && !self.missed.load(Ordering::Relaxed)
            && !changed(&self.done_is_whole)
            && !changed(&self.blobs_are_whole)
    }

    /// State of an indexed result; `None` where a lasting blob is missing.
    fn known(&self, Entry { finished, whole }: Entry, removable: &[&str]) -> Option<FinishedTask> {
        let is_unchanged = |blob: &BlobRef| self.blobs_are_whole[usize::from(blob.digest.0[0])];
        let holds = |blob: &BlobRef| is_unchanged(blob) || self.store.holds_blob(blob);
        if !whole && removable.is_empty() {
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
        Some(FinishedTask { finished, whole })
    }

    fn done_in(&self, shard: usize) -> &[Digest] {
        // An unreadable folder counts as empty.
        self.done[shard].get_or_init(|| self.store.layout.list_shard(Area::Done, shard as u8).unwrap_or_default())
    }
}

/// Times of last change of the folders of an area, or of its pack where that is younger; 0 for absent folders.
fn stamps(layout: &Layout, area: Area) -> Stamps {
    let folder = layout.folder(area.folder());
    let pack = pack_path(layout, area);
    let pack = pack.exists().then(|| stamp(&pack));
    let younger = |folder: u64| pack.map_or(folder, |pack| if folder.min(pack) == 0 { 0 } else { folder.max(pack) });
    (0..SHARDS).map(|shard| younger(stamp(&folder.join(format!("{shard:02x}"))))).collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_blobs::OutputSink;
    use cosfly_stage::Produced;
    use std::collections::BTreeMap;

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
        write(&store, &FolderTimes::default(), &entries, [None; 5]);
        (root, entries)
    }

    fn write(store: &Store, before: &FolderTimes, entries: &[(Digest, Finished)], was_whole: [Option<bool>; 5]) {
        let tasks = entries.iter().zip(was_whole);
        let tasks =
            tasks.map(|((plan, finished), was_whole)| IndexedTask { plan, finished, removable: REMOVABLE, was_whole });
        store.write_index("r", &Digest::of(b"run"), before, tasks).unwrap();
    }

    #[test]
    fn the_index_knows_what_the_records_say() {
        let (root, entries) = store_with_index();
        let store = Store::open(root.path()).unwrap();
        for recipe in ["r", "another"] {
            let known = store.known_tasks(recipe);
            assert!(entries.iter().all(|(plan, finished)| {
                known.finished(plan, &[]) == Some(FinishedTask { finished: finished.clone(), whole: true })
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
        write(&store, &FolderTimes::default(), &entries, [None; 5]);
        assert_eq!(whole(&store), expected);
        // Another index, for which only folders that changed are listed.
        let before = store.known_tasks("r").unchanged_folders();
        assert!(before.done.iter().any(|time| *time != 0) && before.blobs.iter().any(|time| *time != 0));
        store.remove_blob(&entries[3].1.record.outputs["means"]).unwrap();
        std::thread::sleep(2 * CLOCK_STEP);
        write(&store, &before, &entries, [Some(true), Some(true), None, Some(true), None]);
        assert_eq!(whole(&store), [true, true, false, false, true].map(Some));
        fs::remove_file(store.layout.file(Area::Done, &entries[4].0)).unwrap();
        fs::remove_file(store.blob_path(&entries[1].1.record.outputs["a"])).unwrap();
        let before = store.known_tasks("r").unchanged_folders();
        std::thread::sleep(2 * CLOCK_STEP);
        write(&store, &before, &entries, [true, true, false, false, true].map(Some));
        let bytes = fs::read(root.path().join("index/r")).unwrap();
        let indexed = |plan| Index::decode(bytes.clone()).unwrap().number_of(plan).is_some();
        assert_eq!([0, 1, 2, 3, 4].map(|place: usize| indexed(&entries[place].0)), [true, false, true, true, false]);
        assert_eq!(store.known_tasks("r").finished(&entries[2].0, &[]), None);
    }

    #[test]
    fn an_index_that_was_cut_or_edited_is_passed_over() {
        let (root, mut entries) = store_with_index();
        entries.sort_by_key(|(plan, _)| *plan);
        let path = root.path().join("index/r");
        let bytes = fs::read(&path).unwrap();
        let read = Index::decode(bytes.clone()).unwrap().all();
        let read: Vec<_> = read.into_iter().map(|(plan, entry)| (plan, entry.finished)).collect();
        assert_eq!(read, entries);
        for position in (0..bytes.len()).step_by(11) {
            assert!(Index::decode(bytes[..position].to_vec()).is_none());
            let mut changed = bytes.clone();
            changed[position] ^= 4;
            assert!(Index::decode(changed).is_none());
        }
    }
}
