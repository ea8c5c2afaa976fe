//! Sizes and times of the files of a delivered folder, recorded when they were last verified.
//!
//! The record is in the store, not in the folder, so that two folders of one artifact are equal to the byte.

use crate::fault::Step;
use crate::store::Store;
use cosfly_diagnose::Result;
use cosfly_fingerprint::Digest;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

const HEADER: &str = "cosfly-out 1 ";

/// Size, time of last modification, time of last status change, device and inode of a file. While all of them are
/// unchanged, the bytes are unchanged. Times in nanoseconds since 1970.
type Stamp = [u64; 5];

/// Stamps of the files of one folder, from the last time they were verified.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Delivered {
    /// Version of the whole folder.
    pub(crate) version: Digest,
    stamps: BTreeMap<String, Stamp>,
}

impl Delivered {
    /// Stamps of the files `names` of `folder` now; absent files are left out.
    pub(crate) fn look<'n>(version: Digest, folder: &Path, names: impl Iterator<Item = &'n String>) -> Self {
        let stamps = names.filter_map(|name| Some((name.clone(), stamp(&folder.join(name))?)));
        Self { version, stamps: stamps.collect() }
    }

    /// Whether both records are of one version and have the same stamp for the file.
    pub(crate) fn agrees(&self, other: &Self, name: &str) -> bool {
        self.version == other.version
            && self.stamps.get(name).is_some_and(|stamp| other.stamps.get(name) == Some(stamp))
    }

    /// Names of all files.
    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.stamps.keys().map(String::as_str)
    }

    fn encode(&self) -> String {
        let mut body = format!("{}\n", self.version);
        for (name, [size, modified, changed, device, number]) in &self.stamps {
            let name = serde_json::Value::from(name.as_str());
            let _ = writeln!(body, "{size} {modified} {changed} {device} {number} {name}");
        }
        format!("{HEADER}{}\n{body}", Digest::of(body.as_bytes()))
    }

    /// Parses a record; `None` where it is not exactly as written.
    fn decode(text: &str) -> Option<Self> {
        let (digest, body) = text.strip_prefix(HEADER)?.split_once('\n')?;
        if digest.parse::<Digest>().ok()? != Digest::of(body.as_bytes()) {
            return None;
        }
        let mut lines = body.lines();
        let mut delivered = Self { version: lines.next()?.parse().ok()?, stamps: BTreeMap::new() };
        for line in lines {
            let mut words = line.splitn(6, ' ');
            let mut stamp = Stamp::default();
            for number in &mut stamp {
                *number = words.next()?.parse().ok()?;
            }
            delivered.stamps.insert(serde_json::from_str(words.next()?).ok()?, stamp);
        }
        Some(delivered)
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
        self.write_file(&path, delivered.encode().as_bytes(), Step::WriteRun, Step::RenameRun)
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
        let names = ["a \"b\"".to_owned(), "gone".to_owned()];
        let delivered = Delivered::look(Digest::of(b"v"), folder.path(), names.iter());
        assert_eq!(delivered.names().collect::<Vec<_>>(), ["a \"b\""]);
        let text = delivered.encode();
        assert_eq!(Delivered::decode(&text), Some(delivered));
        assert!((0..text.len()).all(|cut| Delivered::decode(&text[..cut]).is_none()));
    }
}
