//! Files of tiles: shapes as glTF, plain, within a `b3dm` or several in a `cmpt`.

use crate::bytes::Bytes;
use crate::gltf::document::MAGIC;
use cosfly_frames::DVec3;
use cosfly_town::MapError;
use serde_json::Value;

/// Deepest nesting of composites, and most contents of one.
const DEEPEST: usize = 4;
const MOST_CONTENTS: usize = 10_000;
/// Length of the head of a `b3dm` and of a `cmpt`.
const HEAD: u64 = 28;
const HEAD_OF_SEVERAL: u64 = 16;
/// The way to files that are read.
const UPGRADE: &str =
    "`npx 3d-tiles-tools upgrade -i tileset.json -o upgraded --targetVersion 1.1` makes glTF of all tiles";

/// Shapes of a file.
pub(super) struct Shapes<'a> {
    /// A glTF file.
    pub file: &'a [u8],
    /// From where its corners count, in the frame of the tile.
    pub center: DVec3,
}

/// All shapes of a file, and how many of its parts show points alone.
///
/// # Errors
/// Files of other kinds, cut and damaged ones.
pub(super) fn shapes(bytes: &[u8]) -> Result<(Vec<Shapes<'_>>, usize), MapError> {
    let (mut found, mut points) = (vec![], 0);
    let mut open = vec![(bytes, 0)];
    while let Some((part, depth)) = open.pop() {
        if found.len() + open.len() > MOST_CONTENTS || depth > DEEPEST {
            let message = format!("it has more than {MOST_CONTENTS} parts, or is nested deeper than {DEEPEST}");
            return Err(MapError::new(message).hint(UPGRADE));
        }
        match part.get(..4) {
            Some(b"b3dm") => found.push(batched(part)?),
            Some(b"cmpt") => {
                let parts = several(part)?;
                open.extend(parts.into_iter().rev().map(|part| (part, depth + 1)));
            }
            Some(b"pnts") => points += 1,
            Some(b"i3dm") => {
                let error = MapError::new("it holds models that stand in many places (`i3dm`), which are not read");
                return Err(error.hint(UPGRADE));
            }
            Some([0x1f, 0x8b, ..]) => {
                let error = MapError::new("it is packed by gzip");
                return Err(error.hint("`npx 3d-tiles-tools ungzip -i packed -o plain` unpacks all tiles"));
            }
            Some(magic) if magic == MAGIC || part.trim_ascii_start().starts_with(b"{") => {
                found.push(Shapes { file: part, center: DVec3::ZERO });
            }
            _ => {
                let shown = String::from_utf8_lossy(&part[..part.len().min(4)]).into_owned();
                let error = MapError::new(format!("its kind, `{}`, is not read", shown.escape_debug()));
                return Err(error.hint("glTF, `b3dm` and `cmpt` are read"));
            }
        }
    }
    Ok((found, points))
}

/// The glTF file of a `b3dm`.
fn batched(part: &[u8]) -> Result<Shapes<'_>, MapError> {
    let bytes = Bytes(part);
    let length = |at| bytes.u32(at, "the head of a `b3dm`").map(u64::from);
    let [whole, text, data, more_text, more_data] = [length(8)?, length(12)?, length(16)?, length(20)?, length(24)?];
    let start = HEAD + text + data + more_text + more_data;
    let size = whole.checked_sub(start).ok_or_else(|| {
        let error = MapError::new(format!("its {whole} bytes hold no glTF file: the tables before it end at {start}"));
        error.hint(UPGRADE)
    })?;
    let file = bytes.slice(start, size, "the end of its glTF file")?;
    if !file.starts_with(MAGIC) {
        return Err(MapError::new("its glTF file is not where its head says").hint(UPGRADE));
    }
    let table = bytes.slice(HEAD, text, "its table of features")?;
    let table: Value = if table.trim_ascii().is_empty() {
        Value::Null
    } else {
        let unread = |error| MapError::new(format!("its table of features cannot be read: {error}")).hint(UPGRADE);
        serde_json::from_slice(table).map_err(unread)?
    };
    let center = &table["RTC_CENTER"];
    let numbers: Option<[f64; 3]> = match (center, center["byteOffset"].as_u64()) {
        (Value::Null, _) => Some([0.0; 3]),
        (_, Some(offset)) => {
            let place = bytes.slice(HEAD + text, data, "its features")?.get(offset.try_into().unwrap_or(usize::MAX)..);
            place
                .and_then(|place| Some(place.get(..12)?.as_chunks::<4>().0.iter().map(|it| f32::from_le_bytes(*it))))
                .and_then(|mut three| Some([three.next()?.into(), three.next()?.into(), three.next()?.into()]))
        }
        _ => serde_json::from_value(center.clone()).ok(),
    };
    let center = numbers.map(DVec3::from_array).filter(|it| it.is_finite());
    let center = center.ok_or_else(|| MapError::new("its `RTC_CENTER` is no place").hint(UPGRADE))?;
    Ok(Shapes { file, center })
}

/// The parts of a `cmpt`.
fn several(part: &[u8]) -> Result<Vec<&[u8]>, MapError> {
    let bytes = Bytes(part);
    let count = bytes.u32(12, "the head of a `cmpt`")?;
    let (mut parts, mut at) = (vec![], HEAD_OF_SEVERAL);
    for _ in 0..count {
        let length = u64::from(bytes.u32(at + 8, "a part")?);
        if length < 12 || parts.len() == MOST_CONTENTS {
            return Err(MapError::new("its parts have no lengths, or are too many").hint(UPGRADE));
        }
        parts.push(bytes.slice(at, length, "the end of a part")?);
        at += length;
    }
    Ok(parts)
}
