//! Colours of the points of LAS and LAZ files, where their point format has them.

use super::compressed;
use super::header::Header;
use super::records::Record;
use crate::coloured_point::ColouredPoint;
use cosfly_frames::DVec3;
use cosfly_town::MapError;

/// First byte of the colours of each point format, 0 to 10.
const COLOURS: [Option<usize>; 11] =
    [None, None, Some(20), Some(28), None, Some(28), None, Some(30), Some(30), None, Some(30)];

/// Points that are kept, file units, with their colours.
pub(crate) fn read(bytes: &[u8]) -> Result<Vec<ColouredPoint>, MapError> {
    let header = Header::read(bytes)?;
    let Some(start) = COLOURS[usize::from(header.point_format)] else {
        let error = MapError::new(format!("the points, of format {}, have no colours", header.point_format));
        return Err(error.hint("give a cloud with colours: LAS point formats 2, 3, 5, 7, 8 and 10 have them"));
    };
    let point = |bytes: &[u8]| {
        let record = Record::read(bytes, header.is_long());
        let colour = [0, 2, 4].map(|k| u16::from_le_bytes([bytes[start + k], bytes[start + k + 1]]));
        (record, colour)
    };
    let mut all: Vec<(Record, [u16; 3])> = Vec::new();
    match header.record(compressed::USER, compressed::RECORD) {
        Some(record) if header.is_compressed => {
            let take = |batches: Vec<Vec<_>>| all.extend(batches.into_iter().flatten());
            compressed::read(&header, record, compressed::coloured_parts(), point, take)?;
        }
        None if header.is_compressed => {
            return Err(MapError::new("the points are compressed, but the record that says how is missing"));
        }
        _ => all.extend(header.plain_points()?.chunks_exact(header.record_bytes).map(point)),
    }
    // The standard has 16 bits a colour; many writers leave 8.
    let is_short = all.iter().flat_map(|(_, colour)| colour).all(|value| *value <= 255);
    let byte = |value: u16| if is_short { value as u8 } else { (value >> 8) as u8 };
    let kept = all.into_iter().filter(|(record, _)| record.is_kept);
    let point = |(record, colour): (Record, [u16; 3])| ColouredPoint {
        position: DVec3::from_array(record.position.map(f64::from)) * header.scale + header.offset,
        colour: colour.map(byte),
    };
    Ok(kept.map(point).collect())
}
