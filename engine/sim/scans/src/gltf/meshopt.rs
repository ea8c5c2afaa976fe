//! The codecs of `EXT_meshopt_compression` and `KHR_meshopt_compression`: attributes, triangles and indices, and their filters.
//! The names of the numbers are those of the extension's appendices.

/// Elements of an attribute that share a width of their differences.
const GROUP: usize = 16;
/// Most elements of a block of attributes, and most bytes of one.
const BLOCK: usize = 256;
const BLOCK_BYTES: usize = 8192;
/// First bytes of the streams.
const ATTRIBUTES: [u8; 2] = [0xa0, 0xa1];
const TRIANGLES: u8 = 0xe1;
const INDICES: u8 = 0xd1;

/// Bytes of `count` elements of `stride` bytes each; none where the stream is not one of them, to its last byte. Asks for no more memory than these bytes.
pub(super) fn unpacked(mode: &str, filter: &str, packed: &[u8], count: usize, stride: usize) -> Option<Vec<u8>> {
    let is_index = stride == 2 || stride == 4;
    let mut plain = match (mode, filter) {
        ("ATTRIBUTES", _) if stride.is_multiple_of(4) && (4..=256).contains(&stride) => {
            attributes(packed, count, stride)?
        }
        ("TRIANGLES", "NONE" | "") if is_index && count.is_multiple_of(3) => {
            indices(&triangles(packed, count / 3)?, stride)
        }
        ("INDICES", "NONE" | "") if is_index => indices(&sequence(packed, count)?, stride),
        _ => return None,
    };
    match (filter, stride) {
        ("NONE" | "", _) => {}
        ("OCTAHEDRAL", 4) => plain.as_chunks_mut().0.iter_mut().for_each(|own| {
            let one = own.map(|byte| byte as i8);
            *own = octahedral(one.map(f32::from), 127.0).map(|number| number as i8 as u8);
        }),
        ("OCTAHEDRAL", 8) => each_of_four(&mut plain, |own| {
            octahedral(own.map(|it| f32::from(it as i16)), 32767.0).map(|number| number as i16 as u16)
        }),
        ("QUATERNION", 8) => each_of_four(&mut plain, |own| quaternion(own.map(|it| it as i16)).map(|it| it as u16)),
        ("EXPONENTIAL", _) => plain.as_chunks_mut().0.iter_mut().for_each(|own| *own = exponential(*own)),
        ("COLOR", 4) => plain.as_chunks_mut().0.iter_mut().for_each(|own: &mut [u8; 4]| {
            let [luma, orange, green, alpha] = *own;
            let wide = [luma.into(), (orange as i8).into(), (green as i8).into(), alpha.into()];
            *own = colour(wide, 255.0).map(|number| number as u8);
        }),
        ("COLOR", 8) => each_of_four(&mut plain, |[luma, orange, green, alpha]| {
            let wide = [luma.into(), (orange as i16).into(), (green as i16).into(), alpha.into()];
            colour(wide, 65535.0).map(|number| number as u16)
        }),
        _ => return None,
    }
    Some(plain)
}

/// Takes bytes from the front.
fn take<'a>(rest: &mut &'a [u8], count: usize) -> Option<&'a [u8]> {
    let (own, after) = rest.split_at_checked(count)?;
    *rest = after;
    Some(own)
}

/// Elements as differences to those before, byte by byte.
fn attributes(packed: &[u8], count: usize, stride: usize) -> Option<Vec<u8>> {
    let (head, rest) = packed.split_first()?;
    let version = ATTRIBUTES.iter().position(|own| own == head)?;
    let (channels, least) = [(0, 32), (stride / 4, 24)][version];
    let (mut rest, tail) = rest.split_at_checked(rest.len().checked_sub((stride + channels).max(least))?)?;
    let tail = &tail[tail.len() - stride - channels..];
    let (mut last, channels) = (tail[..stride].to_vec(), &tail[stride..]);
    let mut plain = vec![0; count * stride];
    let block = (BLOCK_BYTES / stride / GROUP * GROUP).min(BLOCK);
    for own in plain.chunks_mut(block * stride) {
        let elements = own.len() / stride;
        let controls = take(&mut rest, if version == 1 { stride / 4 } else { 0 })?;
        for channel in 0..stride / 4 {
            let mut differences = [[0; BLOCK]; 4];
            for (k, differences) in differences.iter_mut().enumerate() {
                let (widths, control) = match controls.get(channel) {
                    None => ([0, 2, 4, 8], 0),
                    Some(control) => match (control >> (2 * k)) & 3 {
                        0 => ([0, 1, 2, 4], 0),
                        1 => ([1, 2, 4, 8], 1),
                        other => ([0; 4], other),
                    },
                };
                match control {
                    2 => {}
                    3 => differences[..elements].copy_from_slice(take(&mut rest, elements)?),
                    _ => read_groups(&mut rest, &mut differences[..elements.next_multiple_of(GROUP)], widths)?,
                }
            }
            let last = last[4 * channel..].first_chunk_mut()?;
            let mode = channels.get(channel).copied().unwrap_or(0);
            for (at, own) in own.chunks_exact_mut(stride).enumerate() {
                *last = next(*last, differences.map(|differences| differences[at]), mode)?;
                own[4 * channel..][..4].copy_from_slice(last);
            }
        }
    }
    rest.is_empty().then_some(plain)
}

