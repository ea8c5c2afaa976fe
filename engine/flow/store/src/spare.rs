//! The spare of a delivered folder: the version before, kept in the store, which becomes the next version by the files that
//! differ and is then exchanged with the folder in one step.
//!
//! Nothing in a spare is trusted: its files are listed, and each stays only where it is the very file (device, inode, size,
//! times) that was verified in the delivered folder. So a spare that a crash left half way is as good as any.

use crate::delivered::{Stamp, Verified};
use crate::folder::{VERSION_FILE, sync_file_system};
use crate::layout::{Layout, read_dir_or_nothing};
use crate::link::place;
use crate::side_by_side::{PER_THREAD, side_by_side};
use crate::store::{Store, with_folder_of};
use cosfly_blobs::BlobRef;
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_fingerprint::Digest;
use cosfly_stage::Blobs;
use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Folder of the store with the spares of delivered folders, named by the digests of their paths.
const SPARES: &str = "spare";

/// The spare of a delivered folder.
pub(crate) struct Spare<'s> {
    pub(crate) store: &'s Store,
    path: PathBuf,
}

/// Files and folders below a spare, as paths relative to it.
#[derive(Default)]
struct Listed {
    files: Vec<String>,
    folders: Vec<String>,
}

impl<'s> Spare<'s> {
    /// Spare of `folder`, an absolute path.
    pub(crate) fn of(store: &'s Store, folder: &Path) -> Self {
        let name = Digest::of(folder.as_os_str().as_encoded_bytes()).to_string();
        Self { store, path: store.layout.folder(SPARES).join(name) }
    }

    /// Path of the spare.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Makes the spare hold exactly `blobs` and the file `marker`, durably. Gives the stamps of the files that stayed, in
    /// the order of `blobs`; `None` where there is no spare.
    ///
    /// # Errors
    /// Lost blobs, and refusals of the operating system.
    pub(crate) fn update(
        &self,
        blobs: &Blobs,
        verified: &Verified,
        marker: &str,
    ) -> Result<Option<Vec<Option<Stamp>>>> {
        let refused = |error: io::Error| Diagnostic::io(format!("write `{}`", self.path.display()), &error);
        if !fs::symlink_metadata(&self.path).is_ok_and(|metadata| metadata.is_dir()) {
            return Ok(None);
        }
        self.remove_others(blobs).map_err(refused)?;
        let files: Vec<(&String, &BlobRef)> = blobs.iter().collect();
        let stayed = side_by_side(&files, PER_THREAD, |(name, blob)| {
            verified
                .same_file(&blob.digest, &self.path.join(name))
                .map_or_else(|| self.replace(name, blob, verified).map(|()| None), |stamp| Ok(Some(stamp)))
        });
        let mut stayed = stayed.into_iter().collect::<Result<Vec<_>>>()?;
        // A new name of a file changes its time of last status change.
        let is_placed =
            |(file, stayed): (&(&String, &BlobRef), &Option<Stamp>)| stayed.is_none().then_some(file.1.digest);
        let placed: BTreeSet<Digest> = files.iter().zip(&stayed).filter_map(is_placed).collect();
        for ((_, blob), stamp) in files.iter().zip(&mut stayed) {
            *stamp = stamp.filter(|_| !placed.contains(&blob.digest));
        }
        fs::write(self.path.join(VERSION_FILE), marker).and_then(|()| sync_file_system(&self.path)).map_err(refused)?;
        Ok(Some(stayed))
    }

    /// Removes everything that is not called like a blob, the file with the version first.
    fn remove_others(&self, blobs: &Blobs) -> io::Result<()> {
        unless_gone(fs::remove_file(self.path.join(VERSION_FILE)))?;
        let mut listed = Listed::default();
        list(&self.path, "", &mut listed)?;
        for name in listed.files.iter().filter(|name| !blobs.contains_key(name)) {
            fs::remove_file(self.path.join(name))?;
        }
        let parents: BTreeSet<&str> = blobs.keys().flat_map(|name| parents_of(name)).collect();
        for folder in listed.folders.iter().filter(|folder| !parents.contains(folder.as_str())) {
            unless_gone(fs::remove_dir_all(self.path.join(folder)))?;
        }
        Ok(())
    }

