//! Metrics of trackers of many bodies, as TrackEval defines them: HOTA, IDF1, MOTA.
//!
//! * [`frame`]: true and found boxes of a picture, and what a distractor takes away.
//! * [`assignment`]: pairs with the largest sum of scores.
//! * [`hota`], [`identity`], [`clear`]: counts of a sequence; counts of sequences add up.
//! * [`tally`]: all three, and the reported scores.

pub mod assignment;
pub mod clear;
pub mod frame;
pub mod hota;
pub mod identity;
pub mod tally;

pub use frame::TrackedFrame;
pub use tally::TrackTally;
