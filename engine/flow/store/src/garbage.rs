//! Garbage collection: removes everything that no recent run and no pin needs, and spent blobs of those runs.

use crate::history::{PastRun, newest_runs, read_run, run_numbers};
use crate::layout::{Area, Layout, read_dir_or_nothing};
use crate::locks::lock_file;
use crate::names::is_relative_path;
use crate::pack::{Pack, Packed};
use crate::packs::{PACKED_AREAS, Packs, is_small_and_alone, repack};
use crate::records::{self, ActionRecord};
use crate::scratch::sweep_orphans;
use crate::side_by_side::read_side_by_side;
use crate::spare::sweep_spares;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::Path;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Documents whose files are read at once: what they name is held until all are read.
const PIECE: usize = 4096;

/// Rules of garbage collection.
#[derive(Clone, Debug)]
pub struct GarbageOptions {
    /// Number of newest runs kept of every recipe.
    pub keep_runs: usize,
    /// Age below which files are kept, needed or not.
    pub keep_age: Duration,
    /// Current time.
    pub now: SystemTime,
    /// Number of small files of an area from which on they are packed into one.
    pub pack_from: usize,
    /// Whether to count only.
    pub dry_run: bool,
}

impl GarbageOptions {
    /// Small files from which on packing is worth a pack: 16 MB of blocks.
    pub const PACK_FROM: usize = 4096;
}

/// Counts of removed files, or of files that would be removed in a dry run.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct GarbageReport {
    /// Blobs removed.
    pub blobs: u64,
    /// Bytes of those blobs.
    pub blob_bytes: u64,
    /// Records and documents removed.
    pub records: u64,
    /// Bytes of those records and documents.
    pub record_bytes: u64,
    /// Temporary folders of dead processes removed.
    pub orphans: u64,
    /// Bytes of those folders.
    pub orphan_bytes: u64,
    /// Blobs kept.
    pub kept_blobs: u64,
    /// Bytes of the kept blobs.
    pub kept_blob_bytes: u64,
    /// Small files packed; 0 in a dry run.
    pub packed: u64,
}

/// Removes (or counts) everything in the store at `root` that is older than the limit and needed by no recent run or pin.
///
/// # Errors
/// `store-in-use` while a run is active (not in a dry run), the errors of opening a store, or `machine-io`.
pub fn collect_garbage(root: &Path, options: &GarbageOptions) -> Result<GarbageReport> {
    if Layout::check(root)?.is_none() {
        let message = format!("there is no store at `{}`", root.display());
        return Err(Diagnostic::new("store-not-a-store", Fault::Input, message).hint(
            "name the folder that `cosfly run` had for `--store`; without it that is `.cosfly` in the current folder",
        ));
    }
    let layout = Layout::create_or_check(root)?;
    let failed = |error: io::Error| Diagnostic::io(format!("clean the store `{}`", root.display()), &error);
    let _alone = lock(&layout, options.dry_run)?;
    let needed = mark(&layout, options.keep_runs).map_err(failed)?;
    let mut report = GarbageReport::default();
    (report.orphans, report.orphan_bytes) = sweep_orphans(&layout, options.dry_run).map_err(failed)?;
    // References go before their targets: a crash half way leaves nothing dangling.
    for area in [Area::Done, Area::Builds, Area::Plans, Area::Actions, Area::Blobs] {
        sweep(&layout, area, &needed, options, &mut report).map_err(failed)?;
    }
    for folder in ["out", "failed"] {
        sweep_old(&layout, folder, options, &mut report).map_err(failed)?;
    }
    if !options.dry_run {
        sweep_spares(&layout).map_err(failed)?;
        remove_stale_locks(&layout).map_err(failed)?;
    }
    Ok(report)
}

/// Keeps the newest run of `recipe` from garbage collection under `name`.
pub fn pin(root: &Path, recipe: &str, name: &str) -> Result<()> {
    let layout = Layout::create_or_check(root)?;
    let failed = |error: io::Error| Diagnostic::io(format!("pin `{name}` in `{}`", root.display()), &error);
    let path = pin_path(&layout, name)?;
    let folder = layout.folder("runs").join(recipe);
    let Some(newest) = run_numbers(&folder).map_err(failed)?.pop() else {
        return Err(Diagnostic::new("pin-nothing", Fault::Recipe, format!("the store has no run of `{recipe}`"))
            .hint("run the recipe first"));
    };
    fs::create_dir_all(layout.folder("pins")).map_err(failed)?;
    let temporary = layout.folder("tmp").join(format!("pin-{}", std::process::id()));
    fs::copy(folder.join(format!("{newest:08}")), &temporary).and_then(|_| fs::rename(&temporary, path)).map_err(failed)
}

