//! `generated`: a place of our own, described by its kind and a few numbers in a JSON file. It is drawn anew at every reading, so
//! that a recipe of many towns needs no large files.

use super::opendrive::{OpenDrive, OpenDriveOptions};
use cosfly_domain::Town;
use cosfly_places::grid::{GenerateConfig, generate_town};
use cosfly_places::kinds::kind::PlaceKind;
use cosfly_places::kinds::{ALL, GRID};
use cosfly_town::text::{decoded, refused_json};
use cosfly_town::{MapError, MapFormat};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The format `generated`.
pub struct Generated;

/// Options of generated towns: none.
#[derive(Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GeneratedOptions {}

/// The parts of a file that say how to read the rest.
#[derive(Deserialize)]
struct Head {
    format: String,
    #[serde(default)]
    place: Option<String>,
}

/// A file with the numbers of its kind of place.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document<T> {
    #[serde(rename = "format")]
    _format: String,
    #[serde(rename = "place")]
    _place: Option<String>,
    seed: u64,
    #[serde(default)]
    town: T,
}

const FORMAT: &str = "cosfly-generated/1";

impl MapFormat for Generated {
    type Options = GeneratedOptions;

    const NAME: &'static str = "generated";

    const EXAMPLE: &'static [u8] = br#"{
  "format": "cosfly-generated/1",
  "seed": 7,
  "town": {
    "columns": 4, "rows": 4, "min_spacing_m": 62, "max_spacing_m": 75,
    "building_density": 0.8, "tree_density": 0.6, "min_height_m": 5, "max_height_m": 20
  }
}
"#;

    fn recognises(head: &[u8]) -> bool {
        let text = String::from_utf8_lossy(head);
        text.trim_start_matches('\u{feff}').trim_start().starts_with('{') && text.contains("\"cosfly-generated/")
    }

    fn read(bytes: &[u8], _: &GeneratedOptions) -> Result<(Town, Vec<String>), MapError> {
        let text = decoded(bytes)?;
        let head: Head = serde_json::from_str(&text).map_err(|error| refused_json(&error, &text))?;
        if head.format != FORMAT {
            return Err(MapError::new(format!("`format` is `{}`; it must be `{FORMAT}`", head.format)));
        }
        let kind = head.place.as_deref().filter(|place| *place != GRID).map(kind_of).transpose()?;
        let (open_drive, what) = match kind {
            None => grid(&text)?,
            Some(kind) => placed(kind, &text)?,
        };
        let (mut town, warnings) = OpenDrive::read(open_drive.as_bytes(), &OpenDriveOptions::default())?;
        town.synthetic.notes.push(format!("the whole town is generated: {what}"));
        Ok((town, warnings))
    }
}

fn kind_of(place: &str) -> Result<&'static PlaceKind, MapError> {
    let names = || [GRID].into_iter().chain(ALL.iter().map(|kind| kind.name)).map(|name| format!("`{name}`"));
    let found = ALL.iter().find(|kind| kind.name == place).copied();
    found.ok_or_else(|| {
        let message = format!("`place` is `{place}`, a kind that does not exist");
        MapError::new(message).hint(format!("the kinds are {}", names().collect::<Vec<_>>().join(", ")))
    })
}

/// OpenDRIVE of a town on a grid, and what it is made from.
fn grid(text: &str) -> Result<(String, String), MapError> {
    let document: Document<GenerateConfig> = serde_json::from_str(text).map_err(|error| refused_json(&error, text))?;
    let allowed = document.town.clamped();
    if document.town != allowed {
        return Err(out_of_range(&document.town, &allowed));
    }
    Ok((generate_town(&document.town, document.seed), format!("seed {}", document.seed)))
}

/// OpenDRIVE of a place of another kind, and what it is made from.
fn placed(kind: &PlaceKind, text: &str) -> Result<(String, String), MapError> {
    let document: Document<BTreeMap<String, f64>> =
        serde_json::from_str(text).map_err(|error| refused_json(&error, text))?;
    let settings = kind.settings(&document.town).map_err(|it| MapError::new(it.message).hint(it.hint))?;
    Ok((kind.open_drive(&settings, document.seed), format!("place {}, seed {}", kind.name, document.seed)))
}

/// Names the first number that is out of its range.
fn out_of_range(asked: &GenerateConfig, allowed: &GenerateConfig) -> MapError {
    let fields = |config: &GenerateConfig| match serde_json::to_value(config) {
        Ok(serde_json::Value::Object(fields)) => fields,
        _ => serde_json::Map::new(),
    };
    let allowed = fields(allowed);
    let wrong = fields(asked).into_iter().find(|(name, value)| allowed.get(name) != Some(value));
    let (name, value) = wrong.unwrap_or_default();
    MapError::new(format!("`town.{name}` is {value}, out of its range"))
        .hint(format!("the nearest allowed value is {}", allowed[&name]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(from: &str, to: &str) -> MapError {
        let text = String::from_utf8(Generated::EXAMPLE.to_vec()).unwrap().replace(from, to);
        Generated::read(text.as_bytes(), &GeneratedOptions {}).unwrap_err()
    }

    #[test]
    fn numbers_out_of_range_are_refused_by_name() {
        let error = refusal("\"columns\": 4", "\"columns\": 400");
        assert_eq!(error.message, "`town.columns` is 400, out of its range");
        assert_eq!(error.hints, ["the nearest allowed value is 12"]);
        let followed =
            String::from_utf8(Generated::EXAMPLE.to_vec()).unwrap().replace("\"columns\": 4", "\"columns\": 12");
        assert!(Generated::read(followed.as_bytes(), &GeneratedOptions {}).is_ok());
        assert!(refusal("\"max_spacing_m\": 75", "\"max_spacing_m\": 50").message.contains("`town.max_spacing_m`"));
        assert!(refusal("/1\"", "/2\"").message.contains("cosfly-generated/2"));
        let error = refusal("\"rows\"", "\"row\"");
        assert!(error.message.contains("unknown field `row`"), "{error}");
        assert_eq!(error.place.unwrap().line, 5);
    }

    #[test]
    fn places_are_refused_with_what_is_allowed() {
        let read = |place: &str, town: &str| {
            let text = format!(r#"{{"format": "cosfly-generated/1", "seed": 1, "place": "{place}", "town": {town}}}"#);
            Generated::read(text.as_bytes(), &GeneratedOptions {})
        };
        let error = read("old_twon", "{}").unwrap_err();
        assert_eq!(error.message, "`place` is `old_twon`, a kind that does not exist");
        assert!(error.hints[0].contains("`grid`, `arterial`") && error.hints[0].contains("`old_town`"), "{error:?}");
        let error = read("old_town", r#"{"size_m": 20}"#).unwrap_err();
        assert_eq!(error.message, "`town.size_m` of the place `old_town` is 20, out of its range");
        assert_eq!(error.hints, ["it must be 180 to 700: Width of the place, metres"]);
        let error = read("old_town", r#"{"columns": 4}"#).unwrap_err();
        assert!(error.message.contains("`town.columns` is no key") && error.hints[0].contains("`size_m`"), "{error:?}");
        let (town, _) = read("old_town", r#"{"size_m": 180}"#).unwrap();
        assert_eq!(town.synthetic.notes.last().unwrap(), "the whole town is generated: place old_town, seed 1");
        assert!(read("grid", r#"{"columns": 4}"#).is_ok());
    }
}
