//! The entropy coder: coefficients of a block to bits, with the example tables of the JPEG standard (Annex K.3).

use super::transform::{Coefficients, LANES};
use cosfly_frames::simd_kernel;

/// Numbers of codes of each length, and the symbols in the order of their codes.
pub struct CodeTable {
    /// Numbers of codes of 1 to 16 bits.
    pub counts: [u8; 16],
    /// Symbols.
    pub symbols: &'static [u8],
}

/// Tables of DC coefficients, luma and chroma.
pub const DC: [CodeTable; 2] = [
    CodeTable { counts: [0, 1, 5, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0], symbols: &DC_SYMBOLS },
    CodeTable { counts: [0, 3, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0], symbols: &DC_SYMBOLS },
];
/// Tables of AC coefficients, luma and chroma.
pub const AC: [CodeTable; 2] = [
    CodeTable { counts: [0, 2, 1, 3, 3, 2, 4, 3, 5, 5, 4, 4, 0, 0, 1, 0x7d], symbols: &AC_LUMA_SYMBOLS },
    CodeTable { counts: [0, 2, 1, 2, 4, 4, 3, 4, 7, 5, 4, 4, 0, 1, 2, 0x77], symbols: &AC_CHROMA_SYMBOLS },
];

const DC_SYMBOLS: [u8; 12] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11];
#[rustfmt::skip]
const AC_LUMA_SYMBOLS: [u8; 162] = [
    0x01, 0x02, 0x03, 0x00, 0x04, 0x11, 0x05, 0x12, 0x21, 0x31, 0x41, 0x06, 0x13, 0x51, 0x61, 0x07, 0x22, 0x71, 0x14, 0x32,
    0x81, 0x91, 0xa1, 0x08, 0x23, 0x42, 0xb1, 0xc1, 0x15, 0x52, 0xd1, 0xf0, 0x24, 0x33, 0x62, 0x72, 0x82, 0x09, 0x0a, 0x16,
    0x17, 0x18, 0x19, 0x1a, 0x25, 0x26, 0x27, 0x28, 0x29, 0x2a, 0x34, 0x35, 0x36, 0x37, 0x38, 0x39, 0x3a, 0x43, 0x44, 0x45,
    0x46, 0x47, 0x48, 0x49, 0x4a, 0x53, 0x54, 0x55, 0x56, 0x57, 0x58, 0x59, 0x5a, 0x63, 0x64, 0x65, 0x66, 0x67, 0x68, 0x69,
    0x6a, 0x73, 0x74, 0x75, 0x76, 0x77, 0x78, 0x79, 0x7a, 0x83, 0x84, 0x85, 0x86, 0x87, 0x88, 0x89, 0x8a, 0x92, 0x93, 0x94,
    0x95, 0x96, 0x97, 0x98, 0x99, 0x9a, 0xa2, 0xa3, 0xa4, 0xa5, 0xa6, 0xa7, 0xa8, 0xa9, 0xaa, 0xb2, 0xb3, 0xb4, 0xb5, 0xb6,
    0xb7, 0xb8, 0xb9, 0xba, 0xc2, 0xc3, 0xc4, 0xc5, 0xc6, 0xc7, 0xc8, 0xc9, 0xca, 0xd2, 0xd3, 0xd4, 0xd5, 0xd6, 0xd7, 0xd8,
    0xd9, 0xda, 0xe1, 0xe2, 0xe3, 0xe4, 0xe5, 0xe6, 0xe7, 0xe8, 0xe9, 0xea, 0xf1, 0xf2, 0xf3, 0xf4, 0xf5, 0xf6, 0xf7, 0xf8,
    0xf9, 0xfa,
];
#[rustfmt::skip]
const AC_CHROMA_SYMBOLS: [u8; 162] = [
    0x00, 0x01, 0x02, 0x03, 0x11, 0x04, 0x05, 0x21, 0x31, 0x06, 0x12, 0x41, 0x51, 0x07, 0x61, 0x71, 0x13, 0x22, 0x32, 0x81,
    0x08, 0x14, 0x42, 0x91, 0xa1, 0xb1, 0xc1, 0x09, 0x23, 0x33, 0x52, 0xf0, 0x15, 0x62, 0x72, 0xd1, 0x0a, 0x16, 0x24, 0x34,
    0xe1, 0x25, 0xf1, 0x17, 0x18, 0x19, 0x1a, 0x26, 0x27, 0x28, 0x29, 0x2a, 0x35, 0x36, 0x37, 0x38, 0x39, 0x3a, 0x43, 0x44,
    0x45, 0x46, 0x47, 0x48, 0x49, 0x4a, 0x53, 0x54, 0x55, 0x56, 0x57, 0x58, 0x59, 0x5a, 0x63, 0x64, 0x65, 0x66, 0x67, 0x68,
    0x69, 0x6a, 0x73, 0x74, 0x75, 0x76, 0x77, 0x78, 0x79, 0x7a, 0x82, 0x83, 0x84, 0x85, 0x86, 0x87, 0x88, 0x89, 0x8a, 0x92,
    0x93, 0x94, 0x95, 0x96, 0x97, 0x98, 0x99, 0x9a, 0xa2, 0xa3, 0xa4, 0xa5, 0xa6, 0xa7, 0xa8, 0xa9, 0xaa, 0xb2, 0xb3, 0xb4,
    0xb5, 0xb6, 0xb7, 0xb8, 0xb9, 0xba, 0xc2, 0xc3, 0xc4, 0xc5, 0xc6, 0xc7, 0xc8, 0xc9, 0xca, 0xd2, 0xd3, 0xd4, 0xd5, 0xd6,
    0xd7, 0xd8, 0xd9, 0xda, 0xe2, 0xe3, 0xe4, 0xe5, 0xe6, 0xe7, 0xe8, 0xe9, 0xea, 0xf2, 0xf3, 0xf4, 0xf5, 0xf6, 0xf7, 0xf8,
    0xf9, 0xfa,
];

