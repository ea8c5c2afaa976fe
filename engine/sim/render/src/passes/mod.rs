//! Channels that follow exactly from the face nearest at each pixel centre.

pub mod ids;
pub mod on_request;
