//! Table `bodies`: the bodies around the target, against frames, objects and pixels.

use super::body::{Body, PlacedBody, SLACK_PX, size_problem};
use super::boxes::hull_of;
use super::files::CheckedFiles;
use super::film::Film;
use super::flight_list::FlightList;
use super::report::VerifyReport;
use super::rows::{self, PlacedFlight, PlacedFrame, split_of};
use cosfly_diagnose::counted;
use cosfly_domain::BodyKind;
use cosfly_frames::{DVec3, real};
use cosfly_read::{RowIndex, SpaceRow};
use cosfly_schema::tables::{Bodies, Bodies3d};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Places of each flight's bodies in table `bodies`, however the table is cut into files.
pub struct BodiesIndex {
    index: RowIndex,
    /// Path of each file from the dataset's folder.
    names: Vec<String>,
}

/// File and rows of table `bodies_3d` of a flight.
pub type SpaceOfFlight = (String, Vec<(usize, SpaceRow)>);
/// File and bodies of a flight, in the order of their rows.
pub type BodiesOfFlight = (String, Vec<PlacedBody>);

impl BodiesIndex {
    /// Checks a table of bodies as a whole and finds the rows of each flight; `has_frames` tells whether a flight has frames.
    pub fn read(
        (folder, table): (&Path, &str),
        files: &CheckedFiles,
        flights: &FlightList,
        has_frames: &dyn Fn(usize) -> bool,
        report: &mut VerifyReport,
    ) -> Self {
        let mut bodies = Self { index: RowIndex::default(), names: vec![] };
        let below = format!("data/{table}/");
        let names: Vec<&str> = files.sound_below(&below).collect();
        let read = |name: &&str| rows::read(&folder.join(name), &rows::table(table), &mut |_| Ok(()));
        let outcomes: Vec<rows::ReadResult<()>> = names.par_iter().map(read).collect();
        for (name, outcome) in names.into_iter().zip(outcomes) {
            let added = outcome.and_then(|()| {
                let added = bodies.index.add(folder.join(name), &|id| flights.number(id));
                added.map_err(|refusal| refusal.message.clone())
            });
            match added {
                Err(message) => report.find(name, "", "verify-schema", message),
                Ok(unknown) => {
                    bodies.names.push(name.to_owned());
                    for id in unknown {
                        report.find(name, format!("`{id}`"), "verify-reference", "there is no such flight");
                    }
                }
            }
        }
        for (file, name) in bodies.names.iter().enumerate() {
            for flight in bodies.index.numbers_in(file).iter().map(|number| *number as usize) {
                let it = flights.at(flight);
                let mut find = |rule, message| report.find(name, format!("`{}`", it.trajectory_id), rule, message);
                if !has_frames(flight) {
                    find("verify-reference", "its frames are not in table `frames`");
                } else if split_of(&it.place.0) != split_of(name) {
                    find("verify-split", "its flight is in another split");
                }
            }
        }
        bodies
    }

    /// Rows of table `bodies_3d` of some flights, each with its number in the file.
    pub fn in_space(&self, wanted: &BTreeSet<usize>, flights: &FlightList) -> BTreeMap<usize, SpaceOfFlight> {
        let mut found: BTreeMap<usize, SpaceOfFlight> = BTreeMap::new();
        for (file, name) in self.names.iter().enumerate() {
            let numbers = self.index.numbers_in(file).iter().map(|number| *number as usize);
            found.extend(numbers.filter(|it| wanted.contains(it)).map(|number| (number, (name.clone(), vec![]))));
        }
        // The rows could be read before; what cannot be read now is missing in the comparison with the bodies seen.
        let _ = self.index.visit(wanted, &mut |rows, path| {
            let (ids, first) = (rows.values(Bodies3d::trajectory_id)?, rows.first());
            let file = self.index.files().iter().position(|it| it == path).map_or("", |file| &self.names[file]);
            for row in 0..rows.len() {
                let number = flights.number(ids.text(row)).filter(|number| wanted.contains(number));
                if let Some(number) = number {
                    let list = &mut found.entry(number).or_insert_with(|| (file.to_owned(), vec![])).1;
                    list.push((first + row, SpaceRow::read(rows, row)?));
                }
            }
            Ok(())
        });
        found
    }

