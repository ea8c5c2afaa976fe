//! Options of all formats together: their schema, those that are in keys, and those that a file of one format has not.

use crate::FORMATS;
use cosfly_town::{Format, FormatOptions, MapError};
use serde_json::{Map, Value, json};

/// Options of OpenDRIVE that are in all keys: there was no other format once.
const IN_ALL_KEYS: [&str; 6] =
    ["shoulders_as_sidewalks", "signals", "road_marks", "unmarked_crossings", "roofs", "sample_step_m"];

/// Schema of the options of all formats.
pub fn schema() -> Value {
    let mut all =
        json!({ "type": "object", "description": "Options of the file's format.", "additionalProperties": false });
    for format in FORMATS {
        let named = named_schema(format);
        for part in ["properties", "$defs"] {
            for (name, definition) in named[part].as_object().into_iter().flatten() {
                all[part][name] = definition.clone();
            }
        }
    }
    all
}

/// Schema of the options of a format; their descriptions begin with the names of the formats that have them.
fn named_schema(format: &Format) -> Value {
    let mut schema = format.schema();
    for (name, option) in schema["properties"].as_object_mut().into_iter().flatten() {
        let description = option["description"].as_str().unwrap_or_default();
        option["description"] = format!("{}: {description}", owners(name).join(", ")).into();
    }
    schema
}

/// Names of the formats that have an option.
fn owners(name: &str) -> Vec<&'static str> {
    FORMATS.iter().filter(|one| one.option_names().iter().any(|its| its == name)).map(Format::name).collect()
}

/// Options for keys, with defaults. Those of newer formats are left out at their defaults, so that a new one moves no key.
///
/// # Errors
/// An option of the wrong type.
pub fn in_keys(options: &FormatOptions) -> Result<Map<String, Value>, MapError> {
    let mut all = Map::new();
    for format in FORMATS {
        let (own, defaults) = (format.filled(options)?, format.filled(&FormatOptions::default())?);
        for ((name, value), (_, default)) in own.iter().zip(defaults.iter()) {
            if IN_ALL_KEYS.contains(&name.as_str()) || value != default {
                all.insert(name.clone(), value.clone());
            }
        }
    }
    Ok(all)
}

/// Schema that allows all options but those of other formats than `own`, that of `file`.
pub fn without_foreign(own: &Format, file: &str) -> Value {
    let (mut properties, own_names) = (Map::new(), own.option_names());
    for name in FORMATS.iter().flat_map(|format| format.option_names()).filter(|name| !own_names.contains(name)) {
        let owners = owners(&name);
        let maps = if owners.len() == 1 { "the format" } else { "one of the formats" };
        let reason = format!(
            "is an option of maps in {maps} {}, but `{file}` is in the format {}",
            owners.join(", "),
            own.name()
        );
        properties.insert(name, json!({ "not": {}, "description": reason }));
    }
    json!({ "properties": { "options": { "properties": properties } } })
}