    fn replace(&self, name: &str, blob: &BlobRef, verified: &Verified) -> Result<()> {
        let path = self.path.join(name);
        let refused = |error: io::Error| Diagnostic::io(format!("write `{}`", path.display()), &error);
        unless_gone(fs::remove_file(&path)).map_err(refused)?;
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(refused)?;
        }
        place(self.store, blob, verified, &path).map(drop)
    }

    /// Keeps the folder `old`, which was exchanged for a newer one, as the spare; removes it where it cannot be moved here.
    pub(crate) fn keep(&self, old: &Path) -> io::Result<()> {
        let removed = unless_gone(fs::remove_dir_all(&self.path));
        let moved = removed.and_then(|()| with_folder_of(&self.path, || fs::rename(old, &self.path)));
        moved.or_else(|_| fs::remove_dir_all(old))
    }

    /// Makes a first spare of `blobs` by links. Without one, the next version is built whole.
    pub(crate) fn make(&self, blobs: &Blobs) {
        if !self.path.exists() && self.link_all(blobs).is_err() {
            let _ = fs::remove_dir_all(&self.path);
        }
    }

    fn link_all(&self, blobs: &Blobs) -> io::Result<()> {
        let parents: BTreeSet<&str> = blobs.keys().filter_map(|name| parents_of(name).last()).collect();
        fs::create_dir_all(&self.path)?;
        parents.into_iter().try_for_each(|parent| fs::create_dir_all(self.path.join(parent)))?;
        let files: Vec<(&String, &BlobRef)> = blobs.iter().collect();
        let link = |(name, blob): &(&String, &BlobRef)| fs::hard_link(self.store.blob_path(blob), self.path.join(name));
        side_by_side(&files, PER_THREAD, link).into_iter().collect()
    }
}

/// Removes from all spares what garbage collection left without another name, and the spares of folders without a record.
pub(crate) fn sweep_spares(layout: &Layout) -> io::Result<()> {
    for entry in read_dir_or_nothing(&layout.folder(SPARES))? {
        let entry = entry?;
        let spare = entry.path();
        if !entry.file_type()?.is_dir() || !layout.folder("out").join(entry.file_name()).exists() {
            if entry.file_type()?.is_dir() {
                fs::remove_dir_all(&spare)?
            } else {
                fs::remove_file(&spare)?
            }
            continue;
        }
        let mut listed = Listed::default();
        list(&spare, "", &mut listed)?;
        for name in &listed.files {
            let path = spare.join(name);
            if names_of(&fs::symlink_metadata(&path)?) < 2 {
                fs::remove_file(&path)?;
            }
        }
    }
    Ok(())
}

#[cfg(unix)]
fn names_of(metadata: &fs::Metadata) -> u64 {
    std::os::unix::fs::MetadataExt::nlink(metadata)
}

#[cfg(not(unix))]
fn names_of(_: &fs::Metadata) -> u64 {
    1
}

fn list(folder: &Path, prefix: &str, listed: &mut Listed) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if entry.file_type()?.is_dir() {
            list(&entry.path(), &format!("{name}/"), listed)?;
            listed.folders.push(name);
        } else {
            listed.files.push(name);
        }
    }
    Ok(())
}

/// All folders above a file, the outermost first.
fn parents_of(name: &str) -> impl Iterator<Item = &str> {
    name.match_indices('/').map(|(end, _)| &name[..end])
}

