//! The seam: what a command of the command line is.

use crate::console::Console;
use clap::{ArgMatches, CommandFactory, FromArgMatches};
use cosfly_diagnose::Diagnostic;

/// A command. Name, help, examples and arguments are those of the struct, which derives `clap::Parser`.
pub trait Command: CommandFactory + FromArgMatches {
    /// Does the work and returns the exit code.
    ///
    /// # Errors
    /// The reasons why the work cannot be done; their kinds decide the exit code.
    fn run(&self, console: &dyn Console) -> Outcome;
}

/// Exit code of a command, or why there is none.
pub type Outcome = Result<u8, Refusals>;

/// The reasons why a command cannot be carried out, at least one.
#[derive(Debug)]
#[expect(clippy::vec_box, reason = "diagnostics come boxed, in `Result`s")]
pub struct Refusals(pub Vec<Box<Diagnostic>>);

impl From<Box<Diagnostic>> for Refusals {
    fn from(refusal: Box<Diagnostic>) -> Self {
        Self(vec![refusal])
    }
}

impl From<Vec<Box<Diagnostic>>> for Refusals {
    fn from(refusals: Vec<Box<Diagnostic>>) -> Self {
        Self(refusals)
    }
}

/// A [`Command`], or a group of them, as an entry of a list.
pub struct Entry {
    /// Name, help and arguments.
    pub command: fn() -> clap::Command,
    /// Work.
    pub run: fn(&ArgMatches, &dyn Console) -> Outcome,
}

impl Entry {
    /// The entry of a command.
    pub const fn of<C: Command>() -> Self {
        Self { command: C::command, run: run::<C> }
    }
}

fn run<C: Command>(matches: &ArgMatches, console: &dyn Console) -> Outcome {
    C::from_arg_matches(matches).unwrap_or_else(|error| error.format(&mut C::command()).exit()).run(console)
}

/// `group` with the commands of a list.
pub fn with_commands(group: clap::Command, commands: &[Entry]) -> clap::Command {
    group
        .subcommands(commands.iter().map(|entry| (entry.command)()))
        .subcommand_required(true)
        .arg_required_else_help(true)
}

/// Runs the command of a list that was asked for.
pub fn dispatch(commands: &[Entry], matches: &ArgMatches, console: &dyn Console) -> Outcome {
    let (name, matches) = matches.subcommand().expect("a subcommand is required");
    let entry = commands.iter().find(|entry| (entry.command)().get_name() == name);
    (entry.expect("clap knows the commands of the list alone").run)(matches, console)
}
