//! An open store: its state in memory, its records and documents.

use crate::decoded::DecodeCache;
use crate::durability::Durability;
use crate::fault::{FaultPoints, NoFaults, PublishStep};
use crate::layout::{Area, Layout};
use crate::locks::{TaskLock, lock_file};
use crate::packs::Packs;
use crate::records::{self, ActionRecord, Finished};
use crate::remote::Remote;
use crate::scratch::{Scratch, sweep_orphans};
use crate::side_by_side::{PER_THREAD, side_by_side};
use cosfly_blobs::BlobRef;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

/// A store opened by this process. Any number of processes may have it open at once.
pub struct Store {
    pub(crate) layout: Layout,
    pub(crate) scratch: Scratch,
    pub(crate) faults: Arc<dyn FaultPoints>,
    pub(crate) durability: Durability,
    /// First bytes of the digests of blobs whose size and digest this process has checked, or that it wrote itself.
    pub(crate) checked: Mutex<BTreeSet<u64>>,
    pub(crate) decoded: DecodeCache,
    /// Store that the folder is a cache of.
    pub(crate) remote: Option<Arc<dyn Remote>>,
    /// First error of the remote that was not told yet.
    pub(crate) remote_trouble: Mutex<Option<Box<Diagnostic>>>,
    /// Blobs that the remote should have and has not.
    pub(crate) remote_lost: Mutex<BTreeSet<Digest>>,
    /// Small files that have no file of their own.
    pub(crate) packs: Packs,
    /// Names that a pack has, whose bytes are damaged.
    pub(crate) packed_lost: Mutex<BTreeSet<Digest>>,
    /// Lock that runs share, and that garbage collection holds exclusively.
    _garbage_lock: Option<File>,
}

impl Store {
    /// Opens the store at `root`, creating it where nothing exists yet. Waits while garbage is being collected.
    ///
    /// # Errors
    /// `store-newer-version`, `store-damaged-format`, `store-not-a-store`, or `machine-io`.
    pub fn open(root: &Path) -> Result<Self> {
        Self::open_with_faults(root, Arc::new(NoFaults))
    }

    /// Like [`Self::open`], with `faults` that may fail steps of publishing.
    pub fn open_with_faults(root: &Path, faults: Arc<dyn FaultPoints>) -> Result<Self> {
        Self::open_as(root, faults, true)
    }

    /// Like [`Self::open`], for one of very many processes: leaves it to others to remove what dead processes left, since
    /// asking each living one for its lock would cost as many operations as there are processes.
    ///
    /// # Errors
    /// The errors of [`Self::open`].
    pub fn open_as_worker(root: &Path) -> Result<Self> {
        Self::open_as(root, Arc::new(NoFaults), false)
    }

    fn open_as(root: &Path, faults: Arc<dyn FaultPoints>, sweep: bool) -> Result<Self> {
        let layout = Layout::create_or_check(root)?;
        let failed = |error: io::Error| Diagnostic::io(format!("lock the store `{}`", root.display()), &error);
        let garbage_lock = lock_file(&layout.root.join("locks/garbage")).map_err(failed)?;
        garbage_lock.lock_shared().map_err(failed)?;
        if sweep {
            sweep_orphans(&layout, false)
                .map_err(|error| Diagnostic::io(format!("clean `{}`", layout.folder("tmp").display()), &error))?;
        }
        let durability = Durability::of(&layout)?;
        let scratch = Scratch::create(&layout)?;
        Ok(Self {
            layout,
            scratch,
            faults,
            durability,
            checked: Mutex::default(),
            decoded: DecodeCache::default(),
            remote: None,
            remote_trouble: Mutex::default(),
            remote_lost: Mutex::default(),
            packs: Packs::default(),
            packed_lost: Mutex::default(),
            _garbage_lock: Some(garbage_lock),
        })
    }

