//! The seam: surroundings of a command. The terminal is one; a program that embeds the command line brings its own.

pub use crate::interrupt::{Deadline, remove_scratch};
use crate::output;
use crate::progress::Bar;
use crate::reporter::Reporter;
use crate::{interrupt, reporter};
use cosfly_diagnose::{Result, Stop};
use cosfly_stage::RunEvent;
use std::io::BufRead;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Shows the number of finished parts and that of all parts; the display is removed when dropped.
pub type Progress<'a> = Box<dyn Fn(u64, u64) + 'a>;
/// Shows the events of a run, from all threads; the display is removed when dropped.
pub type RunProgress<'a> = Box<dyn Fn(RunEvent) + Sync + 'a>;

/// Output, input, progress and cancellation of a command.
pub trait Console: Sync {
    /// Prints a part of the result; false when nobody reads any more (`| head`).
    ///
    /// # Errors
    /// `machine-io`, such as for a full disk.
    fn print(&self, text: &str) -> Result<bool>;

    /// Prints a message about the work, such as a failure.
    fn tell(&self, message: &str);

    /// Input of commands that read a recipe or states from standard input.
    fn input(&self) -> Box<dyn BufRead + '_>;

    /// The flag that stops a command; finished items are kept.
    fn cancelled(&self) -> Arc<AtomicBool>;

    /// The flag that stops a command that has nothing to keep, within a second. A terminal ends the process instead.
    fn stop(&self) -> Stop;

    /// Until it is dropped, ends the process two seconds after [`Self::cancelled`] was set, and removes the folder `scratch`
    /// of the command before. None where the process is not ours: who ends such a command early removes the folder.
    fn deadline(&self, _scratch: Option<&Path>) -> Option<Deadline> {
        None
    }

    /// Whether messages have colours.
    fn colour(&self) -> bool;

    /// Progress of one kind of work, such as `verify` of `flights`.
    fn progress(&self, verb: &str, noun: &str) -> Progress<'_>;

    /// Progress of a run.
    fn run_progress(&self, quiet: bool) -> RunProgress<'_>;
}

/// Standard output, error and input of the process, and its signals.
pub struct Terminal;

impl Console for Terminal {
    fn print(&self, text: &str) -> Result<bool> {
        output::print(text)
    }

    fn tell(&self, message: &str) {
        output::tell(&cosfly_secrets::without_secrets(message));
    }

    fn input(&self) -> Box<dyn BufRead + '_> {
        Box::new(std::io::stdin().lock())
    }

    fn cancelled(&self) -> Arc<AtomicBool> {
        interrupt::flag()
    }

    fn stop(&self) -> Stop {
        Stop::default()
    }

    fn deadline(&self, scratch: Option<&Path>) -> Option<Deadline> {
        Some(Deadline::begin(scratch))
    }

    fn colour(&self) -> bool {
        reporter::colour()
    }

    fn progress(&self, verb: &str, noun: &str) -> Progress<'_> {
        let bar = Bar::new(verb, noun);
        Box::new(move |done, all| bar.show(done, all))
    }

    fn run_progress(&self, quiet: bool) -> RunProgress<'_> {
        let reporter = Reporter::new(quiet);
        Box::new(move |event| reporter.show(event))
    }
}
