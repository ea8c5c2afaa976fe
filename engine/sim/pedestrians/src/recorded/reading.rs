//! Reading of a file, by its format.

use super::config::{RecordedConfig, RecordedFormat};
use super::error::RecordedError;
use super::track::Recording;
use super::{columns, geojson, gpx, tidy};

impl Recording {
    /// Reads a file of the configured format, or of the one that its content shows.
    ///
    /// # Errors
    /// With the line, where the file is not of the format, a number is none, or a person's time runs backwards.
    pub fn read(bytes: &[u8], config: &RecordedConfig) -> Result<Self, RecordedError> {
        let text = std::str::from_utf8(bytes).map_err(|error| {
            let line = 1 + bytes[..error.valid_up_to()].iter().filter(|byte| **byte == b'\n').count();
            RecordedError::new("the file is not UTF-8 text").at(line as u32).hint(
                "export the tracks as GPX, GeoJSON, `obsmat` or CSV text in UTF-8; packed files must be unpacked first",
            )
        })?;
        let text = text.trim_start_matches('\u{feff}');
        let mut recording = match config.format.unwrap_or_else(|| RecordedFormat::recognised(text)) {
            RecordedFormat::Gpx => gpx::read(text)?,
            RecordedFormat::Geojson => geojson::read(text)?,
            RecordedFormat::Obsmat => columns::read_obsmat(text, config)?,
            RecordedFormat::Csv => columns::read_csv(text, config)?,
        };
        tidy::tidy(&mut recording, config)?;
        Ok(recording)
    }
}
