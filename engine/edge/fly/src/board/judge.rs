//! [`judge`]: flies the entries of a folder again, but for those whose outcome is known.

use super::entry::{Entry, Found, Proof, names};
use super::sees::PolicySees;
use super::sketch::sketch;
use super::standing::{Board, Refused};
use crate::again::{Again, by_record};
use crate::bundle::Bundle;
use crate::flight::Row;
use crate::pilot::Runnable;
use crate::results::{Card, SuiteCard, worst};
use crate::suite::Suite;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_env::EnvironmentSettings;
use cosfly_fingerprint::Digest;
use cosfly_whole::write_file;
use serde::{Deserialize, Serialize};
use std::cell::OnceCell;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// Version of kept outcomes.
const OUTCOMES: u32 = 2;
/// Most letters of a reason.
const MOST_LETTERS: usize = 300;

/// A suite that entries may be of. It is made when the first entry names it.
pub struct Offer<'a> {
    name: String,
    make: Box<dyn Fn() -> Result<Suite> + 'a>,
    made: OnceCell<Suite>,
}

impl<'a> Offer<'a> {
    /// The suite of a name.
    pub fn new(name: String, make: impl Fn() -> Result<Suite> + 'a) -> Self {
        Self { name, make: Box::new(make), made: OnceCell::new() }
    }

    fn suite(&self) -> Result<&Suite> {
        if let Some(made) = self.made.get() {
            return Ok(made);
        }
        let made = (self.make)()?;
        Ok(self.made.get_or_init(|| made))
    }
}

/// Tools that entries are judged with.
pub struct Bench<'a> {
    /// Suites that entries may be of.
    pub offers: &'a [Offer<'a>],
    /// Folder where outcomes are kept: what has not changed is not flown again.
    pub outcomes: PathBuf,
    /// Version of cosfly.
    pub cosfly: &'static str,
    /// Digest of the program: outcomes are kept for the very same one.
    pub program: Digest,
    /// Whether policies are run again, where an entry has its own.
    pub runs_policies: bool,
    /// Threads.
    pub jobs: usize,
    /// Set from anywhere to stop.
    pub cancelled: &'a AtomicBool,
}

/// Judges all entries of a folder. `progress` gets the numbers of judged and of all entries.
///
/// # Errors
/// Errors of the file system and of suites; `fly-stopped`. What is wrong with an entry is on the board.
pub fn judge(folder: &Path, bench: &Bench<'_>, progress: &dyn Fn(u64, u64)) -> Result<Board> {
    let names = names(folder)?;
    let (mut entries, mut refused, mut flown) = (vec![], vec![], 0);
    for (name, number) in names.iter().zip(0..) {
        progress(number, names.len() as u64);
        if bench.cancelled.load(Ordering::Relaxed) {
            let message = "stopped; what was flown again is kept";
            return Err(Diagnostic::new("fly-stopped", Fault::Stopped, message));
        }
        match bench.entry(folder, name, &mut flown) {
            Ok(entry) => entries.push(entry),
            Err(Rejection::Entry(reason)) => refused.push(Refused { file: name.clone(), reason: shortened(&reason) }),
            Err(Rejection::Machine(problem)) => return Err(problem),
        }
    }
    Ok(Board::of(entries, refused, flown))
}

/// Words that hold texts of a file, at most [`MOST_LETTERS`] of them.
fn shortened(words: &str) -> String {
    match words.char_indices().nth(MOST_LETTERS) {
        Some((end, _)) => format!("{}...", &words[..end]),
        None => words.to_owned(),
    }
}

/// Why there is no entry.
enum Rejection {
    /// Its files are at fault; in words.
    Entry(String),
    /// A fault of this machine, not of the entry.
    Machine(Box<Diagnostic>),
}

impl From<String> for Rejection {
    fn from(reason: String) -> Self {
        Self::Entry(reason)
    }
}

impl From<Box<Diagnostic>> for Rejection {
    fn from(problem: Box<Diagnostic>) -> Self {
        Self::Machine(problem)
    }
}

/// An entry that was flown again: all that the board needs of its file.
#[derive(Serialize, Deserialize)]
struct Kept {
    card: Card,
    /// In the order of the suite.
    rows: Vec<Row>,
    /// Where episodes come out differently, in words.
    differ: Vec<String>,
    /// The worst episode from above.
    clip: String,
    /// The policy, run again.
    rerun: Option<Rerun>,
}

/// A policy that was run again.
#[derive(Serialize, Deserialize)]
struct Rerun {
    /// Its inputs; nothing where it could not be run.
    sees: Vec<String>,
    /// Where it gives other actions, or why it could not be run, in words.
    differ: Vec<String>,
}

/// Settings of each part of a suite that a card is of.
fn settings(card: &Card, suite: &Suite) -> std::result::Result<Vec<EnvironmentSettings>, String> {
    card.settings(&suite.parts).map_err(|rule| format!("its environment is not one of this suite: {rule}"))
}

/// The worst episode of a bundle as a drawing; nothing where its actions cannot be flown.
fn clip(bundle: &Bundle, suite: &Suite, settings: &[EnvironmentSettings]) -> String {
    let rows: Vec<Row> = bundle.episodes.iter().map(|record| record.row.clone()).collect();
    let Some(name) = worst(&rows, 1).first().map(|row| &row.episode) else { return String::new() };
    let task = suite.tasks.iter().find(|task| task.episode.name == *name);
    let record = bundle.episodes.iter().find(|record| record.row.episode == *name);
    let Some((task, record)) = task.zip(record) else { return String::new() };
    let flown = by_record(task, settings[task.part], bundle.card.is_measured(), record);
    flown.map_or(String::new(), |flown| sketch(task, &flown.steps))
}

