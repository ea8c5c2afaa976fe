//! Recorded traffic of SUMO: the XML that `sumo --fcd-output` writes, read as a stream.
//!
//! [`read`] keeps what the frames need and nothing else: a file of any size takes the memory of its bodies in those frames.
//! Positions of vehicles are those of their front bumpers, angles are clockwise from north.

mod error;
mod kinds;
mod lines;
mod place;
mod samples;
mod stream;

pub use error::FcdError;
pub use kinds::FcdType;
pub use place::{FcdProjection, NetLocation};
pub use stream::{FcdConfig, read};
