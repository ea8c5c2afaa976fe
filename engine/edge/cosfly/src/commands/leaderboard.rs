//! `cosfly leaderboard`: a folder of results, flown again, as a page.

use crate::arguments::{RecipeArguments, StoreArguments, file_ending_in, threads};
use crate::command::{Command, Outcome, Refusals};
use crate::console::Console;
use crate::exit;
use crate::subject::Subject;
use clap::Parser;
use cosfly_diagnose::{Diagnostic, Fault, Result, absent};
use cosfly_fingerprint::Digest;
use cosfly_fly::board::{Bench, Offer, json, judge, page, told};
use cosfly_runner::RunOptions;
use cosfly_whole::{write_file, write_files};
use std::path::{Path, PathBuf};

/// Folders with suites and benchmarks, where none is named.
const SHIPPED: [&str; 2] = ["recipes/benchmarks", "recipes/suites"];

/// Fly a folder of results again, and write them as a page: a leaderboard without a server
#[derive(Debug, Parser)]
#[command(
    name = "leaderboard",
    after_help = "\
Examples:
  cosfly leaderboard results
  cosfly leaderboard results --run-policies
  cosfly leaderboard results --suite recipes/suites/street.toml --out public/index.html

Each file NAME.jsonl.zst of `cosfly fly bundle` is an entry; NAME.toml beside it may have `licence`, `link`, `sees` (`world`, or
`state` and channels) and `about`. Entries whose actions come to the same rows are ranked by their tracking rate; those that know the world stand
apart. With `--run-policies` baselines and networks in ONNX, in the bundle or in NAME.onnx beside it, are run again; those that give the same
actions are ranked by what they see. What has not changed is not flown again: outcomes are kept in the store. Exits with 1 when an entry is refused or comes out
differently."
)]
pub struct Arguments {
    /// Folder with the files of `cosfly fly bundle`
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
    /// Recipe of a suite, or a benchmark, that entries are of (repeatable) [default: those in recipes/benchmarks and recipes/suites]
    #[arg(long, value_name = "FILE")]
    suite: Vec<PathBuf>,
    /// The page [default: FOLDER/index.html]
    #[arg(long, value_name = "FILE", value_parser = file_ending_in(&["html", "htm"]))]
    out: Option<PathBuf>,
    #[command(flatten)]
    store: StoreArguments,
    /// Episodes at the same time [default: one per core]
    #[arg(long, short, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Run policies again, where an entry is a baseline or has its network in ONNX; no other code of an entry is ever run
    #[arg(long)]
    run_policies: bool,
    /// Print the table as JSON
    #[arg(long)]
    json: bool,
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        if !self.folder.is_dir() {
            let why = absent(&self.folder).unwrap_or_else(|| "is no folder".to_owned());
            let message = format!("`{}` {why}", self.folder.display());
            let refusal = Diagnostic::new("fly-board", Fault::Input, message);
            return Err(refusal.hint("give a folder with files that `cosfly fly bundle` made").into());
        }
        let subjects = self.subjects(console)?;
        let store = self.store.open()?;
        let jobs = threads(self.jobs);
        let cancelled = console.cancelled();
        let options = RunOptions { jobs, cancelled: console.cancelled(), ..RunOptions::default() };
        let make = |subject: &Subject| subject.make(&store, &options, &*console.run_progress(true));
        let offers: Vec<Offer<'_>> =
            subjects.iter().map(|subject| Offer::new(subject.name.clone(), || make(subject))).collect();
        let (outcomes, cosfly) = (self.store.folder().join("reflown"), env!("CARGO_PKG_VERSION"));
        let program = program()?;
        let (runs_policies, cancelled) = (self.run_policies, &*cancelled);
        let bench = Bench { offers: &offers, outcomes, cosfly, program, runs_policies, jobs, cancelled };
        let board = {
            let _deadline = console.deadline(None);
            judge(&self.folder, &bench, &*console.progress("fly again", "entries"))?
        };
        let path = self.out.clone().unwrap_or_else(|| self.folder.join("index.html"));
        write(&path, &page(&board, cosfly))?;
        if self.json {
            console.print(&json(&board))?;
        } else {
            let page = path.display();
            console.print(&format!("{}{page}: {} flown again by this call\n", told(&board), board.flown))?;
        }
        Ok(if board.is_sound() { exit::SUCCESS } else { exit::FOUND_PROBLEMS })
    }
}

impl Arguments {
    /// Suites that entries may be of.
    fn subjects(&self, console: &dyn Console) -> std::result::Result<Vec<Subject>, Refusals> {
        let paths = if self.suite.is_empty() { shipped()? } else { self.suite.clone() };
        let mut subjects = vec![];
        for recipe in paths {
            subjects.extend(Subject::all(&RecipeArguments { recipe, overrides: vec![] }, console)?);
        }
        Ok(subjects)
    }
}

/// Digest of the program that runs.
fn program() -> Result<Digest> {
    let read = std::env::current_exe().and_then(std::fs::read);
    read.map(|bytes| Digest::of(&bytes)).map_err(|error| Diagnostic::io("read the program itself", &error))
}

/// Writes the page, and makes its folder.
fn write(path: &Path, page: &str) -> Result<()> {
    let written = match (path.parent().filter(|folder| !folder.as_os_str().is_empty()), path.file_name()) {
        (Some(folder), Some(name)) if !folder.is_dir() => {
            write_files(folder, &[(name.to_string_lossy().into_owned(), page.as_bytes())])
        }
        _ => write_file(path, page.as_bytes()),
    };
    written.map_err(|error| Diagnostic::io(format!("write {}", path.display()), &error))
}

/// The suites and benchmarks that ship, sorted.
fn shipped() -> Result<Vec<PathBuf>> {
    let mut paths = vec![];
    for folder in SHIPPED {
        let entries = Path::new(folder).read_dir().map_err(|error| {
            Diagnostic::new("fly-board", Fault::Recipe, format!("there is no folder `{folder}` here"))
                .because(error)
                .hint("name suites or benchmarks: `--suite FILE`")
        })?;
        paths.extend(entries.filter_map(|entry| entry.ok().map(|entry| entry.path())));
    }
    let is_suite = |name: &str| name.ends_with(".toml") && !name.ends_with(".secret.toml");
    paths.retain(|path| path.file_name().and_then(|name| name.to_str()).is_some_and(is_suite));
    paths.sort();
    Ok(paths)
}
