//! Outputs of plugins and sensors beside the dataset's own tables: annotations of flights, tables of rows, files.
//!
//! * [`Extra`]: output of one plugin or sensor for one flight, between its stage and the dataset.
//! * [`ExtraSummary`]: output of one plugin or sensor for all flights of a dataset, for card, manifest and checks.

mod extra;
mod table;

pub use extra::{Extra, ExtraShape, ExtraSource, ExtraSummary, OWN_COLUMNS, check_names, is_taken};
pub use table::{columns_of, schema_of, write_batch};
