//! Reads blobs. The size is checked every time, the digest once per process; a damaged blob is removed immediately.

use crate::layout::Area;
use crate::mutex::locked;
use crate::store::Store;
use cosfly_blobs::{BlobPart, BlobRef};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use cosfly_stage::BlobSource;
use std::any::{Any, TypeId};
use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;

impl BlobSource for Store {
    fn read(&self, blob: &BlobRef) -> Result<Vec<u8>> {
        let path = self.blob_path(blob);
        let bytes = match fs::read(&path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound && self.is_packed(Area::Blobs, &blob.digest) => {
                return self.packed(Area::Blobs, &blob.digest).ok_or_else(|| self.damaged(blob));
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound && self.fetch_blob(&path, &blob.digest) => {
                return self.read(blob);
            }
            Err(error) => return Err(self.unreadable(blob, &error)),
        };
        if bytes.len() as u64 != blob.bytes {
            return Err(self.damaged(blob));
        }
        if !self.is_checked(&blob.digest) {
            if Digest::of(&bytes) != blob.digest {
                return Err(self.damaged(blob));
            }
            self.mark_checked(blob.digest);
        }
        Ok(bytes)
    }

    fn read_part(&self, blob: &BlobRef, part: &BlobPart) -> Result<Vec<u8>> {
        match self.part_of(blob, part) {
            Ok(Some(bytes)) => Ok(bytes),
            Ok(None) => Err(self.damaged(blob)),
            Err(error) => Err(self.unreadable(blob, &error)),
        }
    }

    fn open(&self, blob: &BlobRef) -> Result<File> {
        let checked = self.open_checked(blob);
        match checked {
            Ok(Some(file)) => Ok(file),
            Ok(None) => Err(self.damaged(blob)),
            Err(error) => Err(self.unreadable(blob, &error)),
        }
    }

    fn decoded(
        &self,
        blob: &BlobRef,
        kind: TypeId,
        decode: &dyn Fn(&[u8]) -> Result<Arc<dyn Any + Send + Sync>>,
    ) -> Result<Arc<dyn Any + Send + Sync>> {
        self.decoded.get_or_decode(blob.digest, kind, || decode(&self.read(blob)?))
    }
}

impl Store {
    /// Path of a blob.
    pub(crate) fn blob_path(&self, blob: &BlobRef) -> PathBuf {
        self.layout.file(Area::Blobs, &blob.digest)
    }

    pub(crate) fn is_checked(&self, digest: &Digest) -> bool {
        locked(&self.checked).contains(&head(digest))
    }

    pub(crate) fn mark_checked(&self, digest: Digest) {
        locked(&self.checked).insert(head(&digest));
    }

    /// Has the blob checked again when it is read next.
    pub(crate) fn forget_checked(&self, blob: &BlobRef) {
        locked(&self.checked).remove(&head(&blob.digest));
    }

    /// Opens the file of a blob; `None` where it has another size.
    fn open_unchecked(&self, blob: &BlobRef) -> io::Result<Option<File>> {
        let path = self.blob_path(blob);
        let file = match File::open(&path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound && self.bring(blob, &path) => File::open(&path)?,
            opened => opened?,
        };
        Ok((file.metadata()?.len() == blob.bytes).then_some(file))
    }

    /// Gives a blob without a file its file: from a pack or the remote.
    fn bring(&self, blob: &BlobRef, path: &Path) -> bool {
        self.unpack(blob, path) || self.fetch_blob(path, &blob.digest)
    }

    /// Bytes of a part; `None` where the blob has another size, ends before them or has others there.
    fn part_of(&self, blob: &BlobRef, part: &BlobPart) -> io::Result<Option<Vec<u8>>> {
        let end = part.offset.checked_add(u64::from(part.bytes));
        let file = if end.is_some_and(|end| end <= blob.bytes) { self.open_unchecked(blob)? } else { None };
        let Some(mut file) = file else { return Ok(None) };
        file.seek(SeekFrom::Start(part.offset))?;
        let mut bytes = vec![0; part.bytes as usize];
        file.read_exact(&mut bytes)?;
        Ok((Digest::of(&bytes) == part.digest).then_some(bytes))
    }

    /// Opens the file of a blob at its start; `None` where its bytes do not match its digest.
    fn open_checked(&self, blob: &BlobRef) -> io::Result<Option<File>> {
        let Some(mut file) = self.open_unchecked(blob)? else { return Ok(None) };
        if !self.is_checked(&blob.digest) {
            if digest_of_file(&mut file)? != blob.digest {
                return Ok(None);
            }
            file.rewind()?;
            self.mark_checked(blob.digest);
        }
        Ok(Some(file))
    }

