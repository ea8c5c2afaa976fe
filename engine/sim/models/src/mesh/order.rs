//! Order of a mesh's triangles: neighbours in space are neighbours in the list.

use super::textured::TexturedMesh;
use cosfly_frames::DVec3;

impl TexturedMesh {
    /// Sorts the triangles along a Z-order curve through the mesh's bounds.
    pub fn sort_by_place(&mut self) {
        let [low, high] = self.bounds();
        let cell_m = ((high - low).max_element() / f64::from(CELLS - 1)).max(1e-9);
        self.triangles.sort_by_cached_key(|triangle| {
            let middle = triangle.corners().into_iter().sum::<DVec3>() / 3.0;
            z_order(((middle - low) / cell_m).to_array().map(|at| at as u32))
        });
    }
}

/// Cells along each axis of the order of triangles.
const CELLS: u32 = 1 << 21;

/// Interleaves the bits of a cell's three coordinates.
fn z_order(cell: [u32; 3]) -> u64 {
    let spread = |value: u32| {
        let mut v = u64::from(value.min(CELLS - 1));
        v = (v | (v << 32)) & 0x001f_0000_0000_ffff;
        v = (v | (v << 16)) & 0x001f_0000_ff00_00ff;
        v = (v | (v << 8)) & 0x100f_00f0_0f00_f00f;
        v = (v | (v << 4)) & 0x10c3_0c30_c30c_30c3;
        (v | (v << 2)) & 0x1249_2492_4924_9249
    };
    spread(cell[0]) | (spread(cell[1]) << 1) | (spread(cell[2]) << 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_of_three_coordinates_are_interleaved() {
        assert_eq!(z_order([1, 0, 0]), 1);
        assert_eq!(z_order([0, 1, 3]), 0b10_0110);
        assert_eq!(z_order([CELLS - 1; 3]), (1 << 63) - 1);
    }
}
