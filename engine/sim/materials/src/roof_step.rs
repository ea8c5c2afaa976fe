//! [`RoofStep`]: the place of a box in a pitched roof, and the slopes that it shows.

use cosfly_frames::DVec3;

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
    /// What is drawn of the slope where it is of a measured roof.
    pub pieces: Option<Vec<RoofPiece>>,
}

/// A flat piece of a measured roof above a part of a box.
#[derive(Clone, Debug, PartialEq)]
pub struct RoofPiece {
    /// Corners in order, anticlockwise as seen from above; the last two may be one.
    pub corners_in_world: [DVec3; 4],
    /// Whether the roof goes on beside each side, from a corner to the next.
    pub goes_on: [bool; 4],
    /// Its unit normal.
    pub normal_in_world: DVec3,
    /// Unit vector over the ground in which its tiles fall; zero for level roofing.
    pub falls: [f32; 2],
    /// Angle of its tiles.
    pub pitch: RoofPitch,
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
    /// Unit vector over the ground in which all of it falls, in the place of the rectangle.
    pub falls: Option<[f32; 2]>,
}
