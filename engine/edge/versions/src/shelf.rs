//! Versions of a store: one manifest each, in the folder `versions`.

use crate::version::{SCHEMA, Version};
use cosfly_diagnose::{Diagnostic, Fault, Result, counted, nearest_name};
use cosfly_fingerprint::Digest;
use serde::Deserialize;
use serde_json::Value;
use std::io::{BufReader, BufWriter, Write};
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
        return same(&path, version);
    }
    let failed = |error: std::io::Error| Diagnostic::io(format!("write `{}`", path.display()), &error);
    std::fs::create_dir_all(&folder).map_err(failed)?;
    let mut file = tempfile::NamedTempFile::new_in(&folder).map_err(failed)?;
    // Written piece by piece: the manifest of a hundred thousand flights has a hundred megabytes.
    let mut writer = BufWriter::new(&mut file);
    let written = serde_json::to_writer_pretty(&mut writer, version).map_err(std::io::Error::from);
    written.and_then(|()| writer.write_all(b"\n")).and_then(|()| writer.flush()).map_err(failed)?;
    drop(writer);
    file.as_file().sync_all().map_err(failed)?;
    match file.persist_noclobber(&path) {
        Ok(_) => Ok(()),
        // Another process was first.
        Err(error) if error.error.kind() == std::io::ErrorKind::AlreadyExists => same(&path, version),
        Err(error) => Err(failed(error.error)),
    }
}

/// Refuses a version whose name belongs to another one.
fn same(path: &Path, version: &Version) -> Result<()> {
    let old = read(path)?;
    if old.content == version.content {
        return Ok(());
    }
    let message = format!("`{}` is the name of another version: {} {}", version.name, old.dataset, old.dataset_version);
    Err(Diagnostic::new("version-taken", Fault::Recipe, message).hint("choose another name: a version never changes"))
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

/// All versions, in the order of their names, each read when it is its turn.
///
/// # Errors
/// `machine-io`, or damaged manifests.
pub fn all(store: &Path) -> Result<impl Iterator<Item = Result<Version>> + use<>> {
    let folder = folder(store);
    Ok(names(store)?.into_iter().map(move |name| read(&folder.join(format!("{name}.json")))))
}

/// Finds the version with exactly the files of a delivered folder, by the digest in the folder's marker.
///
/// # Errors
/// The errors of [`all`].
pub fn of_content(store: &Path, content: &Digest) -> Result<Option<Version>> {
    all(store)?.find(|version| version.as_ref().map_or(true, |version| version.content == *content)).transpose()
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
        return Err(damaged(format!("it has {size}", size = counted(size, "byte"))));
    }
    let open = || std::fs::File::open(path).map(BufReader::new).map_err(failed);
    let head: Head = serde_json::from_reader(open()?).map_err(|error| damaged(error.to_string()))?;
    match head.schema {
        Some(Value::String(schema)) if schema == SCHEMA => {
            serde_json::from_reader(open()?).map_err(|error| damaged(error.to_string()))
        }
        other => {
            let other = other.as_ref().and_then(Value::as_str);
            Err(damaged(format!("its schema is {other:?}; this cosfly reads `{SCHEMA}`")))
        }
    }
}

/// Keys that tell whether a manifest can be read; all else is passed over.
#[derive(Deserialize)]
struct Head {
    schema: Option<Value>,
}