    /// Bodies of some flights.
    pub fn of(&self, wanted: &BTreeSet<usize>, flights: &FlightList) -> BTreeMap<usize, BodiesOfFlight> {
        let mut found: BTreeMap<usize, BodiesOfFlight> = BTreeMap::new();
        // The rows could be read before; what cannot be read now is missing in the comparison with the pictures.
        let _ = self.index.visit(wanted, &mut |rows, path| {
            let (ids, first) = (rows.values(Bodies::trajectory_id)?, rows.first());
            let file = self.index.files().iter().position(|it| it == path).map_or("", |file| &self.names[file]);
            for row in 0..rows.len() {
                let Some(number) = flights.number(ids.text(row)).filter(|number| wanted.contains(number)) else {
                    continue;
                };
                let [length_m, width_m, height_m] = rows.get(Bodies::size_m, row)?;
                let kind = rows.get(Bodies::kind, row)?;
                let kind = BodyKind::ON_THE_GROUND.iter().copied().find(|it| it.name() == kind);
                let is_person = kind.is_some_and(BodyKind::is_person);
                found.entry(number).or_insert_with(|| (file.to_owned(), vec![])).1.push(PlacedBody {
                    row: first + row,
                    frame: rows.get(Bodies::frame, row)?,
                    instance: rows.get(Bodies::instance, row)?,
                    pixels: rows.get(Bodies::visible_pixels, row)?,
                    visible_box: rows.get(Bodies::visible_box_px, row)?.map(|edges| edges.map(f64::from)),
                    body_id: rows.get(Bodies::body_id, row)?,
                    kind,
                    size_m: DVec3::new(length_m, width_m, height_m),
                    heading_rad: rows.get(Bodies::heading_deg, row)?.to_radians(),
                    space: Body {
                        feet: DVec3::from_array(rows.get(Bodies::feet_in_world_m, row)?),
                        height_m,
                        // A circle around the outline of a vehicle.
                        radius_m: if is_person { 0.5 * length_m } else { 0.5 * real::hypot(length_m, width_m) },
                        has_umbrella: rows.get(Bodies::has_umbrella, row)?.unwrap_or(false),
                    },
                });
            }
            Ok(())
        });
        found
    }
}

/// Order, ids and boxes of the bodies around one flight; the pixels are compared with the log.
pub fn check(
    file: &str,
    flight: &PlacedFlight,
    frames: &[PlacedFrame],
    bodies: &[PlacedBody],
    objects: Option<&BTreeSet<u32>>,
    report: &mut VerifyReport,
) {
    let film = Film { flight, frames, others: bodies, readout: None };
    let largest = objects.and_then(|ids| ids.last().copied()).unwrap_or(1).max(1);
    let mut ids: BTreeMap<u32, &str> = BTreeMap::new();
    let mut last = None;
    for body in bodies {
        let place = || format!("row {}, `{}` frame {}", body.row, flight.trajectory_id, body.frame);
        let mut find = |rule, message| report.find(file, place(), rule, message);
        if last.is_some_and(|last| last >= (body.frame, &body.body_id)) {
            find("verify-order", "the rows of a flight are in the order of frames and ids".to_owned());
        }
        last = Some((body.frame, &body.body_id));
        let DVec3 { x, y, z } = body.size_m;
        if let Some(message) = body.kind.and_then(|kind| size_problem(kind, z, Some([x, y]))) {
            find("verify-kind", message);
        }
        if let Some(instance) = body.instance {
            if instance <= largest {
                find("verify-reference", format!("the id {instance} is not after those of all objects"));
            }
            if *ids.entry(instance).or_insert(&body.body_id) != body.body_id {
                find("verify-duplicate", format!("a second body has the id {instance}"));
            }
        }
        match frames.get(body.frame as usize) {
            None => find("verify-reference", "the flight has no such frame".to_owned()),
            Some(_) => {
                if let Some(message) = box_problem(&film, body) {
                    find("verify-reprojection", message);
                }
            }
        }
    }
}

/// Whether the box of the visible pixels lies in the projected body.
fn box_problem(film: &Film, body: &PlacedBody) -> Option<String> {
    let (seen, instance) = match (body.pixels, body.visible_box, body.instance) {
        (0, None, _) => return None,
        (1.., Some(seen), Some(instance)) => (seen, instance),
        (pixels, ..) => {
            return Some(format!(
                "it is seen in {}: with pixels there are a box and an id, without none",
                counted(pixels, "pixel")
            ));
        }
    };
    let hull = hull_of(film.flight, &film.sights(body.frame as usize, instance, &body.space))?;
    let fits = seen[0] >= hull[0] - SLACK_PX
        && seen[1] >= hull[1] - SLACK_PX
        && seen[2] <= hull[2] + SLACK_PX
        && seen[3] <= hull[3] + SLACK_PX;
    (!fits).then(|| format!("the box {seen:?} leaves the projected body {hull:.1?}"))
}
