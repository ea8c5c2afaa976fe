//! Where a running task puts its blobs, and the moment its action becomes visible.

use crate::blobs::digest_of_file;
use crate::fault::Step;
use crate::layout::Area;
use crate::records::{self, ActionRecord};
use crate::store::{BLOB_LOST, Store, create_file, with_folder_of};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::{Digest, canonical_json};
use cosfly_stage::{BlobRef, BlobSource, OutputSink, PassingFile, Produced, SeekWrite};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::PathBuf;
use std::sync::Arc;

/// Outputs of one task, in temporary files until [`TaskSink::settle`]; dropping it removes them.
pub struct TaskSink<'s> {
    store: &'s Store,
    outputs: BTreeMap<String, (BlobRef, Option<PathBuf>)>,
}

/// What counts as the outcome of an action from now on.
#[derive(Clone, Debug)]
pub struct Settled {
    /// The record that counts.
    pub record: Arc<ActionRecord>,
    /// Set when another execution of the same action gave other bytes (`nondeterministic-stage`).
    pub divergence: Option<Box<Diagnostic>>,
}

impl<'s> TaskSink<'s> {
    pub(crate) fn new(store: &'s Store) -> Self {
        Self { store, outputs: BTreeMap::new() }
    }

    /// Moves the blobs into the store and records them as the outcome of `action`.
    /// Whoever settled the same action first with other bytes, still intact, wins.
    pub fn settle(mut self, action: &Digest, produced: Produced) -> Result<Settled> {
        let outputs = self.outputs.iter().map(|(name, (blob, _))| (name.clone(), *blob)).collect();
        let record = ActionRecord::new(outputs, produced);
        let earlier = self.store.action(action).filter(|earlier| self.store.holds(earlier));
        if let Some(earlier) = earlier.filter(|earlier| *earlier != record)
            && self.store.is_intact(&earlier)
        {
            return self.store.diverged(action, earlier, &record);
        }
        for (blob, temporary) in self.outputs.values_mut() {
            if let Some(path) = temporary.take() {
                // Over what is there: the bytes are the same, unless the old ones are damaged.
                self.store.move_into_place(&path, &self.store.blob_path(blob), Step::RenameBlob)?;
                self.store.mark_checked(blob.digest);
            }
        }
        self.store.settle_record(action, record)
    }

    fn claim(&self, name: &str) -> Result<()> {
        let wrong = |rule: &str| {
            Err(Diagnostic::new("stage-output-name", Fault::Bug, format!("a stage's output is named `{name}`: {rule}")))
        };
        if !is_relative_path(name) {
            return wrong("it must be a relative path of plain names with `/` between them");
        }
        if self.outputs.contains_key(name) {
            return wrong("there is one of that name already");
        }
        let parents = name.match_indices('/').any(|(end, _)| self.outputs.contains_key(&name[..end]));
        let below = format!("{name}/");
        let children = self.outputs.range(below.clone()..).next().is_some_and(|(other, _)| other.starts_with(&below));
        if parents || children {
            return wrong("another output needs that name as a folder, or the other way round");
        }
        Ok(())
    }
}

impl OutputSink for TaskSink<'_> {
    fn put(&mut self, name: &str, bytes: &[u8]) -> Result<()> {
        self.claim(name)?;
        let temporary = self.store.write_temporary(bytes, 0o444, Step::WriteBlob)?;
        let blob = BlobRef { digest: Digest::of(bytes), bytes: bytes.len() as u64 };
        self.outputs.insert(name.to_owned(), (blob, Some(temporary)));
        Ok(())
    }

    fn stream(&mut self, name: &str, write: &mut dyn FnMut(&mut dyn SeekWrite) -> Result<()>) -> Result<BlobRef> {
        self.claim(name)?;
        let path = self.store.scratch.next_path();
        let refused = |error: &io::Error| {
            Diagnostic::io(format!("write output `{name}` to the store `{}`", self.store.root().display()), error)
        };
        let file = self.store.faults.before(Step::WriteBlob).and_then(|()| create_file(&path, 0o444));
        let streamed = file.map_err(|error| refused(&error)).and_then(|file| {
            let mut writer = BufWriter::with_capacity(1 << 16, DigestingFile::new(file));
            let written = write(&mut writer);
            let flushed = if written.is_ok() { writer.flush() } else { Ok(()) };
            let (mut inner, _) = writer.into_parts();
            match (inner.refused.take(), written, flushed) {
                (Some(error), ..) | (None, Ok(()), Err(error)) => Err(refused(&error)),
                (None, Err(diagnostic), _) => Err(diagnostic),
                (None, Ok(()), Ok(())) => inner.finish().map_err(|error| refused(&error)),
            }
        });
        match streamed {
            Ok(blob) => {
                self.outputs.insert(name.to_owned(), (blob, Some(path)));
                Ok(blob)
            }
            Err(diagnostic) => {
                let _ = fs::remove_file(&path);
                Err(diagnostic)
            }
        }
    }

    fn link(&mut self, name: &str, blob: BlobRef) -> Result<()> {
        self.claim(name)?;
        if !self.store.holds_blob(&blob) {
            return Err(Diagnostic::new(
                BLOB_LOST,
                Fault::Machine,
                format!("blob `{}` of the store, linked as `{name}`, is missing", blob.digest.short()),
            ));
        }
        self.outputs.insert(name.to_owned(), (blob, None));
        Ok(())
    }
}

