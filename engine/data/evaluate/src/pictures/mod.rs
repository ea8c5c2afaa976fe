//! Scores of predictions in pictures: depth, labels, detected boxes and masks, trackers' files.
//!
//! * [`settings`]: choices of an evaluation; [`recognise()`]: the kind of predictions.
//! * [`files`], [`given`] and [`raster`]: files and rows by frame, and their values.
//! * [`kinds`]: kinds of frames that are scored separately.
//! * [`tallies`] with [`depth`], [`labels`] and [`detections`]: counts, and their intervals.
//! * [`trackers`]: tracks of many bodies, boxes of the target.
//! * [`report`]: the result as JSON, Markdown and a picture.

mod depth;
mod detections;
mod distances;
mod evaluation;
mod files;
mod given;
mod kinds;
mod labels;
mod markdown;
mod plot;
mod raster;
mod recognise;
pub mod report;
mod settings;
mod tallies;
mod things;
mod trackers;

pub use evaluation::evaluate;
pub use recognise::recognise;
pub use report::PictureEvaluation;
pub use settings::{PictureKind, PictureSettings};
