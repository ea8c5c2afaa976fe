//! Table `people`: all people seen beside the target, against frames, objects and pixels.

use super::body::{Body, SLACK_PX};
use super::files::{CheckedFiles, State};
use super::report::VerifyReport;
use super::rows::{self, PlacedFlight, PlacedFrame};
use cosfly_frames::DVec3;
use cosfly_schema::tables::People;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// A person seen in a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct PersonRow {
    /// Row in its file.
    pub row: usize,
    /// The frame.
    pub frame: u32,
    /// Id in instance images.
    pub instance: u32,
    /// Visible pixels.
    pub pixels: u32,
    /// Edges around the visible pixels: left, top, right, bottom.
    pub visible_box: [f64; 4],
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
    if files.state(&file) != State::Sound {
        if files.listed(&file).is_none() {
            report.find(&file, "", "verify-missing-file", "there is none beside the file of table `frames`");
        }
        return people;
    }
    let mut row_in_file = 0;
    let outcome = rows::read(&folder.join(&file), &rows::table("people"), &mut |rows| {
        for row in 0..rows.len() {
            let [x, y, z] = rows.get(People::feet_in_world_m, row)?;
            people.entry(rows.get(People::trajectory_id, row)?).or_default().push(PersonRow {
                row: row_in_file,
                frame: rows.get(People::frame, row)?,
                instance: rows.get(People::instance, row)?,
                pixels: rows.get(People::visible_pixels, row)?,
                visible_box: rows.get(People::visible_box_px, row)?.map(f64::from),
                walk_id: rows.get(People::walk_id, row)?,
                body: [x, y, z, rows.get(People::height_m, row)?, rows.get(People::radius_m, row)?],
            });
            row_in_file += 1;
        }
        Ok(())
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
    flight: &PlacedFlight,
    frames: &[PlacedFrame],
    people: &[PersonRow],
    objects: Option<&BTreeSet<u32>>,
    report: &mut VerifyReport,
) {
    let largest = objects.and_then(|ids| ids.last().copied()).unwrap_or(1).max(1);
    let mut ids: BTreeMap<u32, &str> = BTreeMap::new();
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
        let frame = frames.get(person.frame as usize);
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
fn box_problem(flight: &PlacedFlight, frame: &PlacedFrame, person: &PersonRow) -> Option<String> {
    let seen = person.visible_box;
    if person.pixels == 0 {
        return Some("a person of whom no pixel is seen has no row".into());
    }
    let hull = person.body().hull(flight, &frame.camera_pose)?;
    let fits = seen[0] >= hull[0] - SLACK_PX
        && seen[1] >= hull[1] - SLACK_PX
        && seen[2] <= hull[2] + SLACK_PX
        && seen[3] <= hull[3] + SLACK_PX;
    (!fits).then(|| format!("the box {seen:?} leaves the projected body {hull:.1?}"))
}
