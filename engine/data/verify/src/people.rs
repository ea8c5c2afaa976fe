//! Table `people`: all people seen beside the target, against frames, objects and pixels.

use super::body::{Body, SLACK_PX};
use super::files::CheckedFiles;
use super::flight_list::FlightList;
use super::report::VerifyReport;
use super::rows::{self, PlacedFlight, PlacedFrame, split_of};
use cosfly_frames::DVec3;
use cosfly_read::RowIndex;
use cosfly_schema::tables::People;
use rayon::prelude::*;
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
    has_umbrella: bool,
}

impl PersonRow {
    /// Point between the feet in the world, and height, metres.
    pub fn feet_and_height(&self) -> (DVec3, f64) {
        let [x, y, z, height_m, _] = self.body;
        (DVec3::new(x, y, z), height_m)
    }

    fn body(&self) -> Body {
        let [x, y, z, height_m, radius_m] = self.body;
        Body { feet: DVec3::new(x, y, z), height_m, radius_m, has_umbrella: self.has_umbrella }
    }
}

/// Where the people of each flight are in table `people`, however the table is cut into files.
pub struct PeopleIndex {
    index: RowIndex,
    /// Path of each file from the dataset's folder.
    names: Vec<String>,
}

/// File and people of a flight, in the order of their rows.
pub type PeopleOfFlight = (String, Vec<PersonRow>);

impl PeopleIndex {
    /// Checks the table as a whole and finds the people of each flight; `has_frames` tells whether a flight has frames.
    pub fn read(
        folder: &Path,
        files: &CheckedFiles,
        flights: &FlightList,
        has_frames: &dyn Fn(usize) -> bool,
        report: &mut VerifyReport,
    ) -> Self {
        let mut people = Self { index: RowIndex::default(), names: vec![] };
        let names: Vec<&str> = files.sound_below("data/people/").collect();
        let read = |name: &&str| rows::read(&folder.join(name), &rows::table("people"), &mut |_| Ok(()));
        let outcomes: Vec<rows::ReadResult<()>> = names.par_iter().map(read).collect();
        for (name, outcome) in names.into_iter().zip(outcomes) {
            let added = outcome.and_then(|()| {
                let added = people.index.add(folder.join(name), &|id| flights.number(id));
                added.map_err(|refusal| refusal.message.clone())
            });
            match added {
                Err(message) => report.find(name, "", "verify-schema", message),
                Ok(unknown) => {
                    people.names.push(name.to_owned());
                    for id in unknown {
                        report.find(name, format!("`{id}`"), "verify-reference", "there is no such flight");
                    }
                }
            }
        }
        for (file, name) in people.names.iter().enumerate() {
            for flight in people.index.numbers_in(file).iter().map(|number| *number as usize) {
                let it = flights.at(flight);
                let mut find = |rule, message| report.find(name, format!("`{}`", it.trajectory_id), rule, message);
                if !has_frames(flight) {
                    find("verify-reference", "its frames are not in table `frames`");
                } else if split_of(&it.place.0) != split_of(name) {
                    find("verify-split", "its flight is in another split");
                }
            }
        }
        people
    }

    /// People of some flights.
    pub fn of(&self, wanted: &BTreeSet<usize>, flights: &FlightList) -> BTreeMap<usize, PeopleOfFlight> {
        let mut found: BTreeMap<usize, PeopleOfFlight> = BTreeMap::new();
        // The rows could be read before; what cannot be read now is missing in the comparison with the pictures.
        let _ = self.index.visit(wanted, &mut |rows, path| {
            let (ids, first) = (rows.values(People::trajectory_id)?, rows.first());
            let file = self.index.files().iter().position(|it| it == path).map_or("", |file| &self.names[file]);
            for row in 0..rows.len() {
                let Some(number) = flights.number(ids.text(row)).filter(|number| wanted.contains(number)) else {
                    continue;
                };
                let [x, y, z] = rows.get(People::feet_in_world_m, row)?;
                found.entry(number).or_insert_with(|| (file.to_owned(), vec![])).1.push(PersonRow {
                    row: first + row,
                    frame: rows.get(People::frame, row)?,
                    instance: rows.get(People::instance, row)?,
                    pixels: rows.get(People::visible_pixels, row)?,
                    visible_box: rows.get(People::visible_box_px, row)?.map(f64::from),
                    walk_id: rows.get(People::walk_id, row)?,
                    body: [x, y, z, rows.get(People::height_m, row)?, rows.get(People::radius_m, row)?],
                    has_umbrella: rows.get_or(People::has_umbrella, row, false)?,
                });
            }
            Ok(())
        });
        found
    }
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
