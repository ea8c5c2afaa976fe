//! Exit codes, as the help documents them.

use cosfly_diagnose::{Diagnostic, Fault};

/// Success.
pub const SUCCESS: u8 = 0;
/// `verify` or `doctor` found problems, `ask-expert` found no flight, `eval` met rows that cannot be scored, or a policy
/// gave `fly` or `dagger` no right answer, or went away, or `leaderboard` has entries that are refused or come out differently.
pub const FOUND_PROBLEMS: u8 = 1;
/// The command line or the environment is invalid (for arguments `clap` exits itself).
pub const ARGUMENTS: u8 = 2;
/// The recipe or the command line asks for something impossible.
pub const RECIPE: u8 = 3;
/// An input file, the store or a given state is missing, unreadable, broken or does not fit.
pub const INPUT: u8 = 4;
/// System error: disk full, no permission, a file vanished.
pub const MACHINE: u8 = 5;
/// Internal error.
pub const BUG: u8 = 70;
/// Stopped by Ctrl-C or a termination signal.
pub const STOPPED: u8 = 130;

/// Exit code for one diagnostic.
pub fn code_of(diagnostic: &Diagnostic) -> u8 {
    match diagnostic.fault {
        Fault::Recipe => RECIPE,
        Fault::Input => INPUT,
        Fault::Machine | Fault::DiskFull | Fault::Lost => MACHINE,
        Fault::Stopped => STOPPED,
        Fault::Bug => BUG,
    }
}

/// Exit code for several diagnostics: the highest of their codes.
pub fn code_of_all<'a>(diagnostics: impl IntoIterator<Item = &'a Box<Diagnostic>>) -> u8 {
    diagnostics.into_iter().map(|diagnostic| code_of(diagnostic)).max().unwrap_or(SUCCESS)
}
