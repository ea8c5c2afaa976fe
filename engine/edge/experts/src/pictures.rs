//! Settings of pictures among the parameters of a stage that films.

use cosfly_diagnose::ParameterError;
use cosfly_render::RenderConfig;
use cosfly_schema::EncodingConfig;
use cosfly_stage::parameters;

/// Key of the settings of encoding.
pub const ENCODING: &str = "encoding";

/// Settings of pictures and of their encoding.
///
/// # Errors
/// Parameters that the schema cannot express.
pub fn read(parameters: serde_json::Value) -> Result<(RenderConfig, EncodingConfig), ParameterError> {
    parameters::read_joined(parameters, ENCODING)
}
