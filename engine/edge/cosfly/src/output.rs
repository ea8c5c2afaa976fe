//! Standard output.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use std::io::{ErrorKind, Write};

/// Prints to standard output; false when its reader went away (`| head`).
///
/// # Errors
/// `machine-io`, such as for a full disk.
pub fn print(text: &str) -> Result<bool> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(false),
        Err(error) => {
            Err(Diagnostic::new("machine-io", Fault::Machine, "could not write to standard output").because(&error))
        }
    }
}
