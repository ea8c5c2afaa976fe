//! A flag by which the user ends long work from outside.

use super::{Diagnostic, Result};
use std::io::Read;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether the user asked to stop; clones share the flag. The default is never set.
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    /// The flag `asked`.
    pub fn of(asked: Arc<AtomicBool>) -> Self {
        Self(asked)
    }

    /// Whether to stop.
    pub fn is_asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Fails when the user asked to stop, for `?` between pieces of the work `subject`.
    ///
    /// # Errors
    /// [`crate::Fault::Stopped`].
    pub fn check(&self, subject: &str) -> Result<()> {
        if self.is_asked() { Err(Diagnostic::stopped(subject)) } else { Ok(()) }
    }

    /// `input`, whose reads fail once the user asked to stop: ends long reading wherever it happens.
    pub fn reading<R>(&self, input: R) -> StoppableReader<'_, R> {
        StoppableReader { input, stop: self }
    }
}

/// See [`Stop::reading`].
#[derive(Debug)]
pub struct StoppableReader<'s, R> {
    input: R,
    stop: &'s Stop,
}

impl<R: Read> Read for StoppableReader<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        if self.stop.is_asked() { Err(std::io::Error::other("stopped")) } else { self.input.read(buffer) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stop_is_shared_and_ends_checks_and_reads() {
        let flag = Arc::new(AtomicBool::new(false));
        let stop = Stop::of(Arc::clone(&flag));
        let mut reader = stop.reading(&[7u8; 4][..]);
        let mut two = [0; 2];
        assert!(stop.check("work").is_ok() && reader.read_exact(&mut two).is_ok());
        flag.store(true, Ordering::Relaxed);
        assert!(reader.read_exact(&mut two).is_err());
        assert_eq!(stop.clone().check("work").unwrap_err().fault, crate::Fault::Stopped);
        assert!(!Stop::default().is_asked());
    }
}
