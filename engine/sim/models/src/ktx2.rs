//! Pictures of KTX 2.0: plain bytes, UASTC (plain or packed by Zstandard) and ETC1S.

use crate::picture::{Picture, check_size};
use basisu::basislz::etc1s::Etc1sTranscoder;
use basisu::uastc::unpack::unpack_uastc;
use cosfly_diagnose::counted;

/// First bytes of a file.
pub(crate) const MAGIC: &[u8] = b"\xabKTX 20\xbb\r\n\x1a\n";
/// Colour models of blocks that are no format of Vulkan.
const ETC1S: u8 = 163;
const UASTC: u8 = 166;
/// Ways to pack a level.
const PLAIN: u32 = 0;
const BASIS_LZ: u32 = 1;
const ZSTANDARD: u32 = 2;
/// Most bytes of a picture for each byte packed by Zstandard, whose shortest block has four bytes and holds 128 KiB at most.
const MOST_EXPANSION: usize = (128 << 10) / 4;
/// Unpacked blocks that are kept.
const KNOWN: usize = 4096;
/// Pixels of a block's side.
const SIDE: usize = 4;

/// Reads the largest picture of a file, of no more pixels than are left.
pub(crate) fn read(bytes: &[u8], left: usize) -> Result<Picture, String> {
    let [format, _, width, height, depth, layers, faces, levels, packing] =
        numbers(bytes, 12).ok_or("it is cut off")?;
    let (width, height) = (width as usize, height as usize);
    check_size(width, height, left)?;
    if depth > 0 || layers > 1 || faces != 1 {
        return Err("it holds several pictures or a volume".into());
    }
    let [start, length, _] = places(bytes, 80).ok_or("it is cut off")?;
    let level = part(bytes, start, length).ok_or("it is cut off")?;
    let [description] = numbers(bytes, 48).ok_or("it is cut off")?;
    let model = bytes.get((description as usize).saturating_add(12)).copied();
    let picture = match (format, model) {
        (23 | 29, _) => Some(Picture::of_samples(&unpacked(level, packing, 3 * width * height)?, width, 3)),
        (37 | 43, _) => Some(Picture::of_samples(&unpacked(level, packing, 4 * width * height)?, width, 4)),
        (0, Some(UASTC)) => {
            let blocks = width.div_ceil(SIDE) * height.div_ceil(SIDE);
            uastc(&unpacked(level, packing, 16 * blocks)?, width, height)
        }
        (0, Some(ETC1S)) if packing == BASIS_LZ => etc1s(bytes, level, levels.max(1) as usize, width, height),
        (0, _) => return Err("its blocks are neither UASTC nor ETC1S".into()),
        _ => return Err(format!("its pixels are of Vulkan's format {format}")),
    };
    picture.ok_or_else(|| "its blocks are damaged".to_owned())
}

/// Numbers of 32 bits from a place.
fn numbers<const N: usize>(bytes: &[u8], at: usize) -> Option<[u32; N]> {
    let own = bytes.get(at..)?.as_chunks::<4>().0.get(..N)?;
    Some(core::array::from_fn(|k| u32::from_le_bytes(own[k])))
}

/// Places and lengths from a place.
fn places<const N: usize>(bytes: &[u8], at: usize) -> Option<[usize; N]> {
    let own = bytes.get(at..)?.as_chunks::<8>().0.get(..N)?;
    let own: Vec<usize> = own.iter().map(|own| u64::from_le_bytes(*own).try_into().ok()).collect::<Option<_>>()?;
    own.try_into().ok()
}

fn part(bytes: &[u8], start: usize, length: usize) -> Option<&[u8]> {
    bytes.get(start..)?.get(..length)
}

/// The bytes of a level, which are as many as its pixels ask for.
fn unpacked(level: &[u8], packing: u32, size: usize) -> Result<Vec<u8>, String> {
    let own = match packing {
        PLAIN => level.to_vec(),
        ZSTANDARD if size.div_ceil(MOST_EXPANSION) > level.len() => {
            return Err(format!("its {} packed bytes cannot hold the {size} of its pixels", level.len()));
        }
        ZSTANDARD => zstd::bulk::decompress(level, size).map_err(|error| error.to_string())?,
        _ => return Err(format!("it is packed in way {packing}")),
    };
    if own.len() == size { Ok(own) } else { Err(format!("it has {} of pixels for {size}", counted(own.len(), "byte"))) }
}

