//! The record model of a dataset and its writers (Parquet, MCAP, Croissant, card), and the checker of finished ones.
//!
//! * [`record`]: what the other stages hand over, one trajectory at a time.
//! * [`config`]: what a recipe says about the dataset as a whole.
//! * [`frame_pack`]: the images of one trajectory between rendering and publishing.
//! * [`mcap_log`]: one MCAP file per trajectory.
//! * [`tables`]: the Parquet tables.
//! * [`flight_labels`]: labels that plugins give to frames.
//! * [`flight_table`]: a flight as an Arrow stream for plugins, and their answers.
//! * [`extras`]: tables and files that plugins add.
//! * [`read`]: reads published datasets back, for pictures and replays.
//! * [`predictions`]: reads what models predicted.
//! * [`splits`]: splits that do not leak, and their linter.
//! * [`carla_job`]: published flights as a job for a CARLA server.
//! * [`verify`]: checks a finished dataset by its files alone.
//! * [`croissant`] and [`publish`]: metadata, card, hashes, and the dataset as a whole.

pub mod carla_job;
pub mod config;
pub mod croissant;
pub mod extras;
pub mod flight_labels;
pub mod flight_table;
pub mod frame_pack;
mod hashing;
pub mod images;
pub mod mcap_log;
pub mod predictions;
pub mod publish;
pub mod read;
pub mod record;
mod reference;
pub mod sample;
pub mod splits;
pub mod tables;
pub mod verify;

pub use cosfly_frames::action;
pub use cosfly_report::PlannerRow;

pub use config::{DatasetConfig, DepthEncoding, EncodingConfig, RgbEncoding};
pub use frame_pack::{FramePackReader, FramePackWriter, PackHeader, PackedFrame};
pub use mcap_log::{LogRecord, write_log};
pub use publish::{DatasetSource, PublishedLog, Summary, write_dataset};
pub use record::{
    CaptionRecord, OtherPerson, PairInfo, PreviewStrip, Rejection, RenderedTrajectory, Role, Sighting, TownInfo,
};
pub use reference::reference;
pub use verify::{Finding, VerifyReport, verify};