impl Drop for TaskSink<'_> {
    fn drop(&mut self) {
        for path in self.outputs.values().filter_map(|(_, temporary)| temporary.as_ref()) {
            let _ = fs::remove_file(path);
        }
    }
}

impl Store {
    /// Makes `record` the outcome of `action`, unless another process was faster with other bytes.
    fn settle_record(&self, action: &Digest, record: ActionRecord) -> Result<Settled> {
        let path = self.layout.file(Area::Actions, action);
        let temporary = self.write_temporary(&records::encode(action, &record), 0o644, Step::WriteAction)?;
        let linked = self
            .faults
            .before(Step::RenameAction)
            .and_then(|()| with_folder_of(&path, || fs::hard_link(&temporary, &path)));
        let settled = |record| Ok(Settled { record: Arc::new(record), divergence: None });
        if linked.is_ok() {
            let _ = fs::remove_file(&temporary);
            self.durability.note(&path);
            return settled(record);
        }
        // There is a record already, or this file system knows no hard links.
        match self.action(action) {
            Some(earlier) if earlier == record => {
                let _ = fs::remove_file(&temporary);
                settled(record)
            }
            Some(earlier) if self.is_intact(&earlier) => {
                let _ = fs::remove_file(&temporary);
                self.diverged(action, earlier, &record)
            }
            Some(earlier) => {
                // The earlier bytes are lost and will not come back.
                self.move_into_place(&temporary, &path, Step::RenameAction)?;
                let divergence = self.report_divergence(action, &record, &earlier)?;
                Ok(Settled { record: Arc::new(record), divergence: Some(divergence) })
            }
            None => {
                self.move_into_place(&temporary, &path, Step::RenameAction)?;
                settled(record)
            }
        }
    }

    /// Whether every blob of a record is there with the right bytes.
    fn is_intact(&self, record: &ActionRecord) -> bool {
        record.outputs.values().all(|blob| self.open(blob).is_ok())
    }

    fn diverged(&self, action: &Digest, kept: ActionRecord, other: &ActionRecord) -> Result<Settled> {
        let divergence = self.report_divergence(action, &kept, other)?;
        Ok(Settled { record: Arc::new(kept), divergence: Some(divergence) })
    }

    fn report_divergence(&self, action: &Digest, kept: &ActionRecord, other: &ActionRecord) -> Result<Box<Diagnostic>> {
        let report = canonical_json(&serde_json::json!({
            "schema": "cosfly.divergence/1", "action": action, "kept": kept, "other": other,
        }));
        let name = format!("{action}-{}", Digest::of(report.as_bytes()).short());
        let path = self.layout.folder("divergence").join(name);
        self.write_file(&path, report.as_bytes(), Step::WriteAction, Step::RenameAction)?;
        let what = first_difference(kept, other);
        Ok(Diagnostic::new(
            "nondeterministic-stage",
            Fault::Bug,
            "the same stage with the same inputs and seed gave other bytes than before",
        )
        .because(format!("{what} differs"))
        .hint(format!("the earlier result is kept; both are described in `{}`", path.display()))
        .hint("raise the stage's version when its results are meant to change"))
    }
}

fn first_difference(kept: &ActionRecord, other: &ActionRecord) -> String {
    let names = kept.outputs.keys().chain(other.outputs.keys());
    names
        .filter(|name| kept.outputs.get(*name) != other.outputs.get(*name))
        .min()
        .map_or_else(|| "what it says about itself".to_owned(), |name| format!("output `{name}`"))
}

/// Relative, of plain names: nothing that could leave the folder it is put in, on any system.
pub(crate) fn is_relative_path(name: &str) -> bool {
    name.len() <= 1024
        && !name.contains(['\\', ':'])
        && !name.chars().any(char::is_control)
        && name.split('/').all(|part| !part.is_empty() && part.len() <= 255 && part != "." && part != "..")
}

/// A file that is hashed while it is written from front to back, and read again only when it was not.
struct DigestingFile {
    file: PassingFile,
    hasher: blake3::Hasher,
    /// Where the next write goes.
    position: u64,
    /// How many bytes are hashed, all from the front.
    hashed: u64,
    in_order: bool,
    /// The first refusal of a write; the stage may have wrapped it in words of its own.
    refused: Option<io::Error>,
}

