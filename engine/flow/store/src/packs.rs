//! Packed files behind the folders of a store: what has no file of its own may be in a pack.
//!
//! Garbage collection packs, alone in the store, what runs still need; a file of its own comes before a packed one.

use crate::layout::{Area, Layout};
use crate::pack::{LARGEST, Pack, PackWriter, Packed};
use crate::records;
use crate::side_by_side::read_side_by_side;
use cosfly_fingerprint::Digest;
use std::fs::{self, File};
use std::io;
use std::iter::Peekable;
use std::path::PathBuf;
use std::sync::OnceLock;
use std::time::UNIX_EPOCH;

/// Areas that are packed.
pub(crate) const PACKED_AREAS: [Area; 4] = [Area::Blobs, Area::Actions, Area::Done, Area::Plans];
/// Files that are read before they are written to a pack.
const PIECE: usize = 4096;

/// Packs of an open store, each opened when it is first asked.
#[derive(Debug, Default)]
pub(crate) struct Packs([OnceLock<Option<Pack>>; PACKED_AREAS.len()]);

impl Packs {
    /// The pack of an area; `None` where there is none.
    pub(crate) fn of(&self, layout: &Layout, area: Area) -> Option<&Pack> {
        let place = PACKED_AREAS.iter().position(|packed| *packed == area)?;
        self.0[place].get_or_init(|| Pack::open(&pack_path(layout, area))).as_ref()
    }
}

/// Whether bytes are what a name of the area promises.
pub(crate) fn is_sound(area: Area, digest: &Digest, bytes: &[u8]) -> bool {
    match area {
        Area::Blobs | Area::Plans => Digest::of(bytes) == *digest,
        Area::Actions | Area::Done => records::content_for(digest, bytes).is_some(),
        Area::Builds => true,
    }
}

pub(crate) fn pack_path(layout: &Layout, area: Area) -> PathBuf {
    layout.folder("packs").join(area.folder())
}

/// Moves small files of an area and what stays of its pack into a new pack; gives the number of files that were moved.
/// Nobody else uses the store. After a crash a file is in its folder, in the pack, or in both.
pub(crate) fn repack(
    layout: &Layout,
    area: Area,
    loose: &[Digest],
    stays: &dyn Fn(&Packed) -> bool,
) -> io::Result<u64> {
    let path = pack_path(layout, area);
    let folder = layout.folder("packs");
    fs::create_dir_all(&folder)?;
    let temporary = layout.folder("tmp").join(format!("pack-{}", std::process::id()));
    let mut writer = PackWriter::new(File::create(&temporary)?)?;
    let old = Pack::open(&path);
    let mut old = old.iter().flat_map(Pack::entries).filter(|packed| stays(packed)).peekable();
    let mut moved = Vec::new();
    for piece in loose.chunks(PIECE) {
        let read = read_side_by_side(piece, |digest| read_loose(layout, area, digest));
        for packed in read.into_iter().flatten() {
            add_before(&mut writer, &mut old, Some(&packed.digest))?;
            // A file of its own comes before a packed one.
            old.next_if(|older| older.digest == packed.digest);
            writer.add(&packed)?;
            moved.push(packed.digest);
        }
    }
    add_before(&mut writer, &mut old, None)?;
    if writer.finish()? == 0 {
        fs::remove_file(&temporary)?;
        fs::remove_file(&path)
            .or_else(|error| if error.kind() == io::ErrorKind::NotFound { Ok(()) } else { Err(error) })?;
    } else {
        fs::rename(&temporary, &path)?;
    }
    if cfg!(unix) {
        File::open(&folder)?.sync_all()?;
    }
    for removed in read_side_by_side(&moved, |digest| fs::remove_file(layout.file(area, digest))) {
        removed?;
    }
    Ok(moved.len() as u64)
}

/// Adds the old entries before `limit`, or all of them.
fn add_before(
    writer: &mut PackWriter,
    old: &mut Peekable<impl Iterator<Item = Packed>>,
    limit: Option<&Digest>,
) -> io::Result<()> {
    while let Some(older) = old.next_if(|older| limit.is_none_or(|limit| older.digest < *limit)) {
        writer.add(&older)?;
    }
    Ok(())
}

