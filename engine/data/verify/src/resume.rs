//! Notes of a check: the flights found sound, so that an interrupted check goes on where it ended.
//!
//! One JSON line per flight, appended when its file is done; a line that was cut short is ignored. The first line says which
//! dataset and which cosfly the notes are of. A flight counts as sound while its log has the size and the time of change
//! that it had then; tables are read and compared with their hashes in every check.

use super::files::{CheckedFiles, State};
use super::report::{LabelGap, VerifyReport};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::UNIX_EPOCH;

/// Notes of a check.
pub struct ResumeFile {
    path: PathBuf,
    file: Mutex<File>,
    known: BTreeMap<String, Line>,
}

/// The first line.
#[derive(PartialEq, Serialize, Deserialize)]
struct Head {
    notes_of: String,
    cosfly: String,
    /// BLAKE3 of `SHA256SUMS`, which names the hashes of everything.
    dataset: String,
}

/// A flight without findings.
#[derive(Serialize, Deserialize)]
struct Line {
    id: String,
    /// Size of its log, bytes, and time of its last change, nanoseconds after 1970.
    log: [u64; 2],
    /// Bytes hashed, frames, boxes, labels, gaps.
    counts: [u64; 5],
    gaps: Vec<LabelGap>,
}

impl ResumeFile {
    /// Opens the notes at `path`, or begins them.
    ///
    /// # Errors
    /// `verify-resume` for notes of something else; a file that cannot be read or written.
    pub fn open(path: &Path, folder: &Path, files: &CheckedFiles) -> Result<Self> {
        let shown = path.display();
        let failed = |error: std::io::Error| Diagnostic::io(format!("write the notes `{shown}`"), &error);
        let sums = std::fs::read(folder.join("SHA256SUMS")).unwrap_or_default();
        let head = Head {
            notes_of: "cosfly verify".to_owned(),
            cosfly: env!("CARGO_PKG_VERSION").to_owned(),
            dataset: blake3::hash(&sums).to_hex().to_string(),
        };
        let file = OpenOptions::new().read(true).append(true).create(true).open(path).map_err(failed)?;
        let mut notes = Self { path: path.to_owned(), file: Mutex::new(file), known: BTreeMap::new() };
        let lines = BufReader::new(File::open(path).map_err(failed)?).split(b'\n');
        let mut lines = lines.map_while(std::result::Result::ok);
        match lines.next() {
            None => notes.append(&head)?,
            Some(first) if serde_json::from_slice::<Head>(&first).is_ok_and(|it| it == head) => {
                // Without a sound list of files nobody knows what the notes are of.
                if files.state("files.parquet") == State::Sound {
                    let read = lines.filter_map(|line| serde_json::from_slice::<Line>(&line).ok());
                    notes.known = read.map(|line| (line.id.clone(), line)).collect();
                }
                // Ends a line that was cut short.
                notes.write(b"\n")?;
            }
            Some(_) => {
                let message = format!("`{shown}` does not hold notes of this dataset by this version of cosfly");
                return Err(Diagnostic::new("verify-resume", Fault::Input, message)
                    .hint("give another file for `--resume`, or remove this one to begin anew"));
            }
        }
        Ok(notes)
    }

    /// Size and time of change of a log; `None` where the system does not tell them.
    pub fn log_state(path: &Path) -> Option<[u64; 2]> {
        let metadata = std::fs::metadata(path).ok().filter(std::fs::Metadata::is_file)?;
        let changed = metadata.modified().ok()?.duration_since(UNIX_EPOCH).ok()?;
        Some([metadata.len(), u64::try_from(changed.as_nanos()).ok()?])
    }

    /// Findings of an earlier check of a flight, if it was sound and its log is as it was.
    pub fn known(&self, id: &str, log: [u64; 2]) -> Option<VerifyReport> {
        let line = self.known.get(id).filter(|line| line.log == log)?;
        let [bytes, frames, boxes, labels, gaps] = line.counts;
        let label_gaps = line.gaps.clone();
        let flights = VerifyReport { files: 1, flights: 1, resumed: 1, ..VerifyReport::default() };
        Some(VerifyReport { bytes, frames, boxes, labels, gaps, label_gaps, ..flights })
    }

    /// Notes a flight, unless something was found.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn note(&self, id: &str, log: [u64; 2], report: &VerifyReport) -> Result<()> {
        if report.found > 0 {
            return Ok(());
        }
        let VerifyReport { bytes, frames, boxes, labels, gaps, .. } = *report;
        let counts = [bytes, frames, boxes, labels, gaps];
        self.append(&Line { id: id.to_owned(), log, counts, gaps: report.label_gaps.clone() })
    }

    fn append(&self, line: &impl Serialize) -> Result<()> {
        let text = serde_json::to_string(line).unwrap_or_default() + "\n";
        self.write(text.as_bytes())
    }

    fn write(&self, bytes: &[u8]) -> Result<()> {
        let mut file = self.file.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        file.write_all(bytes)
            .map_err(|error| Diagnostic::io(format!("write the notes `{}`", self.path.display()), &error))
    }
}
