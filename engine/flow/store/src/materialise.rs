//! Writes an artifact as an ordinary folder: built in a sibling folder, or from the version before, then exchanged in one step.

use crate::blobs::digest_of_file;
use crate::delivered::{Delivered, Stamp, Verified};
use crate::folder::{VERSION_FILE, first_foreign, fresh_beside, put_in_place, sync_file_system};
use crate::link::{place, refused};
use crate::locks::lock_file;
use crate::names::is_relative_path;
use crate::places::check_out_folder;
use crate::side_by_side::{PER_THREAD, side_by_side};
use crate::spare::Spare;
use crate::store::Store;
use crate::turn::Turn;
use cosfly_blobs::BlobRef;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use cosfly_stage::Blobs;
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

/// State of a folder after [`materialise`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Materialised {
    /// Digest over the sorted (path, digest, size) of all files.
    pub version: Digest,
    /// Number of files in the folder.
    pub files: u64,
    /// Bytes of all files.
    pub bytes: u64,
    /// Whether anything was written; false where the folder held this version already.
    pub changed: bool,
}

/// Makes `folder` hold exactly `blobs`, by name. Files are hard links into the store where the file system supports
/// them (they are read-only), copies elsewhere. A reader of `folder` sees the old version or the new one, never a
/// mixture. Where the folder holds this version already, every file whose size or times changed since its last
/// verification is read and compared; a wrong file makes the folder be built again. A link to a folder stays, and the folder
/// behind it is written.
///
/// # Errors
/// [`Fault::Lost`] when a blob is missing or damaged, `out-not-ours` when `folder` holds other files, `out-in-store`
/// when one of folder and store is inside the other, `machine-io` or `disk-full` from the operating system.
pub fn materialise(store: &Store, blobs: &Blobs, folder: &Path) -> Result<Materialised> {
    check_names(blobs)?;
    check_out_folder(store.root(), folder)?;
    let version = content_of(blobs);
    let bytes = blobs.values().fold(0_u64, |sum, blob| sum.saturating_add(blob.bytes));
    let result = |changed| Materialised { version, files: blobs.len() as u64, bytes, changed };
    let folder = std::path::absolute(folder).map_err(|error| refused(folder, &error))?;
    let folder = behind_link(folder)?;
    let _turn = (take_turn(store, &folder)?, Turn::beside(&folder));
    let marker = fs::read(folder.join(VERSION_FILE)).ok();
    let marker = marker.map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    let new_marker = marker_of(&version, blobs);
    let before = store.delivered(&folder);
    if marker.as_ref() == Some(&new_marker) && is_right(store, blobs, &version, &folder, before.as_ref()) {
        return Ok(result(false));
    }
    check_ours(&folder, marker.as_deref(), before.as_ref())?;
    let verified = before.as_ref().map(Delivered::verified).unwrap_or_default();
    let spare = Spare::of(store, &folder);
    let delivered = match exchange_spare(&spare, blobs, &verified, &new_marker, &folder)? {
        Some(stayed) => Delivered::look_again(version, &folder, blobs, stayed),
        None => {
            build_anew(&spare, blobs, &verified, &new_marker, &folder)?;
            Delivered::look(version, &folder, blobs)
        }
    };
    // Without this record the files are read again.
    let _ = store.remember_delivered(&folder, &delivered);
    Ok(result(true))
}

/// Makes the spare of the folder the new version and exchanges both. Gives the stamps of the files that stayed, in the order
/// of `blobs`; `None` where there is no spare, or one on another file system.
fn exchange_spare(
    spare: &Spare<'_>,
    blobs: &Blobs,
    verified: &Verified,
    marker: &str,
    folder: &Path,
) -> Result<Option<Vec<Option<Stamp>>>> {
    if !folder.is_dir() {
        return Ok(None);
    }
    let updated = spare.update(blobs, verified, marker)?;
    Ok(updated.filter(|_| put_in_place(spare.path(), folder).is_ok()))
}

