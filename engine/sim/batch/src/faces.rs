//! The faces drawn in a picture.

use crate::eye::Linear;
use cosfly_maps::SemanticLabel;
use cosfly_render::outside::NO_FACE;

/// A face drawn in this picture.
#[derive(Clone, Copy)]
pub struct DrawnFace {
    /// Inverse depth, exact.
    pub plane: Linear,
    pub instance: u32,
    /// Its number in [`cosfly_render::Scene::faces`]; [`NO_FACE`] for what moves and for the sky.
    pub number: u32,
    pub label: u8,
}

/// Face 0: the sky.
pub const SKY: DrawnFace = DrawnFace { plane: [0.0; 3], instance: 0, number: NO_FACE, label: SemanticLabel::Sky as u8 };
