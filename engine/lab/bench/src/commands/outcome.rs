//! Outcomes of measurements, their output, and counts as arguments.

use clap::builder::TypedValueParser;
use cosfly_diagnose::Diagnostic;
use std::io::{ErrorKind, Write};

/// Errors in a measurement's parameters, at least one.
pub type Refusals = Vec<Box<Diagnostic>>;

/// Outcome of a measurement.
pub type Outcome = Result<(), Refusals>;

/// Prints to standard output; a closed pipe (`| head`) is not an error.
pub fn print(text: &str) -> Outcome {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(vec![Diagnostic::io("write to standard output", &error)])
        }
        Ok(()) | Err(_) => Ok(()),
    }
}

/// Parser of a count from 1 to a million.
pub fn counts() -> impl TypedValueParser<Value = usize> {
    clap::value_parser!(u64).range(1..=1_000_000).map(|count| count as usize)
}
