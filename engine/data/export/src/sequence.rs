//! Sequences of numbered pictures, as trackers read them, and the list that leads from their numbers back to the dataset.

use crate::folder::OutFolder;
use crate::pixels::{rgb_jpeg, rgb_of};
use crate::source::ExportedFlight;
use cosfly_diagnose::Result;
use cosfly_read::LoggedFrame;
use cosfly_schema::tables::Edges;
use serde_json::json;

/// Quality of pictures that the dataset has as PNG.
const JPEG_QUALITY: u8 = 95;

/// Frames of a flight that become pictures 1, 2, 3 and so on.
pub struct Sequence<'a> {
    /// Name in the export.
    pub name: String,
    /// The flight.
    pub episode: &'a ExportedFlight<'a>,
    /// Numbers of the frames in the flight, ascending.
    pub frames: Vec<usize>,
    /// Distance from one of the frames to the next.
    pub every: usize,
}

impl Sequence<'_> {
    /// Writes the pictures as JPEG files; `path_of` names the file of a picture, which counts from 1.
    pub fn write_pictures(&self, out: &OutFolder, path_of: &(dyn Fn(usize) -> String + Sync)) -> Result<()> {
        let frames = &self.frames;
        let make = |frame: usize, logged: LoggedFrame| {
            let number = 1 + frames.partition_point(|it| *it < frame);
            let size = [logged.width, logged.height];
            let file = match logged.rgb_format.as_str() {
                "jpeg" => logged.rgb_file,
                _ => rgb_jpeg(&rgb_of(&logged)?, size, JPEG_QUALITY)?,
            };
            out.put(&path_of(number), &file)
        };
        self.episode.each_picture(frames, make, |_, ()| Ok(()))
    }

    /// Pictures per second, with at most six decimals.
    pub fn rate(&self) -> String {
        let rate = format!("{:.6}", 1.0 / (self.episode.flight.dt_s * self.every as f64));
        rate.trim_end_matches('0').trim_end_matches('.').to_owned()
    }
}

/// The file `sequences.jsonl`: the flight and the frames behind every sequence.
#[derive(Default)]
pub struct SequenceList {
    lines: String,
}

impl SequenceList {
    /// Adds a sequence.
    pub fn add(&mut self, sequence: &Sequence<'_>) {
        let flight = sequence.episode.flight;
        let line = json!({
            "sequence": sequence.name,
            "split": flight.split,
            "trajectory_id": flight.trajectory_id,
            "first_frame": sequence.frames.first(),
            "every": sequence.every,
            "pictures": sequence.frames.len(),
        });
        self.lines.push_str(&format!("{line}\n"));
    }

    /// Writes the file.
    pub fn write(&self, out: &OutFolder) -> Result<()> {
        out.put("sequences.jsonl", self.lines.as_bytes())
    }
}

/// Left, top, width and height of a box, pixels, with commas; the top-left pixel of a picture is (1, 1).
pub fn box_text([left, top, right, bottom]: Edges) -> String {
    format!("{},{},{},{}", left + 1.0, top + 1.0, right - left, bottom - top)
}

/// Text of cards about all sequences.
pub const CARD: &str = "\
Pictures count from 1 without gaps; `sequences.jsonl` has the flight, the first frame and the distance between frames of every
sequence: picture `n` is frame `first_frame + (n - 1) * every`. Boxes are left, top, width and height in pixels; as in these
benchmarks, the top-left pixel is (1, 1). A box is tight around the *visible* pixels. PNG pictures of the dataset become JPEG
files of quality 95.
";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_count_from_one() {
        assert_eq!(box_text([0.0, 0.0, 1.0, 1.0]), "1,1,1,1");
        assert_eq!(box_text([10.0, 20.0, 14.0, 27.0]), "11,21,4,7");
    }
}
