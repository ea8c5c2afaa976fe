//! From a stage's checked JSON parameters to its config struct and back.

use cosfly_stage::ParameterError;
use schemars::{JsonSchema, generate::SchemaSettings};
use serde::{Serialize, de::DeserializeOwned};

/// The JSON Schema of a config struct.
pub fn schema_of<T: JsonSchema>() -> serde_json::Value {
    SchemaSettings::draft2020_12().into_generator().into_root_schema_for::<T>().to_value()
}

/// The config struct; the schema was checked before, so an error here is a rule that the schema cannot say.
pub fn read<T: DeserializeOwned>(parameters: serde_json::Value) -> Result<T, ParameterError> {
    serde_json::from_value(parameters).map_err(|error| refused(&[], error.to_string()))
}

/// The parameters with all defaults filled in: what goes into keys.
pub fn canonical<T: Serialize>(config: &T) -> serde_json::Value {
    serde_json::to_value(config).expect("configs are plain JSON values")
}

/// A refusal that points at `path`.
pub fn refused(path: &[&str], message: impl Into<String>) -> ParameterError {
    ParameterError { path: path.iter().map(|key| (*key).to_owned()).collect(), message: message.into(), hint: None }
}
