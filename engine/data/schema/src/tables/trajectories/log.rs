//! The log of a trajectory.

use super::columns::Trajectories;
use crate::tables::DatasetItem;
use crate::tables::column::columns;

columns! { Trajectories::LOG of DatasetItem;
    /// Path of the trajectory's log, from the dataset's folder.
    mcap_path: String = |item, _| item.mcap_path.clone();
    /// Size of the log.
    mcap_bytes: u64 ["bytes"] = |item, _| item.log.bytes;
    /// SHA-256 of the log, hexadecimal.
    mcap_sha256: String = |item, _| item.log.sha256.clone();
    /// Number of messages in the log.
    mcap_messages: u64 = |item, _| item.log.messages;
}
