//! Depth as a feature: TIFF files of metres in 32-bit floats, which LeRobot reads without loss from 0.6 on.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use serde_json::{Value, json};
use std::io::Write;

/// Steps of the statistics in a metre.
pub const STATISTICS_PER_M: f64 = 1000.0;

/// The feature in `meta/info.json`.
pub fn feature([width, height]: [u32; 2]) -> Value {
    let info = json!({"is_depth_map": true, "depth_unit": "m"});
    json!({"dtype": "image", "shape": [height, width, 1], "names": ["height", "width", "channels"], "info": info})
}

/// A TIFF file of one strip: floats with the predictor for floats (TIFF Technical Note 3), then Deflate.
pub fn tiff(depth_m: &[f32], [width, height]: [u32; 2]) -> Result<Vec<u8>> {
    let mut file = b"II\x2a\0\0\0\0\0".to_vec();
    let packed = packed(depth_m, width as usize);
    file.extend(packed.map_err(|error| {
        Diagnostic::new("image-encode", Fault::Bug, "could not compress an image of depth").because(error)
    })?);
    let strip = file.len() as u32 - 8;
    file.resize(file.len().next_multiple_of(2), 0);
    let directory = file.len() as u32;
    file[4..8].copy_from_slice(&directory.to_le_bytes());
    let [short, long] = [3u16, 4];
    let entries = [
        (256u16, long, width),
        (257, long, height),
        (258, short, 32), // bits of a value
        (259, short, 8),  // Deflate
        (262, short, 1),  // more is lighter
        (273, long, 8),   // place of the strip
        (277, short, 1),  // values of a pixel
        (278, long, height),
        (279, long, strip),
        (317, short, 3), // predictor for floats
        (339, short, 3), // floats
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
fn packed(depth_m: &[f32], width: usize) -> std::io::Result<Vec<u8>> {
    let mut encoder = ZlibEncoder::new(vec![], Compression::fast());
    for row in depth_m.chunks(width.max(1)) {
        let mut before = 0u8;
        let bytes = (0..4).flat_map(|plane| row.iter().map(move |depth| depth.to_be_bytes()[plane]));
        let row: Vec<u8> = bytes.map(|byte| byte.wrapping_sub(std::mem::replace(&mut before, byte))).collect();
        encoder.write_all(&row)?;
    }
    encoder.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;

    #[test]
    fn a_strip_holds_the_floats_byte_by_byte_and_the_directory_says_so() {
        let depth_m = [1.5f32, 2.0, 200.0, 0.25, 7.125, 64.0];
        let file = tiff(&depth_m, [3, 2]).unwrap();
        let number = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap());
        let directory = number(4) as usize;
        assert_eq!((&file[..4], directory % 2), (&b"II\x2a\0"[..], 0));
        let entry = |tag: u16| {
            let mut entries = file[directory + 2..].chunks(12);
            entries.find(|it| it[..2] == tag.to_le_bytes()).map(|it| u32::from_le_bytes(it[8..12].try_into().unwrap()))
        };
        assert_eq!([256, 257, 258, 273, 317, 339].map(entry), [3, 2, 32, 8, 3, 3].map(Some));
        let mut bytes = vec![];
        flate2::read::ZlibDecoder::new(&file[8..][..entry(279).unwrap() as usize]).read_to_end(&mut bytes).unwrap();
        let mut found = vec![];
        for row in bytes.chunks_mut(12) {
            (1..12).for_each(|at| row[at] = row[at].wrapping_add(row[at - 1]));
            found.extend((0..3).map(|at| f32::from_be_bytes([0, 3, 6, 9].map(|plane| row[plane + at]))));
        }
        assert_eq!(found, depth_m);
    }
}