/// Builds the new version beside the folder and exchanges both; what was in the folder is its spare then.
fn build_anew(spare: &Spare<'_>, blobs: &Blobs, verified: &Verified, marker: &str, folder: &Path) -> Result<()> {
    let beside = beside(folder)?;
    let built = build(spare.store, blobs, verified, marker, &beside)
        .and_then(|linked| Ok((linked, put_in_place(&beside, folder).map_err(|error| refused(folder, &error))?)));
    match built {
        // A spare of copies would take as much room again.
        Ok((false, true)) => fs::remove_dir_all(&beside).map_err(|error| refused(folder, &error)),
        Ok((true, true)) => spare.keep(&beside).map_err(|error| refused(folder, &error)),
        Ok((linked, false)) => {
            if linked {
                spare.make(blobs);
            }
            Ok(())
        }
        Err(diagnostic) => {
            let _ = fs::remove_dir_all(&beside);
            Err(diagnostic)
        }
    }
}

/// Whether every file of `folder` is correct. A file with the size and times of `before` is not read.
fn is_right(store: &Store, blobs: &Blobs, version: &Digest, folder: &Path, before: Option<&Delivered>) -> bool {
    let now = Delivered::look(*version, folder, blobs);
    if before == Some(&now) && blobs.len() == now.names().count() {
        return true;
    }
    let mut right = true;
    for (name, blob) in blobs {
        let known = before.is_some_and(|before| before.agrees(&now, name));
        if !known && !holds_bytes(&folder.join(name), blob) {
            right = false;
            // It may be a hard link to the blob itself, which then has to be checked again.
            store.forget_checked(blob);
        }
    }
    if right {
        let _ = store.remember_delivered(folder, &now);
    }
    right
}

fn holds_bytes(path: &Path, blob: &BlobRef) -> bool {
    has_size(path, blob.bytes)
        && File::open(path).and_then(|mut file| digest_of_file(&mut file)).is_ok_and(|digest| digest == blob.digest)
}

fn marker_of(version: &Digest, blobs: &Blobs) -> String {
    let mut marker = format!("{version}\n");
    for name in blobs.keys() {
        marker.push_str(name);
        marker.push('\n');
    }
    marker
}

/// Digest over the sorted (path, digest, size) of all files: [`Materialised::version`].
pub fn content_of(blobs: &Blobs) -> Digest {
    let mut hasher = blake3::Hasher::new();
    for (name, blob) in blobs {
        hasher.update(&(name.len() as u64).to_le_bytes());
        hasher.update(name.as_bytes());
        hasher.update(&blob.digest.0);
        hasher.update(&blob.bytes.to_le_bytes());
    }
    Digest(*hasher.finalize().as_bytes())
}

fn check_names(blobs: &Blobs) -> Result<()> {
    match blobs.keys().find(|name| !is_relative_path(name) || *name == VERSION_FILE) {
        None => Ok(()),
        Some(name) => Err(Diagnostic::new(
            "out-bad-name",
            Fault::Bug,
            format!("an artifact has a file named `{name}`, which would lie outside its folder or hide its version"),
        )),
    }
}

fn has_size(path: &Path, bytes: u64) -> bool {
    fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_file() && metadata.len() == bytes)
}

/// Lock of a folder in the store: two processes that write it take turns. [`Turn`] is for those with another store.
fn take_turn(store: &Store, folder: &Path) -> Result<File> {
    let name = format!("out-{}", Digest::of(folder.as_os_str().as_encoded_bytes()));
    let path = store.root().join("locks").join(name);
    let locked = lock_file(&path).and_then(|file| file.lock().map(|()| file));
    locked.map_err(|error| Diagnostic::io(format!("lock `{}`", path.display()), &error))
}

/// The folder that a link leads to; `folder` itself where it is no link.
fn behind_link(folder: PathBuf) -> Result<PathBuf> {
    if !fs::symlink_metadata(&folder).is_ok_and(|metadata| metadata.is_symlink()) {
        return Ok(folder);
    }
    fs::canonicalize(&folder).map_err(|error| {
        let target = fs::read_link(&folder).unwrap_or_default();
        let message = format!("`{}` is a link to `{}`, which leads nowhere", folder.display(), target.display());
        Diagnostic::new("out-not-ours", Fault::Recipe, message)
            .because(error)
            .hint("make the folder that the link names, remove the link, or choose another folder with `--out`")
    })
}

