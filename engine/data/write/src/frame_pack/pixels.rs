//! The pixels of raw images as the bytes of their records, piece by piece while they are in the nearest caches.

use super::header::{InstanceFormat, PackHeader};
use super::image_record::ImageRecord;
use cosfly_domain::FrameImages;
use cosfly_domain::channels::ChannelSource;
use cosfly_frames::simd::Level;
use cosfly_images::{depth, ids};
use cosfly_schema::config::DepthEncoding;

/// Pixels that are converted and checked together.
const PIECE_PIXELS: usize = 1 << 13;

/// Writes a record into `bytes`, which has its length; gives the CRC-32 of it.
///
/// # Errors
/// The pixel that is no value of the channel: a lower-case fragment.
pub fn write(
    record: &ImageRecord,
    bytes: &mut [u8],
    images: &FrameImages,
    header: &PackHeader,
) -> Result<crc32fast::Hasher, String> {
    record.write_frame(bytes);
    let place = record.pixels();
    match record.channel.source {
        ChannelSource::Depth => write_depth(bytes, place, &images.depth_m, header.encoding.depth),
        ChannelSource::Labels => Ok(pieces(bytes, place, &images.semantic, 1, |ids, bytes| bytes.copy_from_slice(ids))),
        ChannelSource::Ids => write_ids(bytes, place, &images.instance, header.instance),
        // On request; the colours' file is written elsewhere.
        _ => {
            let image = images.on_request.iter().find(|image| image.channel == record.channel);
            let drawn = image.map_or(&[][..], |image| &image.bytes[..]);
            Ok(pieces(bytes, place, drawn, 1, |drawn, bytes| bytes.copy_from_slice(drawn)))
        }
    }
}

type Place = core::ops::Range<usize>;

fn write_depth(
    record: &mut [u8],
    place: Place,
    depth_m: &[f32],
    encoding: DepthEncoding,
) -> Result<crc32fast::Hasher, String> {
    let to_bytes = match encoding {
        DepthEncoding::Grid => depth::grid_bytes,
        DepthEncoding::Lossless => depth::lossless_bytes,
    };
    let mut all_are_depths = true;
    let crc = pieces(record, place, depth_m, 4, |depths, bytes| {
        all_are_depths &= to_bytes(Level::best(), depths, bytes);
    });
    if all_are_depths {
        return Ok(crc);
    }
    let at = depth_m.iter().position(|depth| depth.is_nan() || *depth < 0.0).unwrap_or(0);
    Err(format!("the depth of pixel {at} is `{}`; it must be 0 m or more", depth_m[at]))
}

fn write_ids(
    record: &mut [u8],
    place: Place,
    instance: &[u32],
    format: InstanceFormat,
) -> Result<crc32fast::Hasher, String> {
    let mut seen = 0;
    let crc = match format {
        InstanceFormat::U16 => {
            pieces(record, place, instance, 2, |ids, bytes| seen |= ids::u16_bytes(Level::best(), ids, bytes))
        }
        InstanceFormat::U32 => {
            pieces(record, place, instance, 4, |ids, bytes| ids::u32_bytes(Level::best(), ids, bytes))
        }
    };
    if seen <= u32::from(u16::MAX) {
        return Ok(crc);
    }
    let largest = instance.iter().max().copied().unwrap_or(0);
    Err(format!("instance id {largest} does not fit the pack's 16 bits"))
}

/// Writes the pixels of `record`, `pixel_bytes` each; gives the CRC-32 of the whole record.
fn pieces<T>(
    record: &mut [u8],
    place: Place,
    pixels: &[T],
    pixel_bytes: usize,
    mut write: impl FnMut(&[T], &mut [u8]),
) -> crc32fast::Hasher {
    let mut crc = crc32fast::Hasher::new();
    crc.update(&record[..place.start]);
    let pieces = record[place.clone()].chunks_mut(pixel_bytes * PIECE_PIXELS);
    for (pixels, bytes) in pixels.chunks(PIECE_PIXELS).zip(pieces) {
        write(pixels, bytes);
        crc.update(bytes);
    }
    crc.update(&record[place.end..]);
    crc
}
