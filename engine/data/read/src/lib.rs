//! Readers of published datasets (trajectories, tables, images in logs) and of predictions of models.
//!
//! * [`PublishedDataset`]: a folder with its flights, tables and logs.
//! * [`read`], [`TableFile`], [`Rows`]: rows of a table by the columns' entries in [`cosfly_schema::tables`], so datasets with additional
//!   columns can be read, too. [`columns`]: whole columns by name.
//! * [`LogReader`], [`ImageLog`]: messages and images of a flight's log, in order and at random.
//! * [`predictions`]: files of models' answers.
//!
//! Errors are [`cosfly_diagnose::Diagnostic`]: a caller matches on its code (`dataset-none`, `dataset-changed`), a person reads its text.
//!
//! ```
//! use cosfly_read::PublishedDataset;
//!
//! # let folder = tempfile::tempdir().expect("a folder");
//! # cosfly_sample::write_to_folder(folder.path(), &Default::default(), Default::default()).expect("a dataset");
//! # let folder = folder.path();
//! let dataset = PublishedDataset::open(folder).expect("a dataset");
//! let first = &dataset.flights()[0];
//! let frames = dataset.row_index("frames").and_then(|index| dataset.frames(&index, first)).expect("table `frames`");
//! assert_eq!(frames.len(), first.frames);
//! println!("{} begins at {}", first.trajectory_id, frames[0].pose.position_in_world);
//! assert_eq!(PublishedDataset::open(&folder.join("elsewhere")).err().map(|error| error.code), Some("dataset-none"));
//! ```

mod captions;
pub mod columns;
mod damage;
mod dataset;
mod foreign;
mod frames;
mod goals;
mod identity;
mod image_log;
mod in_space;
mod inner_path;
mod instructions;
mod kept_rows;
mod log;
mod objects;
mod parquet_metadata;
mod picture_column;
mod plain;
pub mod predictions;
mod records;
mod row_index;
mod rows;
mod sightings;
mod tracks;
mod trajectory;
mod ways;

pub use captions::CaptionReader;
pub use dataset::PublishedDataset;
pub use foreign::{ForeignRows, foreign_rows};
pub use frames::{Disturbance, FrameRow};
pub use goals::PublishedGoal;
pub use identity::{Identity, changed};
pub use image_log::{ImageLog, StoredImage};
pub use in_space::{SeenKeyPoint, SpaceReader, SpaceRow};
pub use inner_path::inner_path;
pub use instructions::{InstructionReader, InstructionsByFrame};
pub use log::{LogReader, LoggedBox, LoggedFrame, LoggedSweep, Visit};
pub use objects::{BoxInWorld, PublishedObject};
pub use picture_column::{PictureColumn, PictureFile};
pub use records::{LogDamage, read_records};
pub use row_index::RowIndex;
pub use rows::{RowValues, Rows, TableFile, read};
pub use sightings::{SeenBody, SightingReader};
pub use tracks::FlightTrack;
pub use trajectory::{PublishedFlight, Shared};

#[cfg(test)]
mod tests;