/// Groups of 16 differences; two bits for each say which of the widths it has. What does not fit into its width stands behind the group.
fn read_groups(rest: &mut &[u8], differences: &mut [u8], widths: [usize; 4]) -> Option<()> {
    let (groups, _) = differences.as_chunks_mut::<GROUP>();
    let heads = take(rest, groups.len().div_ceil(4))?;
    for (at, group) in groups.iter_mut().enumerate() {
        let width = widths[usize::from(heads[at / 4] >> (2 * (at % 4))) & 3];
        let own = take(rest, GROUP * width / 8)?;
        if width == 0 || width == 8 {
            group[..own.len()].copy_from_slice(own);
            continue;
        }
        let (in_byte, most) = (8 / width, (1 << width) - 1);
        for (k, difference) in group.iter_mut().enumerate() {
            // Single bits begin with the lowest, wider ones with the highest.
            let place = if width == 1 { k % in_byte } else { in_byte - 1 - k % in_byte };
            let code = (own[k / in_byte] >> (place * width)) & most;
            *difference = if code == most { take(rest, 1)?[0] } else { code };
        }
    }
    Some(())
}

/// Four bytes of an element by those of the one before.
fn next(last: [u8; 4], difference: [u8; 4], mode: u8) -> Option<[u8; 4]> {
    Some(match (mode & 15, mode >> 4) {
        (0, 0) => core::array::from_fn(|k| {
            let code = difference[k];
            last[k].wrapping_add((code >> 1) ^ (code & 1).wrapping_neg())
        }),
        (1, 0) => {
            let halves = |[a, b, c, d]: [u8; 4]| [[a, b], [c, d]].map(u16::from_le_bytes);
            let (last, difference) = (halves(last), halves(difference));
            let own = [0, 1].map(|k| {
                let code: u16 = difference[k];
                last[k].wrapping_add((code >> 1) ^ (code & 1).wrapping_neg()).to_le_bytes()
            });
            [own[0][0], own[0][1], own[1][0], own[1][1]]
        }
        (2, turn) => {
            let difference = u32::from_le_bytes(difference).rotate_right(turn.into());
            (u32::from_le_bytes(last) ^ difference).to_le_bytes()
        }
        _ => return None,
    })
}

/// The last sixteen of what was seen.
struct Recent<T> {
    seen: [T; 16],
    count: usize,
}

impl<T: Copy + Default> Recent<T> {
    fn new() -> Self {
        Self { seen: [T::default(); 16], count: 0 }
    }

    fn push(&mut self, own: T) {
        self.seen[self.count % 16] = own;
        self.count += 1;
    }

    /// The one that many before the last.
    fn before(&self, back: u8) -> Option<T> {
        let at = self.count.checked_sub(1 + usize::from(back))?;
        (back < 16).then(|| self.seen[at % 16])
    }
}

/// A number in groups of seven bits, at most five of them.
fn varint(rest: &mut &[u8]) -> Option<u32> {
    let mut number = 0;
    for at in 0..5 {
        let byte = take(rest, 1)?[0];
        number |= u32::from(byte & 0x7f) << (7 * at);
        if byte & 0x80 == 0 {
            return Some(number);
        }
    }
    None
}

/// A difference whose sign is its lowest bit.
fn signed(code: u32) -> u32 {
    (code >> 1) ^ (code & 1).wrapping_neg()
}

