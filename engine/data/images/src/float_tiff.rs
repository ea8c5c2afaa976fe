//! Depth as TIFF files of 32-bit floats, one strip packed by Deflate, with or without the predictor for floats (TIFF Technical Note 3).

use cosfly_diagnose::{Diagnostic, Fault, Result};
use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use std::io::{Read, Write};

/// Most pixels of a picture that is read: a small file may claim any number.
const MOST_PIXELS: usize = 1 << 26;

/// Tags of a directory.
const WIDTH: u16 = 256;
const HEIGHT: u16 = 257;
const BITS: u16 = 258;
const PACKING: u16 = 259;
const STRIP_STARTS: u16 = 273;
const PARTS: u16 = 277;
const STRIP_ROWS: u16 = 278;
const STRIP_BYTES: u16 = 279;
const PREDICTOR: u16 = 317;
const KIND: u16 = 339;

/// A TIFF file of `values`, row by row, of so many columns and rows.
///
/// # Errors
/// `image-encode`.
pub fn file(values: &[f32], [width, height]: [u32; 2]) -> Result<Vec<u8>> {
    let mut file = b"II\x2a\0\0\0\0\0".to_vec();
    let packed = packed(values, width as usize);
    file.extend(packed.map_err(|error| {
        Diagnostic::new("image-encode", Fault::Bug, "could not compress an image of depth").because(error)
    })?);
    let strip = file.len() as u32 - 8;
    file.resize(file.len().next_multiple_of(2), 0);
    let directory = file.len() as u32;
    file[4..8].copy_from_slice(&directory.to_le_bytes());
    let [short, long] = [3u16, 4];
    let entries = [
        (WIDTH, long, width),
        (HEIGHT, long, height),
        (BITS, short, 32),
        (PACKING, short, 8), // Deflate
        (262, short, 1),     // more is lighter
        (STRIP_STARTS, long, 8),
        (PARTS, short, 1),
        (STRIP_ROWS, long, height),
        (STRIP_BYTES, long, strip),
        (PREDICTOR, short, 3), // for floats
        (KIND, short, 3),      // floats
    ];
    file.extend((entries.len() as u16).to_le_bytes());
    for (tag, kind, value) in entries {
        file.extend([tag.to_le_bytes(), kind.to_le_bytes()].as_flattened());
        file.extend([1u32.to_le_bytes(), value.to_le_bytes()].as_flattened());
    }
    file.extend([0; 4]);
    Ok(file)
}

/// Each row as its first bytes, its second, third and fourth ones, highest first, as differences of neighbours; then Deflate.
fn packed(values: &[f32], width: usize) -> std::io::Result<Vec<u8>> {
    let mut encoder = ZlibEncoder::new(vec![], Compression::fast());
    for row in values.chunks(width.max(1)) {
        let mut before = 0u8;
        let bytes = (0..4).flat_map(|plane| row.iter().map(move |value| value.to_be_bytes()[plane]));
        let row: Vec<u8> = bytes.map(|byte| byte.wrapping_sub(std::mem::replace(&mut before, byte))).collect();
        encoder.write_all(&row)?;
    }
    encoder.finish()
}

