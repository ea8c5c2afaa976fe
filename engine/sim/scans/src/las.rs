//! `LAS`: point clouds of surveys, plain (LAS) or compressed (LAZ), versions 1.0 to 1.4, point formats 0 to 10.

pub mod coloured;
pub mod compressed;
pub mod header;
pub mod projection;
mod records;
pub mod wkt;

use crate::cloud::{CloudBuilder, CloudOptions, town_of};
use crate::way_out::or_advice;
use cosfly_domain::Town;
use cosfly_town::{MapError, MapFormat};
use header::Header;
use projection::Projection;
use records::{Points, Record};

/// The way out of a damaged file.
const WAY_OUT: &str = "the file seems to be damaged: fetch it again, or write it with `pdal translate FILE new.laz`";

/// The format `LAS`.
#[derive(Clone, Copy, Debug)]
pub struct Las;

impl MapFormat for Las {
    type Options = CloudOptions;

    const NAME: &'static str = "LAS";

    const EXAMPLE: &'static [u8] = include_bytes!("las/example.laz");

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
    let mut points = Points { header: &header, units_m, cloud: CloudBuilder::new(options.up_axis), left_out: 0 };
    match header.record(compressed::USER, compressed::RECORD) {
        Some(record) if header.is_compressed => {
            let read = |bytes: &[u8]| Record::read(bytes, header.is_long());
            compressed::read(&header, record, compressed::usual_parts(), read, |batches| points.add_batches(batches))?;
        }
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
