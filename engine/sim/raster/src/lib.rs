//! Pinhole cameras with their mounts, the nearest face at each pixel of a picture, and places in maps of shadows. Nothing here knows a town.

pub mod eye;
pub mod nearer;
pub mod seen_region;
pub mod shadow_frame;
pub mod visibility;
