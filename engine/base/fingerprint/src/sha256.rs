//! Length and SHA-256 of data, computed while it is written or read.

use sha2::{Digest, Sha256};
use std::io::{Read, Result, Write};

/// A writer that computes the length and SHA-256 of everything written through it.
pub struct HashingWriter<W: Write> {
    output: W,
    hasher: Sha256,
    bytes: u64,
}

impl<W: Write> HashingWriter<W> {
    /// Wraps `output`; all bytes are passed on to it.
    pub fn new(output: W) -> Self {
        Self { output, hasher: Sha256::new(), bytes: 0 }
    }

    /// Number of bytes written, and their SHA-256 as 64 hex digits.
    pub fn finish(self) -> (u64, String) {
        (self.bytes, hex(&self.hasher.finalize()))
    }
}

impl<W: Write> Write for HashingWriter<W> {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        let written = self.output.write(bytes)?;
        self.hasher.update(&bytes[..written]);
        self.bytes += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> Result<()> {
        self.output.flush()
    }
}

/// SHA-256 of `bytes` as 64 hex digits.
pub fn sha256_of(bytes: &[u8]) -> String {
    hex(&Sha256::digest(bytes))
}

/// Length and SHA-256 of the rest of `input`, read to its end.
pub fn sha256_of_reader(input: &mut impl Read) -> Result<(u64, String)> {
    let mut hashing = HashingWriter::new(std::io::sink());
    std::io::copy(input, &mut hashing)?;
    Ok(hashing.finish())
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_the_one_of_sha256sum() {
        assert_eq!(sha256_of(b"abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
        let mut writer = HashingWriter::new(vec![]);
        writer.write_all(b"a").unwrap();
        writer.write_all(b"bc").unwrap();
        assert_eq!(writer.finish(), (3, sha256_of(b"abc")));
    }
}
