//! Scores of trackers' files: tracks of many bodies (MOTChallenge), and boxes of the target alone (OTB, UAV123, LaSOT).
//!
//! * [`sequences`]: the sequences of pictures that a tracker saw.
//! * [`files`] and [`lines`]: its files by sequence, and the boxes in them.
//! * [`tracks`], [`target`]: counts of sequences.
//! * [`evaluation`]: the evaluation, sequence by sequence.

mod evaluation;
mod files;
mod lines;
mod sequences;
mod target;
mod tracks;

pub use evaluation::evaluate;
pub use files::recognise;
