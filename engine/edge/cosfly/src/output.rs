//! Standard output.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use std::io::{Error, ErrorKind, Write};

/// Prints to standard output. A reader that went away (`| head`) is no error.
///
/// # Errors
/// `machine-io`, such as for a full disk.
pub fn print(text: &str) -> Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(refusal(&error)),
        Ok(()) | Err(_) => Ok(()),
    }
}

/// The refusal of standard output as a diagnostic.
pub fn refusal(error: &Error) -> Box<Diagnostic> {
    Diagnostic::new("machine-io", Fault::Machine, "could not write to standard output").because(error)
}
