//! Published datasets in the formats of others: one file or folder per format, all fed from the same records.
//!
//! * [`exporter`]: the seam, [`Exporter`], and what every export may be told.
//! * [`source`]: the flights that are exported, one at a time, with their pictures.
//! * [`folder`]: the folder that an export becomes, whole or not at all.
//! * [`card`]: the `README.md` of an export.
//! * [`pixels`]: colour images decoded, ids and depths encoded.
//! * [`media`]: names of picture files.
//! * [`carla_job`]: published flights as a job for a CARLA server.
//! * [`sample_text`]: the facts of a frame as JSON.
//!
//! To add a format, write its file and add two lines: its `mod` here and its entry in [`EXPORTERS`]. Command line, help
//! and the laws that every export must keep follow from that list.

pub mod card;
pub mod carla_job;
pub mod coco;
pub mod exporter;
pub mod folder;
pub mod image_folder;
pub mod lerobot;
pub mod media;
pub mod pixels;
pub mod sample_text;
pub mod source;
pub mod v7;
pub mod vlm;
pub mod webdataset;

pub use exporter::{BoxScale, Exporter, Input, Options};
pub use folder::{OutFolder, Written};
pub use source::Source;

/// All formats, in the order of the help.
pub static EXPORTERS: [&dyn Exporter; 6] =
    [&v7::V7, &lerobot::LeRobot, &vlm::Vlm, &coco::Coco, &webdataset::WebDataset, &image_folder::ImageFolder];

/// The format called `name`.
pub fn exporter(name: &str) -> Option<&'static dyn Exporter> {
    EXPORTERS.into_iter().find(|exporter| exporter.name() == name)
}

#[cfg(test)]
mod laws;
