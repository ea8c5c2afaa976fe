//! The end of a measurement, its output, and its counts.

use clap::builder::TypedValueParser;
use cosfly_diagnose::Diagnostic;
use std::io::{ErrorKind, Write};

/// Everything that can be wrong with a measurement's parameters, at least one.
pub type Refusals = Vec<Box<Diagnostic>>;

/// The end of a measurement.
pub type Outcome = Result<(), Refusals>;

/// Prints to standard output; a reader that went away (`| head`) is no error.
pub fn print(text: &str) -> Outcome {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(vec![Diagnostic::io("write to standard output", &error)])
        }
        Ok(()) | Err(_) => Ok(()),
    }
}

/// A number from 1 to a million.
pub fn counts() -> impl TypedValueParser<Value = usize> {
    clap::value_parser!(u64).range(1..=1_000_000).map(|count| count as usize)
}
