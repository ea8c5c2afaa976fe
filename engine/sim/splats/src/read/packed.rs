//! `.spz`, versions 2 to 4: columns of small numbers, packed together with gzip, or each with Zstandard.

use super::{check_count, exponential};
use crate::cloud::SplatCloud;
use crate::error::SplatError;
use crate::splat::{MOST_COEFFICIENTS, Splat};
use flate2::bufread::GzDecoder;
use std::io::Read;

const HEAD: usize = 16;
/// The first bytes of a file of version 4; those of version 2 and 3 once they are unpacked.
pub(super) const MAGIC: [u8; 4] = *b"NGSP";
/// Files pack to a third or so: what promises to unpack to more than this many times its size is no scene.
const MOST_UNPACKED: usize = 200;
/// Factor of colours.
const COLOUR: f32 = 0.15;

/// The head of a file.
struct Head {
    version: u32,
    count: usize,
    degree: usize,
    /// Bits of a coordinate behind its point.
    fraction: u32,
}

impl Head {
    fn read(own: &[u8; HEAD]) -> Result<Self, SplatError> {
        let word = |at: usize| u32::from_le_bytes([own[at], own[at + 1], own[at + 2], own[at + 3]]);
        if own[..4] != MAGIC {
            let message = "the file is packed with gzip, but does not begin with `NGSP` when unpacked";
            return Err(SplatError::new(message, "give a `.spz` file, or unpack the file first"));
        }
        let head = Self { version: word(4), count: word(8) as usize, degree: own[12].into(), fraction: own[13].into() };
        if !matches!(head.version, 2..=4) {
            let message = format!("the file is SPZ of version {}; versions 2 to 4 are read", head.version);
            return Err(SplatError::new(message, "export the scene as `.ply`"));
        }
        if head.degree > 3 || head.fraction > 24 {
            let message = format!(
                "colours of degree {} and {} bits behind the point; at most 3 and 24 are read",
                head.degree, head.fraction
            );
            return Err(SplatError::new(message, "the file seems to be damaged: fetch or export it again"));
        }
        check_count(head.count)?;
        Ok(head)
    }

    /// Bytes of a turn.
    fn turn_bytes(&self) -> usize {
        if self.version == 2 { 3 } else { 4 }
    }

    /// Numbers of the harmonics beyond the first, of one channel.
    fn further(&self) -> usize {
        (self.degree + 1) * (self.degree + 1) - 1
    }

    /// Bytes of all splats, unless the file is too short for them.
    fn expected(&self, file: &[u8]) -> Result<usize, SplatError> {
        let expected = self.count * self.splat_bytes();
        if expected / MOST_UNPACKED <= file.len() {
            return Ok(expected);
        }
        let message = format!("{} bytes cannot hold the {} splats that the file promises", file.len(), self.count);
        Err(SplatError::cut_off(message))
    }

    /// Bytes of a splat in all columns.
    fn splat_bytes(&self) -> usize {
        9 + 1 + 3 + 3 + self.turn_bytes() + 3 * self.further()
    }
}

/// Reads a file of version 2 or 3.
pub(super) fn read(bytes: &[u8]) -> Result<SplatCloud, SplatError> {
    let mut unpacked = GzDecoder::new(bytes);
    let mut head = [0; HEAD];
    unpacked.read_exact(&mut head).map_err(|_| SplatError::cut_off("the file cannot be unpacked with gzip"))?;
    let head = Head::read(&head)?;
    let expected = head.expected(bytes)?;
    let mut data = Vec::new();
    // What goes on behind the last splat is not read.
    let result = unpacked.take(expected as u64).read_to_end(&mut data);
    if result.is_err() || data.len() < expected {
        return Err(SplatError::cut_off(format!("the file ends before the last of {} splats", head.count)));
    }
    Ok(cloud(&head, &data))
}

