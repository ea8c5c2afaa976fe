//! Counts the lines of a stream, and refuses elements that would fill the memory.

use std::io::{BufRead, Error, ErrorKind, Read, Result};

/// Longest element, bytes.
const LONGEST_ELEMENT: usize = 1 << 20;

/// A stream whose lines are counted.
pub(super) struct Lines<R> {
    inner: R,
    /// Line of what is read next, from 1.
    pub line: u64,
    since_element: usize,
}

impl<R: BufRead> Lines<R> {
    pub fn new(inner: R) -> Self {
        Self { inner, line: 1, since_element: 0 }
    }
}

impl<R: BufRead> Read for Lines<R> {
    fn read(&mut self, out: &mut [u8]) -> Result<usize> {
        let have = self.fill_buf()?;
        let count = have.len().min(out.len());
        out[..count].copy_from_slice(&have[..count]);
        self.consume(count);
        Ok(count)
    }
}

impl<R: BufRead> BufRead for Lines<R> {
    fn fill_buf(&mut self) -> Result<&[u8]> {
        if self.since_element > LONGEST_ELEMENT {
            return Err(Error::new(ErrorKind::InvalidData, "an element is longer than 1 MiB"));
        }
        self.inner.fill_buf()
    }

    fn consume(&mut self, count: usize) {
        // What was handed out last is still in the buffer.
        if let Ok(bytes) = self.inner.fill_buf() {
            let taken = &bytes[..count.min(bytes.len())];
            self.line += taken.iter().filter(|byte| **byte == b'\n').count() as u64;
            self.since_element = match taken.iter().rposition(|byte| *byte == b'>') {
                Some(last) => taken.len() - last - 1,
                None => self.since_element + taken.len(),
            };
        }
        self.inner.consume(count);
    }
}
