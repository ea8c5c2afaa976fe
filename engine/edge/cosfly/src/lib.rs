//! The command line: arguments, commands, progress, exit codes. [`main`] is the process; [`call`] serves programs that
//! embed the command line, such as the Python package.

mod arguments;
mod cli;
mod command;
mod commands;
pub mod console;
pub mod exit;
pub mod expert;
mod gone;
mod interrupt;
mod output;
mod progress;
pub mod recipe_file;
mod reporter;
mod subject;
mod text;
mod town_names;

use console::{Console, Terminal};
use cosfly_diagnose::Diagnostic;
use cosfly_frames::simd::Level;
use cosfly_secrets::without_secrets;
use std::ffi::OsString;
use std::panic::AssertUnwindSafe;

/// The reason why a call did no work.
#[derive(Debug)]
pub enum Refusal {
    /// The arguments are invalid, or ask for help: the text for the user.
    Arguments(Box<clap::Error>),
    /// The work cannot be done.
    Work(Vec<Box<Diagnostic>>),
}

/// The process `cosfly`, with the given arguments (without the name of the program); returns its exit code.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    guarded(|| {
        if let Err(message) = prepare() {
            output::tell(&format!("error: {message}"));
            return exit::ARGUMENTS;
        }
        match call(arguments, &Terminal) {
            Ok(code) => code,
            Err(Refusal::Arguments(error)) => error.exit(),
            Err(Refusal::Work(refusals)) => {
                let all = refusals.iter().map(|refusal| &**refusal);
                output::tell(&without_secrets(&cosfly_diagnose::render_all(all, Terminal.colour())));
                exit::code_of_all(&refusals)
            }
        }
    })
}

/// Runs the command with the given arguments (without the name of the program) and returns its exit code.
///
/// # Errors
/// [`Refusal`].
pub fn call(arguments: impl IntoIterator<Item = OsString>, console: &dyn Console) -> Result<u8, Refusal> {
    let line: Vec<OsString> = std::iter::once(OsString::from("cosfly")).chain(arguments).collect();
    let matches = cli::cli().try_get_matches_from(&line).map_err(|error| {
        let command = line.get(1).and_then(|word| word.to_str()).unwrap_or_default();
        Refusal::Arguments(Box::new(gone::explained(command, error)))
    })?;
    command::dispatch(commands::COMMANDS, &matches, console).map_err(|refusals| Refusal::Work(refusals.0))
}

/// Reads the environment, once per process: the vector level, the user's folder of compiled plugins.
///
/// # Errors
/// A message about a value that is not allowed.
pub fn prepare() -> Result<(), String> {
    choose_vector_level()?;
    #[cfg(feature = "plugins")]
    cosfly_experts::plugins::keep_compiled_in(compiled_plugins());
    Ok(())
}

/// All vector levels give the same bytes; `COSFLY_SIMD` chooses one to show that, empty counts as unset.
fn choose_vector_level() -> Result<(), String> {
    let Some(name) = std::env::var("COSFLY_SIMD").ok().filter(|name| !name.is_empty()) else { return Ok(()) };
    let available = Level::available();
    let Some(level) = available.iter().find(|level| level.name() == name) else {
        let names: Vec<_> = available.iter().map(|level| level.name()).collect();
        return Err(format!("COSFLY_SIMD is `{name}`; this processor has {}", names.join(", ")));
    };
    level.make_best();
    Ok(())
}

/// The user's own folder for compiled plugins; none where the environment names none.
#[cfg(feature = "plugins")]
fn compiled_plugins() -> Option<std::path::PathBuf> {
    let folder = |name: &str| std::env::var_os(name).map(std::path::PathBuf::from).filter(|path| path.is_absolute());
    let caches = folder("XDG_CACHE_HOME").or_else(|| folder("HOME").map(|home| home.join(".cache")));
    caches.map(|caches| caches.join("cosfly").join("plugins"))
}

/// Runs `work`; a panic is an internal error with an exit code of its own.
fn guarded(work: impl FnOnce() -> u8) -> u8 {
    std::panic::catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| {
        output::tell("internal error: please report the lines above, with the recipe or command line");
        exit::BUG
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_ends_with_the_code_of_a_bug() {
        let code = guarded(|| panic!("on purpose"));
        assert_eq!((code, guarded(|| 3)), (exit::BUG, 3));
    }
}