/// End of block, and a run of sixteen zeros.
const END: usize = 0x00;
const SIXTEEN_ZEROS: usize = 0xf0;

/// Code of each symbol.
pub struct Codes {
    /// Code above [`LENGTH_BITS`] bits of its length.
    entries: [u32; 256],
}

const LENGTH_BITS: u32 = 8;

impl Codes {
    /// Assigns codes in increasing order, shortest first.
    pub fn of(table: &CodeTable) -> Self {
        let mut codes = Self { entries: [0; 256] };
        let (mut next, mut symbols) = (0u32, table.symbols.iter());
        for (length, count) in (1u32..).zip(table.counts) {
            for symbol in symbols.by_ref().take(usize::from(count)) {
                codes.entries[usize::from(*symbol)] = next << LENGTH_BITS | length;
                next += 1;
            }
            next <<= 1;
        }
        codes
    }

    /// Code of a symbol, and its length in bits.
    #[inline(always)]
    fn get(&self, symbol: usize) -> (u32, u32) {
        let entry = self.entries[symbol % 256];
        (entry >> LENGTH_BITS, entry & 0xff)
    }
}

/// Most bytes of one block: 64 codes of 16 bits with 11 bits each.
const BLOCK_BYTES: usize = 64 * 27 / 8;
/// Most bytes of [`LANES`] blocks of three components, and the bytes written ahead of the end.
const ROOM_BYTES: usize = 3 * LANES * BLOCK_BYTES + 16;

/// Writer of bits into a file.
pub struct BitWriter {
    /// Bits not written yet: the highest `held` (less than 8) bits; the others are 0.
    bits: u64,
    held: u32,
    /// Bytes written since the last [`Self::flush`].
    room: [u8; ROOM_BYTES],
    written: usize,
}

impl BitWriter {
    /// Writer with nothing written.
    pub const EMPTY: Self = Self { bits: 0, held: 0, room: [0; ROOM_BYTES], written: 0 };

    /// Moves the bytes written so far to `output`.
    pub fn flush(&mut self, output: &mut Vec<u8>) {
        put_stuffed(&self.room[..self.written], output);
        self.written = 0;
    }

    /// Pads the last byte with ones and moves all bytes to `output`.
    pub fn finish(mut self, output: &mut Vec<u8>) {
        self.flush(output);
        if self.held > 0 {
            let ones = 0xff >> self.held;
            put_stuffed(&[(self.bits >> 56) as u8 | ones], output);
        }
    }
}

/// Appends `bytes`, each 0xFF followed by a 0x00 (byte stuffing of the standard).
fn put_stuffed(bytes: &[u8], output: &mut Vec<u8>) {
    for chunk in bytes.chunks(32) {
        if chunk.iter().fold(false, |any, byte| any | (*byte == 0xff)) {
            for byte in chunk {
                output.push(*byte);
                if *byte == 0xff {
                    output.push(0);
                }
            }
        } else {
            output.extend_from_slice(chunk);
        }
    }
}

simd_kernel! {
    /// Appends the first `lanes` blocks of all components; `previous_dc` are the DC values of the preceding blocks. May
    /// be called once between two calls of [`BitWriter::flush`].
    pub fn write_blocks(
        writer: &mut BitWriter,
        coefficients: &[Coefficients; 3],
        codes: &[&[Codes; 2]; 3],
        lanes: usize,
        previous_dc: &mut [i32; 3],
    ) {
        let mut open =
            OpenBits { bits: writer.bits, held: writer.held, written: writer.written, room: &mut writer.room };
        for lane in 0..lanes.min(LANES) {
            for component in 0..3 {
                open.block(&coefficients[component], lane, codes[component], &mut previous_dc[component]);
            }
        }
        (writer.bits, writer.held, writer.written) = (open.bits, open.held, open.written);
    }
}

/// Units of 16 x 16 pixels in a group of blocks.
pub const UNITS: usize = LANES / 2;