    /// Removes a blob. Whatever needs it has it made again. A packed one, which is small, stays until garbage is collected.
    ///
    /// # Errors
    /// `machine-io`.
    pub fn remove_blob(&self, blob: &BlobRef) -> Result<()> {
        self.forget_checked(blob);
        let path = self.blob_path(blob);
        self.remove_from_remote(&path, &blob.digest)?;
        match fs::remove_file(&path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                Err(Diagnostic::io(format!("remove `{}`", path.display()), &error))
            }
            _ => Ok(()),
        }
    }

    fn unreadable(&self, blob: &BlobRef, error: &io::Error) -> Box<Diagnostic> {
        if let Err(trouble) = self.check_remote() {
            trouble
        } else if error.kind() == io::ErrorKind::NotFound {
            lost(blob, "is missing")
        } else if self.clear_away(&self.blob_path(blob)) {
            lost(blob, "is a folder")
        } else {
            Diagnostic::io(format!("read `{}`", self.blob_path(blob).display()), error)
        }
    }

    /// Removes a damaged blob, so that no other reader opens it.
    fn damaged(&self, blob: &BlobRef) -> Box<Diagnostic> {
        self.forget_checked(blob);
        let path = self.blob_path(blob);
        let _ = fs::remove_file(&path);
        self.clear_away(&path);
        lost(blob, "is damaged")
    }
}

/// First bytes of a digest: a run remembers those of every blob that was checked, and eight are enough to tell the blobs of a
/// store apart.
fn head(digest: &Digest) -> u64 {
    let (heads, _) = digest.0.as_chunks::<8>();
    u64::from_le_bytes(heads[0])
}

fn lost(blob: &BlobRef, how: &str) -> Box<Diagnostic> {
    Diagnostic::new("store-blob-lost", Fault::Lost, format!("blob `{}` of the store {how}", blob.digest.short()))
        .hint("run the same command again: the blob will be computed again")
}

/// Digest of a file from its position to its end.
pub fn digest_of_file(file: &mut File) -> io::Result<Digest> {
    let mut hasher = blake3::Hasher::new();
    let mut buffer = vec![0; 1 << 17];
    loop {
        match file.read(&mut buffer) {
            Ok(0) => return Ok(Digest(*hasher.finalize().as_bytes())),
            Ok(length) => hasher.update(&buffer[..length]),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(error) => return Err(error),
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ActionRecord;
    use cosfly_blobs::OutputSink;
    use cosfly_stage::Produced;

    fn store_with(root: &Path, bytes: &[u8]) -> (Store, ActionRecord) {
        let store = Store::open(root).unwrap();
        let mut sink = store.sink();
        sink.put("a", bytes).unwrap();
        let record = (*sink.settle(&Digest::of(b"action"), Produced::default()).unwrap().record).clone();
        (store, record)
    }

    #[test]
    fn a_blob_reads_back_as_bytes_and_as_a_file() {
        let root = tempfile::tempdir().unwrap();
        let (store, record) = store_with(root.path(), b"hello");
        assert_eq!(store.read(&record.outputs["a"]).unwrap(), b"hello");
        let again = Store::open(root.path()).unwrap();
        let mut text = String::new();
        again.open(&record.outputs["a"]).unwrap().read_to_string(&mut text).unwrap();
        assert_eq!(text, "hello");
    }

    #[test]
    fn a_part_is_read_without_the_rest_and_a_wrong_one_is_refused() {
        let root = tempfile::tempdir().unwrap();
        let part = |offset, bytes: &[u8]| BlobPart { offset, bytes: bytes.len() as u32, digest: Digest::of(bytes) };
        for wrong in [part(6, b"worlD"), part(7, b"world"), part(u64::MAX, b"w")] {
            let (store, record) = store_with(root.path(), b"hello world");
            let blob = record.outputs["a"];
            let path = store.blob_path(&blob);
            assert_eq!(store.read_part(&blob, &part(6, b"world")).unwrap(), b"world");
            fs::remove_file(&path).unwrap();
            fs::write(&path, b"HELLO world").unwrap();
            assert_eq!(store.read_part(&blob, &part(6, b"world")).unwrap(), b"world");
            assert_eq!(store.read_part(&blob, &wrong).unwrap_err().fault, Fault::Lost);
            assert!(!path.exists());
        }
    }

    #[test]
    fn a_damaged_blob_is_refused_removed_and_healed_by_publishing_it_again() {
        let root = tempfile::tempdir().unwrap();
        for damage in [&b"hellO"[..], b"hell", b""] {
            let (store, record) = store_with(root.path(), b"hello");
            let blob = record.outputs["a"];
            drop(store);
            let path = Store::open(root.path()).unwrap().blob_path(&blob);
            fs::remove_file(&path).unwrap();
            fs::write(&path, damage).unwrap();
            let store = Store::open(root.path()).unwrap();
            assert_eq!(store.open(&blob).unwrap_err().fault, Fault::Lost);
            assert!(!path.exists() && !store.holds(&record));
            assert_eq!(store.read(&blob).unwrap_err().fault, Fault::Lost);
        }
        let (store, record) = store_with(root.path(), b"hello");
        assert!(store.holds(&record));
    }
}
