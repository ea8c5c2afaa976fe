//! Settings of pictures among the parameters of a stage that films.

use cosfly_diagnose::ParameterError;
use cosfly_render::{CameraConfig, RenderConfig};
use cosfly_schema::EncodingConfig;
use cosfly_stage::{StageNeed, parameters};

/// Key of the settings of encoding.
pub const ENCODING: &str = "encoding";

/// Settings of pictures and of their encoding.
///
/// # Errors
/// Parameters that the schema cannot express.
pub fn read(parameters: serde_json::Value) -> Result<(RenderConfig, EncodingConfig), ParameterError> {
    parameters::read_joined(parameters, ENCODING)
}

/// A film begins before its second picture: offsets of cameras are less than the time from one picture to the next.
pub fn needs_of_offsets(config: &RenderConfig) -> Vec<StageNeed> {
    let need = |(name, camera): (&String, &CameraConfig)| {
        Some(StageNeed::LessThan {
            parameter: format!("cameras.{name}.offset_s"),
            number: camera.offset_s.filter(|offset_s| *offset_s > 0.0)?,
            port: "trajectories",
            other: "dt_s",
            times: f64::from(camera.every.unwrap_or(1).max(1)),
        })
    };
    config.cameras.iter().filter_map(need).collect()
}

/// Need of the key `camera` of a sensor: a film of that camera.
pub fn needs_camera(camera: Option<&str>) -> Vec<StageNeed> {
    let need =
        |name: &str| StageNeed::Variant { parameter: "camera".to_owned(), port: "frames", name: name.to_owned() };
    camera.map(need).into_iter().collect()
}
