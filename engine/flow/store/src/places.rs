//! Allowed places of a dataset's folder relative to the store.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use std::fs;
use std::path::{Component, Path, PathBuf};

/// Rejects a dataset's folder inside the store and a store inside the dataset's folder: files of one would be taken for
/// files of the other. Symbolic links are followed as far as they lead to something that exists.
///
/// # Errors
/// `out-in-store`, `out-not-ours` where a file is in the way, or `machine-io`.
pub fn check_out_folder(store_root: &Path, out: &Path) -> Result<()> {
    let (store, folder) = (resolved(store_root)?, resolved(out)?);
    if let Some(file) = folder.ancestors().find(|it| it.exists()).filter(|it| !it.is_dir()) {
        let message = format!("`{}` exists and is not a folder", file.display());
        return Err(Diagnostic::new("out-not-ours", Fault::Recipe, message)
            .hint("choose another folder with `--out`, or move the existing files elsewhere"));
    }
    let message = if folder == store {
        format!("`{}` is the folder of the store; a dataset cannot be put there", out.display())
    } else if folder.starts_with(&store) {
        format!("`{}` is inside the store `{}`", out.display(), store_root.display())
    } else if store.starts_with(&folder) {
        format!("the store `{}` is inside `{}`, where the dataset would be put", store_root.display(), out.display())
    } else {
        return Ok(());
    };
    Err(Diagnostic::new("out-in-store", Fault::Recipe, message)
        .hint("choose two folders side by side with `--out` and `--store`"))
}

/// Absolute path without links, `.` and `..`; components that do not exist are kept as written.
fn resolved(path: &Path) -> Result<PathBuf> {
    let absolute = std::path::absolute(path)
        .map_err(|error| Diagnostic::io(format!("find the folder `{}`", path.display()), &error))?;
    let mut place = PathBuf::new();
    for component in absolute.components() {
        if component == Component::ParentDir {
            place.pop();
            continue;
        }
        place.push(component);
        if let Ok(real) = fs::canonicalize(&place) {
            place = real;
        }
    }
    Ok(place)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn store_and_dataset_lie_side_by_side() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        let check = |store: &str, out: &str| check_out_folder(&root.join(store), &root.join(out));
        for (store, out) in [("S", "out"), ("S", "S2/out"), ("a/S", "a/out"), ("S", "S/../out")] {
            check(store, out).unwrap();
        }
        for (store, out) in [("S", "S"), ("S", "S/cas"), ("S", "x/../S/tmp/x"), ("out/S", "out"), (".cosfly", ".")] {
            assert_eq!(check(store, out).unwrap_err().code, "out-in-store", "{store} {out}");
        }
    }

    #[test]
    fn a_file_in_the_way_is_refused_before_any_work() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("file"), "text").unwrap();
        for out in ["file", "file/out"] {
            let refusal = check_out_folder(&folder.path().join("S"), &folder.path().join(out)).unwrap_err();
            assert!(refusal.code == "out-not-ours" && refusal.message.contains("file` exists"), "{refusal}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_link_into_the_store_is_seen() {
        let folder = tempfile::tempdir().unwrap();
        let store = folder.path().join("S");
        fs::create_dir_all(store.join("cas")).unwrap();
        std::os::unix::fs::symlink("S/cas", folder.path().join("link")).unwrap();
        assert_eq!(check_out_folder(&store, &folder.path().join("link/x")).unwrap_err().code, "out-in-store");
    }
}
