//! Map formats: the seam [`MapFormat`] and the list of all readers.

pub mod opendrive;

use crate::{MapConfig, MapError, Town};

/// A reader for one map format, over bytes.
pub trait MapFormat: Sync {
    /// Its name in messages.
    fn name(&self) -> &'static str;

    /// Whether the bytes look like this format (cheap: the first few kilobytes).
    fn recognises(&self, bytes: &[u8]) -> bool;

    /// The town as the file states it, with warnings about what the reader coped with.
    /// Fill and simplification come later, for every format alike.
    fn read(&self, bytes: &[u8], options: &MapConfig) -> Result<(Town, Vec<String>), MapError>;
}

/// Every format, sorted by name. A new one costs its file and two lines here.
pub const FORMATS: &[&dyn MapFormat] = &[&opendrive::OpenDrive];