fn pin_path(layout: &Layout, name: &str) -> Result<std::path::PathBuf> {
    if !is_relative_path(name) || name.contains('/') {
        return Err(Diagnostic::new("pin-bad-name", Fault::Recipe, format!("`{name}` cannot be the name of a pin"))
            .hint("use letters, digits, `-` and `_`"));
    }
    Ok(layout.folder("pins").join(name))
}

fn lock(layout: &Layout, dry_run: bool) -> Result<File> {
    let failed = |error: &io::Error| Diagnostic::io(format!("lock the store `{}`", layout.root.display()), error);
    let file = lock_file(&layout.root.join("locks/garbage")).map_err(|error| failed(&error))?;
    let taken = if dry_run { file.try_lock_shared() } else { file.try_lock() };
    match taken {
        Ok(()) => Ok(file),
        Err(TryLockError::WouldBlock) => Err(Diagnostic::new(
            "store-in-use",
            Fault::Machine,
            format!("another cosfly process is using the store `{}`", layout.root.display()),
        )
        .hint("collect garbage while no run is active")),
        Err(TryLockError::Error(error)) => Err(failed(&error)),
    }
}

/// Digests to keep, and blobs to remove whatever their age.
#[derive(Default)]
pub(crate) struct Needed {
    /// Plans, definitions and all documents that they name.
    documents: BTreeSet<Digest>,
    actions: BTreeSet<Digest>,
    blobs: BTreeSet<Digest>,
    /// Blobs of finished tasks that nothing reads any more.
    spent: BTreeSet<Digest>,
}

/// Names of the spent blobs of each task: those that are spent in every run with the task.
fn spent_names(runs: &[PastRun]) -> BTreeMap<Digest, BTreeSet<&str>> {
    let mut names: BTreeMap<Digest, BTreeSet<&str>> = BTreeMap::new();
    for stage in runs.iter().flat_map(|run| &run.stages) {
        for plan in stage.items.values() {
            let here = || stage.spent.iter().map(String::as_str);
            names
                .entry(*plan)
                .and_modify(|known| known.retain(|name| here().any(|it| it == *name)))
                .or_insert_with(|| here().collect());
        }
    }
    names
}

impl GarbageReport {
    fn count(&mut self, area: Area, keep: bool, bytes: u64) {
        let (count, sum) = match (area, keep) {
            (Area::Blobs, true) => (&mut self.kept_blobs, &mut self.kept_blob_bytes),
            (Area::Blobs, false) => (&mut self.blobs, &mut self.blob_bytes),
            (_, true) => return,
            (_, false) => (&mut self.records, &mut self.record_bytes),
        };
        *count += 1;
        *sum += bytes;
    }
}

impl Needed {
    /// Whether a file of some age stays.
    fn keeps(&self, area: Area, digest: &Digest, age: Duration, options: &GarbageOptions) -> bool {
        let spent = area == Area::Blobs && self.spent.contains(digest);
        (age < options.keep_age && !spent) || self.in_area(area).contains(digest)
    }

    /// Digests to keep in an area.
    pub(crate) fn in_area(&self, area: Area) -> &BTreeSet<Digest> {
        match area {
            Area::Blobs => &self.blobs,
            Area::Actions => &self.actions,
            Area::Done | Area::Plans | Area::Builds => &self.documents,
        }
    }
}

fn mark(layout: &Layout, keep_runs: usize) -> io::Result<Needed> {
    let mut roots = Vec::new();
    for recipe in read_dir_or_nothing(&layout.folder("runs"))? {
        roots.extend(newest_runs(&recipe?.path(), keep_runs)?);
    }
    for pin in read_dir_or_nothing(&layout.folder("pins"))? {
        roots.extend(read_run(&pin?.path()));
    }
    let packs = Packs::default();
    let packed = |area, digest: &Digest| packs.of(layout, area)?.read(digest);
    Ok(needed_by(&roots, &|area, digest| fs::read(layout.file(area, digest)).ok().or_else(|| packed(area, digest))))
}

/// File of a digest in an area; `None` where it is absent.
type ReadFile<'a> = dyn Fn(Area, &Digest) -> Option<Vec<u8>> + Sync + 'a;

/// Everything that the runs `roots` need, and their spent blobs.
pub(crate) fn needed_by(roots: &[PastRun], read: &ReadFile<'_>) -> Needed {
    let spent = spent_names(roots);
    let mut needed = Needed::default();
    let mut next: BTreeSet<Digest> = roots.iter().flat_map(PastRun::digests).collect();
    while !next.is_empty() {
        let documents = Vec::from_iter(std::mem::take(&mut next));
        needed.documents.extend(&documents);
        for piece in documents.chunks(PIECE) {
            for (document, found) in piece.iter().zip(read_side_by_side(piece, |document| Found::of(read, document))) {
                next.extend(found.named.into_iter().filter(|named| !needed.documents.contains(named)));
                if let Some((action, record)) = found.finished {
                    needed.actions.insert(action);
                    mark_outputs(record.as_ref(), spent.get(document), &mut needed);
                }
            }
        }
    }
    let Needed { blobs, spent, .. } = &mut needed;
    spent.retain(|blob| !blobs.contains(blob));
    needed
}

