//! A named version as a line of text.

use crate::text::{bytes, count};
use cosfly_versions::Version;

/// Name, size and content of a version.
pub fn line(version: &Version) -> String {
    format!(
        "{}  {} {}, {} in {} of {}, content {}, made with cosfly {}\n",
        version.name,
        version.dataset,
        version.dataset_version,
        count(version.flights.len() as u64, "flight"),
        count(version.files.len() as u64, "file"),
        bytes(version.bytes()),
        version.content.short(),
        version.cosfly
    )
}
