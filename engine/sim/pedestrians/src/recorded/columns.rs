//! Tracks in columns: ETH/UCY `obsmat` and CSV.

use super::{RecordedConfig, RecordedError, RecordedPoint, RecordedTrack, Recording};
use cosfly_diagnose::{counted, plausible};
use cosfly_frames::DVec2;
use std::collections::BTreeMap;

/// Frames in a second of the videos of ETH and UCY.
const OBSMAT_RATE_HZ: f64 = 25.0;

/// Largest time, by any clock: nanoseconds since 1970 are 2e18.
const LATEST: f64 = 1e19;

/// Columns of `obsmat`: frame, id, x, z (height), y, velocities.
const OBSMAT_COLUMNS: usize = 8;

/// Tracks by id, in the order of their first rows.
#[derive(Default)]
struct Rows {
    tracks: Vec<RecordedTrack>,
    places: BTreeMap<String, usize>,
}

impl Rows {
    fn add(&mut self, id: &str, point: RecordedPoint) {
        let place = match self.places.get(id) {
            Some(&place) => place,
            None => {
                self.places.insert(id.to_owned(), self.tracks.len());
                self.tracks.push(RecordedTrack { id: id.to_owned(), points: vec![] });
                self.tracks.len() - 1
            }
        };
        self.tracks[place].points.push(point);
    }

    fn recording(self) -> Recording {
        Recording { tracks: self.tracks, is_geographic: false, warnings: vec![] }
    }
}

fn number(text: &str, column: &str, line: u32) -> Result<f64, RecordedError> {
    let text = text.trim();
    let refused =
        |what: &str| RecordedError::new(format!("`{}` in column `{column}` {what}", shortened(text))).at(line);
    let value = text.parse().ok().filter(|value: &f64| value.is_finite());
    let value: f64 = value.ok_or_else(|| {
        refused("is not a finite number").hint(match column {
            _ if text.contains(',') => "write decimals with a point, as in `10.5`",
            "t" | "frame" => "times are seconds from any beginning, or numbers of frames with `rate_hz`",
            "id" => "people of `obsmat` files are numbers",
            _ => "leave out the rows in which a person has no place",
        })
    })?;
    if matches!(column, "x" | "y") && plausible(value).is_err() {
        return Err(refused("is no place in metres: it must be between -1e9 and 1e9").hint("leave out broken rows"));
    }
    if value.abs() > LATEST {
        return Err(refused("is no time or number: it must be between -1e19 and 1e19").hint("leave out broken rows"));
    }
    Ok(value)
}

/// Text of a message, cut to a readable length.
pub(super) fn shortened(text: &str) -> String {
    let cut: String = text.chars().take(40).collect();
    if cut.len() < text.len() { cut + "..." } else { cut }
}

/// Lines that are not empty and no comment, with their numbers.
fn rows(text: &str) -> impl Iterator<Item = (u32, &str)> {
    let lines = (1_u32..).zip(text.lines());
    lines.filter(|(_, line)| !line.trim().is_empty() && !line.trim_start().starts_with('#'))
}

pub(super) fn read_obsmat(text: &str, config: &RecordedConfig) -> Result<Recording, RecordedError> {
    let rate_hz = config.rate_hz.unwrap_or(OBSMAT_RATE_HZ);
    let mut read = Rows::default();
    for (line, row) in rows(text) {
        let cells: Vec<&str> = row.split_whitespace().take(OBSMAT_COLUMNS + 1).collect();
        if cells.len() != OBSMAT_COLUMNS {
            let message =
                format!("a row of an `obsmat` file has {OBSMAT_COLUMNS} numbers; this one has {}", cells.len());
            return Err(RecordedError::new(message)
                .at(line)
                .hint("the file may be cut off; if it is CSV, set `format = \"csv\"`"));
        }
        let time_s = number(cells[0], "frame", line)? / rate_hz;
        number(cells[1], "id", line)?;
        let at = DVec2::new(number(cells[2], "x", line)?, number(cells[4], "y", line)?);
        let id = cells[1].parse::<f64>().map_or_else(|_| cells[1].to_owned(), |id| id.to_string());
        read.add(&id, RecordedPoint { time_s, at, line });
    }
    Ok(read.recording())
}

