//! [`inside`]: files that lie in a folder, links followed.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_read::inner_path;
use std::path::{Path, PathBuf};

/// The file `name` of `folder`, with all links resolved. Unlike other readers, a server follows no link out of the folder: what a
/// stranger's dataset links to is not the stranger's.
///
/// # Errors
/// `view-outside`, `view-file` for a pipe or a device, which a reader would wait for; or the file is not there.
pub fn inside(folder: &Path, name: &str) -> Result<PathBuf> {
    let refused = |path: &Path, error: std::io::Error| Diagnostic::io(format!("open `{}`", path.display()), &error);
    let outside = || {
        let message = format!("the viewer does not open `{name}`: it leads out of `{}`", folder.display());
        Diagnostic::new("view-outside", Fault::Input, message)
            .hint("where you trust the dataset, copy it with its links resolved: `cp -rL`")
    };
    let root = folder.canonicalize().map_err(|error| refused(folder, error))?;
    let path = inner_path(&root, name).ok_or_else(outside)?;
    let real = path.canonicalize().map_err(|error| refused(&path, error))?;
    if !real.starts_with(&root) {
        return Err(outside());
    }
    if !real.is_file() && !real.is_dir() {
        let message = format!("the viewer does not open `{name}`: it is not a file");
        return Err(Diagnostic::new("view-file", Fault::Input, message));
    }
    Ok(real)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(unix)]
    fn links_within_the_folder_are_followed_and_those_out_of_it_are_not() {
        let scratch = tempfile::tempdir().expect("a folder");
        let folder = scratch.path().join("data");
        std::fs::create_dir(&folder).expect("writable");
        std::fs::write(scratch.path().join("secret"), "x").expect("writable");
        std::fs::write(folder.join("log"), "x").expect("writable");
        std::os::unix::fs::symlink(folder.join("log"), folder.join("near")).expect("linked");
        std::os::unix::fs::symlink(scratch.path().join("secret"), folder.join("far")).expect("linked");
        assert!(inside(&folder, "log").is_ok() && inside(&folder, "near").is_ok());
        for name in ["far", "../secret", "/etc/passwd", ""] {
            assert_eq!(inside(&folder, name).err().map(|error| error.code), Some("view-outside"), "{name}");
        }
        assert!(inside(&folder, "absent").is_err());
        let _socket = std::os::unix::net::UnixListener::bind(folder.join("socket")).expect("a socket");
        assert_eq!(inside(&folder, "socket").err().map(|error| error.code), Some("view-file"));
    }
}
