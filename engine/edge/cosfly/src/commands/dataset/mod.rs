//! `cosfly dataset`: work with finished datasets; one file per command.

mod checkout;
mod diff;
mod lint;
mod list;
mod tag;
mod version_line;

use crate::command::{Entry, dispatch, with_commands};

/// The commands, sorted by name.
const COMMANDS: &[Entry] = &[
    Entry::of::<checkout::Arguments>(),
    Entry::of::<diff::Arguments>(),
    Entry::of::<lint::Arguments>(),
    Entry::of::<list::Arguments>(),
    Entry::of::<tag::Arguments>(),
];

/// The group.
pub const DATASET: Entry = Entry { command: group, run: |matches, console| dispatch(COMMANDS, matches, console) };

fn group() -> clap::Command {
    let about = "Work with finished datasets: lint their splits, name versions, compare them, write them out again";
    with_commands(clap::Command::new("dataset").about(about), COMMANDS)
}
