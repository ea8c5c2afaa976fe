//! The faces drawn in a frame, and where each comes from.

use crate::scene::Scene;
use cosfly_domain::SemanticLabel;
use cosfly_raster::visibility::PlaneOnScreen;

/// A face drawn in this frame.
pub(crate) struct DrawnFace {
    pub plane: PlaneOnScreen,
    /// Unit normal in the world, any side.
    pub normal: [f32; 3],
    pub source: FaceSource,
    pub label: u8,
    pub instance: u32,
}

/// Origin of a drawn face.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum FaceSource {
    /// Box number, face number.
    Box { index: u32, face: u8 },
    /// A face of a box of leaves.
    Crown { index: u32, face: u8 },
    /// Cluster number, polygon number in it.
    Ground { cluster: u32, polygon: u16 },
    /// Triangle of the scene's models.
    Prop { triangle: u32 },
    /// Triangle of the scene's mesh.
    Mesh { triangle: u32 },
    /// What a scan's splats show before a body, at one pixel.
    Splats,
    /// A part of a figure: its look, the first face drawn of it, the number of the triangle in the figure, and whether it is of a
    /// person.
    Figure { look: u32, first_face: u32, triangle: u32, is_cloth: bool },
}

impl FaceSource {
    /// A face of a scene's box.
    pub fn of_box(scene: &Scene, index: u32, face: u8) -> Self {
        match scene.crowns.get(index as usize) {
            Some(Some(_)) => Self::Crown { index, face },
            _ => Self::Box { index, face },
        }
    }
}

/// Share by which the inverse depth of a box counts as greater: of coplanar faces of different boxes, the number decides,
/// not the rounding.
pub(crate) fn box_lift(index: u32) -> f64 {
    5e-7 * f64::from(index % 8)
}

/// Share by which the inverse depth of ground counts as greater: which of two coplanar layers lies on top.
pub(crate) fn ground_lift(label: SemanticLabel) -> f64 {
    let layer = match label {
        SemanticLabel::Terrain | SemanticLabel::Ground | SemanticLabel::Water => 0.0,
        SemanticLabel::Roads => 1.0,
        SemanticLabel::RoadLine => 3.0,
        _ => 2.0,
    };
    2e-6 * layer
}
