//! [`Folder`]: the folder of a result; rows and logs appear in it whole or not at all.

use super::card::Card;
use super::report;
use crate::flight::{Flown, Row};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// The folder of a result: `card.json`, `rows/EPISODE.json`, `logs/EPISODE.jsonl`; once whole also `episodes.jsonl`,
/// `scores.json` and `report.md`.
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
                for part in ["rows", "logs"] {
                    let made = std::fs::create_dir_all(folder.path.join(part));
                    made.map_err(|error| Diagnostic::io(format!("make the folder {}", path.display()), &error))?;
                }
                folder.write("card.json", &text)?;
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

    /// Keeps an episode: its log, then its row.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn keep(&self, flown: &Flown) -> Result<()> {
        let name = &flown.row.episode;
        self.write(&format!("logs/{name}.jsonl"), &flown.log)?;
        self.write(&format!("rows/{name}.json"), &line(&flown.row))
    }

    /// Removes what calls that were killed left half written.
    fn clean(&self) {
        for part in [self.path.clone(), self.path.join("rows"), self.path.join("logs")] {
            for entry in part.read_dir().into_iter().flatten().flatten() {
                if entry.file_name().to_string_lossy().starts_with(".tmp") {
                    _ = std::fs::remove_file(entry.path());
                }
            }
        }
    }

    /// Writes the tables over all rows.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn finish(&self, card: &Card, rows: &[Row]) -> Result<()> {
        self.clean();
        self.write("episodes.jsonl", &rows.iter().map(line).collect::<String>())?;
        self.write("scores.json", &pretty(&report::scores(rows)))?;
        self.write("report.md", &report::markdown(card, rows))
    }

    /// Path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes a file whole or not at all.
    fn write(&self, name: &str, text: &str) -> Result<()> {
        let path = self.path.join(name);
        let place = path.parent().unwrap_or(&self.path);
        let written = tempfile::NamedTempFile::new_in(place).and_then(|mut file| {
            file.write_all(text.as_bytes())?;
            file.as_file().sync_data()?;
            file.persist(&path).map(|_| ()).map_err(|error| error.error)
        });
        written.map_err(|error| Diagnostic::io(format!("write {}", path.display()), &error))
    }
}

fn line(row: &Row) -> String {
    serde_json::to_string(row).unwrap_or_default() + "\n"
}

fn pretty(value: &impl serde::Serialize) -> String {
    serde_json::to_string_pretty(value).unwrap_or_default() + "\n"
}