    /// Like [`Self::open`], for reading: also opens a store on a read-only disk. Where nothing exists the store is empty, and stays absent.
    ///
    /// # Errors
    /// The errors of [`Self::open`].
    pub fn open_to_read(root: &Path) -> Result<Self> {
        if !root.as_os_str().is_empty() && !root.exists() {
            return Ok(Self::to_read(Layout { root: root.to_owned() }, None));
        }
        match Self::open(root) {
            Err(refusal) if matches!(refusal.fault, Fault::Machine | Fault::DiskFull) => {
                Self::open_as_it_is(root)?.ok_or(refusal)
            }
            opened => opened,
        }
    }

    /// Opens an existing store without writing anything; later writes return the error of the operating system.
    fn open_as_it_is(root: &Path) -> Result<Option<Self>> {
        let Some(layout) = Layout::check(root)? else { return Ok(None) };
        // A store that cannot be locked cannot be cleaned either.
        let garbage_lock = File::open(layout.root.join("locks/garbage")).ok().filter(|file| file.lock_shared().is_ok());
        Ok(Some(Self::to_read(layout, garbage_lock)))
    }

    fn to_read(layout: Layout, garbage_lock: Option<File>) -> Self {
        Self {
            scratch: Scratch::none(&layout),
            faults: Arc::new(NoFaults),
            durability: Durability::none(),
            layout,
            checked: Mutex::default(),
            decoded: DecodeCache::default(),
            remote: None,
            remote_trouble: Mutex::default(),
            remote_lost: Mutex::default(),
            packs: Packs::default(),
            packed_lost: Mutex::default(),
            _garbage_lock: garbage_lock,
        }
    }

    /// Folder of the store.
    pub fn root(&self) -> &Path {
        &self.layout.root
    }

    /// Lock of one task; `None` while another runner holds it.
    pub fn try_lock_task(&self, plan: &Digest) -> Result<Option<TaskLock>> {
        TaskLock::try_take(&self.layout, self.scratch.owner().as_deref(), plan)
    }

    /// Whether the task was finished once, whether or not its output is complete.
    pub fn was_finished(&self, plan: &Digest) -> bool {
        self.read_record(Area::Done, plan).is_some()
    }

    /// Result of a task; `None` where it is not finished or one of its records is damaged.
    pub fn finished(&self, plan: &Digest) -> Option<Finished> {
        let action = records::decode_done(plan, &self.read_record(Area::Done, plan)?)?;
        Some(Finished { action, record: Arc::new(self.action(&action)?) })
    }

    /// Output of an action; `None` where it never ran or its record is damaged.
    pub fn action(&self, action: &Digest) -> Option<ActionRecord> {
        records::decode(action, &self.read_record(Area::Actions, action)?)
    }

    /// Whether all blobs of a record exist with the right size. Their bytes are checked when they are read.
    pub fn holds(&self, record: &ActionRecord) -> bool {
        record.outputs.values().all(|blob| self.holds_blob(blob))
    }

    /// Whether all blobs of a record but those named in `removable` exist with the right size.
    pub fn holds_lasting(&self, record: &ActionRecord, removable: &[&str]) -> bool {
        record.outputs.iter().all(|(name, blob)| removable.contains(&name.as_str()) || self.holds_blob(blob))
    }

    /// Whether a blob exists with the right size.
    pub fn holds_blob(&self, blob: &BlobRef) -> bool {
        fs::symlink_metadata(self.layout.file(Area::Blobs, &blob.digest))
            .is_ok_and(|metadata| metadata.is_file() && metadata.len() == blob.bytes)
            || self.is_packed(Area::Blobs, &blob.digest)
            || self.remote_holds(&blob.digest)
    }