fn unless_gone(removed: io::Result<()>) -> io::Result<()> {
    removed.or_else(|error| if error.kind() == io::ErrorKind::NotFound { Ok(()) } else { Err(error) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{GarbageOptions, collect_garbage, materialise};
    use cosfly_blobs::OutputSink;
    use cosfly_stage::Produced;
    use std::time::{Duration, SystemTime};

    fn artifact(store: &Store, files: &[(&str, &str)]) -> Blobs {
        let mut sink = store.sink();
        files.iter().for_each(|(name, text)| sink.put(name, text.as_bytes()).unwrap());
        let action = Digest::of(format!("{files:?}").as_bytes());
        (*sink.settle(&action, Produced::default()).unwrap().record.outputs).clone()
    }

    fn contents(folder: &Path) -> Vec<(String, String)> {
        let mut listed = Listed::default();
        list(folder, "", &mut listed).unwrap();
        listed.files.retain(|name| name != VERSION_FILE);
        let read = |name: String| (name.clone(), fs::read_to_string(folder.join(name)).unwrap());
        let mut contents: Vec<_> = listed.files.into_iter().map(read).collect();
        contents.sort();
        contents
    }

    fn expected(files: &[(&str, &str)]) -> Vec<(String, String)> {
        files.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect()
    }

    const ONE: &[(&str, &str)] = &[("a", "1"), ("old/b", "2"), ("same/c", "3"), ("same/d", "4")];
    const TWO: &[(&str, &str)] = &[("a", "5"), ("new/b", "2"), ("same/c", "3"), ("same/d", "4")];
    const THREE: &[(&str, &str)] = &[("a", "6"), ("old", "7"), ("same/c", "3"), ("same/d", "3")];

    fn open() -> (tempfile::TempDir, Store, PathBuf) {
        let root = tempfile::tempdir().unwrap();
        let store = Store::open(&root.path().join("store")).unwrap();
        let out = root.path().join("out");
        (root, store, out)
    }

    #[test]
    fn a_folder_becomes_each_version_and_its_spare_is_the_one_before() {
        let (_root, store, out) = open();
        let spare = Spare::of(&store, &out);
        let versions = [ONE, TWO, THREE, ONE, THREE, TWO].map(|files| (files, artifact(&store, files)));
        let mut before = None;
        for (files, blobs) in &versions {
            assert!(materialise(&store, blobs, &out).unwrap().changed);
            assert_eq!(contents(&out), expected(files));
            assert_eq!(contents(spare.path()), expected(before.unwrap_or(files)));
            assert!(!out.join("old").is_dir() || *files == ONE, "an empty folder is left");
            assert!(!materialise(&store, blobs, &out).unwrap().changed);
            before = Some(files);
        }
    }

    #[test]
    fn a_file_that_stays_is_neither_read_nor_linked_again() {
        let (root, store, out) = open();
        let [one, two] = [ONE, TWO].map(|files| artifact(&store, files));
        materialise(&store, &one, &out).unwrap();
        drop(store);
        let store = Store::open(&root.path().join("store")).unwrap();
        let times = |name: &str| fs::metadata(out.join(name)).unwrap();
        let before = times("same/c");
        materialise(&store, &two, &out).unwrap();
        assert!(!store.is_checked(&two["same/c"].digest) && store.is_checked(&two["a"].digest));
        #[cfg(unix)]
        assert_eq!(
            std::os::unix::fs::MetadataExt::ctime_nsec(&before),
            std::os::unix::fs::MetadataExt::ctime_nsec(&times("same/c"))
        );
        #[cfg(not(unix))]
        let _ = before;
    }

    #[test]
    fn whatever_is_in_a_spare_never_reaches_the_folder() {
        for damage in 0..6 {
            let (_root, store, out) = open();
            let [one, two] = [ONE, TWO].map(|files| artifact(&store, files));
            materialise(&store, &one, &out).unwrap();
            let spare = Spare::of(&store, &out).path().to_owned();
            match damage {
                0 => fs::remove_dir_all(&spare).unwrap(),
                1 => fs::write(spare.join("foreign"), "x").unwrap(),
                2 => fs::create_dir_all(spare.join("foreign/deep")).unwrap(),
                3 => {
                    fs::remove_file(spare.join("same/c")).unwrap();
                    fs::write(spare.join("same/c"), "9").unwrap();
                }
                4 => {
                    fs::remove_file(spare.join("a")).unwrap();
                    fs::create_dir_all(spare.join("a/b")).unwrap();
                }
                _ => {
                    fs::remove_dir_all(spare.join("same")).unwrap();
                    fs::write(spare.join("same"), "x").unwrap();
                }
            }
            assert!(materialise(&store, &two, &out).unwrap().changed);
            assert_eq!(contents(&out), expected(TWO), "damage {damage}");
            assert!(!out.join("foreign").exists());
        }
    }

    #[test]
    fn garbage_collection_empties_a_spare_of_what_nothing_else_holds_and_touches_no_delivered_file() {
        let (root, store, out) = open();
        let [one, two] = [ONE, TWO].map(|files| artifact(&store, files));
        materialise(&store, &one, &out).unwrap();
        materialise(&store, &two, &out).unwrap();
        let spare = Spare::of(&store, &out).path().to_owned();
        drop(store);
        let now = SystemTime::now() + Duration::from_secs(60);
        let options =
            GarbageOptions { keep_runs: 1, keep_age: Duration::from_secs(3600), now, pack_from: 1, dry_run: false };
        collect_garbage(&root.path().join("store"), &options).unwrap();
        assert_eq!(contents(&spare), expected(ONE), "everything is young");
        let store = Store::open(&root.path().join("store")).unwrap();
        store.remove_blob(&one["a"]).unwrap();
        drop(store);
        collect_garbage(&root.path().join("store"), &options).unwrap();
        assert_eq!(contents(&spare), expected(&ONE[1..]));
        let store = Store::open(&root.path().join("store")).unwrap();
        assert!(!materialise(&store, &two, &out).unwrap().changed);
        assert!(two.values().all(|blob| !store.is_checked(&blob.digest)), "a file was read again");
        drop(store);
        let options = GarbageOptions { keep_age: Duration::ZERO, ..options };
        collect_garbage(&root.path().join("store"), &options).unwrap();
        assert!(!spare.exists(), "the spare of a folder without a record");
    }
}
