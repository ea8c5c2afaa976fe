//! Depth as 32-bit floats, on request rounded to a grid of 2^-10 m.

/// Spacing of the depth grid: 2^-10 m, so that the error is at most 0.49 mm up to 16 km.
pub const GRID_M: f32 = 1.0 / 1024.0;

/// The nearest point of the grid; infinity (sky) stays. Exact arithmetic: a scaling by a power of two and a rounding.
pub fn on_grid(depth_m: f32) -> f32 {
    (depth_m * 1024.0).round_ties_even() * GRID_M
}

/// Row-major little-endian bytes.
pub fn little_endian(depths_m: impl Iterator<Item = f32>) -> Vec<u8> {
    depths_m.flat_map(f32::to_le_bytes).collect()
}
