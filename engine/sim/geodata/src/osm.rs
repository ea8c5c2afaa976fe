//! OpenStreetMap extracts: `.osm.pbf`, `.osm` and `.osm.gz`.
//!
//! `elements` is what a file holds, read by `pbf` or `xml`; `frame` is its place in the world; `rings` makes areas of ways
//! and relations; `buildings`, `passages`, `roads`, `pavements`, `paths`, `land` and `things` make a town of them.

mod bare_streets;
mod buildings;
mod carved;
mod elements;
mod frame;
mod heights;
mod land;
mod lanes;
mod options;
mod passages;
mod paths;
mod pavements;
mod pbf;
mod rings;
mod roads;
mod sea;
mod stated;
mod strip;
mod tags;
mod tally;
mod things;
mod town;
mod unpacked;
mod xml;

#[cfg(test)]
mod input_tests;
#[cfg(test)]
mod passage_tests;
#[cfg(test)]
mod tests;

pub use options::OsmOptions;

use cosfly_domain::Town;
use cosfly_town::{Format, MapError, MapFormat};
use unpacked::{GZIP_MAGIC, Unpacked};

/// The format OpenStreetMap.
#[derive(Clone, Copy, Debug)]
pub struct OpenStreetMap;

impl MapFormat for OpenStreetMap {
    type Options = OsmOptions;

    const NAME: &'static str = "OpenStreetMap";

    const EXAMPLE: &'static [u8] = include_bytes!("osm/every_feature.osm");

    fn recognises(head: &[u8]) -> bool {
        if pbf::recognises(head) {
            return true;
        }
        let unpacked =
            if head.starts_with(GZIP_MAGIC) { Unpacked::head(head, Format::HEAD_BYTES) } else { head.to_vec() };
        begins_with_osm(&String::from_utf8_lossy(&unpacked))
    }

    fn read(bytes: &[u8], options: &OsmOptions) -> Result<(Town, Vec<String>), MapError> {
        let mut elements = if pbf::recognises(bytes) { pbf::read(bytes)? } else { xml::read(bytes)? };
        elements.sort();
        town::town(&elements, options)
    }
}

/// Whether the first tag of a text is `<osm`.
fn begins_with_osm(text: &str) -> bool {
    let mut rest = text.trim_start_matches('\u{feff}').trim_start();
    while let Some(skipped) = rest.strip_prefix("<?").or_else(|| rest.strip_prefix("<!")) {
        let Some((_, after)) = skipped.split_once('>') else { return false };
        rest = after.trim_start();
    }
    rest.strip_prefix("<osm").is_some_and(|rest| rest.starts_with([' ', '>', '\t', '\n', '\r', '/']))
}
