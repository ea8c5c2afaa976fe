//! All formats, one file or folder each.
//!
//! To add one, write its file and add two lines here: its `mod` and its entry in [`FORMATS`]. Command line, help and the
//! laws that every export must keep follow from the list.

mod clouds;
mod coco;
mod grounding;
mod image_folder;
mod lasot;
mod lerobot;
mod mot;
mod otb;
pub(crate) mod ros2;
pub(crate) mod v7;
mod vlm;
mod webdataset;

use crate::format::Export;

/// The formats, sorted by name.
pub static FORMATS: &[Export] = &[
    Export::of::<clouds::Clouds>(),
    Export::of::<coco::Coco>(),
    Export::of::<grounding::Grounding>(),
    Export::of::<image_folder::ImageFolder>(),
    Export::of::<lasot::LaSot>(),
    Export::of::<lerobot::LeRobot>(),
    Export::of::<mot::Mot>(),
    Export::of::<otb::Otb>(),
    Export::of::<ros2::Ros2>(),
    Export::of::<v7::V7>(),
    Export::of::<vlm::Vlm>(),
    Export::of::<webdataset::WebDataset>(),
];
