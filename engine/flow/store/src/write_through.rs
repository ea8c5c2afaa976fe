//! A store elsewhere, such as a bucket, behind a folder: the folder is a cache that is written through.
//!
//! Objects have the names of the files of a store. Everything that other machines need is there before a record says so:
//! blobs, then the action (created once: of two different results the first one stays), then the done record. Nothing lists
//! objects but garbage collection. An error while something is looked for counts as absent at first and is told at the next
//! [`Store::check_remote`], so that no error turns into work that is done twice without a word.

use crate::fault::PublishStep;
use crate::mutex::locked;
use crate::remote::Remote;
use crate::store::Store;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use std::fs;
use std::path::Path;
use std::sync::Arc;

impl Store {
    /// Opens the folder `root` as a cache of `remote`; it may be a scratch disk of one machine.
    ///
    /// # Errors
    /// Those of [`Store::open`] and of the remote; `store-not-a-store` and `store-newer-version` of what is there.
    pub fn open_remote(root: &Path, remote: Arc<dyn Remote>) -> Result<Self> {
        let mut store = Self::open(root)?;
        let format = fs::read(store.layout.root.join("format")).unwrap_or_default();
        if !remote.create("format", format.clone())? {
            let there = remote.get("format")?.unwrap_or_default();
            if there != format {
                let text: String = String::from_utf8_lossy(&there).trim().chars().take(40).collect();
                let message = format!("`{}` holds `{}`, no store of this version", remote.place(), text.escape_debug());
                return Err(Diagnostic::new("store-newer-version", Fault::Input, message)
                    .hint("use the cosfly that wrote it, or choose another prefix with `--store`"));
            }
        }
        store.remote = Some(remote);
        Ok(store)
    }

    /// Place of the remote store; `None` where the folder is the store.
    pub fn remote_place(&self) -> Option<&str> {
        self.remote.as_ref().map(|remote| remote.place())
    }

    /// The first error of the remote since the last call.
    ///
    /// # Errors
    /// That error.
    pub fn check_remote(&self) -> Result<()> {
        locked(&self.remote_trouble).take().map_or(Ok(()), Err)
    }

    /// Bytes of the file at `path`, from the folder or else from the remote; then they are in the folder, too.
    pub(crate) fn read_file(&self, path: &Path) -> Option<Vec<u8>> {
        fs::read(path).ok().or_else(|| self.fetch(path))
    }

    /// Copies a file from the remote into the folder.
    pub(crate) fn fetch(&self, path: &Path) -> Option<Vec<u8>> {
        // After an error that was not told yet, nothing more is asked: a server that hangs would hang every time.
        let remote = self.remote.as_ref().filter(|_| locked(&self.remote_trouble).is_none())?;
        let fetched = remote.get(&self.object(path)).and_then(|bytes| match bytes {
            Some(bytes) => {
                self.write_file(path, &bytes, PublishStep::WriteBlob, PublishStep::RenameBlob).map(|()| Some(bytes))
            }
            None => Ok(None),
        });
        self.or_trouble(fetched).flatten()
    }

    /// Copies a blob from the remote into the folder; true where it is there with the right bytes.
    pub(crate) fn fetch_blob(&self, path: &Path, digest: &Digest) -> bool {
        if self.remote.is_none() {
            return false;
        }
        let fetched = self.fetch(path);
        let is_whole = fetched.is_some_and(|bytes| Digest::of(&bytes) == *digest);
        if !is_whole {
            let _ = fs::remove_file(path);
            if locked(&self.remote_trouble).is_none() {
                locked(&self.remote_lost).insert(*digest);
            }
        }
        is_whole
    }

    /// Removes a blob from the remote, where there is one.
    pub(crate) fn remove_from_remote(&self, path: &Path, digest: &Digest) -> Result<()> {
        let Some(remote) = &self.remote else { return Ok(()) };
        remote.delete(&[self.object(path)])?;
        locked(&self.remote_lost).insert(*digest);
        Ok(())
    }

