//! The faces drawn in a frame, and where each comes from.

use crate::visibility::PlaneOnScreen;

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
    /// Cluster number, polygon number in it.
    Ground { cluster: u32, polygon: u16 },
    /// Triangle of the figures, and the first face drawn of the same part of a body.
    Figure { triangle: u32, first_face: u32 },
}
