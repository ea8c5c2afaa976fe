//! Published datasets in the formats of others: one file or folder per format, all fed from the same records.
//!
//! * [`formats`]: the list of formats; a new one is one file and two lines there.
//! * [`format`](mod@format): the seam, [`Format`], and how a dataset is written in one.
//! * [`prepare`](mod@prepare): a format by its name, with options; all options joined.
//! * [`option`](mod@option): options as data. [`shared_options`]: options that several formats have.
//! * [`source`]: the flights that are exported, one at a time, with their pictures.
//! * [`folder`]: the folder that an export becomes, whole or not at all.
//! * [`card`]: the `README.md` of an export.
//! * [`pixels`]: colour images decoded, ids and depths encoded.
//! * [`sequence`]: pictures numbered from 1, for trackers.
//! * [`single_target`]: such sequences of the target alone.
//! * [`media`]: names of picture files.
//! * [`carla_job`]: published flights as a job for a CARLA server.
//! * [`sample_text`]: the facts of a frame as JSON.

pub mod called;
pub mod card;
pub mod carla_job;
pub mod films;
pub mod folder;
pub mod format;
pub mod formats;
pub mod media;
pub mod option;
pub mod pixels;
pub mod prepare;
pub mod sample_text;
pub mod sequence;
pub mod shared_options;
pub mod single_target;
pub mod source;
mod whole_log;

pub use called::flights_called;
pub use folder::{OutFolder, Written};
pub use format::{Export, Format, Prepared};
pub use formats::FORMATS;
pub use formats::ros2::flown::flown_bags;
pub use option::{ExportOption, OptionKind};
pub use prepare::{flag, joined_options, on_threads, prepare};
pub use source::{Choice, Source};

#[cfg(test)]
mod bag_laws;
#[cfg(test)]
mod laws;
#[cfg(test)]
mod sequence_laws;
