//! [`SeasonRow`].

use crate::vector::Vec3;

/// The look of a season. Colours are linear RGB.
#[derive(Debug)]
pub struct SeasonRow {
    /// Lawns, where they are fresh and where they are dry.
    pub lawn: [Vec3; 2],
    /// Woods seen from afar: near ones, and those of hills in the distance.
    pub woods: [Vec3; 2],
    /// Gaps between leaves or twigs that the sun shines through: the values of a noise between which a gap opens, and the share of
    /// the sun's light in an open one.
    pub gaps: [f32; 3],
    /// Factor of the colour of green leaves.
    pub leaf: Vec3,
    /// Leaves that turn, tree by tree: of an even draw from 0 to 1, slope and offset of the share that has turned.
    pub turned: Option<[f32; 2]>,
    /// Whether trees and bushes are bare, evergreen ones left out.
    pub is_bare: bool,
}