pub(super) fn read_csv(text: &str, config: &RecordedConfig) -> Result<Recording, RecordedError> {
    let mut read = Rows::default();
    let mut rows = rows(text).peekable();
    let Some((first_line, first)) = rows.peek().copied() else { return Ok(read.recording()) };
    let separator = [';', ','].into_iter().find(|sign| first.contains(*sign));
    let width = cells(first, separator).count();
    let mut columns = [0, 1, 2, 3];
    let has_header = cells(first, separator).next().is_some_and(|cell| cell.parse::<f64>().is_err());
    if has_header {
        columns = header(first, separator, config).map_err(|error| error.at(first_line))?;
        rows.next();
    }
    let count = columns.iter().max().map_or(0, |last| last + 1);
    for (line, row) in rows {
        let cells: Vec<&str> = cells(row, separator).take(count).collect();
        if cells.len() < count {
            let message = format!("the row has {}; {count} are needed", counted(cells.len(), "column"));
            return Err(RecordedError::new(message).at(line).hint("a row is time, id, x, y with commas between"));
        }
        // Decimals with a comma would move all columns behind them.
        if self::cells(row, separator).skip(width).any(|cell| !cell.is_empty()) {
            let message = format!("the row has more columns than the first line, which has {width}");
            return Err(RecordedError::new(message)
                .at(line)
                .hint("write decimals with a point, as in `10.5`, and ids without separators"));
        }
        let [time, id, x, y] = columns.map(|column| cells[column]);
        let time_s = number(time, "t", line)? / config.rate_hz.unwrap_or(1.0);
        let at = DVec2::new(number(x, "x", line)?, number(y, "y", line)?);
        read.add(id, RecordedPoint { time_s, at, line });
    }
    let mut recording = read.recording();
    if !has_header {
        recording.warnings.push("the file has no header: its columns count as time, id, x, y".to_owned());
    }
    Ok(recording)
}

/// Cells of a row between separators; without one, between white space.
fn cells(row: &str, separator: Option<char>) -> impl Iterator<Item = &str> {
    let is_between = move |sign: char| separator.map_or(sign.is_whitespace(), |separator| sign == separator);
    let pieces = row.split(is_between).map(unquoted);
    pieces.filter(move |cell| separator.is_some() || !cell.is_empty())
}

fn unquoted(cell: &str) -> &str {
    let cell = cell.trim();
    cell.strip_prefix('"').and_then(|cell| cell.strip_suffix('"')).unwrap_or(cell)
}

/// Places of the columns time, id, x, y in a header.
fn header(row: &str, separator: Option<char>, config: &RecordedConfig) -> Result<[usize; 4], RecordedError> {
    const NAMES: [&[&str]; 4] = [
        &["t", "time", "time_s", "frame", "frame_id", "timestamp"],
        &[
            "id",
            "person",
            "person_id",
            "ped",
            "ped_id",
            "pedestrian",
            "pedestrian_id",
            "agent",
            "agent_id",
            "track",
            "track_id",
        ],
        &["x", "x_m"],
        &["y", "y_m"],
    ];
    let cells: Vec<String> = cells(row, separator).map(str::to_lowercase).collect();
    let is_in_degrees =
        cells.iter().any(|cell| matches!(cell.as_str(), "lat" | "lon" | "lng" | "latitude" | "longitude"));
    let hint = if is_in_degrees {
        "columns hold metres; degrees are read from GPX and GeoJSON"
    } else {
        "name the columns `t`, `id`, `x`, `y`, in any order, or leave the header out"
    };
    let mut columns = [0; 4];
    for (column, names) in columns.iter_mut().zip(NAMES) {
        let mut found = cells.iter().filter(|cell| names.contains(&cell.as_str()));
        if let (Some(first), Some(second)) = (found.next(), found.next()) {
            let message = format!("the header has two columns for `{}`: `{first}` and `{second}`", names[0]);
            return Err(RecordedError::new(message).hint("rename the one that is not to be read"));
        }
        let place = cells.iter().position(|cell| names.contains(&cell.as_str()));
        *column =
            place.ok_or_else(|| RecordedError::new(format!("the header has no column `{}`", names[0])).hint(hint))?;
    }
    let time = &cells[columns[0]];
    if time.starts_with("frame") && config.rate_hz.is_none() {
        let message = format!("the column `{time}` counts frames, and nothing says how many there are in a second");
        return Err(RecordedError::new(message).hint("set `rate_hz`: to 1 where the column holds seconds"));
    }
    Ok(columns)
}
