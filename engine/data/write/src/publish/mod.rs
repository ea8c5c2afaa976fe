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
pub(crate) mod citation;
mod datasheet;
mod kept;
pub mod layout;
mod plan;
mod report;
mod shortcuts;
mod source;
pub(crate) mod summary;
mod viewers;
mod write;

pub use citation::citation;
pub use layout::LAYOUT_VERSION;
pub use plan::DatasetPlan;
pub use source::{DatasetSource, PublishedLog};
pub use summary::{Summary, TownSummary};
pub use write::write_dataset;

#[cfg(test)]
mod tests;
