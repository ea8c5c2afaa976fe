//! Hashes: every file is listed, present, and what it was.

use super::report::VerifyReport;
use super::rows;
use cosfly_diagnose::{Diagnostic, Result, Stop, counted};
use cosfly_fingerprint::sha256::sha256_of_reader;
use cosfly_read::inner_path;
use cosfly_schema::tables::FileRecord;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;

/// State of a file, as far as known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum State {
    /// Not looked at, missing, or no file.
    Unread,
    /// Present and readable, whatever is in it.
    Regular,
    /// Present with the right hash.
    Sound,
}

/// The dataset's files. Logs are read with their flights, all others at once.
pub struct CheckedFiles {
    files: BTreeMap<String, Known>,
    /// Ends the check.
    pub stop: Stop,
}

/// A file that is listed in `files.parquet`, or named by `SHA256SUMS`.
struct Known {
    /// Size and hash in `files.parquet`.
    listed: Option<(u64, Box<str>)>,
    state: State,
}

impl CheckedFiles {
    /// The sound files whose path begins so.
    pub fn sound_below<'a>(&'a self, prefix: &'a str) -> impl Iterator<Item = &'a str> {
        self.below(prefix).filter(|(_, known)| known.state == State::Sound).map(|(path, _)| path)
    }

    fn below<'a>(&'a self, prefix: &'a str) -> impl Iterator<Item = (&'a str, &'a Known)> {
        let from = self.files.range(prefix.to_owned()..);
        from.map(|(path, known)| (path.as_str(), known)).take_while(move |(path, _)| path.starts_with(prefix))
    }

    /// Size and hash of a listed file.
    pub fn listed(&self, path: &str) -> Option<(u64, &str)> {
        self.files.get(path)?.listed.as_ref().map(|(bytes, sha256)| (*bytes, &**sha256))
    }

    /// State of a file; logs are unread.
    pub fn state(&self, path: &str) -> State {
        self.files.get(path).map_or(State::Unread, |known| known.state)
    }

    /// Paths of all listed logs.
    pub fn logs(&self) -> impl Iterator<Item = &str> {
        self.below(LOGS).map(|(path, _)| path)
    }

    /// Compares a listed log with its size and hash.
    ///
    /// # Errors
    /// It is there and cannot be read.
    pub fn check_log(&self, folder: &Path, path: &str, report: &mut VerifyReport) -> Result<State> {
        match self.listed(path) {
            Some((bytes, sha256)) => {
                let expected = Expected { path, bytes: Some(bytes), sha256: Some(sha256) };
                check_file(folder, &expected, &self.stop, report)
            }
            None => Ok(State::Unread),
        }
    }

    /// Compares the size of a listed log alone.
    ///
    /// # Errors
    /// It must not be looked at.
    pub fn check_size(&self, folder: &Path, path: &str, report: &mut VerifyReport) -> Result<()> {
        if let Some((listed, _)) = self.listed(path).filter(|_| is_inside(path))
            && let Some(size) = regular_size(folder, path, report)?
            && size != listed
        {
            report.find(path, "", "verify-size", size_message(size, listed));
        }
        Ok(())
    }
}

/// Folder of the logs.
const LOGS: &str = "mcap/";
/// The two files that `SHA256SUMS` names; `files.parquet` names the others.
const SUMMED: [&str; 2] = ["files.parquet", "croissant.json"];
/// Longest `SHA256SUMS` that is read; two lines need less.
const SUMS_LIMIT: u64 = 64 << 10;

/// Checks `SHA256SUMS`, then every file that `files.parquet` lists but for logs, then looks for others.
pub fn check(folder: &Path, stop: &Stop, report: &mut VerifyReport) -> Result<CheckedFiles> {
    let mut files = CheckedFiles { files: BTreeMap::new(), stop: stop.clone() };
    let sums = sums(folder, report)?;
    for path in SUMMED {
        let sha256 = sums.get(path).map(String::as_str);
        let state = check_file(folder, &Expected { path, bytes: None, sha256 }, stop, report)?;
        files.files.insert(path.to_owned(), Known { listed: None, state });
    }
    if files.state("files.parquet") == State::Sound {
        match rows::files(&folder.join("files.parquet")) {
            Ok(rows) => list(rows, report, &mut files.files),
            Err(message) => report.find("files.parquet", "", "verify-schema", message),
        }
    }
    check_listed(folder, &mut files, report)?;
    each_present(folder, &mut |path| {
        // A link to a folder is not walked; its listed files were found through it.
        let leads_to_known = || files.below(&format!("{path}/")).next().is_some();
        if !files.files.contains_key(path) && path != "SHA256SUMS" && !leads_to_known() {
            report.find(path, "", "verify-extra-file", "it is not in `files.parquet`");
        }
    })?;
    Ok(files)
}

