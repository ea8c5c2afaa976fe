//! [`BoxCandidate`]: a box on its way through simplification.

use cosfly_domain::OrientedBox;

/// A box on its way through simplification.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxCandidate {
    /// Space of the box.
    pub shape: OrientedBox,
    /// Volume of it that originals fill, cubic metres; never more than the true volume.
    pub filled_m3: f64,
    /// No point of the box is farther than this from an original, metres.
    pub growth_m: f64,
    /// Smallest index of the originals in it.
    pub first: usize,
}

impl BoxCandidate {
    /// Volume of the box, cubic metres.
    pub fn volume_m3(&self) -> f64 {
        8.0 * self.shape.half_extents_m.abs().element_product()
    }
}
