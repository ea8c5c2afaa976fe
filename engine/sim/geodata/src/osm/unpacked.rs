//! [`Unpacked`]: text of a plain or gzipped file as a stream with limits, so that a small file cannot fill the memory.

use flate2::bufread::MultiGzDecoder;
use std::io::{self, BufRead, BufReader, Read};

/// Most bytes after unpacking: of any file, and of a small one with so many times its own bytes; texts of maps shrink to a
/// tenth.
const MOST_BYTES: u64 = 4 << 30;
const MOST_BYTES_OF_ANY: u64 = 256 << 20;
const MOST_TIMES_ITSELF: u64 = 100;

/// Most bytes that a packed file of a size may unpack to.
pub fn most_unpacked(bytes: usize) -> u64 {
    (MOST_BYTES_OF_ANY + MOST_TIMES_ITSELF * bytes as u64).min(MOST_BYTES)
}

/// Most bytes of one tag or text of the XML.
const LONGEST_PIECE: usize = 1 << 20;
/// First bytes of a gzip file.
pub const GZIP_MAGIC: &[u8] = &[0x1f, 0x8b];

/// A stream of text.
pub struct Unpacked<'b> {
    source: Source<'b>,
    most: u64,
    left: u64,
    piece: usize,
}

enum Source<'b> {
    Plain(&'b [u8]),
    Packed(Box<BufReader<MultiGzDecoder<&'b [u8]>>>),
}

impl<'b> Unpacked<'b> {
    /// The text of a file.
    pub fn new(bytes: &'b [u8]) -> Self {
        let source = if bytes.starts_with(GZIP_MAGIC) {
            Source::Packed(Box::new(BufReader::with_capacity(1 << 16, MultiGzDecoder::new(bytes))))
        } else {
            Source::Plain(bytes)
        };
        let most = most_unpacked(bytes.len());
        Self { source, most, left: most, piece: 0 }
    }

    /// Says that a tag or text ends here.
    pub fn end_piece(&mut self) {
        self.piece = 0;
    }

    /// Beginning of the unpacked text, as long as it can be unpacked, at most `most` bytes.
    pub fn head(bytes: &'b [u8], most: usize) -> Vec<u8> {
        let mut head = Vec::new();
        // A cut file is an error at its end only; what came before counts.
        let _ = Self::new(bytes).take(most as u64).read_to_end(&mut head);
        head
    }
}

impl Read for Unpacked<'_> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let count = self.fill_buf()?.read(out)?;
        self.consume(count);
        Ok(count)
    }
}

impl BufRead for Unpacked<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.left == 0 {
            return Err(io::Error::other(format!("the file unpacks to more than {} MiB", self.most >> 20)));
        }
        if self.piece > LONGEST_PIECE {
            return Err(io::Error::other(format!("a tag or text is longer than {LONGEST_PIECE} bytes")));
        }
        match &mut self.source {
            // In steps, so that the length of a piece is seen while it grows.
            Source::Plain(rest) => Ok(&rest[..rest.len().min(1 << 16)]),
            Source::Packed(stream) => stream.fill_buf(),
        }
    }

    fn consume(&mut self, count: usize) {
        self.left = self.left.saturating_sub(count as u64);
        self.piece += count;
        match &mut self.source {
            Source::Plain(rest) => *rest = &rest[count..],
            Source::Packed(stream) => stream.consume(count),
        }
    }
}
