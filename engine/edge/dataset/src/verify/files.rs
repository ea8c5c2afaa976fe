//! Hashes: every file is listed, present, and what it was.

use super::report::VerifyReport;
use super::rows;
use crate::hashing::sha256_of_reader;
use crate::tables::FileRecord;
use cosfly_diagnose::{Diagnostic, Result};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::path::Path;

/// The listed files.
pub struct CheckedFiles {
    /// All listed files by path.
    pub listed: BTreeMap<String, FileRecord>,
    /// Those that are present with the right hash.
    pub sound: BTreeSet<String>,
}

impl CheckedFiles {
    /// The sound files whose path begins so.
    pub fn sound_below<'a>(&'a self, prefix: &'a str) -> impl Iterator<Item = &'a str> {
        self.sound.iter().map(String::as_str).filter(move |path| path.starts_with(prefix))
    }
}

/// Checks `SHA256SUMS`, then every file that `files.parquet` lists, then looks for others.
pub fn check(folder: &Path, report: &mut VerifyReport) -> Result<CheckedFiles> {
    let mut sound = BTreeSet::new();
    for file in sums(folder, report)? {
        check_file(folder, &file, report, &mut sound)?;
    }
    let mut listed = BTreeMap::new();
    if sound.contains("files.parquet") {
        match rows::files(&folder.join("files.parquet")) {
            Ok(files) => listed.extend(files.into_iter().map(|file| (file.path.clone(), file))),
            Err(message) => report.find("files.parquet", "", "verify-schema", message),
        }
    }
    for file in listed.values() {
        check_file(folder, file, report, &mut sound)?;
    }
    for path in present(folder)? {
        let known = listed.contains_key(&path) || ["files.parquet", "croissant.json", "SHA256SUMS"].contains(&&*path);
        if !known {
            report.find(&path, "", "verify-extra-file", "it is not in `files.parquet`");
        }
    }
    Ok(CheckedFiles { listed, sound })
}

/// The entries of `SHA256SUMS`; sizes are not in it.
fn sums(folder: &Path, report: &mut VerifyReport) -> Result<Vec<FileRecord>> {
    let bytes =
        std::fs::read(folder.join("SHA256SUMS")).map_err(|error| Diagnostic::io("read `SHA256SUMS`", &error))?;
    let text = String::from_utf8_lossy(&bytes);
    let mut files = vec![];
    for line in text.lines() {
        if let Some((sha256, path)) = line.split_once("  ") {
            files.push(FileRecord { path: path.to_owned(), bytes: u64::MAX, sha256: sha256.to_owned() });
        }
    }
    for path in ["files.parquet", "croissant.json"] {
        if !files.iter().any(|file| file.path == path) {
            report.find("SHA256SUMS", "", "verify-hash", format!("it has no line for `{path}`"));
        }
    }
    files.retain(|file| ["files.parquet", "croissant.json"].contains(&&*file.path));
    Ok(files)
}

fn check_file(folder: &Path, file: &FileRecord, report: &mut VerifyReport, sound: &mut BTreeSet<String>) -> Result<()> {
    if !is_inside(&file.path) {
        report.find(&file.path, "", "verify-path", "the path leads out of the dataset's folder");
        return Ok(());
    }
    let mut input = match File::open(folder.join(&file.path)) {
        Ok(input) => input,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            report.find(&file.path, "", "verify-missing-file", "it is listed and not there");
            return Ok(());
        }
        Err(error) => return Err(Diagnostic::io(format!("open `{}`", file.path), &error)),
    };
    let (bytes, sha256) =
        sha256_of_reader(&mut input).map_err(|error| Diagnostic::io(format!("read `{}`", file.path), &error))?;
    report.files += 1;
    report.bytes += bytes;
    if file.bytes != u64::MAX && bytes != file.bytes {
        report.find(&file.path, "", "verify-size", format!("it has {bytes} bytes; {} are listed", file.bytes));
    } else if sha256 != file.sha256 {
        report.find(&file.path, "", "verify-hash", format!("its SHA-256 is {sha256}; {} is listed", file.sha256));
    } else {
        sound.insert(file.path.clone());
    }
    Ok(())
}

/// Whether a listed path is relative and goes only down.
fn is_inside(path: &str) -> bool {
    Path::new(path).components().all(|part| matches!(part, std::path::Component::Normal(_))) && !path.is_empty()
}

/// All files below the folder, hidden ones left out.
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
            if entry.path().is_dir() {
                open.push((entry.path(), format!("{path}/")));
            } else {
                files.push(path);
            }
        }
    }
    files.sort();
    Ok(files)
}
