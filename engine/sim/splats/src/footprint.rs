//! [`Footprint`]: a splat as a picture sees it.

/// An ellipse on the screen.
#[derive(Clone, Copy, Debug, Default)]
pub struct Footprint {
    /// Its middle: column and row.
    pub place: [f32; 2],
    /// Power of two of its profile at (x, y) from the middle: `xx * x * x + xy * x * y + yy * y * y`.
    pub profile: [f32; 3],
    /// Least power at which it is seen.
    pub least_power: f32,
    /// Opacity of the middle.
    pub opacity: f32,
    /// Red, green, blue, in the space of training.
    pub colour: [f32; 3],
    /// Planar depth of its middle, metres.
    pub depth_m: f32,
    /// Mean depth of the splat at (x, y) from the middle, less that of the middle, metres per pixel.
    pub slope: [f32; 2],
    /// First column and row.
    pub first: [u16; 2],
    /// Last column and row.
    pub last: [u16; 2],
}
