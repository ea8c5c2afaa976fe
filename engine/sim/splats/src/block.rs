//! [`Block`]: sixteen splats side by side, as kernels read them.

/// Splats of a block.
pub const WIDE: usize = 16;

/// Splats in lanes.
#[derive(Clone, Debug)]
pub struct Block {
    /// Middles: x, y, z.
    pub middle: [[f32; WIDE]; 3],
    /// Covariances: xx, xy, xz, yy, yz, zz.
    pub covariance: [[f32; WIDE]; 6],
    /// Opacities; 0 in lanes without a splat.
    pub opacity: [f32; WIDE],
}

impl Block {
    /// A block without splats.
    pub const EMPTY: Self = Self { middle: [[0.0; WIDE]; 3], covariance: [[0.0; WIDE]; 6], opacity: [0.0; WIDE] };
}
