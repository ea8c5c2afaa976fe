//! [`Header`]: the head of a LAS file and its records of variable length.

use crate::bytes::Bytes;
use cosfly_diagnose::{counted, plausible};
use cosfly_frames::DVec3;
use cosfly_town::MapError;

/// Bytes of the head of a record of variable length, and of an extended one.
const RECORD_HEAD_BYTES: [u64; 2] = [54, 60];

/// The head of a file.
#[derive(Debug)]
pub struct Header<'a> {
    /// The whole file.
    pub bytes: Bytes<'a>,
    /// Number of the point format, 0 to 10.
    pub point_format: u8,
    /// Whether the points are compressed.
    pub is_compressed: bool,
    /// Bytes of the record of a point.
    pub record_bytes: usize,
    /// Points that the file says it has.
    pub points: u64,
    /// First byte of the points.
    pub points_start: u64,
    /// Size of a step of stored coordinates, file units.
    pub scale: DVec3,
    /// Place of stored coordinates, file units.
    pub offset: DVec3,
    records: Vec<VariableRecord<'a>>,
}

#[derive(Debug)]
struct VariableRecord<'a> {
    user: &'a [u8],
    number: u16,
    data: &'a [u8],
}

impl VariableRecord<'_> {
    fn is(&self, user: &str, number: u16) -> bool {
        self.number == number && self.user.split(|byte| *byte == 0).next() == Some(user.as_bytes())
    }
}

impl<'a> Header<'a> {
    /// Reads the head; sizes are checked against the bytes that are there.
    ///
    /// # Errors
    /// A version or point format that does not exist, or sizes beyond the end of the file.
    pub fn read(bytes: &'a [u8]) -> Result<Self, MapError> {
        let bytes = Bytes(bytes);
        let [major, minor] = bytes.array(24, "the version")?;
        if major != 1 || minor > 4 {
            return Err(MapError::new(format!("the file is LAS {major}.{minor}; versions 1.0 to 1.4 are read")));
        }
        let [stored_format] = bytes.array(104, "the point format")?;
        let point_format = stored_format & 0b11_1111;
        // Bytes of the standard's records; surveys may append their own.
        const LEAST_BYTES: [usize; 11] = [20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67];
        let Some(least_bytes) = LEAST_BYTES.get(usize::from(point_format)) else {
            return Err(MapError::new(format!("the point format is {point_format}; formats 0 to 10 are read")));
        };
        let record_bytes = usize::from(bytes.u16(105, "the length of a point")?);
        if record_bytes < *least_bytes {
            let rule = format!("points of format {point_format} have at least {least_bytes}");
            return Err(MapError::new(format!(
                "a point has {record_bytes}; {rule}",
                record_bytes = counted(record_bytes, "byte")
            )));
        }
        let vector = |start: u64, what: &str| -> Result<DVec3, MapError> {
            Ok(DVec3::new(bytes.f64(start, what)?, bytes.f64(start + 8, what)?, bytes.f64(start + 16, what)?))
        };
        let (scale, offset) = (vector(131, "the scale")?, vector(155, "the offset")?);
        let are_plausible = |it: DVec3| it.to_array().into_iter().all(|number| plausible(number).is_ok());
        if !(are_plausible(scale) && scale.min_element() > 0.0 && are_plausible(offset)) {
            return Err(MapError::new(format!(
                "the scale is {scale} and the offset {offset}; they must be numbers up to 1e9, and the scale above 0"
            )));
        }
        let old_count = bytes.u32(107, "the number of points")?.into();
        let points = match minor {
            4 => Some(bytes.u64(247, "the number of points")?).filter(|count| *count > 0).unwrap_or(old_count),
            _ => old_count,
        };
        let mut header = Self {
            bytes,
            point_format,
            is_compressed: stored_format & 0b1100_0000 != 0,
            record_bytes,
            points,
            points_start: bytes.u32(96, "the place of the points")?.into(),
            scale,
            offset,
            records: Vec::new(),
        };
        header.add_records(
            bytes.u16(94, "the size of the head")?.into(),
            bytes.u32(100, "the number of records")?.into(),
            0,
        )?;
        if minor == 4 {
            header.add_records(
                bytes.u64(235, "the place of records")?,
                bytes.u32(243, "the number of records")?.into(),
                1,
            )?;
        }
        Ok(header)
    }

    /// Reads the records from `start` on; extended ones have a longer head.
    fn add_records(&mut self, mut start: u64, count: u64, extended: usize) -> Result<(), MapError> {
        const WHAT: &str = "a record of variable length";
        // Each has a head of its own: as many as the file has room for.
        for _ in 0..count {
            let length = match extended {
                0 => self.bytes.u16(start + 20, WHAT)?.into(),
                _ => self.bytes.u64(start.saturating_add(20), WHAT)?,
            };
            let head_bytes = RECORD_HEAD_BYTES[extended];
            let user = self.bytes.slice(start + 2, 16, WHAT)?;
            let number = self.bytes.u16(start + 18, WHAT)?;
            let data = self.bytes.slice(start + head_bytes, length, WHAT)?;
            self.records.push(VariableRecord { user, number, data });
            start += head_bytes + length;
        }
        Ok(())
    }

    /// [`Self::record`] where all records of the user and number say the same.
    ///
    /// # Errors
    /// Two that say different things.
    pub fn only_record(&self, user: &str, number: u16) -> Result<Option<&'a [u8]>, MapError> {
        let first = self.record(user, number);
        let others = self.records.iter().filter(|record| record.is(user, number));
        if others.clone().any(|record| Some(record.data) != first) {
            let message = format!("the file has {} different records {number} of `{user}`", others.count());
            return Err(MapError::new(message).hint("write the file again with one of them"));
        }
        Ok(first)
    }

    /// Data of the record of a user and number.
    pub fn record(&self, user: &str, number: u16) -> Option<&'a [u8]> {
        self.records.iter().find(|record| record.is(user, number)).map(|record| record.data)
    }

    /// Whether the point format is one of the longer ones of LAS 1.4.
    pub fn is_long(&self) -> bool {
        self.point_format >= 6
    }

    /// Records of the points of a plain file.
    ///
    /// # Errors
    /// The file holds fewer than it says.
    pub fn plain_points(&self) -> Result<&'a [u8], MapError> {
        let length = self.points.saturating_mul(self.record_bytes as u64);
        self.bytes.slice(self.points_start, length, &format!("the last of {} points", self.points))
    }
}