/// Rejects a folder with anything in it that a run did not write.
fn check_ours(folder: &Path, marker: Option<&str>, before: Option<&Delivered>) -> Result<()> {
    let not_ours = |message: String| {
        Err(Diagnostic::new("out-not-ours", Fault::Recipe, message)
            .hint("choose another folder with `--out`, or move the existing files elsewhere"))
    };
    match fs::symlink_metadata(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(refused(folder, &error)),
        Ok(metadata) if !metadata.is_dir() => {
            return not_ours(format!("`{}` exists and is not a folder", folder.display()));
        }
        Ok(_) => {}
    }
    let mut known: BTreeSet<&str> = marker.unwrap_or_default().lines().skip(1).chain([VERSION_FILE]).collect();
    if marker.is_some() {
        // The marker may be damaged.
        known.extend(before.into_iter().flat_map(Delivered::names));
    }
    let foreign = first_foreign(folder, "", &known).map_err(|error| refused(folder, &error))?;
    match foreign {
        None => Ok(()),
        Some(_) if marker.is_none() => {
            not_ours(format!("`{}` is not empty and was not made by cosfly", folder.display()))
        }
        Some(name) => not_ours(format!("`{}` holds `{name}`, which was not made by cosfly", folder.display())),
    }
}

fn beside(folder: &Path) -> Result<PathBuf> {
    let made = fresh_beside(folder).ok_or_else(|| {
        let message = format!("`{}` cannot be the folder of a dataset", folder.display());
        Diagnostic::new("out-not-ours", Fault::Recipe, message).hint("choose another folder with `--out`")
    })?;
    made.map_err(|error| refused(folder, &error))
}