/// Names in the files of a document.
struct Found {
    /// Other documents.
    named: Vec<Digest>,
    /// Action of the finished task and its record.
    finished: Option<(Digest, Option<ActionRecord>)>,
}

impl Found {
    fn of(read: &ReadFile<'_>, document: &Digest) -> Self {
        let done = read(Area::Done, document).and_then(|bytes| records::decode_done(document, &bytes));
        let record = |action: &Digest| records::decode(action, &read(Area::Actions, action)?);
        let finished = done.map(|action| (action, record(&action)));
        Self { named: documents_named_in(read, document), finished }
    }
}

fn mark_outputs(record: Option<&ActionRecord>, spent: Option<&BTreeSet<&str>>, needed: &mut Needed) {
    for (name, blob) in record.iter().flat_map(|record| record.outputs.iter()) {
        let is_spent = spent.is_some_and(|names| names.contains(name.as_str()));
        if is_spent { &mut needed.spent } else { &mut needed.blobs }.insert(blob.digest);
    }
}

/// Digests in a plan document, which are the names of other documents.
fn documents_named_in(read: &ReadFile<'_>, document: &Digest) -> Vec<Digest> {
    let Some(bytes) = read(Area::Plans, document) else { return Vec::new() };
    let mut named = Vec::new();
    let mut waiting: Vec<serde_json::Value> = serde_json::from_slice(&bytes).into_iter().collect();
    while let Some(value) = waiting.pop() {
        match value {
            serde_json::Value::String(text) => named.extend(text.parse::<Digest>()),
            serde_json::Value::Array(values) => waiting.extend(values),
            serde_json::Value::Object(members) => waiting.extend(members.into_iter().map(|(_, value)| value)),
            _ => {}
        }
    }
    named
}

fn sweep(
    layout: &Layout,
    area: Area,
    needed: &Needed,
    options: &GarbageOptions,
    report: &mut GarbageReport,
) -> io::Result<()> {
    let listed = layout.list(area)?;
    let mut small = Vec::new();
    for digest in &listed {
        let path = layout.file(area, digest);
        let metadata = match fs::symlink_metadata(&path) {
            // A run may go on during a dry run, and remove a damaged blob.
            Err(error) if error.kind() == io::ErrorKind::NotFound => continue,
            metadata => metadata?,
        };
        let keep = needed.keeps(area, digest, age_of(&metadata, options), options);
        if !keep && !options.dry_run {
            remove(&path, &metadata)?;
        }
        if keep && needed.in_area(area).contains(digest) && is_small_and_alone(&metadata) {
            small.push(*digest);
        }
        report.count(area, keep, metadata.len());
    }
    let stays = |packed: &Packed| {
        let changed = UNIX_EPOCH + Duration::from_secs(packed.changed_s);
        needed.keeps(area, &packed.digest, options.now.duration_since(changed).unwrap_or_default(), options)
    };
    let mut some_go = false;
    for packed in Packs::default().of(layout, area).into_iter().flat_map(Pack::entries) {
        let keep = stays(&packed);
        some_go |= !keep;
        if listed.binary_search(&packed.digest).is_err() {
            report.count(area, keep, packed.bytes.len() as u64);
        }
    }
    let many = PACKED_AREAS.contains(&area) && small.len() >= options.pack_from;
    if !options.dry_run && (many || some_go) {
        report.packed += repack(layout, area, &small, &stays)?;
    }
    Ok(())
}

/// Removes old records of delivered folders, which are then read once more, and old failures of tasks.
fn sweep_old(layout: &Layout, folder: &str, options: &GarbageOptions, report: &mut GarbageReport) -> io::Result<()> {
    for entry in read_dir_or_nothing(&layout.folder(folder))? {
        let path = entry?.path();
        let metadata = fs::symlink_metadata(&path)?;
        if age_of(&metadata, options) >= options.keep_age {
            if !options.dry_run {
                remove(&path, &metadata)?;
            }
            report.records += 1;
            report.record_bytes += metadata.len();
        }
    }
    Ok(())
}

fn age_of(metadata: &fs::Metadata, options: &GarbageOptions) -> Duration {
    metadata.modified().ok().and_then(|made| options.now.duration_since(made).ok()).unwrap_or_default()
}