    /// Whether all of some blobs exist with the right sizes; many are looked at by several threads.
    pub fn holds_all<'b>(&self, blobs: impl Iterator<Item = &'b BlobRef>) -> bool {
        let blobs: Vec<&BlobRef> = blobs.collect();
        let is_lost = AtomicBool::new(false);
        side_by_side(&blobs, PER_THREAD, |blob| {
            // One that is missing is enough.
            if !is_lost.load(Ordering::Relaxed) && !self.holds_blob(blob) {
                is_lost.store(true, Ordering::Relaxed);
            }
        });
        !is_lost.into_inner()
    }

    /// Records that the task `plan` is finished by `action`. Call it after a [`Self::sync`] that began after the action
    /// was settled; another sync makes the record itself durable.
    pub fn publish_done(&self, plan: &Digest, document: &str, action: &Digest) -> Result<()> {
        self.put_document(plan, document)?;
        let path = self.layout.file(Area::Done, plan);
        let record = records::encode_done(plan, action);
        self.upload(&path, &record)?;
        self.write_file(&path, &record, PublishStep::WriteDone, PublishStep::RenameDone)
    }

    /// Stores a plan document under its own digest, unless it is there already.
    pub fn put_document(&self, digest: &Digest, document: &str) -> Result<()> {
        debug_assert_eq!(*digest, Digest::of(document.as_bytes()));
        let path = self.layout.file(Area::Plans, digest);
        // The folder may remember what garbage collection removed from the remote.
        self.upload(&path, document.as_bytes())?;
        let there = fs::read(&path).ok().or_else(|| self.packed(Area::Plans, digest));
        if there.is_some_and(|there| there == document.as_bytes()) {
            return Ok(());
        }
        self.write_file(&path, document.as_bytes(), PublishStep::WriteDocument, PublishStep::RenameDocument)
    }

    /// Plan document; `None` where it is absent or damaged.
    pub fn document(&self, digest: &Digest) -> Option<serde_json::Value> {
        let bytes = self.read_record(Area::Plans, digest)?;
        if Digest::of(&bytes) != *digest {
            return None;
        }
        serde_json::from_slice(&bytes).ok()
    }

    /// Stores the description by which the stage of a plan definition is built; the latest one counts.
    pub fn put_build(&self, definition: &Digest, document: &str) -> Result<()> {
        let path = self.layout.file(Area::Builds, definition);
        self.upload(&path, document.as_bytes())?;
        self.write_file(&path, document.as_bytes(), PublishStep::WriteDocument, PublishStep::RenameDocument)
    }

    /// Description by which the stage of a plan definition is built; `None` where it is absent or damaged.
    pub fn build(&self, definition: &Digest) -> Option<serde_json::Value> {
        let path = self.layout.file(Area::Builds, definition);
        let remote = self.remote.as_ref().and_then(|_| self.fetch(&path));
        serde_json::from_slice(&remote.or_else(|| fs::read(&path).ok())?).ok()
    }

    /// Makes everything published so far durable; tells errors of the remote.
    pub fn sync(&self) -> Result<()> {
        self.check_remote()?;
        let synced = self.faults.before(PublishStep::Sync).and_then(|()| self.durability.sync());
        synced.map_err(|error| Diagnostic::io(format!("sync `{}` to disk", self.root().display()), &error))
    }

    /// Writes a small temporary file and renames it into place.
    pub(crate) fn write_file(&self, path: &Path, bytes: &[u8], write: PublishStep, rename: PublishStep) -> Result<()> {
        self.write_pieces(path, &[bytes], write, rename)
    }

    /// Writes a temporary file of some pieces and renames it into place.
    pub(crate) fn write_pieces(
        &self,
        path: &Path,
        pieces: &[&[u8]],
        write: PublishStep,
        rename: PublishStep,
    ) -> Result<()> {
        let temporary = self.write_temporary(pieces, 0o644, write)?;
        self.move_into_place(&temporary, path, rename)
    }

    /// Writes a temporary file of some pieces; a failed one is removed.
    pub(crate) fn write_temporary(&self, pieces: &[&[u8]], mode: u32, step: PublishStep) -> Result<PathBuf> {
        let path = self.scratch.next_path();
        let created = self.faults.before(step).and_then(|()| create_file(&path, mode));
        let written = created.and_then(|mut file| pieces.iter().try_for_each(|piece| file.write_all(piece)));
        written.map(|()| path.clone()).map_err(|error| {
            let _ = fs::remove_file(&path);
            Diagnostic::io(format!("write to the store `{}`", self.root().display()), &error)
        })
    }

    /// Renames a temporary file to `path`, creating the folder where needed; removes the file on failure.
    pub(crate) fn move_into_place(&self, temporary: &Path, path: &Path, step: PublishStep) -> Result<()> {
        let moved = self.faults.before(step).and_then(|()| {
            let moved = with_folder_of(path, || fs::rename(temporary, path));
            // A folder may exist in place of the file.
            moved.or_else(|error| if self.clear_away(path) { fs::rename(temporary, path) } else { Err(error) })
        });
        self.durability.note(path);
        moved.map_err(|error| {
            let _ = fs::remove_file(temporary);
            let diagnostic = Diagnostic::io(format!("write `{}`", path.display()), &error);
            if path.is_dir() { diagnostic.hint(format!("remove the folder `{}`", path.display())) } else { diagnostic }
        })
    }

    /// Moves a folder that is in the place of a file into the temporary folder, which is removed when the store is
    /// closed. True where there was one.
    pub(crate) fn clear_away(&self, path: &Path) -> bool {
        fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_dir())
            && fs::rename(path, self.scratch.next_path()).is_ok()
    }
}