    /// Whether the remote has a blob, as far as its records say: a blob that turned out lost is not there.
    pub(crate) fn remote_holds(&self, digest: &Digest) -> bool {
        self.remote.is_some() && !locked(&self.remote_lost).contains(digest)
    }

    /// Copies a blob of the folder to the remote, unless it is there.
    pub(crate) fn upload_blob(&self, path: &Path, digest: &Digest, bytes: u64) -> Result<()> {
        let Some(remote) = &self.remote else { return Ok(()) };
        let name = self.object(path);
        if remote.size(&name)? != Some(bytes) {
            let read = fs::read(path);
            remote.put(&name, read.map_err(|error| Diagnostic::io(format!("read `{}`", path.display()), &error))?)?;
        }
        locked(&self.remote_lost).remove(digest);
        Ok(())
    }

    /// Copies files of the folder to the remote, by their names in the store.
    pub fn upload_files(&self, names: &[String]) -> Result<()> {
        for name in names.iter().filter(|_| self.remote.is_some()) {
            let path = self.layout.root.join(name);
            let read = fs::read(&path);
            self.upload(&path, &read.map_err(|error| Diagnostic::io(format!("read `{name}`"), &error))?)?;
        }
        Ok(())
    }

    /// Copies all small files of a folder of the remote, such as `versions`, into the folder here.
    pub fn fetch_files(&self, folder: &str) -> Result<()> {
        let Some(remote) = &self.remote else { return Ok(()) };
        for object in remote.list(folder)? {
            self.fetch(&self.layout.root.join(&object.name));
        }
        self.check_remote()
    }

    /// Writes a file of the folder to the remote, too.
    pub(crate) fn upload(&self, path: &Path, bytes: &[u8]) -> Result<()> {
        self.remote.as_ref().map_or(Ok(()), |remote| remote.put(&self.object(path), bytes.to_vec()))
    }

    /// Name of the object of a file of the folder.
    pub(crate) fn object(&self, path: &Path) -> String {
        let relative = path.strip_prefix(&self.layout.root).unwrap_or(path);
        let parts: Vec<_> = relative.iter().map(|part| part.to_string_lossy()).collect();
        parts.join("/")
    }