/// Values of a TIFF file, row by row, with the numbers of columns and rows.
///
/// # Errors
/// The damage, or the difference from what [`file`] writes; in words.
pub fn read(file: &[u8]) -> Result<(Vec<f32>, [usize; 2]), String> {
    let short = |at: usize| Some(usize::from(u16::from_le_bytes(*file.get(at..)?.first_chunk()?)));
    let long = |at: usize| Some(u32::from_le_bytes(*file.get(at..)?.first_chunk()?) as usize);
    if !file.starts_with(b"II\x2a\0") {
        return Err("it is no TIFF file in the order of bytes of Intel".into());
    }
    let directory = long(4).ok_or("it is cut off")?;
    let count = short(directory).ok_or("it is cut off")?;
    let entry = |tag: u16| {
        let mut places = (0..count).map(|number| directory + 2 + 12 * number);
        let at = places.find(|at| short(*at) == Some(usize::from(tag)))?;
        match (short(at + 2)?, long(at + 4)?) {
            (3, 1) => short(at + 8),
            (4, 1) => long(at + 8),
            _ => None,
        }
    };
    let [Some(width), Some(height), Some(start), Some(length)] = [WIDTH, HEIGHT, STRIP_STARTS, STRIP_BYTES].map(entry)
    else {
        return Err("it states no size, or has not one strip".into());
    };
    let has = |tag: u16, value: usize| entry(tag) == Some(value);
    if !(has(BITS, 32) && has(KIND, 3) && entry(PARTS).is_none_or(|parts| parts == 1) && has(PACKING, 8)) {
        return Err("it is not one 32-bit float a pixel, packed by Deflate".into());
    }
    let is_predicted = match entry(PREDICTOR) {
        None | Some(1) => false,
        Some(3) => true,
        Some(other) => return Err(format!("its predictor is {other}; 1 and 3 are read")),
    };
    let pixels = width.checked_mul(height).filter(|pixels| (1..=MOST_PIXELS).contains(pixels));
    let pixels = pixels.ok_or_else(|| format!("it is {width} x {height} pixels; {MOST_PIXELS} in all are read"))?;
    let strip = file.get(start..).and_then(|rest| rest.get(..length)).ok_or("it is cut off")?;
    let mut bytes = vec![];
    // As many as its size asks for, and one more, which would be too much.
    let unpacked = ZlibDecoder::new(strip).take(4 * pixels as u64 + 1).read_to_end(&mut bytes);
    unpacked.map_err(|error| format!("its strip is damaged: {error}"))?;
    if bytes.len() != 4 * pixels {
        return Err("its strip does not have the bytes that its size asks for".into());
    }
    if !is_predicted {
        return Ok((bytes.as_chunks().0.iter().map(|four| f32::from_le_bytes(*four)).collect(), [width, height]));
    }
    let mut values = Vec::with_capacity(pixels);
    for row in bytes.chunks_exact_mut(4 * width) {
        (1..row.len()).for_each(|at| row[at] = row[at].wrapping_add(row[at - 1]));
        values.extend((0..width).map(|at| f32::from_be_bytes([0, 1, 2, 3].map(|plane| row[plane * width + at]))));
    }
    Ok((values, [width, height]))
}

#[cfg(test)]
mod tests {
    use super::*;

    const DEPTH_M: [f32; 6] = [1.5, 2.0, 200.0, 0.25, 7.125, f32::INFINITY];

    #[test]
    fn a_strip_holds_the_floats_byte_by_byte_and_the_directory_says_so() {
        let file = file(&DEPTH_M, [3, 2]).unwrap();
        let number = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap());
        let directory = number(4) as usize;
        assert_eq!((&file[..4], directory % 2), (&b"II\x2a\0"[..], 0));
        let entry = |tag: u16| {
            let mut entries = file[directory + 2..].chunks(12);
            entries.find(|it| it[..2] == tag.to_le_bytes()).map(|it| u32::from_le_bytes(it[8..12].try_into().unwrap()))
        };
        assert_eq!([256, 257, 258, 273, 317, 339].map(entry), [3, 2, 32, 8, 3, 3].map(Some));
        let mut bytes = vec![];
        ZlibDecoder::new(&file[8..][..entry(279).unwrap() as usize]).read_to_end(&mut bytes).unwrap();
        // The highest bytes of the first row: 1.5 and 2.0 begin with 3f and 40, 200.0 with 43.
        assert_eq!(bytes[..3], [0x3f, 1, 3]);
        assert_eq!(read(&file).unwrap(), (DEPTH_M.to_vec(), [3, 2]));
    }

    #[test]
    fn what_is_cut_or_claims_too_much_is_refused() {
        let whole = file(&DEPTH_M, [3, 2]).unwrap();
        // What ends it are two bytes of padding and the place of no further directory.
        for length in 0..whole.len() - 6 {
            assert!(read(&whole[..length]).is_err(), "{length} bytes");
        }
        let directory = u32::from_le_bytes(whole[4..8].try_into().unwrap()) as usize;
        let with = |entry: usize, value: u32| {
            let mut file = whole.clone();
            file[directory + 2 + 12 * entry + 8..][..4].copy_from_slice(&value.to_le_bytes());
            read(&file).unwrap_err()
        };
        assert!(with(0, 4).contains("bytes that its size asks for"));
        assert!(with(0, u32::MAX).contains("in all are read"));
        assert!(with(2, 16).contains("32-bit float"));
        assert!(with(9, 2).contains("predictor"));
    }
}
