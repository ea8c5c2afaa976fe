//! [`ColouredPoint`]: a point of a cloud with its colour.

use cosfly_frames::DVec3;

/// A point of a cloud.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColouredPoint {
    /// Position, frame and units of the file.
    pub position: DVec3,
    /// Red, green and blue, sRGB.
    pub colour: [u8; 3],
}
