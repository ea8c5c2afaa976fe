//! Parameters of a stage: from checked JSON to the config struct and back.

use cosfly_diagnose::ParameterError;
use schemars::{JsonSchema, generate::SchemaSettings};
use serde::{Serialize, de::DeserializeOwned};

/// JSON Schema of a config struct.
pub fn schema_of<T: JsonSchema>() -> serde_json::Value {
    SchemaSettings::draft2020_12().into_generator().into_root_schema_for::<T>().to_value()
}

/// Config struct of checked parameters; an error here is a rule that the schema cannot express.
pub fn read<T: DeserializeOwned>(parameters: serde_json::Value) -> Result<T, ParameterError> {
    serde_json::from_value(parameters).map_err(|error| refused_at("", error.to_string()))
}

/// Parameters with all defaults filled in, for keys.
pub fn canonical<T: Serialize>(config: &T) -> serde_json::Value {
    serde_json::to_value(config).expect("configs are plain JSON values")
}

/// `table` without the parameters `names`, which must not enter a key. A name that is not in the table is a bug: a misspelt one
/// fails with the first stage that is built.
pub fn without(mut table: serde_json::Value, names: &[&str]) -> serde_json::Value {
    let all = table.as_object_mut().expect("parameters are a table");
    for name in names {
        assert!(all.remove(*name).is_some(), "there is no parameter `{name}`");
    }
    table
}

/// Schema of `A` with one more property, `key`, that holds a `B`: configs of two rooms in one table of a recipe.
pub fn joined_schema<A: JsonSchema, B: JsonSchema>(key: &str) -> serde_json::Value {
    let (mut outer, mut inner) = (schema_of::<A>(), schema_of::<B>());
    for meta in ["$schema", "title"] {
        inner.as_object_mut().expect("a schema is a table").remove(meta);
    }
    if let Some(definitions) = inner.as_object_mut().and_then(|table| table.remove("$defs")) {
        let all = outer.as_object_mut().expect("a schema is a table").entry("$defs").or_insert_with(Default::default);
        for (name, definition) in definitions.as_object().expect("definitions are a table") {
            all[name] = definition.clone();
        }
    }
    outer["properties"][key] = inner;
    outer
}

/// Reads parameters of the form of [`joined_schema`]; a missing `key` gives `B`'s defaults.
pub fn read_joined<A: DeserializeOwned, B: DeserializeOwned + Default>(
    mut parameters: serde_json::Value,
    key: &str,
) -> Result<(A, B), ParameterError> {
    let inner = parameters.as_object_mut().and_then(|table| table.remove(key));
    Ok((read(parameters)?, inner.map(read).transpose()?.unwrap_or_default()))
}

/// [`canonical`] parameters of the form of [`joined_schema`].
pub fn joined_canonical<A: Serialize, B: Serialize>(outer: &A, inner: &B, key: &str) -> serde_json::Value {
    let mut all = canonical(outer);
    all[key] = canonical(inner);
    all
}

/// Schema of `A` and `B` side by side in one table; their properties have different names.
pub fn merged_schema<A: JsonSchema, B: JsonSchema>() -> serde_json::Value {
    merged_into(schema_of::<A>(), schema_of::<B>())
}

/// `all` with the properties of `more` beside its own.
pub fn merged_into(mut all: serde_json::Value, mut more: serde_json::Value) -> serde_json::Value {
    for part in ["properties", "$defs"] {
        let taken = more.as_object_mut().and_then(|table| table.remove(part));
        for (name, definition) in taken.iter().filter_map(serde_json::Value::as_object).flatten() {
            all[part][name] = definition.clone();
        }
    }
    all
}

/// Reads parameters of the form of [`merged_schema`].
pub fn read_merged<A: DeserializeOwned, B: DeserializeOwned + JsonSchema>(
    mut parameters: serde_json::Value,
) -> Result<(A, B), ParameterError> {
    let second = take(&mut parameters)?;
    Ok((read(parameters)?, second))
}

/// Takes the properties of a `B` out of a table that holds more.
pub fn take<B: DeserializeOwned + JsonSchema>(parameters: &mut serde_json::Value) -> Result<B, ParameterError> {
    let schema = schema_of::<B>();
    let names = schema["properties"].as_object().into_iter().flat_map(|properties| properties.keys());
    let mut second = serde_json::Map::new();
    for name in names {
        if let Some(value) = parameters.as_object_mut().and_then(|table| table.remove(name)) {
            second.insert(name.clone(), value);
        }
    }
    read(second.into())
}

/// A refusal that points at `path`, keys and list positions as in `view.pitch[1]`; empty is the whole table.
pub fn refused_at(path: &str, message: impl Into<String>) -> ParameterError {
    let keys = path.split(['.', '[', ']']).filter(|key| !key.is_empty());
    ParameterError { path: keys.map(str::to_owned).collect(), message: message.into(), hint: None }
}
