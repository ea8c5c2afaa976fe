//! Image encoders: colour, depth, and the small previews.

pub mod depth;
pub mod jpeg;
pub mod previews;
pub mod rgb;
