//! `generated`: a town of our own, described by a few numbers in a JSON file. The streets are drawn anew at every reading, so
//! that a recipe of many towns needs no large files.

use super::opendrive::{OpenDrive, OpenDriveOptions};
use crate::generate::{GenerateConfig, generate_town};
use cosfly_domain::Town;
use cosfly_town::text::{decoded, refused_json};
use cosfly_town::{MapError, MapFormat};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The format `generated`.
pub struct Generated;

/// Options of generated towns: none.
#[derive(Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GeneratedOptions {}

/// A file as it stands.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    format: String,
    seed: u64,
    #[serde(default)]
    town: GenerateConfig,
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
        let document: Document = serde_json::from_str(&text).map_err(|error| refused_json(&error, &text))?;
        if document.format != FORMAT {
            return Err(MapError::new(format!("`format` is `{}`; it must be `{FORMAT}`", document.format)));
        }
        let allowed = document.town.clamped();
        if document.town != allowed {
            return Err(out_of_range(&document.town, &allowed));
        }
        let (mut town, warnings) =
            OpenDrive::read(generate_town(&document.town, document.seed).as_bytes(), &OpenDriveOptions::default())?;
        town.synthetic.notes.push(format!("the whole town is generated: seed {}", document.seed));
        Ok((town, warnings))
    }
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
        let error = refusal("\"rows\"", "\"row\"");
        assert!(error.message.contains("unknown field `row`"), "{error}");
        assert_eq!(error.place.unwrap().line, 5);
    }
}
