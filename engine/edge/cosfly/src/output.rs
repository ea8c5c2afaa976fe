//! Standard output and standard error.

use cosfly_diagnose::{Diagnostic, Fault, Result, visible_text};
use std::borrow::Cow;
use std::io::{ErrorKind, IsTerminal, Write};

/// Prints to standard output; false when its reader went away (`| head`).
///
/// # Errors
/// `machine-io`, such as for a full disk.
pub fn print(text: &str) -> Result<bool> {
    let mut out = std::io::stdout().lock();
    // Names and texts of others must not control a terminal; files and pipes get them as they are.
    let text = if out.is_terminal() { Cow::Owned(visible_text(text)) } else { Cow::Borrowed(text) };
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(false),
        Err(error) => {
            Err(Diagnostic::new("machine-io", Fault::Machine, "could not write to standard output").because(&error))
        }
    }
}

/// Tells standard error a line. One that cannot be written (a full disk, a reader that went away) is lost: work and exit code stay as they are.
pub fn tell(text: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}
