//! A file that is hashed while it is written.

use crate::blobs::digest_of_file;
use cosfly_blobs::{BlobRef, PassingFile};
use cosfly_fingerprint::Digest;
use std::fs::File;
use std::io::{self, Seek, SeekFrom, Write};

/// A file that is hashed while it is written from front to back, and read again only where it was written in another
/// order.
pub(crate) struct DigestingFile {
    file: PassingFile,
    hasher: blake3::Hasher,
    /// Position of the next write.
    position: u64,
    /// Number of bytes hashed, all from the front.
    hashed: u64,
    in_order: bool,
    /// First error of a write; the stage may have wrapped it in a message of its own.
    pub(crate) refused: Option<io::Error>,
}

impl DigestingFile {
    pub(crate) fn new(file: File) -> Self {
        let file = PassingFile::new(file);
        Self { file, hasher: blake3::Hasher::new(), position: 0, hashed: 0, in_order: true, refused: None }
    }

    /// Reference to the written bytes.
    pub(crate) fn finish(mut self) -> io::Result<BlobRef> {
        let bytes = self.file.file().metadata()?.len();
        let digest = if self.in_order && bytes == self.hashed {
            Digest(*self.hasher.finalize().as_bytes())
        } else {
            self.file.rewind()?;
            digest_of_file(self.file.file())?
        };
        Ok(BlobRef { digest, bytes })
    }
}

impl Write for DigestingFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self.file.write(bytes) {
            Ok(length) => {
                if self.position == self.hashed {
                    self.hasher.update(&bytes[..length]);
                    self.hashed += length as u64;
                } else {
                    self.in_order = false;
                }
                self.position += length as u64;
                Ok(length)
            }
            Err(error) => {
                if error.kind() != io::ErrorKind::Interrupted && self.refused.is_none() {
                    self.refused = Some(copy_of(&error));
                }
                Err(error)
            }
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for DigestingFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.position = self.file.seek(to)?;
        Ok(self.position)
    }
}

fn copy_of(error: &io::Error) -> io::Error {
    error.raw_os_error().map_or_else(|| io::Error::new(error.kind(), error.to_string()), io::Error::from_raw_os_error)
}
