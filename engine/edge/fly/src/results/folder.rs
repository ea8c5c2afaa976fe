//! [`Folder`]: the folder of a result; rows and logs appear in it whole or not at all.

use super::card::Card;
use super::report;
use crate::flight::{Flown, Row};
use crate::log::{self, Line};
use crate::whole;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use std::path::{Path, PathBuf};

/// Folders in the folder.
const PARTS: [&str; 3] = ["rows", "logs", "clips"];

/// The folder of a result: `card.json`, `rows/EPISODE.json`, `logs/EPISODE.jsonl` and `.mcap`; once whole also `episodes.jsonl`,
/// `scores.json`, `report.md`, `report.html` and `clips/EPISODE.gif`.
pub struct Folder {
    path: PathBuf,
}

impl Folder {
    /// Opens the folder for the evaluation that `card` describes, or makes it.
    ///
    /// # Errors
    /// `fly-out` where another evaluation is in the folder; errors of the file system.
    pub fn open(path: &Path, card: &Card) -> Result<Self> {
        let folder = Self { path: path.to_owned() };
        let text = pretty(card);
        match std::fs::read_to_string(folder.path.join("card.json")) {
            Ok(kept) if kept == text => {}
            Ok(_) => {
                let message = format!("`{}` holds the result of another evaluation", path.display());
                return Err(Diagnostic::new("fly-out", Fault::Recipe, message)
                    .hint("its card.json names the suite, the policy and the settings")
                    .hint("give another folder with `--out`, or another `--name` to the policy"));
            }
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                if path.read_dir().is_ok_and(|mut entries| entries.next().is_some()) {
                    let message = format!("`{}` is a folder with other files", path.display());
                    return Err(
                        Diagnostic::new("fly-out", Fault::Recipe, message).hint("give another folder with `--out`")
                    );
                }
                for part in PARTS {
                    let made = std::fs::create_dir_all(folder.path.join(part));
                    made.map_err(|error| Diagnostic::io(format!("make the folder {}", path.display()), &error))?;
                }
                folder.write("card.json", text.as_bytes())?;
            }
            Err(error) => return Err(Diagnostic::io(format!("read {}", path.join("card.json").display()), &error)),
        }
        Ok(folder)
    }

    /// Card and rows of a finished result.
    ///
    /// # Errors
    /// `fly-result` where there is none, or it is damaged.
    pub fn read(path: &Path) -> Result<(Card, Vec<Row>)> {
        let text = |name: &str| {
            std::fs::read_to_string(path.join(name)).map_err(|error| {
                let message = format!("`{}` is no finished result of `cosfly fly`", path.display());
                Diagnostic::new("fly-result", Fault::Input, message)
                    .because(format!("{name}: {error}"))
                    .hint("give the folder of a policy, such as out/street/follow; run an unfinished one to its end")
            })
        };
        let damaged = |name: &str, error: serde_json::Error| {
            let message = format!("`{}` is damaged", path.join(name).display());
            Diagnostic::new("fly-result", Fault::Input, message).because(error.to_string())
        };
        let card = serde_json::from_str(&text("card.json")?).map_err(|error| damaged("card.json", error))?;
        let rows = text("episodes.jsonl")?;
        let rows = rows.lines().map(serde_json::from_str).collect::<std::result::Result<_, _>>();
        Ok((card, rows.map_err(|error| damaged("episodes.jsonl", error))?))
    }

    /// Row of an episode, where it was flown before.
    pub fn row(&self, episode: &str) -> Option<Row> {
        let text = std::fs::read_to_string(self.path.join("rows").join(format!("{episode}.json"))).ok()?;
        serde_json::from_str(&text).ok()
    }

    /// Keeps an episode: its logs, then its row.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn keep(&self, flown: &Flown, mcap: Option<&[u8]>) -> Result<()> {
        let name = &flown.row.episode;
        self.write(&format!("logs/{name}.jsonl"), log::text(&flown.steps).as_bytes())?;
        mcap.map_or(Ok(()), |bytes| self.write(&format!("logs/{name}.mcap"), bytes))?;
        self.write(&format!("rows/{name}.json"), line(&flown.row).as_bytes())
    }

    /// The steps of an episode that was flown before.
    ///
    /// # Errors
    /// `fly-result` where its log is damaged; errors of the file system.
    pub fn steps(&self, episode: &str) -> Result<Vec<Line>> {
        let path = self.path.join(format!("logs/{episode}.jsonl"));
        let text = std::fs::read_to_string(&path);
        let text = text.map_err(|error| Diagnostic::io(format!("read {}", path.display()), &error))?;
        log::read(&text).map_err(|error| error.because(path.display().to_string()))
    }

    /// Keeps a file of an episode, in one of the folder's parts, unless it is there.
    ///
    /// # Errors
    /// Those of `make`; errors of the file system.
    pub fn keep_once(&self, name: &str, make: &dyn Fn() -> Result<Option<Vec<u8>>>) -> Result<bool> {
        if self.path.join(name).exists() {
            return Ok(true);
        }
        let made = make()?;
        made.as_ref().map_or(Ok(()), |bytes| self.write(name, bytes))?;
        Ok(made.is_some())
    }

    /// Removes a file of an episode.
    pub fn forget(&self, name: &str) {
        _ = std::fs::remove_file(self.path.join(name));
    }

    /// Removes what calls that were killed left half written.
    fn clean(&self) {
        for part in PARTS.map(|part| self.path.join(part)).into_iter().chain([self.path.clone()]) {
            for entry in part.read_dir().into_iter().flatten().flatten() {
                if entry.file_name().to_string_lossy().starts_with(".tmp") {
                    _ = std::fs::remove_file(entry.path());
                }
            }
        }
    }

    /// Writes the tables over all rows, and the page.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn finish(&self, card: &Card, rows: &[Row], page: &str) -> Result<()> {
        self.clean();
        self.write("episodes.jsonl", rows.iter().map(line).collect::<String>().as_bytes())?;
        self.write("scores.json", pretty(&report::scores(rows)).as_bytes())?;
        self.write("report.html", page.as_bytes())?;
        self.write("report.md", report::markdown(card, rows).as_bytes())
    }

    /// Path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes a file whole or not at all.
    fn write(&self, name: &str, bytes: &[u8]) -> Result<()> {
        let path = self.path.join(name);
        whole::write(&path, bytes).map_err(|error| Diagnostic::io(format!("write {}", path.display()), &error))
    }
}

fn line(row: &Row) -> String {
    serde_json::to_string(row).unwrap_or_default() + "\n"
}

fn pretty(value: &impl serde::Serialize) -> String {
    serde_json::to_string_pretty(value).unwrap_or_default() + "\n"
}