/// State while triangles are read.
struct Corners<'a> {
    data: &'a [u8],
    next: u32,
    last: u32,
    edges: Recent<[u32; 2]>,
    vertices: Recent<u32>,
}

impl Corners<'_> {
    fn fresh(&mut self) -> u32 {
        let own = self.next;
        self.next = own.wrapping_add(1);
        own
    }

    fn stated(&mut self) -> Option<u32> {
        self.last = self.last.wrapping_add(signed(varint(&mut self.data)?));
        Some(self.last)
    }

    /// A corner that is new (0), one of the last, or stated (15); and whether it is to be remembered.
    fn corner(&mut self, code: u8) -> Option<(u32, bool)> {
        Some(match code {
            0 => (self.fresh(), true),
            15 => (self.stated()?, true),
            _ => (self.vertices.before(code - 1)?, false),
        })
    }

    /// A triangle at one of the last edges.
    fn beside(&mut self, edge: u8, code: u8) -> Option<[u32; 3]> {
        let [a, b] = self.edges.before(edge)?;
        let c = match code {
            0 => self.fresh(),
            0xd | 0xe => {
                self.last = if code == 0xd { self.last.wrapping_sub(1) } else { self.last.wrapping_add(1) };
                self.last
            }
            0xf => self.stated()?,
            _ => self.vertices.before(code)?,
        };
        if !(1..0xd).contains(&code) {
            self.vertices.push(c);
        }
        Some([a, b, c])
    }

    /// A triangle of its own.
    fn alone(&mut self, code: u8, table: &[u8]) -> Option<[u32; 3]> {
        let pair = match code {
            0xe | 0xf => take(&mut self.data, 1)?[0],
            _ => table[usize::from(code)],
        };
        if code >= 0xe && pair == 0 {
            self.next = 0;
        }
        let a = if code == 0xf { self.stated()? } else { self.fresh() };
        let (b, is_new_b) = self.corner(pair >> 4)?;
        let (c, is_new_c) = self.corner(pair & 15)?;
        self.edges.push([b, a]);
        self.vertices.push(a);
        [(b, is_new_b), (c, is_new_c)]
            .into_iter()
            .filter(|(_, is_new)| *is_new)
            .for_each(|(own, _)| self.vertices.push(own));
        Some([a, b, c])
    }
}

/// Corners of triangles by the edges and corners of those before.
fn triangles(packed: &[u8], count: usize) -> Option<Vec<u32>> {
    let (head, rest) = packed.split_first()?;
    let (codes, rest) = rest.split_at_checked(count)?;
    let (data, table) = rest.split_at_checked(rest.len().checked_sub(16)?)?;
    let is_table = table[14..] == [0, 0] && table.iter().all(|pair| pair >> 4 != 15 && pair & 15 != 15);
    if *head != TRIANGLES || !is_table {
        return None;
    }
    let mut state = Corners { data, next: 0, last: 0, edges: Recent::new(), vertices: Recent::new() };
    let mut corners = Vec::with_capacity(3 * count);
    for code in codes {
        let [a, b, c] = match (code >> 4, code & 15) {
            (15, own) => state.alone(own, table)?,
            (edge, own) => state.beside(edge, own)?,
        };
        state.edges.push([c, b]);
        state.edges.push([a, c]);
        corners.extend([a, b, c]);
    }
    state.data.is_empty().then_some(corners)
}

/// Numbers as differences to one of two before.
fn sequence(packed: &[u8], count: usize) -> Option<Vec<u32>> {
    let (head, rest) = packed.split_first()?;
    let (mut data, _) = rest.split_at_checked(rest.len().checked_sub(4)?)?;
    let mut last = [0_u32; 2];
    if *head != INDICES || count > data.len() {
        return None;
    }
    let mut numbers = Vec::with_capacity(count);
    for _ in 0..count {
        let code = varint(&mut data)?;
        let own = &mut last[(code & 1) as usize];
        *own = own.wrapping_add(signed(code >> 1));
        numbers.push(*own);
    }
    data.is_empty().then_some(numbers)
}

fn indices(numbers: &[u32], stride: usize) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes().into_iter().take(stride)).collect()
}

