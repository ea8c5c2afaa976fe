//! The `cosfly` command: arguments, progress, exit codes. The only code that prints or reads the environment.

mod arguments;
mod commands;
mod exit;
mod interrupt;
mod reporter;
mod text;

#[cfg(feature = "plugins")]
use arguments::PluginCommand;
use arguments::{Arguments, Command, DatasetCommand, TaskCommand};
use clap::Parser;
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_frames::simd::Level;
use std::io::{ErrorKind, Write};
use std::panic::AssertUnwindSafe;
use std::process::ExitCode;

fn main() -> ExitCode {
    guarded(command)
}

/// One call of the command line.
fn command() -> ExitCode {
    if let Err(message) = choose_vector_level() {
        eprintln!("error: {message}");
        return ExitCode::from(exit::ARGUMENTS);
    }
    let arguments = Arguments::parse();
    #[cfg(feature = "plugins")]
    cosfly_stages::plugins::keep_compiled_in(compiled_plugins());
    let outcome = match arguments.command {
        Command::Run(arguments) => commands::run::run(&arguments),
        Command::Plan(arguments) => commands::plan::plan(&arguments),
        Command::PlanFrom(arguments) => commands::plan_from::plan_from(&arguments),
        Command::Why(arguments) => commands::why::why(&arguments),
        Command::Graph(arguments) => commands::graph::graph(&arguments),
        Command::Verify(arguments) => commands::verify::verify(&arguments),
        Command::Dataset(DatasetCommand::Lint(arguments)) => commands::dataset_lint::dataset_lint(&arguments),
        Command::Dataset(DatasetCommand::Tag(arguments)) => commands::dataset_versions::tag(&arguments),
        Command::Dataset(DatasetCommand::List(arguments)) => commands::dataset_versions::list(&arguments),
        Command::Dataset(DatasetCommand::Diff(arguments)) => commands::dataset_versions::diff(&arguments),
        Command::Dataset(DatasetCommand::Checkout(arguments)) => commands::dataset_versions::checkout(&arguments),
        Command::Eval(arguments) => commands::eval::eval(&arguments),
        Command::Preview(arguments) => commands::preview::preview(&arguments),
        Command::Doctor(arguments) => commands::doctor::doctor(&arguments),
        Command::Export(arguments) => commands::export::export(&arguments),
        Command::CarlaJob(arguments) => commands::carla_job::carla_job(&arguments),
        Command::Gc(arguments) => commands::collect::collect(&arguments),
        Command::Schema(arguments) => commands::schema::schema(&arguments),
        Command::Town(arguments) => commands::town::town(&arguments),
        #[cfg(feature = "plugins")]
        Command::Plugin(PluginCommand::New(arguments)) => commands::plugin_new::new(&arguments),
        #[cfg(feature = "plugins")]
        Command::Plugin(PluginCommand::Check(arguments)) => commands::plugin_check::check(&arguments),
        #[cfg(feature = "plugins")]
        Command::Plugin(PluginCommand::Bench(arguments)) => commands::plugin_bench::bench(&arguments),
        Command::Task(TaskCommand::Run { digest, store }) => commands::task::run(&digest, &store),
    };
    match outcome {
        Ok(code) => ExitCode::from(code),
        Err(refusals) => {
            let all = refusals.iter().map(|refusal| &**refusal);
            eprintln!("{}", cosfly_diagnose::render_all(all, reporter::colour()));
            exit::code_of_all(&refusals)
        }
    }
}

/// Everything gives the same bytes with every vector level; `COSFLY_SIMD` chooses one to see that, empty counts as unset.
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

/// Prints to standard output; a reader that went away (`| head`) is no error, a full disk is.
fn print(text: &str) -> Result<(), commands::Refusals> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(vec![unwritten(&error)]),
        Ok(()) | Err(_) => Ok(()),
    }
}

/// What to say when standard output takes nothing more.
fn unwritten(error: &std::io::Error) -> Box<Diagnostic> {
    Diagnostic::new("machine-io", Fault::Machine, "could not write to standard output").because(error)
}

/// Runs `work`; a panic is cosfly's own fault and ends with the exit code for that.
fn guarded(work: impl FnOnce() -> ExitCode) -> ExitCode {
    std::panic::catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| {
        eprintln!("error: cosfly itself is wrong here; please report the lines above, with the recipe or command line");
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
