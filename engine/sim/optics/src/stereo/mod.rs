//! Stereo matching: disparities between the two pictures of a rectified pair. Whole numbers only: the same bytes on every processor.
//!
//! Semi-global matching (Hirschmüller 2008): [`census`] codes pixels by their neighbours, [`paths`] adds the costs of disparities along
//! five paths in one pass over the rows, [`matcher`] takes the best ones, and [`speckles`] drops small islands.

mod census;
mod matcher;
mod paths;
mod speckles;

pub use matcher::{STEPS, StereoMatcher};
