//! LAZ: chunks of compressed points, unpacked side by side. Sizes and counts are checked before anything is allocated.

use super::header::Header;
use cosfly_diagnose::{contained, counted};
use cosfly_town::MapError;
use laz::laszip::ChunkTable;
use laz::record::{LayeredPointRecordDecompressor, RecordDecompressor, SequentialPointRecordDecompressor};
use laz::{DecompressionSelection, LazItem, LazItemRecordBuilder, LazItemType, LazVlr};
use rayon::prelude::*;
use std::io::Cursor;

/// User and number of the record that says how points are compressed.
pub const USER: &str = "laszip encoded";
/// See [`USER`].
pub const RECORD: u16 = 22204;

/// Compressor of files without chunks.
const WITHOUT_CHUNKS: u16 = 1;
/// Bytes before the first chunk: the place of the table of chunks.
const TABLE_PLACE_BYTES: u64 = 8;
/// Most points for each compressed byte of a chunk, and of a file beside those that any file may have; surveys have fewer than one.
const MOST_POINTS_PER_BYTE: u64 = 8;
const MOST_POINTS_PER_BYTE_OF_FILE: u64 = 2;
const POINTS_OF_ANY_FILE: u64 = 1_000_000;
/// Chunks that are unpacked before their points are taken.
const CHUNKS_AT_ONCE: usize = 32;

/// A chunk: its bytes and the number of its points.
struct Chunk<'a> {
    bytes: &'a [u8],
    points: usize,
}

/// Parts of points that are unpacked.
pub(super) fn usual_parts() -> DecompressionSelection {
    DecompressionSelection::base().decompress_z().decompress_classification().decompress_flags()
}

/// [`usual_parts`] with colours.
pub(super) fn coloured_parts() -> DecompressionSelection {
    usual_parts().decompress_rgb()
}

/// Unpacks the records of all points of a compressed file and gives them to `take`, some chunks at a time.
///
/// # Errors
/// A layout that does not fit the point format, chunks beyond the end of the file, or damaged chunks.
pub(super) fn read<T: Send>(
    header: &Header<'_>,
    record: &[u8],
    parts: DecompressionSelection,
    read: impl Fn(&[u8]) -> T + Sync,
    mut take: impl FnMut(Vec<Vec<T>>),
) -> Result<(), MapError> {
    let vlr = LazVlr::from_buffer(record).map_err(|error| damaged(&error.to_string()))?;
    check_items(header, vlr.items())?;
    let data = header.bytes.0.len() as u64 - header.points_start.min(header.bytes.0.len() as u64);
    let most = MOST_POINTS_PER_BYTE_OF_FILE.saturating_mul(data).saturating_add(POINTS_OF_ANY_FILE);
    if header.points > most.min(MOST_POINTS_PER_BYTE.saturating_mul(data)) {
        let message = format!(
            "the file says that it has {}, but there are only {data} of them",
            counted(header.points, "point"),
            data = counted(data, "byte")
        );
        return Err(MapError::new(message).hint("the file seems to be cut off or damaged: fetch it again"));
    }
    let chunks = if record.starts_with(&WITHOUT_CHUNKS.to_le_bytes()) {
        let bytes = header.bytes.slice(header.points_start, data, "the points")?;
        vec![Chunk { bytes, points: header.points as usize }]
    } else {
        chunks(header, &vlr)?
    };
    for some in chunks.chunks(CHUNKS_AT_ONCE) {
        let unpacked: Result<Vec<Vec<T>>, MapError> =
            some.par_iter().map(|chunk| unpacked(header, vlr.items(), chunk, (parts, &read))).collect();
        take(unpacked?);
    }
    Ok(())
}

fn damaged(problem: &str) -> MapError {
    let error = MapError::new(format!("the compressed points are damaged: {problem}"));
    error.hint("the file seems to be cut off or damaged: fetch it again")
}

/// The parts of a compressed point must be those of its point format.
fn check_items(header: &Header<'_>, items: &[LazItem]) -> Result<(), MapError> {
    let usual = |extra: u16| LazItemRecordBuilder::default_for_point_format_id(header.point_format, extra);
    let plain: usize =
        usual(0).map_err(|error| damaged(&error.to_string()))?.iter().map(|item| usize::from(item.size())).sum();
    let expected = usual((header.record_bytes - plain) as u16).map_err(|error| damaged(&error.to_string()))?;
    let is_alike =
        |(own, usual): (&LazItem, &LazItem)| own.size() == usual.size() && own.item_type() == usual.item_type();
    let same_version = items.windows(2).all(|pair| (pair[0].version() <= 2) == (pair[1].version() <= 2));
    if items.len() != expected.len() || !items.iter().zip(&expected).all(is_alike) || !same_version {
        let rule = format!("those of format {} with {} bytes are expected", header.point_format, header.record_bytes);
        return Err(damaged(&format!("the parts of a point are {items:?}; {rule}")));
    }
    Ok(())
}

