//! Places along a Z curve over the ground: neighbours on the curve are mostly neighbours on the ground.

/// Interleaves the bits of a cell's two coordinates.
pub fn z_order(x: u32, y: u32) -> u64 {
    let spread = |value: u32| (0..32).fold(0u64, |sum, bit| sum | (u64::from(value >> bit & 1) << (2 * bit)));
    spread(x) | (spread(y) << 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_alternate() {
        assert_eq!((z_order(0b11, 0b00), z_order(0b00, 0b11), z_order(2, 1)), (0b0101, 0b1010, 0b0110));
        assert_eq!(z_order(u32::MAX, u32::MAX), u64::MAX);
    }
}
