//! Files outside the store that stages read: hashed once per run, and checked for changes during the run.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::{Digest, DigestOfPieces};
use std::collections::BTreeMap;
use std::fs::{self, File, Metadata};
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Bytes of a file that are in memory while it is hashed.
const PIECE_BYTES: usize = 1 << 20;

/// A source file as it was when it was planned.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct HashedSource {
    pub(crate) parameter: String,
    pub(crate) path: PathBuf,
    pub(crate) digest: Digest,
    /// Size and time of change; while both stay, the file is not read again.
    stamp: (u64, Option<SystemTime>),
}

/// Hashes every file once, for any number of stages that read it.
#[derive(Default)]
pub(crate) struct SourceReader {
    known: BTreeMap<PathBuf, (Digest, (u64, Option<SystemTime>))>,
}

impl SourceReader {
    pub(crate) fn read(&mut self, parameter: &str, path: &Path) -> Result<HashedSource> {
        let (digest, stamp) = match self.known.get(path) {
            Some(known) => *known,
            None => {
                let read =
                    digest_of(path).map_err(|error| Diagnostic::unread(format!("`{}`", path.display()), &error))?;
                self.known.insert(path.to_owned(), read);
                read
            }
        };
        Ok(HashedSource { parameter: parameter.to_owned(), path: path.to_owned(), digest, stamp })
    }
}

impl HashedSource {
    /// Fails where the file changed since it was planned.
    pub(crate) fn check_unchanged(&self) -> Result<()> {
        let metadata = fs::metadata(&self.path).map_err(|error| unreadable(&self.path, &error))?;
        if stamp(&metadata) == self.stamp {
            return Ok(());
        }
        let (digest, _) = digest_of(&self.path).map_err(|error| unreadable(&self.path, &error))?;
        if digest == self.digest {
            return Ok(());
        }
        Err(Diagnostic::new(
            "source-changed",
            Fault::Input,
            format!("`{}` changed while it was being used", self.path.display()),
        )
        .hint("run the same command again"))
    }
}

fn digest_of(path: &Path) -> std::io::Result<(Digest, (u64, Option<SystemTime>))> {
    let before = stamp(&fs::metadata(path)?);
    let (mut file, mut pieces) = (File::open(path)?, DigestOfPieces::default());
    // Piece by piece: files of recorded traffic may be larger than the memory.
    let mut piece = vec![0; PIECE_BYTES];
    loop {
        match file.read(&mut piece) {
            Ok(0) => return Ok((pieces.digest(), before)),
            Ok(length) => pieces.add(&piece[..length]),
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
}

fn stamp(metadata: &Metadata) -> (u64, Option<SystemTime>) {
    (metadata.len(), metadata.modified().ok())
}

fn unreadable(path: &Path, error: &std::io::Error) -> Box<Diagnostic> {
    Diagnostic::io(format!("read `{}`", path.display()), error)
}
