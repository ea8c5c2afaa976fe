//! Hashes: every file is listed, present, and what it was.

use super::report::VerifyReport;
use super::rows;
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_fingerprint::sha256::sha256_of_reader;
use cosfly_schema::tables::FileRecord;
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;

/// The listed files.
pub struct CheckedFiles {
    /// All listed files by path.
    pub listed: BTreeMap<String, FileRecord>,
    /// Those that are present with the right hash.
    pub sound: BTreeSet<String>,
    /// Those that are present and can be read, whatever is in them.
    pub regular: BTreeSet<String>,
}

impl CheckedFiles {
    /// The sound files whose path begins so.
    pub fn sound_below<'a>(&'a self, prefix: &'a str) -> impl Iterator<Item = &'a str> {
        self.sound.iter().map(String::as_str).filter(move |path| path.starts_with(prefix))
    }
}

/// The two files that `SHA256SUMS` names; `files.parquet` names the others.
const SUMMED: [&str; 2] = ["files.parquet", "croissant.json"];
/// Longest `SHA256SUMS` that is read; two lines need less.
const SUMS_LIMIT: u64 = 64 << 10;

/// Checks `SHA256SUMS`, then every file that `files.parquet` lists, then looks for others.
pub fn check(folder: &Path, report: &mut VerifyReport) -> Result<CheckedFiles> {
    let mut files = CheckedFiles { listed: BTreeMap::new(), sound: BTreeSet::new(), regular: BTreeSet::new() };
    let sums = sums(folder, report)?;
    for path in SUMMED {
        let sha256 = sums.get(path).map(String::as_str);
        check_file(folder, &Expected { path, bytes: None, sha256 }, report, &mut files)?;
    }
    if files.sound.contains("files.parquet") {
        match rows::files(&folder.join("files.parquet")) {
            Ok(rows) => list(rows, report, &mut files.listed),
            Err(message) => report.find("files.parquet", "", "verify-schema", message),
        }
    }
    for file in files.listed.clone().values() {
        let expected = Expected { path: &file.path, bytes: Some(file.bytes), sha256: Some(&file.sha256) };
        check_file(folder, &expected, report, &mut files)?;
    }
    for path in present(folder)? {
        let is_known = files.listed.contains_key(&path) || SUMMED.contains(&&*path) || path == "SHA256SUMS";
        // A link to a folder is not walked; its listed files were found through it.
        let leads_to_known = || files.listed.keys().any(|file| file.starts_with(&format!("{path}/")));
        if !is_known && !leads_to_known() {
            report.find(&path, "", "verify-extra-file", "it is not in `files.parquet`");
        }
    }
    Ok(files)
}

fn list(rows: Vec<FileRecord>, report: &mut VerifyReport, listed: &mut BTreeMap<String, FileRecord>) {
    for (row, file) in rows.into_iter().enumerate() {
        if let Some(first) = listed.insert(file.path.clone(), file) {
            let message = format!("`{}` is listed twice", first.path);
            report.find("files.parquet", format!("row {row}"), "verify-duplicate", message);
        }
    }
}

/// The hashes in `SHA256SUMS` by path. A file without one is read all the same, so that one missing line hides
/// nothing else.
fn sums(folder: &Path, report: &mut VerifyReport) -> Result<BTreeMap<String, String>> {
    const FILE: &str = "SHA256SUMS";
    let mut sums = BTreeMap::new();
    if regular_size(folder, FILE, report)?.is_none() {
        return Ok(sums);
    }
    let mut bytes = vec![];
    File::open(folder.join(FILE))
        .and_then(|file| file.take(SUMS_LIMIT).read_to_end(&mut bytes))
        .map_err(|error| Diagnostic::io("read `SHA256SUMS`", &error))?;
    for (number, line) in String::from_utf8_lossy(&bytes).lines().enumerate() {
        let place = format!("line {}", number + 1);
        match line.split_once("  ") {
            Some((sha256, path)) if SUMMED.contains(&path) => {
                if sums.insert(path.to_owned(), sha256.to_owned()).is_some() {
                    report.find(FILE, place, "verify-hash", format!("a second line for `{path}`"));
                }
            }
            Some((_, path)) => {
                report.find(FILE, place, "verify-hash", format!("`{path}` does not belong here, only {SUMMED:?} do"));
            }
            None => report.find(FILE, place, "verify-hash", "it is not a hash, two spaces and a path"),
        }
    }
    for path in SUMMED.into_iter().filter(|path| !sums.contains_key(*path)) {
        report.find(FILE, "", "verify-hash", format!("it has no line for `{path}`"));
    }
    Ok(sums)
}

