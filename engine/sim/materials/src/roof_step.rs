//! [`RoofStep`]: the place of a box in a pitched roof, and the slopes that it shows.

/// Place of a box in a building with a pitched roof.
#[derive(Clone, Debug, PartialEq)]
pub struct RoofStep {
    /// Looks of the upright faces, in the order of the faces of boxes.
    pub sides: [FaceLook; 4],
    /// Slope of the upper face; none where it is level.
    pub top: Option<TopSlope>,
    /// Foot and height of the wall below, metres.
    pub wall_m: [f64; 2],
    /// Height of the slope below the upper face, metres; 0 where something stands on a level upper face.
    pub slope_m: f64,
}

/// Look of an upright face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FaceLook {
    /// A wall of its own.
    Wall,
    /// The wall below goes on.
    Gable,
    /// A slope that falls outwards.
    Slope(RoofPitch),
}

/// Sine and cosine of a slope's angle.
pub type RoofPitch = [f32; 2];

/// An upper face that slopes down from a rectangle on all sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TopSlope {
    /// Middle and half size of the rectangle along the box's axes, from its middle, metres.
    pub above_m: [f32; 4],
    /// Its angle.
    pub pitch: RoofPitch,
}