/// Removes a file, or a folder in its place.
fn remove(path: &Path, metadata: &fs::Metadata) -> io::Result<()> {
    let removed = if metadata.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
    removed.or_else(|error| if error.kind() == io::ErrorKind::NotFound { Ok(()) } else { Err(error) })
}

/// Removes lock files of killed processes; no living process holds one during garbage collection.
fn remove_stale_locks(layout: &Layout) -> io::Result<()> {
    for entry in read_dir_or_nothing(&layout.folder("locks"))? {
        let entry = entry?;
        let name = entry.file_name();
        if name.to_str().is_some_and(|name| name.starts_with("task-") || name.starts_with("out-")) {
            fs::remove_file(entry.path())?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{PastRun, PastStage, Store};
    use cosfly_blobs::OutputSink;
    use cosfly_stage::Produced;
    use std::collections::BTreeMap;

    /// A run of one task with one blob, remembered.
    fn run(store: &Store, text: &str) {
        run_with_spent(store, text, vec![]);
    }

    fn run_with_spent(store: &Store, text: &str, spent: Vec<String>) {
        let definition = format!("{{\"what\":\"{text}\"}}");
        let definition_digest = Digest::of(definition.as_bytes());
        let document = format!("{{\"definition\":\"{definition_digest}\"}}");
        let plan = Digest::of(document.as_bytes());
        let action = Digest::of(format!("action {text}").as_bytes());
        let mut sink = store.sink();
        sink.put("a", text.as_bytes()).unwrap();
        sink.settle(&action, Produced::default()).unwrap();
        store.put_document(&definition_digest, &definition).unwrap();
        store.publish_done(&plan, &document, &action).unwrap();
        let items = BTreeMap::from([("all".to_owned(), plan)]);
        let stage = PastStage { items, spent, ..PastStage::new("s".to_owned(), definition_digest) };
        store.record_run("r", &PastRun { stages: vec![stage] }).unwrap();
    }

    fn collect(root: &Path, keep_runs: usize, age_s: u64, dry_run: bool) -> GarbageReport {
        let now = SystemTime::now() + Duration::from_secs(3600);
        let keep_age = Duration::from_secs(age_s);
        collect_garbage(root, &GarbageOptions { keep_runs, keep_age, now, pack_from: usize::MAX, dry_run }).unwrap()
    }

    #[test]
    fn spent_blobs_go_whatever_their_age_unless_a_run_needs_them() {
        let root = tempfile::tempdir().unwrap();
        let root = root.path();
        let spent = || vec!["a".to_owned()];
        let store = Store::open(root).unwrap();
        run_with_spent(&store, "one", spent());
        run_with_spent(&store, "two", spent());
        run(&store, "two");
        drop(store);
        let report = collect(root, 10, 7200, false);
        assert_eq!((report.blobs, report.kept_blobs, report.records), (1, 1, 0));
    }

    #[test]
    fn what_recent_runs_and_pins_need_stays_and_the_rest_goes() {
        let root = tempfile::tempdir().unwrap();
        let root = root.path();
        let nowhere = root.join("nowhere");
        let refusal = collect_garbage(
            &nowhere,
            &GarbageOptions {
                keep_runs: 1,
                keep_age: Duration::ZERO,
                now: SystemTime::now(),
                pack_from: 1,
                dry_run: true,
            },
        )
        .unwrap_err();
        assert!(refusal.code == "store-not-a-store" && !nowhere.exists(), "{refusal}");
        let store = Store::open(root).unwrap();
        run(&store, "oldest");
        pin(root, "r", "paper").unwrap();
        for text in ["older", "old", "new"] {
            run(&store, text);
        }
        let options = GarbageOptions {
            keep_runs: 2,
            keep_age: Duration::ZERO,
            now: SystemTime::now(),
            pack_from: 1,
            dry_run: false,
        };
        assert_eq!(collect_garbage(root, &options).unwrap_err().code, "store-in-use");
        drop(store);
        let count = |report: &GarbageReport| (report.blobs, report.blob_bytes, report.records, report.kept_blobs);
        assert_eq!(count(&collect(root, 2, 7200, false)), (0, 0, 0, 4), "all is younger than two hours");
        let predicted = collect(root, 2, 0, true);
        assert_eq!(count(&predicted), (1, 5, 4, 3));
        assert_eq!(collect(root, 2, 0, false), predicted);
        assert_eq!(count(&collect(root, 2, 0, false)), (0, 0, 0, 3));
        fs::remove_file(root.join("pins/paper")).unwrap();
        assert_eq!(count(&collect(root, 2, 0, false)), (1, 6, 4, 2));
        let store = Store::open(root).unwrap();
        let done = store.layout.list(Area::Done).unwrap();
        assert_eq!(done.len(), 2);
        assert!(done.iter().all(|plan| store.holds(&store.finished(plan).unwrap().record)));
    }
}
