//! Publishes a dataset: tables, logs, card, `croissant.json`, hashes, all through output sinks.
//!
//! In three steps, of which only the second and third see more than one group of walks, and neither sees a frame:
//! [`FlightNote`]s are made group by group; [`plan_groups`] draws the splits of all flights from the notes; [`write_shard`]
//! writes the tables of a group in one pass over its flights; [`write_dataset`] writes the rest from the shards.
//!
//! ```text
//! README.md  LICENSE  croissant.json  SHA256SUMS  files.parquet
//! data/<table>/<split>-<group>[-<part>].parquet     mcap/<town>/<000>/<trajectory>.mcap
//! layouts/{foxglove.json, show_in_rerun.py}         schemas/cosfly.proto      report/index.html
//! ```
//! `files.parquet` holds the hash of every other file; `SHA256SUMS` holds those of `files.parquet` and
//! `croissant.json`, which names it.

mod card;
pub(crate) mod citation;
mod datasheet;
mod files;
mod group_flights;
pub mod layout;
mod notes;
mod plan;
mod report;
mod shard;
mod shortcuts;
mod source;
mod split;
pub(crate) mod summary;
mod viewers;
mod write;

pub use citation::citation;
pub use group_flights::GroupFlights;
pub use layout::LAYOUT_VERSION;
pub use notes::FlightNote;
pub use plan::{FlightPlan, GroupName, GroupPlan};
pub use shard::{Shard, write_shard};
pub use source::{DatasetSource, GroupSource, PublishedLog};
pub use split::{SplitPlan, nothing_left, plan_groups};
pub use summary::{Summary, TownSummary};
pub use write::{Shards, write_dataset};

#[cfg(test)]
mod tests;
