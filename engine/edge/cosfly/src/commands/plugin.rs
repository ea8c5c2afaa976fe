//! `cosfly plugin`: begin and check plugins; one file per command.

use super::{plugin_check, plugin_new};
use crate::command::{Entry, dispatch, with_commands};

/// The commands, sorted by name.
const COMMANDS: &[Entry] = &[Entry::of::<plugin_check::Arguments>(), Entry::of::<plugin_new::Arguments>()];

/// The group.
pub const PLUGIN: Entry = Entry { command: group, run: |matches, console| dispatch(COMMANDS, matches, console) };

fn group() -> clap::Command {
    let about = "Begin, check and measure plugins: cost terms, objectives and stages of your own";
    with_commands(clap::Command::new("plugin").about(about), COMMANDS)
}
