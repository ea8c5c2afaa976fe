//! The `cosfly` command: arguments, progress, exit codes. The only code that prints or reads the environment.

mod arguments;
mod cli;
mod command;
mod commands;
mod exit;
mod interrupt;
mod output;
mod progress;
mod reporter;
mod text;

use cosfly_frames::simd::Level;
use std::panic::AssertUnwindSafe;
use std::process::ExitCode;

fn main() -> ExitCode {
    guarded(called)
}

/// One call of the command line.
fn called() -> ExitCode {
    if let Err(message) = choose_vector_level() {
        eprintln!("error: {message}");
        return ExitCode::from(exit::ARGUMENTS);
    }
    let matches = cli::cli().get_matches();
    #[cfg(feature = "plugins")]
    cosfly_stages::plugins::keep_compiled_in(compiled_plugins());
    match command::dispatch(commands::COMMANDS, &matches) {
        Ok(code) => ExitCode::from(code),
        Err(command::Refusals(refusals)) => {
            let all = refusals.iter().map(|refusal| &**refusal);
            eprintln!("{}", cosfly_diagnose::render_all(all, reporter::colour()));
            exit::code_of_all(&refusals)
        }
    }
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
fn guarded(work: impl FnOnce() -> ExitCode) -> ExitCode {
    std::panic::catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| {
        eprintln!("internal error: please report the lines above, with the recipe or command line");
        ExitCode::from(exit::BUG)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_ends_with_the_code_of_a_bug() {
        let code = guarded(|| panic!("on purpose"));
        assert_eq!(format!("{code:?}"), format!("{:?}", ExitCode::from(exit::BUG)));
        assert_eq!(format!("{:?}", guarded(|| ExitCode::from(3))), format!("{:?}", ExitCode::from(3)));
    }
}
