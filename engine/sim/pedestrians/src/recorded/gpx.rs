//! GPX tracks, read as a stream: `trk` / `trkseg` / `trkpt` with `lat`, `lon` and `time`.

use super::columns::shortened;
use super::{RecordedError, RecordedPoint, RecordedTrack, Recording, instant};
use cosfly_frames::DVec2;
use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;

pub(super) fn read(text: &str) -> Result<Recording, RecordedError> {
    let mut xml = Reader::from_str(text);
    let mut lines = Lines::of(text);
    let mut reading = Reading::default();
    loop {
        let line = lines.at(xml.buffer_position() as usize);
        let event = xml.read_event().map_err(|error| {
            RecordedError::new(format!("broken XML: {error}")).at(line).hint("export the tracks as GPX again")
        })?;
        match event {
            Event::Start(tag) => reading.open(&tag, line)?,
            Event::Empty(tag) => {
                reading.open(&tag, line)?;
                reading.close(tag.local_name().as_ref(), line)?;
            }
            Event::End(tag) => reading.close(tag.local_name().as_ref(), line)?,
            Event::Text(piece) => {
                if let (Some(text), Ok(piece)) = (&mut reading.text, piece.decode()) {
                    text.push_str(&piece);
                }
            }
            Event::Eof if reading.is_complete && reading.track_count == 0 => {
                let hint = "people are tracks, `trkpt` with `time`; routes and waypoints say no times";
                return Err(RecordedError::new("the file has no `<trk>`").at(line).hint(hint));
            }
            Event::Eof if reading.is_complete => return Ok(reading.finished()),
            Event::Eof => {
                let message = "the file ends before `</gpx>`";
                return Err(RecordedError::new(message).at(line).hint("export the tracks as GPX again"));
            }
            _ => {}
        }
    }
}

/// The file so far.
#[derive(Default)]
struct Reading {
    tracks: Vec<RecordedTrack>,
    /// Names of the elements that are open.
    depth: usize,
    is_complete: bool,
    track: Option<Track>,
    /// Depth of the open track and of the open point.
    track_depth: usize,
    point_depth: usize,
    /// Place of the open point.
    point: Option<DVec2>,
    time_s: Option<f64>,
    /// Text of the open `name` or `time`.
    text: Option<String>,
    track_count: usize,
    untimed: usize,
    /// Points outside of a `trkseg`.
    astray: usize,
    /// Way points and routes.
    others: usize,
}

/// The open track.
struct Track {
    name: Option<String>,
    segments: Vec<Vec<RecordedPoint>>,
}

impl Reading {
    fn open(&mut self, tag: &BytesStart<'_>, line: u32) -> Result<(), RecordedError> {
        self.depth += 1;
        let name = tag.local_name();
        if self.depth == 1 && name.as_ref() != b"gpx" {
            let name = String::from_utf8_lossy(name.as_ref()).into_owned();
            let message = format!("the file begins with `<{}>`, not with `<gpx>`", shortened(&name));
            let hint = "recorded people are read from GPX, GeoJSON, `obsmat` and CSV";
            return Err(RecordedError::new(message).at(line).hint(hint));
        }
        let is_below = |depth: usize| self.depth == depth + 1;
        match name.as_ref() {
            b"trk" if self.track.is_some() => return Err(second("trk", line)),
            b"trk" => {
                self.track_count += 1;
                self.track = Some(Track { name: None, segments: vec![] });
                self.track_depth = self.depth;
            }
            b"trkseg" => {
                if let Some(track) = &mut self.track {
                    track.segments.push(vec![]);
                }
            }
            b"trkpt" if self.point.is_some() => return Err(second("trkpt", line)),
            b"trkpt" => {
                self.point = Some(DVec2::new(degrees(tag, "lon", 180.0, line)?, degrees(tag, "lat", 90.0, line)?));
                self.point_depth = self.depth;
                self.time_s = None;
            }
            // Extensions may have elements of the same names.
            b"time" if self.point.is_some() && is_below(self.point_depth) => {
                if self.time_s.is_some() {
                    return Err(second("time", line));
                }
                self.text = Some(String::new());
            }
            b"name" if self.point.is_none() && is_below(self.track_depth) => {
                if self.track.as_ref().is_some_and(|track| track.name.is_some()) {
                    return Err(second("name", line));
                }
                self.text = self.track.is_some().then(String::new);
            }
            b"wpt" | b"rte" => self.others += 1,
            _ => {}
        }
        Ok(())
    }

