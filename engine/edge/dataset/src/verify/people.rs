//! Table `people`: everybody beside the target who is seen, against frames, objects and pixels.

use super::files::CheckedFiles;
use super::flight::{Body, SLACK_PX};
use super::report::VerifyReport;
use super::rows::{self, FlightRow, FrameRow};
use crate::tables;
use cosfly_frames::DVec3;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Somebody who is seen in a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct PersonRow {
    /// Row in its file.
    pub row: usize,
    /// The frame.
    pub frame: i64,
    /// Id in instance images.
    pub instance: i64,
    /// Visible pixels.
    pub pixels: i64,
    /// Edges around them.
    pub visible_box: Option<[f64; 4]>,
    walk_id: String,
    body: [f64; 5],
}

impl PersonRow {
    fn body(&self) -> Body {
        let [x, y, z, height_m, radius_m] = self.body;
        Body { feet: DVec3::new(x, y, z), height_m, radius_m }
    }
}

/// The people of each flight of one file, in the order of their rows.
pub type PeopleOfFlights = BTreeMap<String, Vec<PersonRow>>;

/// Reads the people of the flights whose frames are in `frames_file`: both tables are cut alike.
pub fn read(folder: &Path, files: &CheckedFiles, frames_file: &str, report: &mut VerifyReport) -> PeopleOfFlights {
    let mut people = PeopleOfFlights::new();
    let file = file_beside(frames_file);
    if !files.sound.contains(&file) {
        if !files.listed.contains_key(&file) {
            report.find(&file, "", "verify-missing-file", "there is none beside the file of table `frames`");
        }
        return people;
    }
    let table = tables::of_trajectories().into_iter().find(|table| table.name == "people").expect("it exists");
    let mut row_in_file = 0;
    let outcome = rows::batches(&folder.join(&file), &table, &mut |batch| {
        for row in 0..batch.rows() {
            let integer = |name| batch.integer(name, row).unwrap_or(-1);
            let real = |name| batch.real(name, row).unwrap_or(f64::NAN);
            let [x, y, z] = batch.reals("feet_in_world_m", row).unwrap_or([f64::NAN; 3]);
            people.entry(batch.text("trajectory_id", row)).or_default().push(PersonRow {
                row: row_in_file,
                frame: integer("frame"),
                instance: integer("instance"),
                pixels: integer("visible_pixels"),
                visible_box: batch.pixel_box("visible_box_px", row),
                walk_id: batch.text("walk_id", row),
                body: [x, y, z, real("height_m"), real("radius_m")],
            });
            row_in_file += 1;
        }
    });
    if let Err(message) = outcome {
        report.find(&file, "", "verify-schema", message);
    }
    people
}

/// The file of table `people` that goes with a file of table `frames`.
pub fn file_beside(frames_file: &str) -> String {
    frames_file.replacen("data/frames/", "data/people/", 1)
}

/// Order, ids and boxes of the people of one flight; the pixels are compared with the log.
pub fn check(
    file: &str,
    flight: &FlightRow,
    frames: &[FrameRow],
    people: &[PersonRow],
    objects: Option<&BTreeSet<i64>>,
    report: &mut VerifyReport,
) {
    let largest = objects.and_then(|ids| ids.last().copied()).unwrap_or(1).max(1);
    let mut ids: BTreeMap<i64, &str> = BTreeMap::new();
    let mut last = None;
    for person in people {
        let place = || format!("row {}, `{}` frame {}", person.row, flight.trajectory_id, person.frame);
        if last.is_some_and(|last| last >= (person.frame, person.instance)) {
            report.find(file, place(), "verify-order", "the rows of a flight are in the order of frames and ids");
        }
        last = Some((person.frame, person.instance));
        if person.instance <= largest {
            let message = format!("the id {} is not after those of all objects", person.instance);
            report.find(file, place(), "verify-reference", message);
        }
        if *ids.entry(person.instance).or_insert(&person.walk_id) != person.walk_id {
            report.find(file, place(), "verify-duplicate", format!("a second walk has the id {}", person.instance));
        }
        let frame = usize::try_from(person.frame).ok().and_then(|frame| frames.get(frame));
        match frame {
            None => report.find(file, place(), "verify-reference", "the flight has no such frame"),
            Some(frame) => {
                if let Some(message) = box_problem(flight, frame, person) {
                    report.find(file, place(), "verify-reprojection", message);
                }
            }
        }
    }
}

/// Whether the box of the visible pixels lies in the projected body.
fn box_problem(flight: &FlightRow, frame: &FrameRow, person: &PersonRow) -> Option<String> {
    let (Some(seen), true) = (person.visible_box, person.pixels > 0) else {
        return Some("somebody of whom nothing is seen has no row".into());
    };
    let hull = person.body().hull(flight, &frame.camera_pose)?;
    let fits = seen[0] >= hull[0] - SLACK_PX
        && seen[1] >= hull[1] - SLACK_PX
        && seen[2] <= hull[2] + SLACK_PX
        && seen[3] <= hull[3] + SLACK_PX;
    (!fits).then(|| format!("the box {seen:?} leaves the projected body {hull:.1?}"))
}
