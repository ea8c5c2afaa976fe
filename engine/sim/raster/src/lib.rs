//! Pinhole cameras with their mounts, and the nearest face at each pixel of a picture. Nothing here knows a town.

pub mod eye;
pub mod nearer;
pub mod visibility;
