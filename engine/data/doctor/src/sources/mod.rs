//! One reader per layout: from files to episodes.

pub mod lerobot;
pub mod ours;
pub mod record;
pub mod v7;

/// Frames whose pictures are looked at: a stretch of this many, in the middle of a flight, so that shifts show.
pub(crate) const LOOKS: usize = 16;

/// The stretch of `frames` that is looked at.
pub(crate) fn stretch(frames: usize) -> std::ops::Range<usize> {
    let count = LOOKS.min(frames);
    let start = (frames - count) / 2;
    start..start + count
}
