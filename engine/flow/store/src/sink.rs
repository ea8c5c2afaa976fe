//! Sink for the blobs of a running task, and the publication of its action.

use crate::digesting::DigestingFile;
use crate::fault::PublishStep;
use crate::layout::Area;
use crate::names::is_relative_path;
use crate::records::{self, ActionRecord};
use crate::store::{Store, create_file, with_folder_of};
use cosfly_blobs::{BlobRef, OutputSink, SeekWrite};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::{Digest, canonical_json};
use cosfly_stage::{BlobSource, Blobs, Produced};
use std::collections::BTreeMap;
use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Outputs of one task, in temporary files until [`TaskSink::settle`]; dropping it removes them.
pub struct TaskSink<'s> {
    store: &'s Store,
    outputs: BTreeMap<String, (BlobRef, Option<PathBuf>)>,
}

/// Final outcome of an action.
#[derive(Clone, Debug)]
pub struct Settled {
    /// Record of the outcome.
    pub record: Arc<ActionRecord>,
    /// Set where another execution of the same action gave different bytes (`nondeterministic-stage`).
    pub divergence: Option<Box<Diagnostic>>,
}

impl<'s> TaskSink<'s> {
    /// Moves the blobs into the store and records them as the outcome of `action`. An earlier outcome with other bytes
    /// is kept while it is intact.
    ///
    /// # Errors
    /// [`Fault::Lost`] where a linked blob is missing; refusals of the disk.
    pub fn settle(mut self, action: &Digest, produced: Produced) -> Result<Settled> {
        self.check_links()?;
        let outputs: Blobs = self.outputs.iter().map(|(name, (blob, _))| (name.clone(), *blob)).collect();
        let record = ActionRecord::new(outputs, produced);
        let earlier = self.store.action(action).filter(|earlier| self.store.holds(earlier));
        if let Some(earlier) = earlier.filter(|earlier| *earlier != record)
            && self.store.is_intact(&earlier)
        {
            return self.store.diverged(action, earlier, &record);
        }
        for (blob, temporary) in self.outputs.values_mut() {
            if let Some(path) = temporary.take() {
                // This may replace a blob: its bytes are the same, unless they are damaged.
                self.store.move_into_place(&path, &self.store.blob_path(blob), PublishStep::RenameBlob)?;
                self.store.mark_checked(blob.digest);
                self.store.upload_blob(&self.store.blob_path(blob), &blob.digest, blob.bytes)?;
            }
        }
        self.store.settle_record(action, record)
    }

    /// Refuses links to blobs that are not in the store.
    fn check_links(&self) -> Result<()> {
        let links = || self.outputs.iter().filter(|(_, (_, temporary))| temporary.is_none());
        if self.store.holds_all(links().map(|(_, (blob, _))| blob)) {
            return Ok(());
        }
        let lost = links().find(|(_, (blob, _))| !self.store.holds_blob(blob));
        let (name, digest) = lost.map_or(("", None), |(name, (blob, _))| (name, Some(blob.digest)));
        let blob = digest.map_or_else(String::new, |digest| digest.short());
        Err(Diagnostic::new(
            "store-blob-lost",
            Fault::Lost,
            format!("blob `{blob}` of the store, linked as `{name}`, is missing"),
        ))
    }

    fn claim(&self, name: &str) -> Result<()> {
        let wrong = |rule: &str| {
            Err(Diagnostic::new("stage-output-name", Fault::Bug, format!("a stage's output is named `{name}`: {rule}")))
        };
        if !is_relative_path(name) {
            return wrong("it must be a relative path of plain names with `/` between them");
        }
        if self.outputs.contains_key(name) {
            return wrong("an output of that name exists already");
        }
        let parents = name.match_indices('/').any(|(end, _)| self.outputs.contains_key(&name[..end]));
        let below = format!("{name}/");
        let children = self.outputs.range(below.clone()..).next().is_some_and(|(other, _)| other.starts_with(&below));
        if parents || children {
            return wrong("another output uses that name as a folder, or vice versa");
        }
        Ok(())
    }
}