/// A small file that only the store has; `None` for any other and a damaged one.
fn read_loose(layout: &Layout, area: Area, digest: &Digest) -> Option<Packed> {
    let path = layout.file(area, digest);
    let metadata = fs::symlink_metadata(&path).ok()?;
    if !is_small_and_alone(&metadata) {
        return None;
    }
    let changed = metadata.modified().ok()?.duration_since(UNIX_EPOCH).unwrap_or_default();
    let bytes = fs::read(&path).ok().filter(|bytes| is_sound(area, digest, bytes))?;
    Some(Packed { digest: *digest, changed_s: changed.as_secs(), bytes })
}

/// Whether packing a file frees its blocks: it is small, and no delivered folder has a link to it.
pub(crate) fn is_small_and_alone(metadata: &fs::Metadata) -> bool {
    #[cfg(unix)]
    let alone = std::os::unix::fs::MetadataExt::nlink(metadata) == 1;
    #[cfg(not(unix))]
    let alone = false;
    metadata.is_file() && metadata.len() <= LARGEST && alone
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::Store;
    use crate::{FolderTimes, GarbageOptions, GarbageReport, IndexedTask, PastRun, PastStage, collect_garbage};
    use cosfly_blobs::OutputSink;
    use cosfly_stage::{BlobSource, Produced};
    use std::collections::BTreeMap;
    use std::io::Read;
    use std::path::Path;
    use std::time::{Duration, SystemTime};

    /// A task with a blob of its own text, finished.
    fn finish(store: &Store, text: &str) -> Digest {
        let document = format!("\"plan of {text}\"");
        let (plan, action) = (Digest::of(document.as_bytes()), Digest::of(text.as_bytes()));
        let mut sink = store.sink();
        sink.put("a", text.as_bytes()).unwrap();
        sink.settle(&action, Produced::default()).unwrap();
        store.publish_done(&plan, &document, &action).unwrap();
        plan
    }

    fn run(store: &Store, texts: &[String]) -> Vec<Digest> {
        let plans: Vec<Digest> = texts.iter().map(|text| finish(store, text)).collect();
        let items = texts.iter().cloned().zip(plans.iter().copied()).collect::<BTreeMap<_, _>>();
        let stage = PastStage { items, ..PastStage::new("s".to_owned(), Digest::of(b"definition")) };
        store.record_run("r", &PastRun { stages: vec![stage] }).unwrap();
        plans
    }

    fn texts(numbers: std::ops::Range<usize>) -> Vec<String> {
        numbers.map(|number| format!("text {number}")).collect()
    }

    fn collect(root: &Path, keep_runs: usize) -> GarbageReport {
        let now = SystemTime::now() + Duration::from_secs(3600);
        let options = GarbageOptions { keep_runs, keep_age: Duration::ZERO, now, pack_from: 1, dry_run: false };
        let predicted = collect_garbage(root, &GarbageOptions { dry_run: true, ..options.clone() }).unwrap();
        let report = collect_garbage(root, &options).unwrap();
        assert_eq!(GarbageReport { packed: 0, ..report.clone() }, predicted);
        report
    }

    fn files_in(root: &Path, folder: &str) -> usize {
        let shards = fs::read_dir(root.join(folder)).into_iter().flatten();
        shards.map(|shard| fs::read_dir(shard.unwrap().path()).unwrap().count()).sum()
    }

    /// Everything that was published reads back, by all ways.
    fn assert_known(root: &Path, texts: &[String], plans: &[Digest]) {
        let store = Store::open(root).unwrap();
        let known = store.known_tasks("r");
        for (text, plan) in texts.iter().zip(plans) {
            assert!(known.finished(plan, &[]).is_some_and(|known| known.whole), "{text}");
            let finished = store.finished(plan).unwrap();
            assert!(store.was_finished(plan) && store.holds(&finished.record));
            assert_eq!(store.document(plan), Some(format!("plan of {text}").into()));
            let blob = finished.record.outputs["a"];
            assert_eq!(store.read(&blob).unwrap(), text.as_bytes());
            let mut read = String::new();
            store.open(&blob).unwrap().read_to_string(&mut read).unwrap();
            assert_eq!(read, *text);
        }
    }

    #[test]
    fn what_is_packed_reads_back_runs_again_and_is_packed_once() {
        let root = tempfile::tempdir().unwrap();
        let root = root.path();
        let all = texts(0..50);
        let plans = run(&Store::open(root).unwrap(), &all);
        assert_eq!(collect(root, 1).packed, 4 * 50);
        assert!(["cas", "ac", "done", "plan"].iter().all(|folder| files_in(root, folder) == 0));
        assert_known(root, &all, &plans);
        // A blob that was opened has a file again, until the next collection; tasks that run again make no other.
        assert_eq!(files_in(root, "cas"), 50);
        run(&Store::open(root).unwrap(), &all);
        assert_eq!(files_in(root, "plan"), 0);
        let report = collect(root, 1);
        assert_eq!((report.kept_blobs, report.blobs, report.records), (50, 0, 0));
        assert!(["cas", "ac", "done", "plan"].iter().all(|folder| files_in(root, folder) == 0));
        assert_known(root, &all, &plans);
    }

    #[test]
    fn packed_files_that_no_run_needs_go_and_no_index_knows_them() {
        let root = tempfile::tempdir().unwrap();
        let root = root.path();
        let plans = run(&Store::open(root).unwrap(), &texts(0..20));
        collect(root, 1);
        {
            let store = Store::open(root).unwrap();
            std::thread::sleep(Duration::from_millis(50));
            let finished: Vec<_> = plans.iter().map(|plan| store.finished(plan).unwrap()).collect();
            let tasks = plans.iter().zip(&finished);
            let tasks = tasks.map(|(plan, finished)| IndexedTask { plan, finished, removable: &[], was_whole: None });
            store.write_index("r", &Digest::of(b"run"), &FolderTimes::default(), tasks).unwrap();
            let unchanged = store.known_tasks("r").unchanged_folders();
            assert!(unchanged.done.iter().any(|time| *time != 0) && unchanged.blobs.iter().any(|time| *time != 0));
        }
        assert_known(root, &texts(0..20), &plans);
        run(&Store::open(root).unwrap(), &texts(10..30));
        let report = collect(root, 1);
        assert_eq!((report.blobs, report.records, report.kept_blobs), (10, 30, 20));
        let store = Store::open(root).unwrap();
        let known = store.known_tasks("r");
        let lasts: Vec<bool> = plans.iter().map(|plan| known.finished(plan, &[]).is_some()).collect();
        assert_eq!(lasts, [[false; 10], [true; 10]].concat());
        drop(store);
        collect(root, 0);
        assert!(fs::read_dir(root.join("packs")).unwrap().next().is_none());
        assert!(Store::open(root).unwrap().finished(&plans[15]).is_none());
    }

    #[test]
    fn a_crash_between_pack_and_removal_and_a_damaged_pack_lose_nothing_that_is_not_made_again() {
        let root = tempfile::tempdir().unwrap();
        let root = root.path();
        let all = texts(0..40);
        let plans = run(&Store::open(root).unwrap(), &all);
        collect(root, 1);
        // As after a crash: some files were not removed yet.
        run(&Store::open(root).unwrap(), &all[..20]);
        run(&Store::open(root).unwrap(), &all);
        assert_known(root, &all, &plans);
        collect(root, 1);
        for area in PACKED_AREAS {
            let path = root.join("packs").join(area.folder());
            let mut bytes = fs::read(&path).unwrap();
            bytes[14] ^= 0x55; // the start of the first page, which is the only one
            fs::write(&path, bytes).unwrap();
        }
        let store = Store::open(root).unwrap();
        assert!(plans.iter().all(|plan| store.finished(plan).is_none() && store.document(plan).is_none()));
        let blob = cosfly_blobs::BlobRef { digest: Digest::of(b"text 3"), bytes: 6 };
        assert_eq!(store.read(&blob).unwrap_err().code, "store-blob-lost");
        assert!(!store.holds_blob(&blob));
        drop(store);
        run(&Store::open(root).unwrap(), &all);
        assert_known(root, &all, &plans);
    }

    #[test]
    fn a_file_that_a_delivered_folder_shares_or_a_damaged_one_is_not_packed() {
        let root = tempfile::tempdir().unwrap();
        let store = Store::open(root.path()).unwrap();
        let plans = run(&store, &texts(0..4));
        let blob = |plan: &Digest| store.blob_path(&store.finished(plan).unwrap().record.outputs["a"]);
        fs::hard_link(blob(&plans[0]), root.path().join("delivered")).unwrap();
        fs::remove_file(blob(&plans[1])).unwrap();
        fs::write(blob(&plans[1]), "texT 1").unwrap();
        drop(store);
        assert_eq!(collect(root.path(), 1).packed, 4 * 4 - 2);
        assert_eq!(files_in(root.path(), "cas"), 2);
    }
}