/// Reads a file of version 4: a head, a list of the lengths of its columns, and each column packed by itself.
pub(super) fn read_columns(bytes: &[u8]) -> Result<SplatCloud, SplatError> {
    let cut = || SplatError::cut_off("the file ends before the last of its columns");
    let head = Head::read(bytes.first_chunk().ok_or_else(cut)?)?;
    if head.version < 4 {
        let message = format!("a file of version {} is packed with gzip, and this one is not", head.version);
        return Err(SplatError::new(message, "fetch or export it again"));
    }
    let expected = head.expected(bytes)?;
    let number = |at: usize| Some(u64::from_le_bytes(*bytes.get(at..)?.first_chunk()?) as usize);
    let list = u32::from_le_bytes(*bytes[HEAD..].first_chunk().ok_or_else(cut)?) as usize;
    let widths = [9, 1, 3, 3, 4, 3 * head.further()].into_iter().filter(|width| *width > 0);
    let mut at = list.saturating_add(16 * widths.clone().count());
    let mut data = Vec::with_capacity(expected);
    for (column, width) in widths.enumerate() {
        let (packed, unpacked) = (list + 16 * column, width * head.count);
        let length = number(packed).filter(|_| number(packed + 8) == Some(unpacked)).ok_or_else(cut)?;
        let own = bytes.get(at..).and_then(|rest| rest.get(..length)).ok_or_else(cut)?;
        let own = zstd::bulk::decompress(own, unpacked).ok().filter(|own| own.len() == unpacked).ok_or_else(cut)?;
        data.extend(own);
        at += length;
    }
    Ok(cloud(&head, &data))
}

fn cloud(head: &Head, data: &[u8]) -> SplatCloud {
    let count = head.count;
    let (middles, rest) = data.split_at(9 * count);
    let (opacities, rest) = rest.split_at(count);
    let (colours, rest) = rest.split_at(3 * count);
    let (spreads, rest) = rest.split_at(3 * count);
    let (turns, further) = rest.split_at(head.turn_bytes() * count);
    let unit = 1.0 / (1_u32 << head.fraction) as f32;
    let mut cloud = SplatCloud::new(head.degree);
    for (splat, opacity) in opacities.iter().enumerate() {
        let coordinate = |axis: usize| {
            let own = &middles[9 * splat + 3 * axis..][..3];
            // A number of three bytes with its sign.
            (i32::from_le_bytes([0, own[0], own[1], own[2]]) >> 8) as f32 * unit
        };
        let byte = |column: &[u8], at: usize| f32::from(column[3 * splat + at]);
        let mut harmonics = [[0.0; 3]; MOST_COEFFICIENTS];
        harmonics[0] = [0, 1, 2].map(|channel| (byte(colours, channel) / 255.0 - 0.5) / COLOUR);
        let own = &further[3 * head.further() * splat..][..3 * head.further()];
        for (harmonic, own) in harmonics[1..].iter_mut().zip(own.as_chunks::<3>().0) {
            *harmonic = own.map(|value| (f32::from(value) - 128.0) / 128.0);
        }
        cloud.push(&Splat {
            middle: [0, 1, 2].map(coordinate),
            spread: [0, 1, 2].map(|axis| exponential(byte(spreads, axis) / 16.0 - 10.0)),
            turn: if head.version == 2 {
                turn_of_three([0, 1, 2].map(|axis| byte(turns, axis)))
            } else {
                let own = &turns[4 * splat..];
                turn_of_word(u32::from_le_bytes([own[0], own[1], own[2], own[3]]))
            },
            opacity: f32::from(*opacity) / 255.0,
            harmonics,
        });
    }
    cloud
}

/// The turn of version 2: x, y and z, with w at least 0.
fn turn_of_three(bytes: [f32; 3]) -> [f32; 4] {
    let [x, y, z] = bytes.map(|value| value / 127.5 - 1.0);
    [(1.0 - x * x - y * y - z * z).max(0.0).sqrt(), x, y, z]
}

