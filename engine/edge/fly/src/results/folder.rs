//! [`Folder`]: the folder of a result; rows and logs appear in it whole or not at all.

use super::card::Card;
use super::differences::differences;
use super::report;
use crate::flight::{FlownEpisode, Row};
use crate::log::{self, LogLine};
use cosfly_diagnose::{Diagnostic, Fault, Result, counted};
use cosfly_whole::{Appeared, NewFolder, write_file};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// Folders in the folder.
const PARTS: [&str; 3] = ["rows", "logs", "clips"];

/// The folder of a result: `card.json`, `rows/EPISODE.json`, `logs/EPISODE.jsonl` and `.mcap`; once whole also `episodes.jsonl`,
/// `scores.json`, `report.md`, `report.html` and `clips/EPISODE.gif`. It appears with its card when the first episode is kept: a
/// policy that never flies leaves none.
pub struct Folder {
    path: PathBuf,
    card: String,
    /// Whether the folder with this card was there, or was made.
    is_there: AtomicBool,
}

impl Folder {
    /// The folder of the evaluation that `card` describes, which may be there already.
    ///
    /// # Errors
    /// `fly-out` where something else is in the folder; errors of the file system.
    pub fn open(path: &Path, card: &Card) -> Result<Self> {
        let folder = Self { path: path.to_owned(), card: pretty(card), is_there: AtomicBool::new(false) };
        folder.look()?;
        Ok(folder)
    }

    /// Whether the folder is there with this card.
    fn look(&self) -> Result<bool> {
        let card = self.path.join("card.json");
        loop {
            match std::fs::read_to_string(&card) {
                Ok(kept) if kept == self.card => {
                    self.is_there.store(true, Ordering::Relaxed);
                    return Ok(true);
                }
                Ok(kept) => return Err(self.other_evaluation(&kept)),
                Err(error) if error.kind() == ErrorKind::NotFound => {}
                Err(error) => return Err(Diagnostic::io(format!("read {}", card.display()), &error)),
            }
            let is_empty = match self.path.read_dir() {
                Ok(mut entries) => entries.next().is_none(),
                Err(error) => error.kind() == ErrorKind::NotFound,
            };
            // Between the two looks another process may have made it: folder and card appear together.
            if is_empty {
                return Ok(false);
            }
            if !card.exists() {
                let message = format!("`{}` is a folder with other files", self.path.display());
                let refusal = Diagnostic::new("fly-out", Fault::Recipe, message);
                return Err(refusal.hint("give another folder with `--out`"));
            }
        }
    }

    fn other_evaluation(&self, kept: &str) -> Box<Diagnostic> {
        let message = format!("`{}` holds the result of another evaluation", self.path.display());
        let refusal = Diagnostic::new("fly-out", Fault::Recipe, message);
        let values = (serde_json::from_str(kept).ok(), serde_json::from_str(&self.card).ok());
        let refusal = match values {
            (Some(kept), Some(asked)) => differences("", &kept, &asked).into_iter().fold(refusal, Diagnostic::because),
            _ => refusal.because("its card.json is damaged"),
        };
        refusal.hint("give another folder with `--out`, or another `--name` to the policy; or remove this one")
    }

    /// Makes the folder with its card, where nobody has.
    fn make(&self) -> Result<()> {
        if self.is_there.load(Ordering::Relaxed) {
            return Ok(());
        }
        let refused = |error: &std::io::Error| Diagnostic::io(format!("make {}", self.path.display()), error);
        let made = || {
            let folder = NewFolder::beside(&self.path)?;
            PARTS.iter().try_for_each(|part| std::fs::create_dir(folder.path().join(part)))?;
            std::fs::write(folder.path().join("card.json"), &self.card)?;
            folder.appear()
        };
        if made().map_err(|error| refused(&error))? == Appeared::Taken {
            // Another share of the evaluation was first; what it made is looked at as any other folder.
            self.look()?;
        }
        self.is_there.store(true, Ordering::Relaxed);
        Ok(())
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
        let card: Card = serde_json::from_str(&text("card.json")?).map_err(|error| damaged("card.json", error))?;
        let rows = text("episodes.jsonl")?;
        let rows = rows.lines().map(serde_json::from_str).collect::<std::result::Result<Vec<Row>, _>>();
        let rows = rows.map_err(|error| damaged("episodes.jsonl", error))?;
        if rows.len() as u64 != card.suite.episodes {
            let all = counted(card.suite.episodes, "episode");
            let message = format!("`{}` has {} of {all}", path.display(), rows.len());
            return Err(Diagnostic::new("fly-result", Fault::Input, message)
                .hint("fly it again: the same command makes the tables of all rows"));
        }
        Ok((card, rows))
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
    pub fn keep(&self, flown: &FlownEpisode, mcap: Option<&[u8]>) -> Result<()> {
        let name = &flown.row.episode;
        self.make()?;
        self.write(&format!("logs/{name}.jsonl"), log::text(&flown.steps).as_bytes())?;
        mcap.map_or(Ok(()), |bytes| self.write(&format!("logs/{name}.mcap"), bytes))?;
        self.write(&format!("rows/{name}.json"), line(&flown.row).as_bytes())
    }

    /// The steps of an episode that was flown before.
    ///
    /// # Errors
    /// `fly-result` where its log is damaged; errors of the file system.
    pub fn steps(&self, episode: &str) -> Result<Vec<LogLine>> {
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
        self.make()?;
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
        write_file(&path, bytes).map_err(|error| Diagnostic::io(format!("write {}", path.display()), &error))
    }
}

fn line(row: &Row) -> String {
    serde_json::to_string(row).unwrap_or_default() + "\n"
}

fn pretty(value: &impl serde::Serialize) -> String {
    serde_json::to_string_pretty(value).unwrap_or_default() + "\n"
}
