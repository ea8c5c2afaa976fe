//! `cosfly map`: work with map files; one file per command.

mod areas;
mod convert;
mod inspect;
pub mod mesh;
mod own_recipe;
mod tiles;
mod town;

use crate::command::{Entry, dispatch, with_commands};

/// The commands, sorted by name.
const COMMANDS: &[Entry] =
    &[Entry::of::<convert::Arguments>(), Entry::of::<inspect::Arguments>(), Entry::of::<tiles::Arguments>()];

/// The group.
pub const MAP: Entry = Entry { command: group, run: |matches, console| dispatch(COMMANDS, matches, console) };

fn group() -> clap::Command {
    with_commands(
        clap::Command::new("map").about("Work with map files: what is read from them, a plan, and towns as scans"),
        COMMANDS,
    )
}
