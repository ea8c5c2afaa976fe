//! Codecs of pictures: colour, depth, ids. They know no channel.

pub mod depth;
pub mod float_tiff;
pub mod ids;
pub mod jpeg;
pub mod read;
pub mod rgb;
