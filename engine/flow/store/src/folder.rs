//! Folders on disk: built in a sibling folder, exchanged in one step, searched for foreign files.

use std::collections::BTreeSet;
use std::fs;
#[cfg(target_os = "linux")]
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

/// File in a materialised folder with its version and the names of its files.
pub const VERSION_FILE: &str = ".cosfly-version";

/// First file below `folder` that is not in `known`, as a path relative to `folder`.
pub(crate) fn first_foreign(folder: &Path, prefix: &str, known: &BTreeSet<&str>) -> io::Result<Option<String>> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        let foreign = if entry.file_type()?.is_dir() {
            first_foreign(&entry.path(), &format!("{name}/"), known)?
        } else {
            (!known.contains(name.as_str())).then_some(name)
        };
        if foreign.is_some() {
            return Ok(foreign);
        }
    }
    Ok(None)
}

/// Creates an empty folder next to `folder`, on the same file system; leftovers of killed runs there are removed.
/// `None` where `folder` has no name of its own.
pub(crate) fn fresh_beside(folder: &Path) -> Option<io::Result<PathBuf>> {
    let (parent, name) = (folder.parent()?, folder.file_name()?);
    let beside = parent.join(format!(".{}.cosfly-tmp", name.to_string_lossy()));
    let made = fs::create_dir_all(parent)
        .and_then(|()| match fs::remove_dir_all(&beside) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
            _ => Ok(()),
        })
        .and_then(|()| fs::create_dir(&beside));
    Some(made.map(|()| beside))
}

/// Makes everything below `folder` durable.
pub(crate) fn sync_file_system(folder: &Path) -> io::Result<()> {
    #[cfg(target_os = "linux")]
    match rustix::fs::syncfs(File::open(folder)?) {
        Ok(()) | Err(rustix::io::Errno::NOSYS | rustix::io::Errno::PERM | rustix::io::Errno::OPNOTSUPP) => {}
        Err(error) => return Err(error.into()),
    }
    #[cfg(not(target_os = "linux"))]
    let _ = folder;
    Ok(())
}

/// Exchanges the new folder with the old one, in one step where the system supports it. True where the old folder is in the
/// place of the new one then; false where there was none.
pub(crate) fn put_in_place(new: &Path, folder: &Path) -> io::Result<bool> {
    match fs::rename(new, folder) {
        // The folder did not exist or was empty.
        Ok(()) => return Ok(false),
        Err(error) if fs::symlink_metadata(folder).is_err() => return Err(error),
        Err(_) => {}
    }
    if exchange(new, folder).is_ok() {
        return Ok(true);
    }
    let old = new.with_extension("cosfly-old");
    let _ = fs::remove_dir_all(&old);
    fs::rename(folder, &old)?;
    if let Err(error) = fs::rename(new, folder) {
        fs::rename(&old, folder)?;
        return Err(error);
    }
    fs::rename(&old, new).map(|()| true)
}

#[cfg(target_os = "linux")]
fn exchange(a: &Path, b: &Path) -> io::Result<()> {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    Ok(renameat_with(CWD, a, CWD, b, RenameFlags::EXCHANGE)?)
}

#[cfg(not(target_os = "linux"))]
fn exchange(_a: &Path, _b: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}