/// Fills an empty folder; true where all files are links. A blob that is the file that was verified in the folder before is
/// linked without being read.
fn build(store: &Store, blobs: &Blobs, verified: &Verified, marker: &str, folder: &Path) -> Result<bool> {
    let parents: BTreeSet<&str> = blobs.keys().filter_map(|name| Some(name.rsplit_once('/')?.0)).collect();
    for parent in parents {
        fs::create_dir_all(folder.join(parent)).map_err(|error| refused(folder, &error))?;
    }
    let files: Vec<(&String, &BlobRef)> = blobs.iter().collect();
    let placed = side_by_side(&files, PER_THREAD, |(name, blob)| place(store, blob, verified, &folder.join(name)));
    let linked = placed.into_iter().try_fold(true, |all, linked| linked.map(|linked| all && linked))?;
    fs::write(folder.join(VERSION_FILE), marker)
        .and_then(|()| sync_file_system(folder))
        .map_err(|error| refused(folder, &error))?;
    Ok(linked)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_blobs::OutputSink;
    use cosfly_stage::Produced;

    fn artifact(store: &Store, files: &[(&str, &str)]) -> Blobs {
        let mut sink = store.sink();
        files.iter().for_each(|(name, text)| sink.put(name, text.as_bytes()).unwrap());
        let action = Digest::of(format!("{files:?}").as_bytes());
        (*sink.settle(&action, Produced::default()).unwrap().record.outputs).clone()
    }

    fn open() -> (tempfile::TempDir, Store, PathBuf) {
        let root = tempfile::tempdir().unwrap();
        let store = Store::open(&root.path().join("store")).unwrap();
        let out = root.path().join("made/out");
        (root, store, out)
    }

    #[test]
    fn a_folder_becomes_exactly_the_artifact_and_is_left_alone_when_it_is_that_already() {
        let (_root, store, out) = open();
        let first = artifact(&store, &[("a.txt", "one"), ("b/c.txt", "two")]);
        assert!(materialise(&store, &first, &out).unwrap().changed);
        assert_eq!(fs::read_to_string(out.join("b/c.txt")).unwrap(), "two");
        assert!(!materialise(&store, &first, &out).unwrap().changed);
        let second = artifact(&store, &[("a.txt", "three")]);
        let made = materialise(&store, &second, &out).unwrap();
        assert_eq!((made.changed, made.files, made.bytes), (true, 1, 5));
        assert!(!out.join("b").exists());
        assert_eq!(fs::read_dir(out.parent().unwrap()).unwrap().count(), 1, "nothing is left beside");
        // A file that was removed or truncated is restored.
        fs::remove_file(out.join("a.txt")).unwrap();
        assert!(materialise(&store, &second, &out).unwrap().changed);
        assert_eq!(fs::read_to_string(out.join("a.txt")).unwrap(), "three");
    }

    #[test]
    fn a_file_of_the_last_version_is_not_read_again_unless_it_was_touched() {
        for touched in [false, true] {
            let (root, store, out) = open();
            let (one, two) = ([("a", "one"), ("b", "same")], [("a", "two"), ("b", "same")]);
            let (first, second) = (artifact(&store, &one), artifact(&store, &two));
            materialise(&store, &first, &out).unwrap();
            drop(store);
            let store = Store::open(&root.path().join("store")).unwrap();
            if touched {
                let path = store.blob_path(&first["b"]);
                let mut permissions = fs::metadata(&path).unwrap().permissions();
                #[expect(clippy::permissions_set_readonly_false, reason = "a file of this test")]
                permissions.set_readonly(false);
                fs::set_permissions(&path, permissions).unwrap();
                fs::write(&path, "SAME").unwrap();
                assert_eq!(materialise(&store, &second, &out).unwrap_err().fault, Fault::Lost);
                continue;
            }
            assert!(materialise(&store, &second, &out).unwrap().changed);
            let read = ["a", "b"].map(|name| store.is_checked(&second[name].digest));
            assert_eq!(read, [true, false]);
            assert_eq!(fs::read_to_string(out.join("b")).unwrap(), "same");
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_link_to_a_folder_stays_and_the_folder_behind_it_is_written() {
        let (root, store, _) = open();
        let (link, target) = (root.path().join("link"), root.path().join("far/data"));
        std::os::unix::fs::symlink(&target, &link).unwrap();
        let first = artifact(&store, &[("a.txt", "one")]);
        let refusal = materialise(&store, &first, &link).unwrap_err();
        assert!(refusal.code == "out-not-ours" && refusal.message.contains("far/data"), "{refusal}");
        fs::create_dir_all(&target).unwrap();
        for (text, changed) in [("one", true), ("one", false), ("two", true), ("three", true)] {
            let made = materialise(&store, &artifact(&store, &[("a.txt", text)]), &link).unwrap();
            assert_eq!(made.changed, changed, "{text}");
            assert_eq!(fs::read_to_string(target.join("a.txt")).unwrap(), text);
            assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        }
        // The folder is known by its own name, too.
        let same = artifact(&store, &[("a.txt", "three")]);
        assert!(!materialise(&store, &same, &target).unwrap().changed);
        // A link to a file, and one to somebody's folder.
        fs::write(root.path().join("file"), "mine").unwrap();
        fs::create_dir(root.path().join("mine")).unwrap();
        fs::write(root.path().join("mine/thesis.tex"), "x").unwrap();
        for name in ["file", "mine"] {
            let link = root.path().join(format!("to-{name}"));
            std::os::unix::fs::symlink(root.path().join(name), &link).unwrap();
            assert_eq!(materialise(&store, &same, &link).unwrap_err().code, "out-not-ours", "{name}");
        }
    }

    #[test]
    fn runs_with_different_stores_into_one_folder_both_end_whole() {
        let root = tempfile::tempdir().unwrap();
        let out = root.path().join("made/out");
        let texts = ["one", "two", "three"];
        std::thread::scope(|scope| {
            for text in texts {
                let store = Store::open(&root.path().join(text)).unwrap();
                let out = &out;
                scope.spawn(move || {
                    for round in 0..20 {
                        let files: Vec<(String, String)> =
                            (0..8).map(|file| (file.to_string(), format!("{text}{round}"))).collect();
                        let files: Vec<(&str, &str)> = files.iter().map(|(a, b)| (a.as_str(), b.as_str())).collect();
                        materialise(&store, &artifact(&store, &files), out).unwrap();
                    }
                });
            }
        });
        let held: BTreeSet<String> =
            (0..8).map(|file| fs::read_to_string(out.join(file.to_string())).unwrap()).collect();
        assert!(held.len() == 1 && texts.iter().any(|text| held.contains(&format!("{text}19"))), "{held:?}");
        assert_eq!(fs::read_dir(out.parent().unwrap()).unwrap().count(), 1, "nothing is left beside");
    }

    #[test]
    fn what_cosfly_did_not_make_is_never_replaced() {
        let (_root, store, out) = open();
        let blobs = artifact(&store, &[("a.txt", "one")]);
        fs::create_dir_all(&out).unwrap();
        fs::write(out.join("thesis.tex"), "x").unwrap();
        assert_eq!(materialise(&store, &blobs, &out).unwrap_err().code, "out-not-ours");
        fs::remove_file(out.join("thesis.tex")).unwrap();
        materialise(&store, &blobs, &out).unwrap();
        fs::write(out.join("notes.md"), "x").unwrap();
        assert!(!materialise(&store, &blobs, &out).unwrap().changed);
        let other = artifact(&store, &[("a.txt", "two")]);
        let refusal = materialise(&store, &other, &out).unwrap_err();
        assert!(refusal.message.contains("`notes.md`"), "{}", refusal.message);
        assert_eq!(fs::read_to_string(out.join("a.txt")).unwrap(), "one");
        let file = out.join("a.txt");
        assert_eq!(materialise(&store, &other, &file).unwrap_err().code, "out-not-ours");
    }

    #[test]
    fn names_outside_the_folder_are_refused() {
        let (_root, store, out) = open();
        let blob = artifact(&store, &[("a", "x")])["a"];
        for name in ["../x", "/x", "a/../../x", VERSION_FILE] {
            let blobs = Blobs::from([(name.to_owned(), blob)]);
            assert_eq!(materialise(&store, &blobs, &out).unwrap_err().code, "out-bad-name", "{name}");
        }
    }

    #[test]
    fn a_damaged_blob_is_never_given_out() {
        let (root, store, out) = open();
        let blobs = artifact(&store, &[("a", "x"), ("b", "y")]);
        drop(store);
        let store = Store::open(&root.path().join("store")).unwrap();
        let path = store.blob_path(&blobs["b"]);
        fs::remove_file(&path).unwrap();
        fs::write(&path, "z").unwrap();
        assert_eq!(materialise(&store, &blobs, &out).unwrap_err().fault, Fault::Lost);
        assert!(!out.exists() && fs::read_dir(out.parent().unwrap()).unwrap().next().is_none());
    }

    #[test]
    fn a_file_that_was_edited_keeping_its_size_and_time_is_put_back() {
        for linked in [false, true] {
            let (_root, store, out) = open();
            let blobs = artifact(&store, &[("a", "one"), ("b", "two")]);
            materialise(&store, &blobs, &out).unwrap();
            let path = out.join("b");
            let modified = fs::metadata(&path).unwrap().modified().unwrap();
            if linked {
                let blob = store.blob_path(&blobs["b"]);
                fs::remove_file(&blob).unwrap();
                fs::write(&blob, "twO").unwrap();
                fs::remove_file(&path).unwrap();
                fs::hard_link(&blob, &path).unwrap();
            } else {
                fs::remove_file(&path).unwrap();
                fs::write(&path, "twO").unwrap();
            }
            File::options().write(true).open(&path).unwrap().set_modified(modified).unwrap();
            if linked {
                assert_eq!(materialise(&store, &blobs, &out).unwrap_err().fault, Fault::Lost);
                assert!(!store.holds_blob(&blobs["b"]));
                artifact(&store, &[("a", "one"), ("b", "two")]);
            }
            assert!(materialise(&store, &blobs, &out).unwrap().changed);
            assert_eq!(fs::read_to_string(&path).unwrap(), "two");
            assert!(!materialise(&store, &blobs, &out).unwrap().changed);
        }
    }

    #[test]
    fn a_damaged_marker_and_a_lost_record_are_made_again() {
        let (_root, store, out) = open();
        let blobs = artifact(&store, &[("a", "one"), ("b", "two")]);
        materialise(&store, &blobs, &out).unwrap();
        let marker = fs::read(out.join(VERSION_FILE)).unwrap();
        let mut damaged = marker.clone();
        *damaged.iter_mut().rev().nth(1).unwrap() = 0xff;
        fs::write(out.join(VERSION_FILE), &damaged).unwrap();
        assert!(materialise(&store, &blobs, &out).unwrap().changed);
        assert_eq!(fs::read(out.join(VERSION_FILE)).unwrap(), marker);
        fs::remove_dir_all(store.root().join("out")).unwrap();
        assert!(!materialise(&store, &blobs, &out).unwrap().changed);
        assert_eq!(store.delivered(&out).unwrap().names().count(), 2);
    }
}
