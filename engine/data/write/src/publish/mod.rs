//! Publishes a dataset: tables, logs, card, `croissant.json`, hashes, all through one output sink.
//!
//! ```text
//! README.md  LICENSE  croissant.json  SHA256SUMS  files.parquet
//! data/<table>/<split>-00000-of-00001.parquet      mcap/<town>/<000>/<trajectory>.mcap
//! layouts/{foxglove.json, show_in_rerun.py}         schemas/cosfly.proto      report/index.html
//! ```
//! `files.parquet` holds the hash of every other file; `SHA256SUMS` holds those of `files.parquet` and
//! `croissant.json`, which names it.

mod card;
mod datasheet;
mod plan;
mod report;
mod summary;
mod viewers;
mod write;

pub use card::citation;
pub use plan::DatasetPlan;
pub use summary::{Summary, TownSummary};
pub use write::{DatasetSource, PublishedLog, write_dataset};

/// Version of the layout of published datasets; raised when paths, tables or conventions change.
pub const LAYOUT_VERSION: u32 = 1;

#[cfg(test)]
mod tests;
