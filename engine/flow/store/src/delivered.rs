//! Sizes and times of the files of a delivered folder, recorded when they were last verified.
//!
//! The record is in the store, not in the folder, so that two folders of one artifact are equal to the byte.

use crate::fault::PublishStep;
use crate::hex::{digest_of_hex, push_digest, push_quoted, unquoted};
use crate::history::{seal, unsealed};
use crate::side_by_side::{PER_THREAD, side_by_side};
use crate::store::Store;
use cosfly_blobs::BlobRef;
use cosfly_diagnose::Result;
use cosfly_fingerprint::Digest;
use cosfly_stage::Blobs;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

const HEADER: &str = "cosfly-out 2 ";

/// Size, time of last modification, time of last status change, device and inode of a file. While all of them are
/// unchanged, the bytes are unchanged. Times in nanoseconds since 1970.
pub(crate) type Stamp = [u64; 5];

/// Stamps of the files of one folder, from the last time they were verified.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Delivered {
    /// Version of the whole folder.
    pub(crate) version: Digest,
    /// Digest of the bytes and stamp of each file.
    files: BTreeMap<String, (Digest, Stamp)>,
}

impl Delivered {
    /// Stamps of the files of `folder` now, which hold `blobs` by name; absent files are left out.
    pub(crate) fn look(version: Digest, folder: &Path, blobs: &Blobs) -> Self {
        let blobs: Vec<(&String, &BlobRef)> = blobs.iter().collect();
        let stamps = side_by_side(&blobs, PER_THREAD, |(name, _)| stamp(&folder.join(name)));
        let files = blobs.into_iter().zip(stamps);
        let files = files.filter_map(|((name, blob), stamp)| Some((name.clone(), (blob.digest, stamp?))));
        Self { version, files: files.collect() }
    }

    /// Like [`Self::look`], without another look at the files whose stamps are in `known`, in the order of `blobs`.
    pub(crate) fn look_again(version: Digest, folder: &Path, blobs: &Blobs, known: Vec<Option<Stamp>>) -> Self {
        let files = blobs.iter().zip(known);
        let files = files.filter_map(|((name, blob), known)| {
            Some((name.clone(), (blob.digest, known.or_else(|| stamp(&folder.join(name)))?)))
        });
        Self { version, files: files.collect() }
    }

    /// Whether both records have the same bytes and the same stamp for the file.
    pub(crate) fn agrees(&self, other: &Self, name: &str) -> bool {
        self.files.get(name).is_some_and(|file| other.files.get(name) == Some(file))
    }

    /// Names of all files.
    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.files.keys().map(String::as_str)
    }

    /// Stamps of verified files by the digests of their bytes: a blob that is still the same file need not be read.
    pub(crate) fn verified(&self) -> Verified {
        Verified(self.files.values().copied().collect())
    }

    fn encode(&self) -> String {
        let (mut body, start) = unsealed(HEADER);
        let _ = writeln!(body, "{}", self.version);
        for (name, (digest, [size, modified, changed, device, number])) in &self.files {
            push_digest(&mut body, digest);
            let _ = write!(body, " {size} {modified} {changed} {device} {number} ");
            push_quoted(&mut body, name);
            body.push('\n');
        }
        seal(&mut body, start);
        body
    }

    /// Parses a record; `None` where it is not exactly as written.
    fn decode(text: &str) -> Option<Self> {
        let (digest, body) = text.strip_prefix(HEADER)?.split_once('\n')?;
        if digest.parse::<Digest>().ok()? != Digest::of(body.as_bytes()) {
            return None;
        }
        let mut lines = body.lines();
        let mut delivered = Self { version: lines.next()?.parse().ok()?, files: BTreeMap::new() };
        for line in lines {
            let mut words = line.splitn(7, ' ');
            let digest = digest_of_hex(words.next()?)?;
            let mut stamp = Stamp::default();
            for number in &mut stamp {
                *number = words.next()?.parse().ok()?;
            }
            delivered.files.insert(unquoted(words.next()?)?, (digest, stamp));
        }
        Some(delivered)
    }
}

/// Stamps of files by the digests of their bytes.
#[derive(Default)]
pub(crate) struct Verified(BTreeMap<Digest, Stamp>);

impl Verified {
    /// Stamp of the file at `path` where it is the one whose bytes were verified to have `digest`.
    pub(crate) fn same_file(&self, digest: &Digest, path: &Path) -> Option<Stamp> {
        self.0.get(digest).copied().filter(|known| stamp(path).as_ref() == Some(known))
    }
}

impl Store {
    /// Record of `folder`, an absolute path.
    pub(crate) fn delivered(&self, folder: &Path) -> Option<Delivered> {
        Delivered::decode(&fs::read_to_string(self.delivered_path(folder)).ok()?)
    }

    /// Records that the files of `folder` are verified. Without the record they are read again.
    pub(crate) fn remember_delivered(&self, folder: &Path, delivered: &Delivered) -> Result<()> {
        let path = self.delivered_path(folder);
        self.write_file(&path, delivered.encode().as_bytes(), PublishStep::WriteRun, PublishStep::RenameRun)
    }

    fn delivered_path(&self, folder: &Path) -> std::path::PathBuf {
        self.layout.folder("out").join(Digest::of(folder.as_os_str().as_encoded_bytes()).to_string())
    }
}

fn stamp(path: &Path) -> Option<Stamp> {
    let metadata = fs::symlink_metadata(path).ok().filter(fs::Metadata::is_file)?;
    let since = |time: SystemTime| time.duration_since(UNIX_EPOCH).unwrap_or_default().as_nanos();
    let modified = metadata.modified().map_or(0, |time| u64::try_from(since(time)).unwrap_or(u64::MAX));
    #[cfg(unix)]
    let [changed, device, number] = {
        use std::os::unix::fs::MetadataExt;
        let changed = metadata.ctime().wrapping_mul(1_000_000_000).wrapping_add(metadata.ctime_nsec());
        [changed.cast_unsigned(), metadata.dev(), metadata.ino()]
    };
    #[cfg(not(unix))]
    let [changed, device, number] = [0; 3];
    Some([metadata.len(), modified, changed, device, number])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_reads_back_and_a_damaged_one_is_passed_over() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("a \"b\""), "x").unwrap();
        let blob = |text: &str| BlobRef { digest: Digest::of(text.as_bytes()), bytes: text.len() as u64 };
        let blobs = Blobs::from([("a \"b\"".to_owned(), blob("x")), ("gone".to_owned(), blob("y"))]);
        let delivered = Delivered::look(Digest::of(b"v"), folder.path(), &blobs);
        assert_eq!(delivered.names().collect::<Vec<_>>(), ["a \"b\""]);
        let text = delivered.encode();
        assert_eq!(Delivered::decode(&text), Some(delivered));
        assert!((0..text.len()).all(|cut| Delivered::decode(&text[..cut]).is_none()));
    }
}