/// The place of a block among those that are known.
fn place_of(block: &[u8; 16]) -> usize {
    let mixed = u128::from_le_bytes(*block);
    let mixed = ((mixed >> 64) as u64 ^ mixed as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    (mixed >> 32) as usize % KNOWN
}

fn uastc(blocks: &[u8], width: usize, height: usize) -> Option<Picture> {
    let mut samples = vec![0; 4 * width * height];
    // Small files of large pictures repeat their blocks, and to unpack one takes long.
    let mut known = vec![None; KNOWN];
    for (at, block) in blocks.as_chunks().0.iter().enumerate() {
        let (left, top) = (at % width.div_ceil(SIDE) * SIDE, at / width.div_ceil(SIDE) * SIDE);
        let place = &mut known[place_of(block)];
        let pixels = match place {
            Some((of, pixels)) if of == block => *pixels,
            _ => {
                let pixels = unpack_uastc(block, false)?;
                *place = Some((*block, pixels));
                pixels
            }
        };
        for (row, pixels) in pixels.as_chunks::<SIDE>().0.iter().enumerate().take(height - top) {
            let to = &mut samples[4 * ((top + row) * width + left)..][..4 * SIDE.min(width - left)];
            for (to, own) in to.as_chunks_mut().0.iter_mut().zip(pixels) {
                *to = [own.r(), own.g(), own.b(), own.a()];
            }
        }
    }
    Some(Picture::of_samples(&samples, width, 4))
}

fn etc1s(bytes: &[u8], level: &[u8], levels: usize, width: usize, height: usize) -> Option<Picture> {
    let [start, length] = places(bytes, 64)?;
    let tables = part(bytes, start, length)?;
    let [counts, endpoints, selectors, codes, _, flags, colour, colour_length, alpha, alpha_length] =
        numbers(tables, 0)?;
    let (endpoints, selectors, codes) = (endpoints as usize, selectors as usize, codes as usize);
    let (_, rest) = tables.split_at_checked(20 + 20 * levels)?;
    let (endpoints, rest) = rest.split_at_checked(endpoints)?;
    let (selectors, rest) = rest.split_at_checked(selectors)?;
    let mut decoder = Etc1sTranscoder::new();
    let is_read = decoder.decode_palettes(counts & 0xffff, endpoints, counts >> 16, selectors)
        && decoder.decode_tables(rest.get(..codes)?);
    // What a film changes of the picture before is no picture.
    if !is_read || flags & 2 != 0 {
        return None;
    }
    let [across, down] = [width, height].map(|side| side.div_ceil(SIDE) as u32);
    let (wide, high, mut samples) = (width as u32, height as u32, vec![0; 4 * width * height]);
    let colour = part(level, colour as usize, colour_length as usize)?;
    let alpha = part(level, alpha as usize, alpha_length as usize)?;
    if alpha.is_empty() {
        decoder.transcode_slice_rgba32(colour, across, down, wide, high, None, &mut samples)?;
    } else {
        decoder.transcode_image_rgba32(colour, alpha, across, down, wide, high, None, &mut samples)?;
    }
    Some(Picture::of_samples(&samples, width, 4))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file of plain pixels of four bytes, packed by Zstandard.
    fn file([width, height]: [u32; 2], level: &[u8]) -> Vec<u8> {
        let numbers = [43, 1, width, height, 0, 0, 1, 1, ZSTANDARD, 104, 44, 0, 0, 0, 0, 0, 0];
        let mut file = MAGIC.to_vec();
        file.extend(numbers.iter().flat_map(|number: &u32| number.to_le_bytes()));
        file.extend(
            [148, level.len() as u64, u64::from(width) * u64::from(height) * 4].map(u64::to_le_bytes).as_flattened(),
        );
        file.resize(148, 0);
        file.extend(level);
        file
    }

    #[test]
    fn blocks_that_repeat_are_unpacked_once_and_stay_apart() {
        let file = include_bytes!("pictures/four_uastc.ktx2");
        let [start, length, _] = places::<3>(file, 80).expect("a level");
        let blocks = &file[start..start + length];
        let (first, other) = (&blocks[..16], &blocks[48..64]);
        let row = [first, other, other, first, first, other].concat();
        let picture = uastc(&row.repeat(2), 24, 8).expect("a picture");
        let alone = [first, other].map(|block| uastc(block, 4, 4).expect("a picture"));
        for at in 0..24 * 8 {
            let (column, line) = (at % 24, at / 24);
            let of = &alone[usize::from([1, 2, 5].contains(&(column / 4)))];
            let own = column % 4 + 4 * (line % 4);
            assert_eq!((picture.rgb[at], picture.alpha.get(at)), (of.rgb[own], of.alpha.get(own)), "pixel {at}");
        }
    }

    #[test]
    fn a_few_bytes_hold_a_picture_of_one_colour_and_no_more_pixels_than_they_can() {
        let level = zstd::bulk::compress(&[40, 120, 20, 255].repeat(2048 * 2048), 3).expect("packed");
        let picture = read(&file([2048, 2048], &level), 1 << 26).expect("a picture");
        assert_eq!((picture.width, picture.height, picture.rgb[77]), (2048, 2048, [40, 120, 20]));
        assert!(picture.rgb.len() > 2000 * level.len(), "{} bytes", level.len());
        let claimed = read(&file([8192, 8192], &level[..1024]), 1 << 26).err().expect("refused");
        assert_eq!(claimed, "its 1024 packed bytes cannot hold the 268435456 of its pixels");
        assert!(read(&file([8192, 8192], &level), 1 << 26).is_err());
    }
}
