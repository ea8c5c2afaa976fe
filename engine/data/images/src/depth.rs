//! Depth as 32-bit floats, on request rounded to a grid of 2^-10 m.

use cosfly_frames::simd_kernel;

/// Spacing of the depth grid: 2^-10 m; the error is at most 0.49 mm up to 16 km.
pub const GRID_M: f32 = 1.0 / 1024.0;

/// Smallest power of two above which all floats are whole; adding it to a smaller number rounds that to a whole number,
/// ties to even.
const WHOLE: f32 = 8_388_608.0;

/// Depth rounded to the grid, for depths of 0 m or more; infinity (sky) stays. Exact arithmetic: a scaling by a power
/// of two and a rounding.
#[inline(always)]
pub fn on_grid(depth_m: f32) -> f32 {
    let steps = depth_m * 1024.0;
    (if steps < WHOLE { (steps + WHOLE) - WHOLE } else { steps }) * GRID_M
}

simd_kernel! {
    /// Row-major little-endian bytes of depths on the grid; false when one of them is not 0 m or more.
    pub fn grid_bytes(depth_m: &[f32], bytes: &mut [u8]) -> bool {
        let mut wrong = 0;
        for (depth, four) in depth_m.iter().zip(bytes.as_chunks_mut::<4>().0) {
            *four = on_grid(*depth).to_le_bytes();
            wrong |= wrong_depth(*depth);
        }
        wrong == 0
    }
}

simd_kernel! {
    /// Row-major little-endian bytes of unrounded depths; false when one of them is not 0 m or more.
    pub fn lossless_bytes(depth_m: &[f32], bytes: &mut [u8]) -> bool {
        let mut wrong = 0;
        for (depth, four) in depth_m.iter().zip(bytes.as_chunks_mut::<4>().0) {
            *four = depth.to_le_bytes();
            wrong |= wrong_depth(*depth);
        }
        wrong == 0
    }
}

/// 1 for NaN and numbers below 0.
#[inline(always)]
fn wrong_depth(depth_m: f32) -> u32 {
    u32::from(depth_m.is_nan() | (depth_m < 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::simd::Level;

    #[test]
    fn the_grid_is_met_by_rounding_to_even_at_every_vector_level() {
        let mut depths = vec![0.0, 0.5 * GRID_M, 1.5 * GRID_M, 8191.999, 8192.0, 16_384.5, 1e30, f32::INFINITY];
        depths.extend((0..1000).map(|i| 0.37 * i as f32 + 1e-4 * (i * i % 77) as f32));
        let expected: Vec<u8> =
            depths.iter().flat_map(|depth| ((depth * 1024.0).round_ties_even() * GRID_M).to_le_bytes()).collect();
        for level in Level::available() {
            let mut bytes = vec![0; 4 * depths.len()];
            assert!(grid_bytes(level, &depths, &mut bytes) && bytes == expected, "{}", level.name());
        }
    }

    #[test]
    fn depths_that_are_none_are_noticed() {
        for bad in [f32::NAN, -1.0, -f32::INFINITY] {
            let mut depths = vec![3.0; 100];
            depths[41] = bad;
            let mut bytes = vec![0; 400];
            assert!(!grid_bytes(Level::best(), &depths, &mut bytes), "{bad}");
            assert!(!lossless_bytes(Level::best(), &depths, &mut bytes), "{bad}");
        }
    }
}
