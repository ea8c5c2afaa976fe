//! Versions of a store: one manifest each, in the folder `versions`.

use crate::version::{SCHEMA, Version};
use cosfly_diagnose::{Diagnostic, Fault, Result, nearest_name};
use cosfly_fingerprint::Digest;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Longest manifest, bytes.
const LIMIT: u64 = 1 << 30;

fn folder(store: &Path) -> PathBuf {
    store.join("versions")
}

/// Whether `name` can name a version: letters, digits, `.`, `_` and `-`, not beginning with a dot.
fn is_name(name: &str) -> bool {
    (1..=100).contains(&name.len())
        && !name.starts_with('.')
        && name.bytes().all(|byte| byte.is_ascii_alphanumeric() || matches!(byte, b'.' | b'_' | b'-'))
}

/// Adds a version. Adding an equal version again has no effect.
///
/// # Errors
/// `version-bad-name`, `version-taken` where the name belongs to another version, or `machine-io`.
pub fn put(store: &Path, version: &Version) -> Result<()> {
    let name = &version.name;
    if !is_name(name) {
        return Err(Diagnostic::new("version-bad-name", Fault::Recipe, format!("`{name}` cannot name a version"))
            .hint("use letters, digits, `.`, `_` and `-`, such as `v1.0.0`"));
    }
    let folder = folder(store);
    let path = folder.join(format!("{name}.json"));
    if path.exists() {
        let old = read(&path)?;
        if old.content == version.content {
            return Ok(());
        }
        let message = format!("`{name}` is the name of another version: {} {}", old.dataset, old.dataset_version);
        return Err(Diagnostic::new("version-taken", Fault::Recipe, message)
            .hint("choose another name: a version never changes"));
    }
    let text = serde_json::to_string_pretty(version).expect("a manifest is plain data") + "\n";
    let failed = |error: std::io::Error| Diagnostic::io(format!("write `{}`", path.display()), &error);
    std::fs::create_dir_all(&folder).map_err(failed)?;
    let mut file = tempfile::NamedTempFile::new_in(&folder).map_err(failed)?;
    file.write_all(text.as_bytes()).and_then(|()| file.as_file().sync_all()).map_err(failed)?;
    file.persist_noclobber(&path).map_err(|error| failed(error.error))?;
    Ok(())
}

/// Reads the version called `name`.
///
/// # Errors
/// `version-unknown` with the nearest name, or damage of its manifest.
pub fn get(store: &Path, name: &str) -> Result<Version> {
    let path = folder(store).join(format!("{name}.json"));
    if is_name(name) && path.exists() {
        return read(&path);
    }
    let names = names(store)?;
    let message = format!("the store `{}` has no version `{name}`", store.display());
    let refusal = Diagnostic::new("version-unknown", Fault::Recipe, message);
    Err(match nearest_name(name, names.iter().map(String::as_str)) {
        Some(near) => refusal.hint(format!("did you mean `{near}`?")),
        None if names.is_empty() => refusal.hint("`cosfly dataset tag NAME RECIPE` names one"),
        None => refusal.hint(format!("its versions are `{}`", names.join("`, `"))),
    })
}

/// Reads all versions, in the order of their names.
///
/// # Errors
/// `machine-io`, or damaged manifests.
pub fn all(store: &Path) -> Result<Vec<Version>> {
    names(store)?.iter().map(|name| read(&folder(store).join(format!("{name}.json")))).collect()
}

/// Finds the version with exactly the files of a delivered folder, by the digest in the folder's marker.
///
/// # Errors
/// The errors of [`all`].
pub fn of_content(store: &Path, content: &Digest) -> Result<Option<Version>> {
    Ok(all(store)?.into_iter().find(|version| version.content == *content))
}

fn names(store: &Path) -> Result<Vec<String>> {
    let folder = folder(store);
    let failed = |error: std::io::Error| Diagnostic::io(format!("read `{}`", folder.display()), &error);
    let entries = match std::fs::read_dir(&folder) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(vec![]),
        entries => entries.map_err(failed)?,
    };
    let mut names = vec![];
    for entry in entries {
        let name = entry.map_err(failed)?.file_name().to_string_lossy().into_owned();
        names.extend(name.strip_suffix(".json").filter(|name| is_name(name)).map(str::to_owned));
    }
    names.sort();
    Ok(names)
}

fn read(path: &Path) -> Result<Version> {
    let failed = |error: std::io::Error| Diagnostic::io(format!("read `{}`", path.display()), &error);
    let damaged = |what: String| {
        let message = format!("`{}` is not the manifest of a version", path.display());
        Diagnostic::new("version-damaged", Fault::Input, message).because(what)
    };
    let size = std::fs::metadata(path).map_err(failed)?.len();
    if size > LIMIT {
        return Err(damaged(format!("it has {size} bytes")));
    }
    let bytes = std::fs::read(path).map_err(failed)?;
    let tree: serde_json::Value = serde_json::from_slice(&bytes).map_err(|error| damaged(error.to_string()))?;
    match tree["schema"].as_str() {
        Some(SCHEMA) => serde_json::from_value(tree).map_err(|error| damaged(error.to_string())),
        other => Err(damaged(format!("its schema is {other:?}; this cosfly reads `{SCHEMA}`"))),
    }
}