    fn close(&mut self, name: &[u8], line: u32) -> Result<(), RecordedError> {
        self.depth = self.depth.saturating_sub(1);
        self.is_complete |= self.depth == 0;
        match name {
            b"time" => {
                if let (Some(text), Some(_)) = (self.text.take(), self.point) {
                    self.time_s = Some(instant::seconds(&text).ok_or_else(|| {
                        RecordedError::new(format!("`{}` is not a time", shortened(&text)))
                            .at(line)
                            .hint("times look like `2010-10-03T09:36:30Z`")
                    })?);
                }
            }
            b"name" => {
                if let (Some(text), Some(track)) = (self.text.take(), &mut self.track) {
                    track.name = Some(text).filter(|text| !text.is_empty());
                }
            }
            b"trkpt" => {
                let segment = self.track.as_mut().and_then(|track| track.segments.last_mut());
                match (self.point.take(), self.time_s.take(), segment) {
                    (Some(at), Some(time_s), Some(segment)) => segment.push(RecordedPoint { time_s, at, line }),
                    (Some(_), None, Some(_)) => self.untimed += 1,
                    (Some(_), _, None) => self.astray += 1,
                    (None, ..) => {}
                }
            }
            b"trk" => self.close_track(),
            _ => {}
        }
        Ok(())
    }

    fn close_track(&mut self) {
        let Some(track) = self.track.take() else { return };
        let name = track.name.unwrap_or_else(|| format!("track {}", self.track_count));
        for (part, points) in track.segments.into_iter().filter(|points| !points.is_empty()).enumerate() {
            let id = if part == 0 { name.clone() } else { format!("{name} / {}", part + 1) };
            self.tracks.push(RecordedTrack { id, points });
        }
    }

    fn finished(self) -> Recording {
        let mut recording = Recording { tracks: self.tracks, is_geographic: true, warnings: vec![] };
        for (count, what) in [
            (self.untimed, "points without a time are left out"),
            (self.astray, "points outside of a `<trkseg>` are left out"),
            (self.others, "way points and routes are left out: they say no times"),
        ] {
            if count > 0 {
                recording.warnings.push(format!("{count} {what}"));
            }
        }
        recording
    }
}

/// An element that its parent has already, or that is within itself.
fn second(name: &str, line: u32) -> RecordedError {
    RecordedError::new(format!("a second `<{name}>` where one may be"))
        .at(line)
        .hint("leave one of the two out, or export the tracks as GPX again")
}

fn degrees(tag: &BytesStart<'_>, key: &str, most: f64, line: u32) -> Result<f64, RecordedError> {
    let found = tag.try_get_attribute(key).ok().flatten();
    let text = found.and_then(|it| it.normalized_value(XmlVersion::Implicit1_0).ok().map(|text| text.into_owned()));
    let text = text.unwrap_or_default();
    let value = text.trim().parse().ok().filter(|value: &f64| value.abs() <= most);
    value.ok_or_else(|| {
        RecordedError::new(format!("`{key}` is `{}`; it must be a number within -{most} and {most}", shortened(&text)))
            .at(line)
            .hint("every `trkpt` has `lat` and `lon` in degrees")
    })
}

/// Counts the lines up to a place that only moves on.
struct Lines<'a> {
    text: &'a [u8],
    at: usize,
    line: u32,
}

impl<'a> Lines<'a> {
    fn of(text: &'a str) -> Self {
        Self { text: text.as_bytes(), at: 0, line: 1 }
    }

    fn at(&mut self, at: usize) -> u32 {
        let passed = self.text.get(self.at..at).unwrap_or_default();
        self.line += passed.iter().filter(|byte| **byte == b'\n').count() as u32;
        self.at = self.at.max(at);
        self.line
    }
}
