//! Outcomes of measurements, their output, and counts as arguments.

use clap::builder::TypedValueParser;
use cosfly_diagnose::Diagnostic;
use serde::Serialize;
use std::fmt::Display;
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

/// A report as JSON.
pub fn json(report: &impl Serialize) -> String {
    serde_json::to_string_pretty(report).unwrap_or_default() + "\n"
}

/// Prints a report, as JSON or in words.
pub fn print_report<R: Serialize + Display>(report: &R, is_json: bool) -> Outcome {
    print(&if is_json { json(report) } else { report.to_string() })
}

/// Parser of a count from 1 to a million.
pub fn counts() -> impl TypedValueParser<Value = usize> {
    clap::value_parser!(u64).range(1..=1_000_000).map(|count| count as usize)
}