    /// The value, or nothing where the remote refused; the refusal is kept for [`Self::check_remote`].
    pub(crate) fn or_trouble<T>(&self, result: Result<T>) -> Option<T> {
        match result {
            Ok(value) => Some(value),
            Err(refusal) => {
                locked(&self.remote_trouble).get_or_insert(refusal);
                None
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::remote::RemoteObject;
    use crate::{GarbageOptions, PastRun, PastStage, collect_remote_garbage};
    use cosfly_blobs::OutputSink;
    use cosfly_stage::{BlobSource, Produced};
    use std::collections::BTreeMap;
    use std::sync::Mutex;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::time::{Duration, SystemTime};

    /// Objects in memory, with errors on demand.
    #[derive(Default)]
    struct Memory {
        objects: Mutex<BTreeMap<String, Vec<u8>>>,
        fails: AtomicBool,
    }

    impl Memory {
        fn objects(&self) -> Result<std::sync::MutexGuard<'_, BTreeMap<String, Vec<u8>>>> {
            if self.fails.load(Ordering::Relaxed) {
                return Err(Diagnostic::new("remote-refused", Fault::Machine, "on purpose"));
            }
            Ok(self.objects.lock().unwrap())
        }
    }

    impl Remote for Memory {
        fn place(&self) -> &str {
            "memory"
        }

        fn get(&self, name: &str) -> Result<Option<Vec<u8>>> {
            Ok(self.objects()?.get(name).cloned())
        }

        fn size(&self, name: &str) -> Result<Option<u64>> {
            Ok(self.objects()?.get(name).map(|bytes| bytes.len() as u64))
        }

        fn put(&self, name: &str, bytes: Vec<u8>) -> Result<()> {
            self.objects()?.insert(name.to_owned(), bytes);
            Ok(())
        }

        fn create(&self, name: &str, bytes: Vec<u8>) -> Result<bool> {
            let mut objects = self.objects()?;
            Ok(!objects.contains_key(name) && objects.insert(name.to_owned(), bytes).is_none())
        }

        fn list(&self, folder: &str) -> Result<Vec<RemoteObject>> {
            let object = |(name, bytes): (&String, &Vec<u8>)| RemoteObject {
                name: name.clone(),
                bytes: bytes.len() as u64,
                written: SystemTime::UNIX_EPOCH,
            };
            let prefix = format!("{folder}/");
            Ok(self.objects()?.iter().filter(|(name, _)| name.starts_with(&prefix)).map(object).collect())
        }

        fn delete(&self, names: &[String]) -> Result<()> {
            let mut objects = self.objects()?;
            names.iter().for_each(|name| drop(objects.remove(name)));
            Ok(())
        }
    }

    fn machine(remote: &Arc<Memory>) -> (tempfile::TempDir, Store) {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open_remote(folder.path(), Arc::clone(remote) as Arc<dyn Remote>).unwrap();
        (folder, store)
    }

    /// Finishes the task `plan` with `bytes`.
    fn finish(store: &Store, text: &str, bytes: &[u8]) -> (Digest, crate::Settled) {
        let document = format!("\"{text}\"");
        let plan = Digest::of(document.as_bytes());
        let mut sink = store.sink();
        sink.put("a", bytes).unwrap();
        let settled = sink.settle(&plan, Produced::default()).unwrap();
        store.sync().unwrap();
        store.publish_done(&plan, &document, &plan).unwrap();
        (plan, settled)
    }

    #[test]
    fn what_one_machine_makes_another_one_finds_and_reads() {
        let remote = Arc::new(Memory::default());
        let ((_first, first), (_second, second)) = (machine(&remote), machine(&remote));
        let (plan, settled) = finish(&first, "task", b"bytes");
        assert_eq!(second.finished(&plan).unwrap().record, settled.record);
        assert_eq!(second.known_tasks("r").finished(&plan, &[]).unwrap().finished.record, settled.record);
        assert!(second.document(&plan).is_some() && second.holds(&settled.record));
        assert_eq!(second.read(&settled.record.outputs["a"]).unwrap(), b"bytes");
        let failure = Diagnostic::new("map-empty", Fault::Input, "no roads");
        first.put_failure(&plan, &failure).unwrap();
        assert_eq!(second.failure(&plan), Some(failure));
        second.forget_failure(&plan);
        assert_eq!(first.failure(&plan), None);
    }

    #[test]
    fn of_two_results_the_first_one_stays_and_the_other_is_reported() {
        let remote = Arc::new(Memory::default());
        let ((_first, first), (_second, second)) = (machine(&remote), machine(&remote));
        let (_, kept) = finish(&first, "task", b"one");
        let mut sink = second.sink();
        sink.put("a", b"two").unwrap();
        // The other machine had not seen the record when it began.
        let late = sink.settle(&Digest::of(b"\"task\""), Produced::default()).unwrap();
        assert_eq!(late.divergence.unwrap().code, "nondeterministic-stage");
        assert_eq!(late.record, kept.record);
        let (_, same) = finish(&second, "task", b"one");
        assert!(same.divergence.is_none());
    }

    #[test]
    fn a_lost_or_damaged_blob_is_noticed_and_made_again() {
        let remote = Arc::new(Memory::default());
        let (_first, first) = machine(&remote);
        let (plan, settled) = finish(&first, "task", b"bytes");
        let blob = settled.record.outputs["a"];
        let name = first.object(&first.blob_path(&blob));
        for damage in [None, Some(b"bytez".to_vec()), Some(Vec::new())] {
            let (_other, other) = machine(&remote);
            match damage {
                Some(bytes) => drop(remote.objects().unwrap().insert(name.clone(), bytes)),
                None => drop(remote.objects().unwrap().remove(&name)),
            }
            assert_eq!(other.read(&blob).unwrap_err().fault, Fault::Lost);
            assert!(!other.holds(&settled.record));
            remote.objects().unwrap().remove(&name);
            assert_eq!(finish(&other, "task", b"bytes").0, plan);
            assert!(other.holds(&settled.record));
            assert_eq!(remote.get(&name).unwrap().unwrap(), b"bytes");
        }
    }

    #[test]
    fn an_error_is_told_and_never_taken_for_something_absent() {
        let remote = Arc::new(Memory::default());
        let ((_first, first), (_second, second)) = (machine(&remote), machine(&remote));
        let (plan, settled) = finish(&first, "task", b"bytes");
        remote.fails.store(true, Ordering::Relaxed);
        assert_eq!(second.finished(&plan), None);
        assert_eq!(second.check_remote().unwrap_err().code, "remote-refused");
        assert_eq!(second.check_remote(), Ok(()), "once");
        assert_eq!(second.read(&settled.record.outputs["a"]).unwrap_err().code, "remote-refused");
        let mut sink = second.sink();
        sink.put("a", b"x").unwrap();
        assert_eq!(sink.settle(&Digest::of(b"other"), Produced::default()).unwrap_err().code, "remote-refused");
        let folder = tempfile::tempdir().unwrap();
        let refusal = Store::open_remote(folder.path(), remote as Arc<dyn Remote>).map(drop).unwrap_err();
        assert_eq!(refusal.code, "remote-refused");
    }

    #[test]
    fn garbage_is_what_no_kept_run_needs_and_an_error_removes_nothing() {
        let remote = Arc::new(Memory::default());
        let (_folder, store) = machine(&remote);
        let (kept, _) = finish(&store, "kept", b"kept");
        let (gone, settled) = finish(&store, "gone", b"gone");
        let items = BTreeMap::from([("i".to_owned(), kept)]);
        let stage = PastStage { items, ..PastStage::new("s".to_owned(), Digest::of(b"definition")) };
        store.record_run("r", &PastRun { stages: vec![stage] }).unwrap();
        let day = Duration::from_secs(86_400);
        let options = |dry_run, keep_age| GarbageOptions {
            keep_runs: 1,
            keep_age,
            now: SystemTime::now(),
            pack_from: 1,
            dry_run,
        };
        let count = || remote.objects().unwrap().len();
        let before = count();
        assert_eq!(collect_remote_garbage(&*remote, &options(true, day)).unwrap().blobs, 1);
        assert_eq!(collect_remote_garbage(&*remote, &options(false, 365 * 100 * day)).unwrap().blobs, 0);
        remote.fails.store(true, Ordering::Relaxed);
        assert_eq!(collect_remote_garbage(&*remote, &options(false, day)).unwrap_err().code, "remote-refused");
        remote.fails.store(false, Ordering::Relaxed);
        assert_eq!(count(), before);
        let report = collect_remote_garbage(&*remote, &options(false, day)).unwrap();
        assert_eq!((report.blobs, report.records, report.kept_blobs), (1, 3, 1));
        let (_other, other) = machine(&remote);
        assert!(other.finished(&kept).is_some() && other.finished(&gone).is_none());
        assert_eq!(other.read(&settled.record.outputs["a"]).unwrap_err().fault, Fault::Lost);
    }

    #[test]
    fn a_remote_with_something_else_is_refused() {
        let remote = Arc::new(Memory::default());
        remote.put("format", b"cosfly-store 9\n".to_vec()).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let refusal = Store::open_remote(folder.path(), remote as Arc<dyn Remote>).map(drop).unwrap_err();
        assert_eq!(refusal.code, "store-newer-version");
    }
}
