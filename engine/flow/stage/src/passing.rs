//! Files that pass by once: what lies behind is let go from the system's file cache.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};

/// This much lies behind before it is let go, bytes.
const LET_GO_BYTES: u64 = 8 << 20;
/// Told again each time: what was not on the disk the last time, bytes.
const TOLD_AGAIN_BYTES: u64 = 4 * LET_GO_BYTES;

/// A large file that is written or read once, from front to back. The system is told at every few megabytes that those
/// behind will not be needed soon, so that datasets of any size pass through a small part of the memory: what others keep
/// in the file cache stays there, and virtual machines need not be given fresh pages all the time, which costs them more
/// than the copying. Pages that are not on the disk yet are only sent there, and let go the next time.
#[derive(Debug)]
pub struct PassingFile {
    file: File,
    /// Where the present passage began; everything from here to `position` was passed.
    began: u64,
    position: u64,
    /// Before this place the system was told already.
    let_go: u64,
}

impl PassingFile {
    /// A file at its beginning.
    pub fn new(file: File) -> Self {
        Self { file, began: 0, position: 0, let_go: 0 }
    }

    /// The file itself.
    pub fn file(&mut self) -> &mut File {
        &mut self.file
    }

    fn pass(&mut self, bytes: usize) {
        self.position += bytes as u64;
        if self.position.saturating_sub(self.let_go) >= LET_GO_BYTES {
            let_go(&self.file, self.began.max(self.let_go.saturating_sub(TOLD_AGAIN_BYTES)), self.position);
            self.let_go = self.position;
        }
    }
}

/// Advice only: whether it is taken changes no byte.
#[cfg(target_os = "linux")]
fn let_go(file: &File, from: u64, to: u64) {
    let bytes = core::num::NonZeroU64::new(to.saturating_sub(from));
    let _ = rustix::fs::fadvise(file, from, bytes, rustix::fs::Advice::DontNeed);
}

#[cfg(not(target_os = "linux"))]
fn let_go(_: &File, _: u64, _: u64) {}

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
        if position < self.let_go || position > self.position {
            (self.began, self.let_go) = (position, position);
        }
        self.position = position;
        Ok(position)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_passed_by_is_still_there() {
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