/// Checks all listed files but logs, side by side.
fn check_listed(folder: &Path, files: &mut CheckedFiles, report: &mut VerifyReport) -> Result<()> {
    let stop = files.stop.clone();
    let mut entries: Vec<(&String, &mut Known)> =
        files.files.iter_mut().filter(|(path, known)| known.listed.is_some() && !path.starts_with(LOGS)).collect();
    for together in entries.chunks_mut(TOGETHER) {
        let checked: Vec<Result<VerifyReport>> = together
            .par_iter_mut()
            .map(|(path, known)| {
                let mut report = VerifyReport::default();
                if let Some((bytes, sha256)) = &known.listed {
                    let expected = Expected { path, bytes: Some(*bytes), sha256: Some(sha256) };
                    known.state = known.state.max(check_file(folder, &expected, &stop, &mut report)?);
                }
                Ok(report)
            })
            .collect();
        checked.into_iter().try_for_each(|checked| checked.map(|checked| report.absorb(checked)))?;
    }
    Ok(())
}

/// Files that are checked before their findings are joined.
const TOGETHER: usize = 1024;

fn list(rows: Vec<FileRecord>, report: &mut VerifyReport, files: &mut BTreeMap<String, Known>) {
    for (row, file) in rows.into_iter().enumerate() {
        let known = files.entry(file.path).or_insert(Known { listed: None, state: State::Unread });
        if known.listed.replace((file.bytes, file.sha256.into())).is_some() {
            report.find("files.parquet", format!("row {row}"), "verify-duplicate", "its path is listed twice");
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

fn check_file(folder: &Path, file: &Expected<'_>, stop: &Stop, report: &mut VerifyReport) -> Result<State> {
    let path = file.path;
    if !is_inside(path) {
        report.find(path, "", "verify-path", "the path leads out of the dataset's folder");
        return Ok(State::Unread);
    }
    let Some(size) = regular_size(folder, path, report)? else { return Ok(State::Unread) };
    if let Some(listed) = file.bytes.filter(|bytes| *bytes != size) {
        report.find(path, "", "verify-size", size_message(size, listed));
        return Ok(State::Regular);
    }
    let (bytes, sha256) = File::open(folder.join(path))
        .and_then(|input| sha256_of_reader(&mut stop.reading(input.take(size))))
        .map_err(|error| Diagnostic::io(format!("read `{path}`"), &error))?;
    report.files += 1;
    report.bytes += bytes;
    match file.sha256 {
        Some(listed) if listed != sha256 => {
            report.find(path, "", "verify-hash", format!("its SHA-256 is {sha256}; {listed} is listed"));
            Ok(State::Regular)
        }
        _ => Ok(State::Sound),
    }
}

fn size_message(size: u64, listed: u64) -> String {
    format!("it has {size}; {listed} are listed", size = counted(size, "byte"))
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
    inner_path(Path::new(""), path).is_some()
}

/// All files below the folder, folder by folder in the order of names, hidden ones left out. Links to folders are not
/// followed: they could lead back.
fn each_present(folder: &Path, visit: &mut dyn FnMut(&str)) -> Result<()> {
    let mut open = vec![(folder.to_owned(), String::new())];
    while let Some((directory, prefix)) = open.pop() {
        let read_error = |error| Diagnostic::io(format!("read `{}`", directory.display()), &error);
        let mut entries = vec![];
        for entry in std::fs::read_dir(&directory).map_err(read_error)? {
            let entry = entry.map_err(read_error)?;
            let name = entry.file_name().to_string_lossy().into_owned();
            if !name.starts_with('.') {
                entries.push((name, entry.file_type().map_err(read_error)?.is_dir()));
            }
        }
        entries.sort();
        for (name, is_folder) in entries.into_iter().rev() {
            let path = format!("{prefix}{name}");
            if is_folder {
                open.push((directory.join(name), format!("{path}/")));
            } else {
                visit(&path);
            }
        }
    }
    Ok(())
}