impl Bench<'_> {
    fn entry(&self, folder: &Path, name: &str, flown: &mut usize) -> std::result::Result<Entry, Rejection> {
        let Found { bytes, policy, notes } = Found::read(folder, name)?;
        // The same bytes, judged by the same program; suite and settings are looked at below.
        let policy = policy.filter(|_| self.runs_policies);
        let beside = policy.as_ref().map_or_else(String::new, |policy| Digest::of(policy).to_string());
        let (file, program, runs) = (Digest::of(&bytes), self.program, self.runs_policies);
        let key = format!("{OUTCOMES}\n{file}\n{program}\n{runs} {beside}\n");
        let place = self.outcomes.join(Digest::of(key.as_bytes()).to_string());
        let kept = std::fs::read(&place).ok().and_then(|kept| serde_json::from_slice::<Kept>(&kept).ok());
        let kept = match kept {
            Some(kept) => kept,
            None => {
                let bundle = Bundle::of_bytes(&bytes).map_err(|rule| format!("it is no whole bundle: {rule}"))?;
                let kept = self.fly(bundle, policy.as_deref())?;
                *flown += 1;
                self.keep(&place, &kept)?;
                kept
            }
        };
        let suite = self.suite(&kept.card)?;
        settings(&kept.card, suite)?;
        let suite = SuiteCard::of(suite);
        let Kept { card, rows, differ, clip, rerun } = kept;
        let shown = rerun.as_ref().filter(|rerun| rerun.differ.is_empty()).map(|rerun| rerun.sees.as_slice());
        let sees = PolicySees::of(&card, &notes, &rows, shown)?;
        let proof = match rerun {
            _ if !differ.is_empty() => Proof::Claimed(differ),
            Some(rerun) if rerun.differ.is_empty() => Proof::Rerun,
            Some(rerun) if rerun.sees.is_empty() => Proof::NotRun(rerun.differ),
            rerun => Proof::Reflown(rerun.map_or(vec![], |rerun| rerun.differ)),
        };
        Ok(Entry { file: name.to_owned(), card, suite, rows, notes, sees, proof, clip })
    }

    /// The suite of a card: found by its name, held by its hash.
    fn suite(&self, card: &Card) -> std::result::Result<&Suite, Rejection> {
        let (asked, mut hashes) = (&card.suite, vec![]);
        for offer in self.offers.iter().filter(|offer| offer.name == asked.name) {
            let suite = offer.suite()?;
            if suite.digest.to_string() == asked.hash {
                return Ok(suite);
            }
            hashes.push(suite.digest.short());
        }
        if hashes.is_empty() {
            let known: Vec<String> = self.offers.iter().map(|offer| format!("`{}`", offer.name)).collect();
            return Err(format!("it is of the suite `{}`; here are {}", asked.name, known.join(", ")).into());
        }
        let (hash, theirs): (String, _) = (asked.hash.chars().take(12).collect(), &card.cosfly);
        let (ours, name) = (hashes.join(", "), &asked.name);
        Err(format!(
            "it is of another suite: its `{name}` has the hash {hash}, the one here {ours} \
             (it was flown with cosfly {theirs}, here is {})",
            self.cosfly
        )
        .into())
    }

    fn fly(&self, bundle: Bundle, beside: Option<&[u8]>) -> std::result::Result<Kept, Rejection> {
        let suite = self.suite(&bundle.card)?;
        let settings = settings(&bundle.card, suite)?;
        let (jobs, cancelled) = (self.jobs, self.cancelled);
        let again = Again { bundle: &bundle, suite, settings: &settings, jobs, cancelled };
        let rerun = if self.runs_policies { run_again(&again, beside)? } else { None };
        let differ = match &rerun {
            // The same actions were flown, to the same rows.
            Some(rerun) if rerun.differ.is_empty() => vec![],
            _ => again.by_record(&|_, _| ()).map_err(rejection)?,
        };
        let clip = clip(&bundle, suite, &settings);
        let at = |row: &Row| suite.tasks.iter().position(|task| task.episode.name == row.episode);
        let mut rows: Vec<Row> = bundle.episodes.into_iter().map(|episode| episode.row).collect();
        rows.sort_by_cached_key(at);
        let differ = differ.iter().map(|words| shortened(words)).collect();
        Ok(Kept { card: bundle.card, rows, differ, clip, rerun })
    }

    fn keep(&self, place: &Path, kept: &Kept) -> Result<()> {
        let text = serde_json::to_string(kept).unwrap_or_default();
        let written = std::fs::create_dir_all(&self.outcomes).and_then(|()| write_file(place, text.as_bytes()));
        written.map_err(|error| Diagnostic::io(format!("write {}", place.display()), &error))
    }
}

/// The policy of an entry, run again; none where there is none to run.
fn run_again(again: &Again<'_>, beside: Option<&[u8]>) -> std::result::Result<Option<Rerun>, Rejection> {
    let bundle = again.bundle;
    let policy = match Runnable::of(&bundle.card.policy, bundle.policy.as_deref().or(beside)) {
        Ok(Some(policy)) => policy,
        Ok(None) => return Ok(None),
        Err(rule) => return Ok(Some(Rerun { sees: vec![], differ: vec![shortened(&rule)] })),
    };
    let differ = again.by_policy(&policy, &|_, _| ()).map_err(rejection)?;
    let sees = policy.sees().into_iter().map(str::to_owned).collect();
    Ok(Some(Rerun { sees, differ: differ.iter().map(|words| shortened(words)).collect() }))
}

/// Whether what went wrong is the entry's fault.
fn rejection(problem: Box<Diagnostic>) -> Rejection {
    match problem.fault {
        Fault::Input => Rejection::Entry(problem.message),
        _ => Rejection::Machine(problem),
    }
}
