//! The faces drawn in a picture.

use crate::eye::Linear;
use cosfly_domain::SemanticLabel;
use cosfly_raster::visibility::NO_FACE;

/// A face drawn in this picture.
#[derive(Clone, Copy)]
pub struct DrawnFace {
    /// Inverse depth, exact.
    pub plane: Linear,
    pub instance: u32,
    /// Its number in [`cosfly_render::Scene::faces_of`]; for bodies, [`BODY`] more than the number of their part in this picture;
    /// [`NO_FACE`] for what else moves and for the sky.
    pub number: u32,
    /// Number of a vehicle's triangle in its figure; any for other faces.
    pub triangle: u32,
    pub label: u8,
}

/// Numbers from here on are those of parts of bodies.
pub const BODY: u32 = 1 << 31;

/// Face 0: the sky.
pub const SKY: DrawnFace =
    DrawnFace { plane: [0.0; 3], instance: 0, number: NO_FACE, triangle: 0, label: SemanticLabel::Sky as u8 };
