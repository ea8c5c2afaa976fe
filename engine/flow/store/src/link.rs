//! A blob at a path of its own: a hard link into the store where the file system supports it, a copy elsewhere.

use crate::delivered::Verified;
use crate::store::Store;
use cosfly_blobs::BlobRef;
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_stage::BlobSource;
use std::fs::{self, File};
use std::io;
use std::path::Path;

/// Puts a blob at `path`, where nothing is; true where it is a link.
pub(crate) fn place(store: &Store, blob: &BlobRef, verified: &Verified, path: &Path) -> Result<bool> {
    let stored = store.blob_path(blob);
    if verified.same_file(&blob.digest, &stored).is_some() && fs::hard_link(&stored, path).is_ok() {
        return Ok(true);
    }
    let mut source = store.open(blob)?;
    let mut copy = || io::copy(&mut source, &mut File::create_new(path)?).map(|_| false);
    let placed = fs::hard_link(&stored, path).map_or_else(|_| copy(), |()| Ok(true));
    placed.map_err(|error| refused(path, &error))
}

/// Refusal of the operating system to write a folder.
pub(crate) fn refused(folder: &Path, error: &io::Error) -> Box<Diagnostic> {
    Diagnostic::io(format!("write the folder `{}`", folder.display()), error)
}