/// Known size and hash of a file.
struct Expected<'a> {
    path: &'a str,
    bytes: Option<u64>,
    sha256: Option<&'a str>,
}

fn check_file(folder: &Path, file: &Expected<'_>, report: &mut VerifyReport, files: &mut CheckedFiles) -> Result<()> {
    let path = file.path;
    if !is_inside(path) {
        report.find(path, "", "verify-path", "the path leads out of the dataset's folder");
        return Ok(());
    }
    let Some(size) = regular_size(folder, path, report)? else { return Ok(()) };
    files.regular.insert(path.to_owned());
    if let Some(listed) = file.bytes.filter(|bytes| *bytes != size) {
        report.find(path, "", "verify-size", format!("it has {size} bytes; {listed} are listed"));
        return Ok(());
    }
    let (bytes, sha256) = File::open(folder.join(path))
        .and_then(|input| sha256_of_reader(&mut input.take(size)))
        .map_err(|error| Diagnostic::io(format!("read `{path}`"), &error))?;
    report.files += 1;
    report.bytes += bytes;
    match file.sha256 {
        Some(listed) if listed != sha256 => {
            report.find(path, "", "verify-hash", format!("its SHA-256 is {sha256}; {listed} is listed"));
        }
        _ => {
            files.sound.insert(path.to_owned());
        }
    }
    Ok(())
}

/// The size of a file that can be read to its end: pipes, devices and folders are findings and never opened.
fn regular_size(folder: &Path, path: &str, report: &mut VerifyReport) -> Result<Option<u64>> {
    match std::fs::metadata(folder.join(path)) {
        Ok(found) if found.is_file() => return Ok(Some(found.len())),
        Ok(_) => report.find(path, "", "verify-not-a-file", "it is a folder, a pipe or a device; a file belongs here"),
        Err(error) if error.kind() == ErrorKind::PermissionDenied => {
            return Err(Diagnostic::io(format!("open `{path}`"), &error));
        }
        Err(error) if error.kind() == ErrorKind::NotFound => {
            report.find(path, "", "verify-missing-file", "it is listed and not there");
        }
        Err(error) => report.find(path, "", "verify-missing-file", format!("it cannot be found: {error}")),
    }
    Ok(None)
}

/// Whether a listed path is relative and goes only down.
fn is_inside(path: &str) -> bool {
    Path::new(path).components().all(|part| matches!(part, std::path::Component::Normal(_))) && !path.is_empty()
}

/// All files below the folder, hidden ones left out. Links to folders are not followed: they could lead back.
fn present(folder: &Path) -> Result<Vec<String>> {
    let mut files = vec![];
    let mut open = vec![(folder.to_owned(), String::new())];
    while let Some((directory, prefix)) = open.pop() {
        let read_error = |error| Diagnostic::io(format!("read `{}`", directory.display()), &error);
        for entry in std::fs::read_dir(&directory).map_err(read_error)? {
            let entry = entry.map_err(read_error)?;
            let name = entry.file_name().to_string_lossy().into_owned();
            if name.starts_with('.') {
                continue;
            }
            let path = format!("{prefix}{name}");
            if entry.file_type().map_err(read_error)?.is_dir() {
                open.push((entry.path(), format!("{path}/")));
            } else {
                files.push(path);
            }
        }
    }
    files.sort();
    Ok(files)
}
