//! Pictures of channels for people: false colours of what is no picture, and small previews of frames.

mod colour_wheel;
pub mod false_colours;
pub mod previews;
