//! CityJSON 1.0 to 2.0 and CityJSONSeq: buildings with their roofs, roads, ground, plants.
//!
//! [`document`] is the file as it stands, [`shapes`] its faces in the world, [`words`] says what an object is,
//! [`layers`] turns the solid under a roof into boxes, [`town`] puts the parts together.

mod boundaries;
mod document;
mod doubts;
mod faces;
mod ground;
mod layers;
mod plants;
mod shapes;
mod town;
mod undersides;
mod words;

use cosfly_domain::Town;
use cosfly_town::{MapError, MapFormat};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The format CityJSON.
#[derive(Clone, Copy, Debug)]
pub struct CityJson;

/// Options of CityJSON maps: none.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CityJsonOptions {}

impl MapFormat for CityJson {
    type Options = CityJsonOptions;

    const NAME: &'static str = "CityJSON";

    const EXAMPLE: &'static [u8] = include_bytes!("cityjson/every_feature.city.json");

    fn recognises(head: &[u8]) -> bool {
        let text = String::from_utf8_lossy(head);
        let text = text.trim_start_matches('\u{feff}').trim_start();
        let Some(members) = text.strip_prefix('{') else { return false };
        // Members may come in any order, and the first one may fill the head.
        let first = members.trim_start();
        const FIRST: [&str; 4] = ["\"CityObjects\"", "\"appearance\"", "\"geometry-templates\"", "\"vertices\""];
        const ANYWHERE: [&str; 3] = ["\"CityJSON\"", "\"CityObjects\"", "\"referenceSystem\""];
        let has_transform = || ["\"transform\"", "\"scale\"", "\"translate\""].iter().all(|name| text.contains(name));
        FIRST.iter().any(|name| first.starts_with(name))
            || ANYWHERE.iter().any(|name| text.contains(name))
            || has_transform()
    }

    fn read(bytes: &[u8], _: &CityJsonOptions) -> Result<(Town, Vec<String>), MapError> {
        town::town(bytes)
    }
}
