//! Image encoders: colour, depth, ids, and previews.

pub mod depth;
pub mod false_colours;
pub mod ids;
pub mod jpeg;
pub mod previews;
pub mod read;
pub mod rgb;
