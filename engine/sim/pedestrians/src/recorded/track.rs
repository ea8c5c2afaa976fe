//! Recorded people: where they were, and when.

use cosfly_frames::DVec2;

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
    /// Parts left out, in words.
    pub warnings: Vec<String>,
}
