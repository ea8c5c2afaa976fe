//! `LAS`: point clouds of surveys, plain (LAS) or compressed (LAZ), versions 1.0 to 1.4, point formats 0 to 10.

pub mod compressed;
mod contained;
pub mod header;
pub mod projection;
pub mod wkt;

use crate::cloud::{CloudBuilder, CloudOptions, class, town_of};
use crate::way_out::or_advice;
use cosfly_domain::Town;
use cosfly_frames::DVec3;
use cosfly_town::{MapError, MapFormat};
use header::Header;
use projection::Projection;
use rayon::prelude::*;

/// The way out of a damaged file.
const WAY_OUT: &str = "the file seems to be damaged: fetch it again, or write it with `pdal translate FILE new.laz`";

/// The format `LAS`.
#[derive(Clone, Copy, Debug)]
pub struct Las;

impl MapFormat for Las {
    type Options = CloudOptions;

    const NAME: &'static str = "LAS";

    const EXAMPLE: &'static [u8] = include_bytes!("example.laz");

    fn recognises(head: &[u8]) -> bool {
        head.starts_with(b"LASF")
    }

    fn read(bytes: &[u8], options: &CloudOptions) -> Result<(Town, Vec<String>), MapError> {
        or_advice(town(bytes, options), WAY_OUT)
    }
}

fn town(bytes: &[u8], options: &CloudOptions) -> Result<(Town, Vec<String>), MapError> {
    let header = Header::read(bytes)?;
    let projection = Projection::read(&header)?;
    let mut warnings = Vec::new();
    let units_m = projection.units_m(options.unit_m, &mut warnings)?;
    let mut points = Points { header: &header, units_m, cloud: CloudBuilder::default(), left_out: 0 };
    match header.record(compressed::USER, compressed::RECORD) {
        Some(record) if header.is_compressed => compressed::read(&header, record, &mut points)?,
        None if header.is_compressed => {
            let error = MapError::new("the points are compressed, but the record that says how is missing");
            return Err(error.hint("write the file again with LAStools, PDAL or laspy"));
        }
        _ => points.add_all(header.plain_points()?),
    }
    if points.left_out > 0 {
        warnings.push(format!("{} points that are withheld or overlap others were left out", points.left_out));
    }
    town_of(points.cloud.finish(projection.text, warnings)?, options)
}

/// Takes records of points.
struct Points<'a> {
    header: &'a Header<'a>,
    /// Length of the units of plan and height, metres.
    units_m: [f64; 2],
    cloud: CloudBuilder,
    left_out: usize,
}

/// What the town's builder takes from the record of a point.
#[derive(Clone, Copy, Debug)]
struct Record {
    position: [i32; 3],
    class: u8,
    is_kept: bool,
}

impl Record {
    /// Reads the bytes that all records of a point format begin with; there are at least 20.
    fn read(bytes: &[u8], is_long: bool) -> Self {
        let number = |at: usize| i32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
        // Formats 6 to 10 have a byte of flags and a byte for the class, older ones share one.
        const WITHHELD: [u8; 2] = [1 << 7, 1 << 2];
        const OVERLAP: u8 = 12;
        // Older formats have a class for ground that a coarse model keeps.
        const KEY_POINT: u8 = 8;
        let class = if is_long { bytes[16] } else { bytes[15] & 31 };
        let is_kept = bytes[15] & WITHHELD[usize::from(is_long)] == 0 && class != OVERLAP;
        let class = match class {
            0 => class::UNCLASSIFIED,
            KEY_POINT if !is_long => class::GROUND,
            other => other,
        };
        Self { position: [number(0), number(4), number(8)], class, is_kept }
    }
}

impl Points<'_> {
    fn add(&mut self, record: Record) {
        if record.is_kept {
            let stored = DVec3::from_array(record.position.map(f64::from)) * self.header.scale + self.header.offset;
            let [plan_m, height_m] = self.units_m;
            self.cloud.push(stored * DVec3::new(plan_m, plan_m, height_m), record.class);
        } else {
            self.left_out += 1;
        }
    }

    /// Adds records batch by batch, as [`Self::add`] does one after another.
    fn add_batches(&mut self, batches: Vec<Vec<Record>>) {
        let mut batches = batches.into_iter();
        // All points count from the first one that is kept.
        while self.cloud.sibling().is_none() {
            let Some(batch) = batches.next() else { return };
            batch.into_iter().for_each(|record| self.add(record));
        }
        let (header, units_m) = (self.header, self.units_m);
        let batches: Vec<(CloudBuilder, Vec<Record>)> =
            batches.filter_map(|batch| Some((self.cloud.sibling()?, batch))).collect();
        let part = |(cloud, batch): (CloudBuilder, Vec<Record>)| {
            let mut part = Points { header, units_m, cloud, left_out: 0 };
            batch.into_iter().for_each(|record| part.add(record));
            part
        };
        let parts: Vec<Points<'_>> = batches.into_par_iter().map(part).collect();
        for part in parts {
            self.cloud.join(part.cloud);
            self.left_out += part.left_out;
        }
    }

    fn add_all(&mut self, records: &[u8]) {
        for record in records.chunks_exact(self.header.record_bytes) {
            self.add(Record::read(record, self.header.is_long()));
        }
    }
}