impl DigestingFile {
    fn new(file: File) -> Self {
        let file = PassingFile::new(file);
        Self { file, hasher: blake3::Hasher::new(), position: 0, hashed: 0, in_order: true, refused: None }
    }

    fn finish(mut self) -> io::Result<BlobRef> {
        let bytes = self.file.file().metadata()?.len();
        let digest = if self.in_order && bytes == self.hashed {
            Digest(*self.hasher.finalize().as_bytes())
        } else {
            self.file.rewind()?;
            digest_of_file(self.file.file())?
        };
        Ok(BlobRef { digest, bytes })
    }
}

impl Write for DigestingFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self.file.write(bytes) {
            Ok(length) => {
                if self.position == self.hashed {
                    self.hasher.update(&bytes[..length]);
                    self.hashed += length as u64;
                } else {
                    self.in_order = false;
                }
                self.position += length as u64;
                Ok(length)
            }
            Err(error) => {
                if error.kind() != io::ErrorKind::Interrupted && self.refused.is_none() {
                    self.refused = Some(copy_of(&error));
                }
                Err(error)
            }
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for DigestingFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.position = self.file.seek(to)?;
        Ok(self.position)
    }
}

fn copy_of(error: &io::Error) -> io::Error {
    error.raw_os_error().map_or_else(|| io::Error::new(error.kind(), error.to_string()), io::Error::from_raw_os_error)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn open() -> (tempfile::TempDir, Store) {
        let root = tempfile::tempdir().unwrap();
        let store = Store::open(root.path()).unwrap();
        (root, store)
    }

    #[test]
    fn names_that_could_leave_the_folder_are_refused() {
        let (_root, store) = open();
        let mut sink = store.sink();
        for name in ["", "/etc/passwd", "..", "a/../b", "a//b", "a\\b", "c:x", "a/", "\n", "./a"] {
            assert_eq!(sink.put(name, b"x").unwrap_err().code, "stage-output-name", "{name:?}");
        }
        sink.put("a/b", b"x").unwrap();
        for name in ["a/b", "a", "a/b/c"] {
            assert_eq!(sink.put(name, b"x").unwrap_err().code, "stage-output-name", "{name:?}");
        }
        sink.put("a.txt", b"x").unwrap();
        sink.put("a/c", b"x").unwrap();
    }

    #[test]
    fn a_streamed_blob_has_the_digest_of_its_bytes_also_after_seeking_back() {
        let (_root, store) = open();
        let mut sink = store.sink();
        let plain = sink.stream("plain", &mut |w| w.write_all(b"abcdef").map_err(|e| Diagnostic::io("w", &e))).unwrap();
        let patched = sink
            .stream("patched", &mut |w| {
                let write = |w: &mut dyn SeekWrite| -> io::Result<()> {
                    w.write_all(b"______")?;
                    w.rewind()?;
                    w.write_all(b"abc")?;
                    w.seek(SeekFrom::End(-3))?;
                    w.write_all(b"def")
                };
                write(w).map_err(|e| Diagnostic::io("w", &e))
            })
            .unwrap();
        assert_eq!(plain, BlobRef { digest: Digest::of(b"abcdef"), bytes: 6 });
        assert_eq!(patched, plain);
    }

    #[test]
    fn an_abandoned_task_leaves_nothing() {
        let (root, store) = open();
        let mut sink = store.sink();
        sink.put("a", b"x").unwrap();
        sink.stream("b", &mut |_| Err(Diagnostic::new("x", Fault::Bug, "x"))).unwrap_err();
        drop(sink);
        let scratch = fs::read_dir(root.path().join("tmp")).unwrap().next().unwrap().unwrap().path();
        assert_eq!(fs::read_dir(scratch).unwrap().count(), 1, "only the owner file");
        assert!(!root.path().join("cas").exists());
    }

    #[test]
    fn two_results_of_one_action_are_told_apart_and_the_first_is_kept() {
        let (root, store) = open();
        let action = Digest::of(b"action");
        let settle = |bytes: &[u8]| {
            let mut sink = store.sink();
            sink.put("a", bytes).unwrap();
            sink.settle(&action, Produced::default()).unwrap()
        };
        let first = settle(b"one");
        assert!(first.divergence.is_none() && settle(b"one").divergence.is_none());
        let second = settle(b"two");
        assert_eq!(second.divergence.unwrap().code, "nondeterministic-stage");
        assert_eq!(second.record, first.record);
        assert_eq!(fs::read_dir(root.path().join("divergence")).unwrap().count(), 1);
        // When the first bytes are lost, the later ones take their place, and that is said too.
        fs::remove_file(store.blob_path(&first.record.outputs["a"])).unwrap();
        let third = settle(b"two");
        assert!(third.divergence.is_some() && third.record != first.record);
        assert_eq!(store.action(&action).as_ref(), Some(&*third.record));
        assert!(store.is_checked(&Digest::of(b"two")));
    }
}
