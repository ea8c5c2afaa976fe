//! Parameters of plugins: the schema that a plugin declares, and its defaults.

use serde_json::{Map, Value};

/// The schema in what `describe` gave; an empty text is that of no parameters. Keys that it does not list are refused unless
/// it says otherwise.
///
/// # Errors
/// Why the text is no schema of an object.
pub fn check_schema(text: &str) -> Result<Value, String> {
    if text.trim().is_empty() {
        return Ok(serde_json::json!({ "type": "object", "properties": {}, "additionalProperties": false }));
    }
    let mut schema: Value =
        serde_json::from_str(text).map_err(|error| format!("its `params-schema` is not JSON: {error}"))?;
    let is_object = schema.get("type").and_then(Value::as_str) == Some("object");
    let has_properties = schema.get("properties").is_none_or(Value::is_object);
    let (Some(table), true, true) = (schema.as_object_mut(), is_object, has_properties) else {
        return Err("its `params-schema` is not the schema of an object (`\"type\": \"object\"`)".to_owned());
    };
    table.entry("additionalProperties").or_insert(Value::Bool(false));
    Ok(schema)
}

/// `given` with the defaults of what is missing, as JSON text with sorted keys.
pub fn with_defaults(schema: &Value, given: &Map<String, Value>) -> String {
    Value::Object(filled(schema, given)).to_string()
}

fn filled(schema: &Value, given: &Map<String, Value>) -> Map<String, Value> {
    let mut all = given.clone();
    for (name, rule) in schema.get("properties").and_then(Value::as_object).into_iter().flatten() {
        match (all.get_mut(name), rule.get("default")) {
            (Some(Value::Object(inner)), _) => *inner = filled(rule, inner),
            (None, Some(default)) => {
                all.insert(name.clone(), default.clone());
            }
            _ => {}
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_fill_what_is_missing_at_every_depth() {
        let schema = check_schema(
            r#"{"type":"object","properties":{"a":{"default":1},"b":{"type":"object","properties":{"c":{"default":2}}}}}"#,
        )
        .unwrap();
        let given = serde_json::json!({ "b": { "d": 3 } });
        assert_eq!(with_defaults(&schema, given.as_object().unwrap()), r#"{"a":1,"b":{"c":2,"d":3}}"#);
        assert_eq!(schema["additionalProperties"], false);
    }

    #[test]
    fn what_is_no_schema_of_an_object_is_refused() {
        for text in ["{", "[]", "{\"type\":\"string\"}", "{\"type\":\"object\",\"properties\":3}"] {
            assert!(check_schema(text).is_err(), "{text}");
        }
        check_schema("").unwrap();
    }
}
