//! One reader per layout: from files to episodes.

pub mod lerobot;
pub mod ours;
pub mod record;
pub mod v7;

/// Number of consecutive frames whose pictures are read, in the middle of a flight.
pub(crate) const LOOKS: usize = 16;

/// The stretch of `frames` whose pictures are read.
pub(crate) fn stretch(frames: usize) -> std::ops::Range<usize> {
    let count = LOOKS.min(frames);
    let start = (frames - count) / 2;
    start..start + count
}
