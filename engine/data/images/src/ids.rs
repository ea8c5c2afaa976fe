//! Instance ids as bytes.

use cosfly_frames::simd_kernel;

simd_kernel! {
    /// Writes the low 16 bits of ids, little-endian; returns the bits set in any id.
    pub fn u16_bytes(ids: &[u32], bytes: &mut [u8]) -> u32 {
        let mut seen = 0;
        for (id, two) in ids.iter().zip(bytes.as_chunks_mut::<2>().0) {
            *two = (*id as u16).to_le_bytes();
            seen |= *id;
        }
        seen
    }
}

simd_kernel! {
    /// Writes ids, little-endian.
    pub fn u32_bytes(ids: &[u32], bytes: &mut [u8]) {
        for (id, four) in ids.iter().zip(bytes.as_chunks_mut::<4>().0) {
            *four = id.to_le_bytes();
        }
    }
}