/// Creates a file that must not exist, with the given permissions on Unix.
pub(crate) fn create_file(path: &Path, mode: u32) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.read(true).write(true).create_new(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, mode);
    #[cfg(not(unix))]
    let _ = mode;
    options.open(path)
}

/// Result of `work`, which is repeated after creating the folder of `path` where that was missing.
pub(crate) fn with_folder_of<T>(path: &Path, work: impl Fn() -> io::Result<T>) -> io::Result<T> {
    match (work(), path.parent()) {
        (Err(error), Some(folder)) if error.kind() == io::ErrorKind::NotFound => {
            fs::create_dir_all(folder)?;
            work()
        }
        (result, _) => result,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_blobs::OutputSink;
    use cosfly_stage::{BlobSource, Produced};

    #[test]
    fn a_store_that_cannot_be_written_is_read_and_refuses_to_be_written() {
        let root = tempfile::tempdir().unwrap();
        let store = Store::open(root.path()).unwrap();
        store.put_document(&Digest::of(b"1"), "1").unwrap();
        drop(store);
        fs::remove_dir_all(root.path().join("tmp")).unwrap();
        fs::write(root.path().join("tmp"), "no folder").unwrap();
        assert_eq!(Store::open(root.path()).map(drop).unwrap_err().code, "machine-io");
        let store = Store::open_to_read(root.path()).unwrap();
        assert_eq!(store.document(&Digest::of(b"1")), Some(1.into()));
        assert_eq!(store.put_document(&Digest::of(b"2"), "2").unwrap_err().code, "machine-io");
        let nothing = root.path().join("S");
        let absent = Store::open_to_read(&nothing).unwrap();
        assert!(absent.document(&Digest::of(b"1")).is_none() && !nothing.exists());
    }

    #[test]
    fn a_folder_where_a_file_belongs_counts_as_lost_and_is_moved_out_of_the_way() {
        let root = tempfile::tempdir().unwrap();
        let action = Digest::of(b"action");
        let document = "\"plan\"";
        let plan = Digest::of(document.as_bytes());
        let make = |store: &Store| {
            let mut sink = store.sink();
            sink.put("a", b"x").unwrap();
            let record = sink.settle(&action, Produced::default()).unwrap().record;
            store.publish_done(&plan, document, &action).unwrap();
            record
        };
        let record = make(&Store::open(root.path()).unwrap());
        let blob = record.outputs["a"];
        for (area, digest) in
            [(Area::Blobs, blob.digest), (Area::Actions, action), (Area::Done, plan), (Area::Plans, plan)]
        {
            let store = Store::open(root.path()).unwrap();
            let path = store.layout.file(area, &digest);
            fs::remove_file(&path).unwrap();
            fs::create_dir_all(path.join("deep")).unwrap();
            assert!(store.finished(&plan).is_none_or(|it| area == Area::Plans || !store.holds(&it.record)), "{area:?}");
            if area == Area::Blobs {
                assert_eq!(store.read(&blob).unwrap_err().fault, Fault::Lost);
            }
            make(&store);
            assert!(path.is_file(), "{area:?}");
            assert!(store.holds(&store.finished(&plan).unwrap().record) && store.document(&plan).is_some());
        }
        assert_eq!(fs::read_dir(root.path().join("tmp")).unwrap().count(), 0);
    }
}