/// The chunks as the table at the end of the points lists them.
fn chunks<'a>(header: &Header<'a>, vlr: &LazVlr) -> Result<Vec<Chunk<'a>>, MapError> {
    let file = header.bytes;
    let mut table_start = file.u64(header.points_start, "the place of the table of chunks")?;
    if table_start == u64::MAX {
        // Streamed files have it in their last bytes.
        table_start = file.u64((file.0.len() as u64).saturating_sub(8), "the place of the table of chunks")?;
    }
    let first = header.points_start + TABLE_PLACE_BYTES;
    let packed = table_start.checked_sub(first).ok_or_else(|| damaged("the table of chunks lies before the points"))?;
    let count = u64::from(file.u32(table_start.saturating_add(4), "the table of chunks")?);
    // A chunk holds at least one whole point.
    if count > packed / header.record_bytes as u64 {
        return Err(damaged(&format!(
            "the table lists {count} in {packed}",
            packed = counted(packed, "byte"),
            count = counted(count, "chunk")
        )));
    }
    let mut source = Cursor::new(file.0);
    source.set_position(header.points_start);
    let table = ChunkTable::read_from(&mut source, vlr).map_err(|error| damaged(&error.to_string()))?;
    let (mut start, mut left) = (first, header.points);
    let mut chunks = Vec::with_capacity(table.len());
    for entry in &table {
        let points = entry.point_count.min(left);
        let is_inside = entry.byte_count <= table_start - start;
        if !is_inside || (entry.point_count > left && vlr.uses_variable_size_chunks()) {
            return Err(damaged("the chunks do not add up to the points"));
        }
        if points > 0 {
            let bytes = file.slice(start, entry.byte_count, "a chunk of points")?;
            chunks.push(Chunk { bytes, points: points as usize });
        }
        (start, left) = (start + entry.byte_count, left - points);
    }
    if left > 0 || start != table_start {
        return Err(damaged(&format!("{left} of {} points are in no chunk", header.points)));
    }
    Ok(chunks)
}

/// Parts of points that are unpacked, and the reader of their records.
type Wanted<'a, T> = (DecompressionSelection, &'a (dyn Fn(&[u8]) -> T + Sync));

fn unpacked<T>(
    header: &Header<'_>,
    items: &Vec<LazItem>,
    chunk: &Chunk<'_>,
    wanted: Wanted<'_, T>,
) -> Result<Vec<T>, MapError> {
    let is_layered = items[0].version() > 2;
    if is_layered {
        check_layers(header, items, chunk.bytes)?;
    }
    if chunk.points as u64 > MOST_POINTS_PER_BYTE.saturating_mul(chunk.bytes.len() as u64) {
        return Err(damaged(&format!(
            "a chunk has {} in {}",
            counted(chunk.points, "point"),
            counted(chunk.bytes.len(), "byte")
        )));
    }
    let source = Cursor::new(chunk.bytes);
    let records = || {
        if is_layered {
            all_records(LayeredPointRecordDecompressor::new(source), header, items, (chunk.points, wanted))
        } else {
            all_records(SequentialPointRecordDecompressor::new(source), header, items, (chunk.points, wanted))
        }
    };
    // The decoder of laz 0.13 indexes beyond its tables on some damaged bytes; nothing of it outlives the chunk.
    contained(records).unwrap_or_else(|| Err(damaged("a chunk holds what no encoder writes")))
}

fn all_records<R, T>(
    mut unpacker: impl RecordDecompressor<R>,
    header: &Header<'_>,
    items: &Vec<LazItem>,
    (points, (parts, read)): (usize, Wanted<'_, T>),
) -> Result<Vec<T>, MapError> {
    unpacker.set_fields_from(items).map_err(|error| damaged(&error.to_string()))?;
    unpacker.set_selection(parts);
    let mut bytes = vec![0; header.record_bytes];
    let mut records = Vec::with_capacity(points);
    for _ in 0..points {
        unpacker.decompress_next(&mut bytes).map_err(|error| damaged(&error.to_string()))?;
        records.push(read(&bytes));
    }
    Ok(records)
}

/// A layered chunk states the sizes of its layers after its first point: they must fit into it.
fn check_layers(header: &Header<'_>, items: &[LazItem], chunk: &[u8]) -> Result<(), MapError> {
    let layers: usize = items
        .iter()
        .map(|item| match item.item_type() {
            LazItemType::Point14 => 9,
            LazItemType::RGBNIR14 => 2,
            LazItemType::Byte14(count) => usize::from(count),
            _ => 1,
        })
        .sum();
    let sizes_start = header.record_bytes + 4;
    let sizes = chunk.get(sizes_start..sizes_start + 4 * layers).ok_or_else(|| damaged("a chunk is too short"))?;
    let size = |bytes: &[u8]| u64::from(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]));
    let stated: u64 = sizes.chunks_exact(4).map(size).sum();
    let there = (chunk.len() - sizes_start - 4 * layers) as u64;
    if stated > there {
        return Err(damaged(&format!("a chunk has layers of {stated} bytes, but there are {there}")));
    }
    Ok(())
}
