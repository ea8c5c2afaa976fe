//! The faces drawn in a picture.

use crate::eye::Linear;
use cosfly_maps::SemanticLabel;

/// A face drawn in this picture.
#[derive(Clone, Copy)]
pub struct DrawnFace {
    /// Inverse depth, exact.
    pub plane: Linear,
    pub instance: u32,
    pub label: u8,
}

/// Face 0: the sky.
pub const SKY: DrawnFace = DrawnFace { plane: [0.0; 3], instance: 0, label: SemanticLabel::Sky as u8 };
