//! Readers of published datasets (trajectories, tables, images in logs) and of predictions of models.
//!
//! Columns are requested by their entries in [`cosfly_schema::tables`], so datasets with additional columns can be
//! read, too.

mod captions;
pub mod columns;
mod damage;
mod dataset;
pub mod drawn_ground;
mod foreign;
mod frames;
mod goals;
mod identity;
mod image_log;
mod inner_path;
mod instructions;
mod log;
mod objects;
mod parquet_metadata;
mod picture_column;
mod plain;
pub mod predictions;
mod records;
mod row_index;
mod rows;
mod tracks;
mod trajectory;
mod ways;
mod whole_files;

pub use captions::CaptionReader;
pub use dataset::PublishedDataset;
pub use foreign::{ForeignRows, foreign_rows};
pub use frames::{Disturbance, FrameRow};
pub use goals::PublishedGoal;
pub use identity::{Identity, changed};
pub use image_log::{ImageLog, StoredImage};
pub use inner_path::inner_path;
pub use instructions::{InstructionReader, InstructionsByFrame};
pub use log::{LogReader, LoggedFrame, SceneBox};
pub use objects::{BoxInWorld, PublishedObject};
pub use picture_column::{PictureColumn, PictureFile};
pub use records::read_records;
pub use row_index::RowIndex;
pub use rows::{Rows, TableFile, Values, read};
pub use tracks::FlightTrack;
pub use trajectory::{PublishedFlight, Shared};
pub use whole_files::{log_problem, parquet_problem};

#[cfg(test)]
mod tests;
