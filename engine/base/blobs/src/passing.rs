//! Files read or written once: pages behind the position are released from the system's file cache.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};

/// Number of bytes behind the position after which they are released.
const RELEASE_BYTES: u64 = 8 << 20;
/// Number of bytes before those that are released again: pages that were not on the disk at the last release.
const REPEATED_BYTES: u64 = 4 * RELEASE_BYTES;

/// A large file that is written or read once, from front to back.
///
/// Every few megabytes, the pages behind the position are reported to the system as no longer needed. A dataset of any
/// size then passes through a small part of the memory, other files stay in the cache, and a virtual machine need not
/// supply fresh pages all the time, which costs more than copying. Pages that are not on the disk yet are sent there
/// and released at the next call.
#[derive(Debug)]
pub struct PassingFile {
    file: File,
    /// Start of the current pass: everything from here to `position` was passed.
    passage_start: u64,
    position: u64,
    /// End of the released range.
    released: u64,
}

impl PassingFile {
    /// Wraps a file positioned at its start.
    pub fn new(file: File) -> Self {
        Self { file, passage_start: 0, position: 0, released: 0 }
    }

    /// Underlying file.
    pub fn file(&mut self) -> &mut File {
        &mut self.file
    }

    fn pass(&mut self, bytes: usize) {
        self.position += bytes as u64;
        if self.position.saturating_sub(self.released) >= RELEASE_BYTES {
            let from = self.passage_start.max(self.released.saturating_sub(REPEATED_BYTES));
            release(&self.file, from, self.position);
            self.released = self.position;
        }
    }
}

/// Advises the system only: no byte depends on it.
#[cfg(target_os = "linux")]
fn release(file: &File, from: u64, to: u64) {
    let bytes = core::num::NonZeroU64::new(to.saturating_sub(from));
    let _ = rustix::fs::fadvise(file, from, bytes, rustix::fs::Advice::DontNeed);
}

#[cfg(not(target_os = "linux"))]
fn release(_: &File, _: u64, _: u64) {}

impl Read for PassingFile {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let read = self.file.read(bytes)?;
        self.pass(read);
        Ok(read)
    }
}

impl Write for PassingFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.file.write(bytes)?;
        self.pass(written);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for PassingFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let position = self.file.seek(to)?;
        if position < self.released || position > self.position {
            (self.passage_start, self.released) = (position, position);
        }
        self.position = position;
        Ok(position)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_byte_is_lost_by_releasing_pages() {
        let path = std::env::temp_dir().join(format!("cosfly-passing-{}", std::process::id()));
        let piece: Vec<u8> = (0..1_000_003u32).map(|i| (i % 251) as u8).collect();
        let mut written = PassingFile::new(File::create(&path).unwrap());
        (0..30).for_each(|_| written.write_all(&piece).unwrap());
        written.rewind().unwrap();
        written.write_all(b"start").unwrap();
        drop(written);
        let mut bytes = vec![];
        PassingFile::new(File::open(&path).unwrap()).read_to_end(&mut bytes).unwrap();
        std::fs::remove_file(&path).unwrap();
        assert_eq!((bytes.len(), &bytes[..5]), (30 * piece.len(), &b"start"[..]));
        assert!(bytes.chunks(piece.len()).skip(1).all(|other| other == piece) && bytes[5..piece.len()] == piece[5..]);
    }
}