simd_kernel! {
    /// Appends the first `units` units of group `group`: four blocks of luma, and one of each chroma component, which cover both
    /// groups. May be called once between two calls of [`BitWriter::flush`].
    pub fn write_units(
        writer: &mut BitWriter,
        luma: &[[Coefficients; 2]; 2],
        chroma: &[Coefficients; 2],
        codes: &[&[Codes; 2]; 2],
        group: usize,
        units: usize,
        previous_dc: &mut [i32; 3],
    ) {
        let mut open =
            OpenBits { bits: writer.bits, held: writer.held, written: writer.written, room: &mut writer.room };
        let [of_luma, of_blue, of_red] = previous_dc;
        for unit in 0..units.min(UNITS) {
            for half in luma {
                open.block(&half[group % 2], 2 * unit, codes[0], of_luma);
                open.block(&half[group % 2], 2 * unit + 1, codes[0], of_luma);
            }
            open.block(&chroma[0], UNITS * group + unit, codes[1], of_blue);
            open.block(&chroma[1], UNITS * group + unit, codes[1], of_red);
        }
        (writer.bits, writer.held, writer.written) = (open.bits, open.held, open.written);
    }
}

/// The state of a [`BitWriter`] while blocks are written: small enough to stay in registers.
struct OpenBits<'a> {
    bits: u64,
    held: u32,
    written: usize,
    room: &'a mut [u8; ROOM_BYTES],
}

impl OpenBits<'_> {
    #[inline(always)]
    fn block(&mut self, blocks: &Coefficients, lane: usize, [dc, ac]: &[Codes; 2], previous_dc: &mut i32) {
        let lane = lane % LANES;
        let value = blocks.values[0][lane];
        let (bits, size) = magnitude(value.wrapping_sub(*previous_dc));
        *previous_dc = value;
        self.symbol(dc, size as usize, bits, size);
        let mut left = blocks.occupied(lane) & !1;
        let mut before = 0u32;
        while left != 0 {
            let k = left.trailing_zeros() % 64;
            left &= left.wrapping_sub(1);
            let mut zeros = k.wrapping_sub(before).wrapping_sub(1);
            before = k;
            while zeros >= 16 {
                self.symbol(ac, SIXTEEN_ZEROS, 0, 0);
                zeros = zeros.wrapping_sub(16);
            }
            let (bits, size) = magnitude(blocks.values[k as usize][lane]);
            self.symbol(ac, (zeros << 4 | size) as usize, bits, size);
        }
        if before != 63 {
            self.symbol(ac, END, 0, 0);
        }
    }

    /// Appends a code and the bits after it. No branch can be mispredicted: eight bytes are written every time, and the
    /// full ones are counted.
    #[inline(always)]
    fn symbol(&mut self, codes: &Codes, symbol: usize, bits: u32, size: u32) {
        let (code, length) = codes.get(symbol);
        let held = self.held.wrapping_add(length).wrapping_add(size);
        let new = u64::from(code.wrapping_shl(size) | bits);
        self.bits |= new.wrapping_shl(64u32.wrapping_sub(held));
        if let Some(place) = self.room.get_mut(self.written..self.written.wrapping_add(8)) {
            place.copy_from_slice(&self.bits.to_be_bytes());
        }
        self.written = self.written.wrapping_add((held / 8) as usize);
        self.bits = self.bits.wrapping_shl(held & 56);
        self.held = held % 8;
    }
}

/// Additional bits of a coefficient within its size category, and that category.
#[inline(always)]
fn magnitude(value: i32) -> (u32, u32) {
    let sign = value >> 31;
    let size = 32u32.wrapping_sub((value ^ sign).wrapping_sub(sign).leading_zeros());
    (value.wrapping_add(sign) as u32 & 1u32.wrapping_shl(size).wrapping_sub(1), size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_those_of_the_standard() {
        let luma = Codes::of(&AC[0]);
        assert_eq!(luma.get(0x00), (0b1010, 4));
        assert_eq!(luma.get(0x01), (0b00, 2));
        assert_eq!(luma.get(0xf0), (0b111_1111_1001, 11));
        assert_eq!(luma.get(0xfa), (0xfffe, 16));
        let chroma = Codes::of(&AC[1]);
        assert_eq!(chroma.get(0x00), (0b00, 2));
        assert_eq!(chroma.get(0xf0), (0b11_1111_1010, 10));
    }

    #[test]
    fn magnitudes_are_those_of_the_standard() {
        for (value, expected) in
            [(0, (0, 0)), (1, (1, 1)), (-1, (0, 1)), (5, (5, 3)), (-5, (2, 3)), (-1024, (1023, 11))]
        {
            assert_eq!(magnitude(value), expected, "{value}");
        }
    }

    #[test]
    fn ones_bytes_are_stuffed_and_the_end_is_filled_with_ones() {
        let mut file = vec![];
        put_stuffed(&[0x12, 0xff, 0x34, 0xff], &mut file);
        assert_eq!(file, [0x12, 0xff, 0, 0x34, 0xff, 0]);
        file.clear();
        let mut writer = BitWriter { bits: 0, held: 3, written: 1, ..BitWriter::EMPTY };
        writer.room[0] = 0xff;
        writer.finish(&mut file);
        assert_eq!(file, [0xff, 0, 0x1f]);
    }
}
