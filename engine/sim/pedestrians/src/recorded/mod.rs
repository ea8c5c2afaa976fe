//! Recorded people: tracks with time from GPX, GeoJSON, ETH/UCY `obsmat` and CSV files, read from bytes.
//!
//! [`Recording::read`] gives tracks as the file has them, checked; [`Recording::placed`] puts them into a town as a
//! [`Prescribed`](cosfly_world::Prescribed) population.

mod columns;
mod config;
mod curve;
mod error;
mod geojson;
mod gpx;
mod instant;
mod placed;
mod tidy;
mod unique;

pub use config::{RecordedConfig, RecordedFormat};
use cosfly_frames::DVec2;
pub use error::RecordedError;

/// One recorded person.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedTrack {
    /// Name in the file.
    pub id: String,
    /// Places in order of time.
    pub points: Vec<RecordedPoint>,
}

/// Where somebody was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordedPoint {
    /// Time, seconds: since 1970 in GPX and GeoJSON files, by the file's own clock in others.
    pub time_s: f64,
    /// Place: longitude and latitude in degrees in GPX and GeoJSON files, metres by the file's own axes in others.
    pub at: DVec2,
    /// Line of the file, from 1; 0 where the format has no lines.
    pub line: u32,
}

/// Tracks of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// Tracks with at least two points.
    pub tracks: Vec<RecordedTrack>,
    /// Whether places are longitudes and latitudes.
    pub is_geographic: bool,
    /// What was left out, in words.
    pub warnings: Vec<String>,
}

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