/// Changes elements of four numbers of 16 bits.
fn each_of_four(plain: &mut [u8], change: impl Fn([u16; 4]) -> [u16; 4]) {
    for own in plain.as_chunks_mut::<8>().0 {
        let numbers = core::array::from_fn(|k| u16::from_le_bytes([own[2 * k], own[2 * k + 1]]));
        for (to, number) in own.as_chunks_mut::<2>().0.iter_mut().zip(change(numbers)) {
            *to = number.to_le_bytes();
        }
    }
}

/// A direction on an octahedron: two numbers, what counts as 1, and a number that stays.
fn octahedral([x, y, one, rest]: [f32; 4], most: f32) -> [f32; 4] {
    let (x, y) = (x / one, y / one);
    let z = 1.0 - x.abs() - y.abs();
    let below = z.min(0.0);
    let (x, y) = (x - below.copysign(x), y - below.copysign(y));
    let length = (x * x + y * y + z * z).sqrt();
    let [x, y, z] = [x, y, z].map(|share| (share / length * most).round());
    [x, y, z, rest]
}

/// A turn without its largest number; the fourth says which it is and what counts as 1.
fn quaternion([x, y, z, last]: [i16; 4]) -> [i16; 4] {
    let unit = core::f32::consts::FRAC_1_SQRT_2 / f32::from(last | 3);
    let [x, y, z] = [x, y, z].map(|number| f32::from(number) * unit);
    let largest = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
    let mut own = [0; 4];
    for (k, number) in [largest, x, y, z].into_iter().enumerate() {
        own[((last & 3) as usize + k) % 4] = (number * 32767.0).round() as i16;
    }
    own
}

/// A real number by its power of two (8 bits) and its digits (24 bits).
fn exponential(packed: [u8; 4]) -> [u8; 4] {
    let number = i32::from_le_bytes(packed);
    let power = f64::from_bits(((1023 + i64::from(number >> 24)) as u64) << 52);
    ((f64::from(number << 8 >> 8) * power) as f32).to_le_bytes()
}

/// Red, green, blue and alpha of luma, orange, green and an alpha whose highest bit says how many bits all have.
fn colour([luma, orange, green, alpha]: [i32; 4], most: f32) -> [f32; 4] {
    let all = alpha.checked_ilog2().map_or(0, |bit| (2 << bit) - 1);
    let short = alpha & (all >> 1);
    let alpha = (short << 1) | (short & 1);
    let scale = most / all as f32;
    [luma + orange - green, luma + green, luma - orange - green, alpha].map(|number| (number as f32 * scale).round())
}

#[cfg(test)]
mod tests {
    use super::*;
    use base64::Engine as _;
    use base64::engine::general_purpose::STANDARD;

    /// Streams of meshoptimizer 1.2's encoder, of both versions, and what its decoder makes of them.
    const CASES: &str = include_str!("meshopt_cases.txt");

    #[test]
    fn streams_of_the_first_encoder_are_unpacked_and_cut_ones_refused() {
        for case in CASES.lines() {
            let words: Vec<&str> = case.split(' ').collect();
            let [mode, filter, count, stride, packed, plain] = words[..] else { panic!("{case}") };
            let (count, stride): (usize, usize) = (count.parse().expect("a count"), stride.parse().expect("a stride"));
            let [packed, plain] = [packed, plain].map(|text| STANDARD.decode(text).expect("bytes"));
            let own = unpacked(mode, filter, &packed, count, stride).expect(case);
            // Filters are exact to the last step of what they round to.
            let number = |bytes: &[u8]| bytes.iter().rev().fold(0_u32, |all, byte| all << 8 | u32::from(*byte));
            let (width, step) =
                if ["OCTAHEDRAL", "QUATERNION", "COLOR"].contains(&filter) { (stride / 4, 1) } else { (1, 0) };
            let mut pairs = own.chunks(width).zip(plain.chunks(width));
            let is_near = pairs.all(|(own, plain)| number(own).abs_diff(number(plain)) <= step);
            assert!(own.len() == plain.len() && is_near, "{case}");
            for length in 0..packed.len() {
                let cut = unpacked(mode, filter, &packed[..length], count, stride);
                assert!(cut.is_none(), "{length} of {case}");
            }
            assert!(unpacked(mode, filter, &packed, count, stride + 1).is_none(), "{case}");
            let other = if filter == "NONE" { "QUATERNION" } else { "BENT" };
            assert!(unpacked(mode, other, &packed, count, if stride == 8 { 12 } else { stride }).is_none(), "{case}");
        }
    }
}