impl OutputSink for TaskSink<'_> {
    fn put(&mut self, name: &str, bytes: &[u8]) -> Result<()> {
        self.claim(name)?;
        let temporary = self.store.write_temporary(&[bytes], 0o444, PublishStep::WriteBlob)?;
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
        let file = self.store.faults.before(PublishStep::WriteBlob).and_then(|()| create_file(&path, 0o444));
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
    /// Creates a sink for the outputs of one task.
    pub fn sink(&self) -> TaskSink<'_> {
        TaskSink { store: self, outputs: BTreeMap::new() }
    }

    /// Makes `record` the outcome of `action`, unless another process recorded other bytes first.
    fn settle_record(&self, action: &Digest, record: ActionRecord) -> Result<Settled> {
        let path = self.layout.file(Area::Actions, action);
        if let Some(earlier) = self.created_elsewhere(action, &path, &record)? {
            return if earlier == record {
                Ok(Settled { record: Arc::new(record), divergence: None })
            } else {
                self.diverged(action, earlier, &record)
            };
        }
        let temporary = self.write_temporary(&[&records::encode(action, &record)], 0o644, PublishStep::WriteAction)?;
        let linked = self
            .faults
            .before(PublishStep::RenameAction)
            .and_then(|()| with_folder_of(&path, || fs::hard_link(&temporary, &path)));
        let settled = |record| Ok(Settled { record: Arc::new(record), divergence: None });
        if linked.is_ok() {
            let _ = fs::remove_file(&temporary);
            self.durability.note(&path);
            return settled(record);
        }
        // A record exists already, or this file system has no hard links.
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
                // The earlier bytes are lost.
                self.move_into_place(&temporary, &path, PublishStep::RenameAction)?;
                let divergence = self.report_divergence(action, &record, &earlier)?;
                Ok(Settled { record: Arc::new(record), divergence: Some(divergence) })
            }
            None => {
                self.move_into_place(&temporary, &path, PublishStep::RenameAction)?;
                settled(record)
            }
        }
    }

    /// Creates the record in the remote; gives the intact record that was there before, which the folder then holds.
    fn created_elsewhere(&self, action: &Digest, path: &Path, record: &ActionRecord) -> Result<Option<ActionRecord>> {
        let Some(remote) = &self.remote else { return Ok(None) };
        let (name, bytes) = (self.object(path), records::encode(action, record));
        if remote.create(&name, bytes.clone())? {
            return Ok(None);
        }
        let earlier = self.fetch(path).and_then(|there| records::decode(action, &there));
        self.check_remote()?;
        let earlier = earlier.filter(|earlier| earlier == record || self.is_intact(earlier));
        if earlier.is_none() {
            // Its blobs are lost or its bytes damaged.
            remote.put(&name, bytes)?;
        }
        Ok(earlier)
    }

    /// Whether every blob of a record exists with the right bytes.
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
        self.write_file(&path, report.as_bytes(), PublishStep::WriteAction, PublishStep::RenameAction)?;
        Ok(Diagnostic::new(
            "nondeterministic-stage",
            Fault::Bug,
            "the same stage with the same inputs and seed gave different bytes than before",
        )
        .because(format!("{} differs", first_difference(kept, other)))
        .hint(format!("the earlier result is kept; both are described in `{}`", path.display()))
        .hint("where its results are meant to change, raise the version of the stage's kind"))
    }
}

fn first_difference(kept: &ActionRecord, other: &ActionRecord) -> String {
    let names = kept.outputs.keys().chain(other.outputs.keys());
    names
        .filter(|name| kept.outputs.get(name) != other.outputs.get(name))
        .min()
        .map_or_else(|| "a note or a warning".to_owned(), |name| format!("output `{name}`"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::SeekFrom;

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
        // When the first bytes are lost, the later ones replace them, and the divergence is reported too.
        fs::remove_file(store.blob_path(&first.record.outputs["a"])).unwrap();
        let third = settle(b"two");
        assert!(third.divergence.is_some() && third.record != first.record);
        assert_eq!(store.action(&action).as_ref(), Some(&*third.record));
        assert!(store.is_checked(&Digest::of(b"two")));
    }
}
