//! Options as data, read from the JSON Schema of a format's options, for command lines and books.

use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde_json::{Map, Value};

/// An option of one format, or of several.
#[derive(Clone, Debug, PartialEq)]
pub struct ExportOption {
    /// Name of the field, such as `shard_size`.
    pub name: String,
    /// Meaning.
    pub doc: String,
    /// Placeholder of the value in the help, such as `TOWN=NAME`: the schema's `title`.
    pub placeholder: Option<String>,
    /// Values that it takes.
    pub kind: OptionKind,
    /// Value where it is not given.
    pub default: Value,
}

/// Values of an option.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum OptionKind {
    /// True where the option is there.
    Flag,
    /// A whole number.
    Count {
        /// The smallest one.
        least: u64,
        /// The largest one.
        most: u64,
    },
    /// A number.
    Number,
    /// One of some words, each with its meaning, which may be empty.
    Choice(Vec<(String, String)>),
    /// A text.
    Text,
    /// Texts; the option may be repeated.
    Texts,
}

/// Options of a format whose options are the struct `O`.
pub fn options_of<O: JsonSchema>() -> Vec<ExportOption> {
    let settings = SchemaSettings::draft2020_12().with(|settings| settings.inline_subschemas = true);
    let schema = settings.into_generator().into_root_schema_for::<O>().to_value();
    schema["properties"].as_object().into_iter().flatten().map(|(name, schema)| option(name, schema)).collect()
}

fn option(name: &str, schema: &Value) -> ExportOption {
    let text = |key: &str| schema[key].as_str().map(str::to_owned);
    ExportOption {
        name: name.to_owned(),
        doc: text("description").unwrap_or_default(),
        placeholder: text("title"),
        kind: kind(schema),
        default: schema["default"].clone(),
    }
}

fn kind(schema: &Value) -> OptionKind {
    let words = choices(schema);
    if !words.is_empty() {
        return OptionKind::Choice(words);
    }
    match schema["type"].as_str() {
        Some("boolean") => OptionKind::Flag,
        Some("integer") => OptionKind::Count {
            least: schema["minimum"].as_u64().unwrap_or(0),
            most: schema["maximum"].as_u64().unwrap_or(u64::MAX),
        },
        Some("number") => OptionKind::Number,
        Some("array") => OptionKind::Texts,
        _ => OptionKind::Text,
    }
}

/// Words of an enum: `oneOf` where variants have docs, else `enum`.
fn choices(schema: &Value) -> Vec<(String, String)> {
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let documented = schema["oneOf"].as_array().into_iter().flatten();
    let documented = documented.map(|variant| (text(&variant["const"]), text(&variant["description"])));
    let plain = schema["enum"].as_array().into_iter().flatten().map(|word| (text(word), String::new()));
    documented.chain(plain).collect()
}

/// The names of `options` that are not in `known`.
pub fn foreign<'a>(options: &'a Map<String, Value>, known: &'a [ExportOption]) -> impl Iterator<Item = &'a str> {
    options.keys().map(String::as_str).filter(move |name| known.iter().all(|option| option.name != *name))
}
