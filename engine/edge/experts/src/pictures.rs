//! Settings of pictures among the parameters of a stage that films.

use cosfly_diagnose::ParameterError;
use cosfly_domain::channels::ChannelSource;
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

/// Bytes of a film for each frame of its flight, on average over the films, as measured; for predictions.
pub fn bytes_per_frame(config: &RenderConfig) -> u64 {
    let films = config.films();
    let cameras: Vec<RenderConfig> = match films.is_empty() {
        true => vec![config.of_camera(None)],
        false => films.iter().map(|film| config.of_camera(Some(film))).collect(),
    };
    cameras.iter().map(bytes_of_picture).sum::<u64>() / cameras.len() as u64
}

/// Bytes of a picture with all its channels, by frame of the flight: large ones have fewer a pixel.
fn bytes_of_picture(camera: &RenderConfig) -> u64 {
    let pixels = f64::from(camera.width) * f64::from(camera.height);
    let on_request = camera.channels.iter().map(|channel| match channel.source {
        ChannelSource::Flow(_) => 7.1,
        ChannelSource::FilmNumber => 0.9,
        ChannelSource::Number(_) | ChannelSource::Bytes(_) => 0.1,
        _ => 0.0,
    });
    let bytes = 28.0 * (pixels * pixels.sqrt()).sqrt() + pixels * on_request.sum::<f64>();
    bytes as u64 / u64::from(camera.every)
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
