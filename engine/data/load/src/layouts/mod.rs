//! Layouts of datasets, one file each.
//!
//! To add one, write its file and add two lines here: its `mod` and its entry in [`LAYOUTS`].

mod lerobot;
mod ours;
mod tasks;
mod v7;

use crate::layout::Layout;

/// All layouts, in the order in which a folder is tried.
#[rustfmt::skip] // an entry per line
pub const LAYOUTS: &[Layout] = &[
    ours::LAYOUT,
    v7::LAYOUT,
    lerobot::LAYOUT,
];