/// The turn of version 3: three parts of ten bits, without the largest of x, y, z, w, whose number stands in the highest bits.
fn turn_of_word(word: u32) -> [f32; 4] {
    let largest = (word >> 30) as usize;
    let (mut parts, mut left, mut squares) = ([0.0_f32; 4], word, 0.0);
    for at in (0..4).rev().filter(|at| *at != largest) {
        let size = core::f32::consts::FRAC_1_SQRT_2 * (left & 0x1ff) as f32 / 511.0;
        parts[at] = if left >> 9 & 1 == 1 { -size } else { size };
        squares += size * size;
        left >>= 10;
    }
    parts[largest] = (1.0 - squares).max(0.0).sqrt();
    let [x, y, z, w] = parts;
    [w, x, y, z]
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::Compression;
    use flate2::write::GzEncoder;
    use std::io::Write;

    fn packed(version: u32, count: u32, degree: u8, data: &[u8]) -> Vec<u8> {
        let mut file = GzEncoder::new(Vec::new(), Compression::best());
        let mut head = MAGIC.to_vec();
        head.extend(version.to_le_bytes());
        head.extend(count.to_le_bytes());
        head.extend([degree, 12, 0, 0]);
        file.write_all(&head).and_then(|()| file.write_all(data)).expect("memory");
        file.finish().expect("memory")
    }

    #[test]
    fn columns_of_version_4_are_those_of_version_3() {
        let columns: [&[u8]; 6] =
            [&[0, 24, 0, 0, 0xe0, 0xff, 0, 4, 0], &[204], &[128, 90, 128], &[123; 3], &[7, 1, 0, 0xc0], &[131; 9]];
        let mut file = MAGIC.to_vec();
        file.extend([4_u32, 1].iter().flat_map(|number| number.to_le_bytes()));
        // Degree 1, 12 bits behind the point; an extension of 8 bytes before the list.
        file.extend([1, 12, 2, 6, 40].iter().chain(&[0; 23]));
        let chunks = columns.map(|own| zstd::bulk::compress(own, 3).expect("memory"));
        for (own, chunk) in columns.iter().zip(&chunks) {
            file.extend([chunk.len() as u64, own.len() as u64].iter().flat_map(|number| number.to_le_bytes()));
        }
        file.extend(chunks.concat());
        let own = read_columns(&file).expect("a cloud");
        let former = read(&packed(3, 1, 1, &columns.concat())).expect("a cloud");
        assert_eq!(format!("{own:?}"), format!("{former:?}"));
        for length in 0..file.len() {
            let error = read_columns(&file[..length]).expect_err("cut");
            assert!(error.message.contains("ends before"), "{length}: {}", error.message);
        }
        let promised = |at: usize, to: u8| {
            let mut file = file.clone();
            file[at] = to;
            read_columns(&file).map(|_| ()).expect_err("refused").message
        };
        assert!(promised(8, 2).contains("ends before") && promised(11, 1).contains("at most"));
        assert!(
            promised(10, 9).contains("cannot hold")
                && promised(4, 3).contains("gzip")
                && promised(4, 5).contains("version 5")
        );
        assert!(promised(19, 255).contains("ends before"));
    }

    #[test]
    fn both_versions_are_read() {
        // 1.5, -2 and 0.25 in 4096ths; opaque enough; grey; a tenth of a metre; no turn.
        let mut data = vec![0, 24, 0, 0, 0xe0, 0xff, 0, 4, 0];
        data.extend([204, 128, 128, 128, 123, 123, 123]);
        let two = [data.clone(), vec![128, 128, 128]].concat();
        let three = [data, (3_u32 << 30).to_le_bytes().to_vec()].concat();
        for (version, data) in [(2, two), (3, three)] {
            let cloud = read(&packed(version, 1, 0, &data)).expect("a cloud");
            assert_eq!(cloud.bounds(), [[1.5, -2.0, 0.25]; 2]);
            let block = &cloud.blocks()[0];
            assert!((block.covariance[0][0].sqrt() - 0.099).abs() < 1e-3 && block.covariance[1][0].abs() < 1e-3);
        }
    }

    #[test]
    fn files_that_promise_too_much_are_refused_before_they_are_unpacked() {
        let refused = |bytes: &[u8]| read(bytes).expect_err("refused").message;
        assert!(refused(&packed(3, u32::MAX, 3, &[])).contains("at most"));
        assert!(refused(&packed(3, 9_000_000, 3, &[])).contains("cannot hold"));
        assert!(refused(&packed(3, 10, 3, &[0; 9])).contains("ends before"));
        assert!(refused(&packed(5, 1, 0, &[])).contains("version 5"));
        assert!(refused(&packed(2, 1, 7, &[])).contains("degree 7"));
        assert!(refused(&[0x1f, 0x8b, 1]).contains("gzip"));
    }
}
