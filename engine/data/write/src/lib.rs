//! The writers of a dataset: packed frames, logs, tables, and the dataset as a whole.
//!
//! * [`frame_pack`]: the images of one trajectory between rendering and publishing.
//! * [`log`]: one MCAP file per trajectory.
//! * [`check_clothes`]: texts against the clothes in the pictures.
//! * [`table_file`]: Parquet files.
//! * [`derive`]: rows that are worked out once for a flight, texts among them.
//! * [`croissant`] and [`publish`]: metadata, card, hashes, and the dataset as a whole.

mod clothes;
pub mod croissant;
pub mod derive;
pub mod frame_pack;
mod gathered_extras;
pub mod log;
mod message_head;
pub mod publish;
pub mod table_file;
mod unread;

pub use clothes::check_clothes;
pub use frame_pack::{FramePackReader, FramePackWriter, PackHeader, PackedFrame};
pub use log::{WrittenLog, write_log};
pub use publish::{
    DatasetSource, FlightNote, GroupFlights, GroupName, GroupPlan, GroupSource, PublishedLog, Shard, Shards, Summary,
    nothing_left, plan_groups, write_dataset, write_shard,
};
pub use unread::unread;
