//! Huffman codes of a JPEG scan.

/// Bits that are looked up at once.
const FAST: u32 = 10;

/// A Huffman table.
pub struct Table {
    /// By the next [`FAST`] bits: symbol, and bits of its code in the high byte; 0 for longer codes.
    symbols: Box<[u16; 1 << FAST]>,
    /// By the next [`FAST`] bits, where code and value fit: value (16 bits), zeros before (8), bits of both (8); else 0.
    values: Box<[i32; 1 << FAST]>,
    /// First code of each length that is too large, in 16 bits, from the left.
    ends: [u32; 17],
    /// Place of the first symbol of each length, less its first code.
    offsets: [i32; 17],
    list: Vec<u8>,
}

impl Table {
    /// The table with some numbers of codes of the lengths 1 to 16; `None` where they do not fit.
    pub fn new(counts: &[u8; 16], list: &[u8]) -> Option<Self> {
        let (mut symbols, mut values) = (Box::new([0u16; 1 << FAST]), Box::new([0i32; 1 << FAST]));
        let (mut ends, mut offsets) = ([0; 17], [0; 17]);
        let (mut code, mut place) = (0u32, 0usize);
        for length in 1..=16u32 {
            offsets[length as usize] = place as i32 - code as i32;
            for _ in 0..counts[length as usize - 1] {
                let symbol = *list.get(place)?;
                (code < 1 << length).then_some(())?;
                if length <= FAST {
                    let first = (code << (FAST - length)) as usize;
                    symbols[first..first + (1 << (FAST - length))].fill(u16::from(symbol) | (length as u16) << 8);
                }
                (code, place) = (code + 1, place + 1);
            }
            ends[length as usize] = code << (16 - length);
            code <<= 1;
        }
        for (bits, value) in values.iter_mut().enumerate() {
            let (symbol, length) = (symbols[bits] & 255, u32::from(symbols[bits] >> 8));
            let size = u32::from(symbol & 15);
            if length > 0 && size > 0 && length + size <= FAST {
                let raw = (bits as u32 >> (FAST - length - size)) & ((1 << size) - 1);
                *value = extended(raw, size) << 16 | i32::from(symbol >> 4) << 8 | (length + size) as i32;
            }
        }
        Some(Self { symbols, values, ends, offsets, list: list.to_vec() })
    }
}

/// A number of `size` bits with JPEG's sign.
fn extended(raw: u32, size: u32) -> i32 {
    if size > 0 && raw < 1 << (size - 1) { raw as i32 - (1 << size) + 1 } else { raw as i32 }
}

/// The bits of a scan.
pub struct Bits<'f> {
    scan: &'f [u8],
    at: usize,
    /// Next bits, from the highest one on.
    buffer: u64,
    count: u32,
    /// Bits of zeros given after the end of the data.
    missing: u32,
}

impl<'f> Bits<'f> {
    /// Bits of a scan, which begins after its header.
    pub fn new(scan: &'f [u8]) -> Self {
        Self { scan, at: 0, buffer: 0, count: 0, missing: 0 }
    }

    /// Fills the buffer to at least 48 bits; zeros after the end.
    #[inline(always)]
    fn fill(&mut self) {
        if self.count >= 48 {
            return;
        }
        if let Some(eight) = self.scan.get(self.at..).and_then(|rest| rest.first_chunk::<8>()) {
            let next = u64::from_be_bytes(*eight);
            // No byte is 0xff when no byte of the complement is 0.
            let inverse = !next;
            if inverse.wrapping_sub(0x0101_0101_0101_0101) & !inverse & 0x8080_8080_8080_8080 == 0 {
                self.buffer |= next >> self.count;
                let bytes = (64 - self.count) / 8;
                self.at += bytes as usize;
                self.count += 8 * bytes;
                // Bits of a byte that is not taken whole are read again.
                self.buffer &= !0 << (64 - self.count);
                return;
            }
        }
        self.fill_slowly();
    }

    fn fill_slowly(&mut self) {
        while self.count <= 56 {
            let byte = match (self.scan.get(self.at), self.scan.get(self.at + 1)) {
                (Some(0xff), Some(0)) => {
                    self.at += 2;
                    0xff
                }
                (Some(0xff), _) | (None, _) => {
                    self.missing += 8;
                    0
                }
                (Some(byte), _) => {
                    self.at += 1;
                    *byte
                }
            };
            self.buffer |= u64::from(byte) << (56 - self.count);
            self.count += 8;
        }
    }

    #[inline(always)]
    fn peek(&self, bits: u32) -> u32 {
        (self.buffer >> (64 - bits)) as u32
    }

    #[inline(always)]
    fn skip(&mut self, bits: u32) {
        self.buffer <<= bits;
        self.count -= bits;
    }

    /// The next symbol; at least 16 bits must be in the buffer.
    #[inline(always)]
    fn symbol(&mut self, table: &Table) -> Option<u32> {
        let found = table.symbols[self.peek(FAST) as usize];
        if found != 0 {
            self.skip(u32::from(found >> 8));
            return Some(u32::from(found & 255));
        }
        let next = self.peek(16);
        let length = (FAST + 1..=16).find(|length| next < table.ends[*length as usize])?;
        self.skip(length);
        let place = (next >> (16 - length)) as i32 + table.offsets[length as usize];
        table.list.get(usize::try_from(place).ok()?).map(|symbol| u32::from(*symbol))
    }

    #[inline(always)]
    fn value(&mut self, size: u32) -> i32 {
        if size == 0 {
            return 0;
        }
        let raw = self.peek(size);
        self.skip(size);
        extended(raw, size)
    }

    /// The change of a block's mean.
    #[inline(always)]
    pub fn dc(&mut self, table: &Table) -> Option<i32> {
        self.fill();
        let size = self.symbol(table).filter(|size| *size <= 15)?;
        Some(self.value(size))
    }

    /// The other coefficients of a block, times their quantities, at their `places`; whether there are any.
    #[inline(always)]
    pub fn ac(
        &mut self,
        table: &Table,
        quantities: &[u16; 64],
        places: &[u8; 64],
        coefficients: &mut [i32; 65],
    ) -> Option<bool> {
        let mut at = 1;
        while at < 64 {
            self.fill();
            let both = table.values[self.peek(FAST) as usize];
            let (zeros, value);
            if both != 0 {
                self.skip((both & 255) as u32);
                (zeros, value) = ((both >> 8 & 255) as usize, both >> 16);
            } else {
                let symbol = self.symbol(table)?;
                let size = symbol & 15;
                if size == 0 {
                    if symbol != 0xf0 {
                        break;
                    }
                    at += 16;
                    continue;
                }
                (zeros, value) = ((symbol >> 4) as usize, self.value(size));
            }
            at += zeros;
            let place = *places.get(at)?;
            coefficients[usize::from(place.min(64))] = value.wrapping_mul(i32::from(quantities[at]));
            at += 1;
        }
        Some(at > 1)
    }

    /// Goes on after a restart marker.
    pub fn restart(&mut self) -> Option<()> {
        (self.buffer, self.count) = (0, 0);
        while self.scan.get(self.at..self.at + 2)? != [0xff, self.scan[self.at + 1] & 0x07 | 0xd0] {
            self.at += 1;
        }
        self.at += 2;
        Some(())
    }

    /// Whether the data were long enough: only bits that were read in advance are missing.
    pub fn is_sound(&self) -> bool {
        self.missing <= self.count
    }
}
