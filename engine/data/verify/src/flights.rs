//! All flights, side by side: table `frames` with the tables beside it, and the log of each flight.

use super::bodies::{BodiesIndex, SpaceOfFlight};
use super::body::PlacedBody;
use super::checks::OF_FLIGHTS;
use super::files::{CheckedFiles, State};
use super::flight_rows::FlightRows;
use super::log::{self, Known};
use super::options::Wanted;
use super::report::VerifyReport;
use super::resume::ResumeFile;
use super::rows::{self, PlacedFlight, PlacedFrame};
use super::tables::SmallTables;
use cosfly_diagnose::Result;
use cosfly_domain::OrientedBox;
use cosfly_frames::DVec3;
use cosfly_read::{FlightTrack, RowIndex, Rows as TableRows};
use cosfly_schema::tables::{self, Objects};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

/// Flights of one file that are checked side by side.
const TOGETHER: usize = 16;
/// Files of table `frames` whose findings are joined at a time, per thread.
const FILES_PER_THREAD: usize = 16;

/// Digest of the motion of a flight.
pub type Motion = [u8; 16];

/// The digest that a hasher holds.
pub fn motion_of(hasher: &blake3::Hasher) -> Motion {
    hasher.finalize().as_bytes()[..16].try_into().unwrap_or_default()
}

/// Callback for a row of table `objects`: its place, its town and its box.
type EachBox<'a> = &'a mut dyn FnMut(&TableRows<'_>, usize, String, OrientedBox) -> Result<()>;

/// The flights of a dataset and all that is known of them.
pub struct Flights<'a> {
    /// Folder of the dataset.
    pub folder: &'a Path,
    /// Its files.
    pub files: &'a CheckedFiles,
    /// Its small tables.
    pub tables: &'a SmallTables,
    /// The flights that are checked in full.
    pub wanted: &'a Wanted,
    resume: Option<ResumeFile>,
    index: RowIndex,
    bodies: BodiesIndex,
    in_space: BodiesIndex,
}

impl Flights<'_> {
    /// Gives each box of table `objects` with its town; damage of the table is reported elsewhere.
    pub fn each_box(&self, each: EachBox<'_>) {
        for file in self.files.sound_below("data/objects/") {
            let _ = rows::read(&self.folder.join(file), &tables::of_objects(), &mut |rows| {
                (0..rows.len()).try_for_each(|row| {
                    let shape = OrientedBox {
                        center_in_world: DVec3::from_array(rows.get(Objects::center_in_world_m, row)?),
                        half_extents_m: 0.5 * DVec3::from_array(rows.get(Objects::size_m, row)?),
                        yaw_rad: rows.get(Objects::yaw_deg, row)?.to_radians(),
                    };
                    each(rows, row, rows.get(Objects::town, row)?, shape)
                })
            });
        }
    }
}

/// A flight that was checked.
struct Checked {
    number: usize,
    first_row: usize,
    motion: Motion,
    report: VerifyReport,
    /// Size and time of change of the log, where it was read.
    log: Option<[u64; 2]>,
}

/// Rows of a flight, and what they are compared with.
struct Rows<'a> {
    file: &'a str,
    frames: &'a [PlacedFrame],
    bodies_file: &'a str,
    bodies: &'a [PlacedBody],
    in_space: Option<&'a SpaceOfFlight>,
    expert: Option<&'a FlightTrack>,
    film: Option<(&'a PlacedFlight, &'a FlightTrack)>,
}

impl<'a> Flights<'a> {
    /// The flights; finds their rows in table `frames`.
    pub fn new(
        folder: &'a Path,
        files: &'a CheckedFiles,
        tables: &'a SmallTables,
        wanted: &'a Wanted,
        resume: Option<ResumeFile>,
        report: &mut VerifyReport,
    ) -> Self {
        let mut index = RowIndex::default();
        for file in files.sound_below("data/frames/") {
            // Damage is found again, and reported, when all columns are read.
            let _ = index.add(folder.join(file), &|id| tables.flights.number(id));
        }
        let mut read =
            |table| BodiesIndex::read((folder, table), files, &tables.flights, &|number| index.has(number), report);
        let (bodies, in_space) = (read("bodies"), read("bodies_3d"));
        Self { folder, files, tables, wanted, resume, index, bodies, in_space }
    }

    /// Tracks of some flights; those whose rows are damaged are left out.
    pub fn tracks(&self, wanted: &BTreeSet<usize>) -> BTreeMap<usize, FlightTrack> {
        let number_of = |id: &str| self.tables.flights.number(id);
        self.index.tracks(wanted, &number_of).unwrap_or_else(|_| {
            let single = |number: &usize| self.index.tracks(&[*number].into(), &number_of).unwrap_or_default();
            wanted.iter().flat_map(single).collect()
        })
    }

    /// Whether table `frames` has rows of a flight.
    pub fn has_frames(&self, number: usize) -> bool {
        self.index.has(number)
    }

    /// Checks all wanted flights: rows of `frames`, the log of each, then other logs. Returns the motion of each flight by its
    /// number.
    ///
    /// # Errors
    /// A log is there and cannot be read, or the notes of the check cannot be written.
    pub fn check_all(
        &self,
        report: &mut VerifyReport,
        progress: &(dyn Fn(u64, u64) + Sync),
    ) -> Result<Vec<Option<Motion>>> {
        report.sample = self.wanted.sample();
        let all = report.sample.unwrap_or(self.tables.flights.len() as u64);
        let done = AtomicU64::new(0);
        let count = || progress(done.fetch_add(1, Ordering::Relaxed) + 1, all);
        let mut motions: Vec<Option<Motion>> = vec![None; self.tables.flights.len()];
        let files: Vec<&str> = self.files.sound_below("data/frames/").collect();
        for together in files.chunks(FILES_PER_THREAD * rayon::current_num_threads()) {
            let checked: Vec<Result<(Vec<Checked>, VerifyReport)>> =
                together.par_iter().map(|file| self.check_file(file, &count)).collect();
            for (file, checked) in together.iter().zip(checked) {
                let (flights, of_file) = checked?;
                for flight in flights {
                    let id = &self.tables.flights.at(flight.number).trajectory_id;
                    if motions[flight.number].is_some() {
                        let place = format!("row {}, `{id}`", flight.first_row);
                        report.find(file, place, "verify-duplicate", "its rows are apart");
                        continue;
                    }
                    motions[flight.number] = Some(flight.motion);
                    if let (Some(resume), Some(log)) = (&self.resume, flight.log) {
                        resume.note(id, log, &flight.report)?;
                    }
                    report.absorb(flight.report);
                }
                report.absorb(of_file);
            }
        }
        self.check_missing(&motions, report);
        self.check_other_logs(&motions, report)?;
        Ok(motions)
    }

    /// Checks the flights of one file of table `frames`.
    fn check_file(&self, file: &str, count: &(dyn Fn() + Sync)) -> Result<(Vec<Checked>, VerifyReport)> {
        let (mut report, mut checked) = (VerifyReport::default(), vec![]);
        let path = self.folder.join(file);
        if self.wanted.sample().is_some() && !self.has_wanted(&path) {
            if let Err(message) = rows::check_columns(&path, &rows::table("frames")) {
                report.find(file, "", "verify-schema", message);
            }
            return Ok((checked, report));
        }
        let mut batch: Vec<Vec<PlacedFrame>> = vec![];
        let mut seen: BTreeSet<usize> = BTreeSet::new();
        let mut outcome_of_logs = Ok(());
        let mut work =
            |batch: &mut Vec<Vec<PlacedFrame>>| match self.check_together(file, &std::mem::take(batch), count) {
                Ok(flights) => checked.extend(flights),
                Err(refusal) => outcome_of_logs = Err(refusal),
            };
        let outcome = rows::frames(&path, &mut |frames| {
            let id = &frames[0].trajectory_id;
            let place = || format!("row {}, `{id}`", frames[0].row);
            let Some(number) = self.tables.flights.number(id) else {
                return report.find(file, place(), "verify-reference", "there is no such flight");
            };
            if !seen.insert(number) {
                return report.find(file, place(), "verify-duplicate", "its rows are apart");
            }
            if self.wanted.has(number) {
                batch.push(frames);
                if batch.len() == TOGETHER {
                    work(&mut batch);
                }
            }
        });
        work(&mut batch);
        outcome_of_logs?;
        if let Err(message) = outcome {
            report.find(file, "", "verify-schema", message);
        }
        Ok((checked, report))
    }

    /// Whether a file of table `frames` holds a flight of the sample.
    fn has_wanted(&self, path: &Path) -> bool {
        let file = self.index.files().iter().position(|it| it == path);
        file.is_none_or(|file| self.index.numbers_in(file).iter().any(|number| self.wanted.has(*number as usize)))
    }

    fn check_together(
        &self,
        file: &str,
        batch: &[Vec<PlacedFrame>],
        count: &(dyn Fn() + Sync),
    ) -> Result<Vec<Checked>> {
        let flights = &self.tables.flights;
        let number = |frames: &[PlacedFrame]| flights.number(&frames[0].trajectory_id).unwrap_or_default();
        let numbers: BTreeSet<usize> = batch.iter().map(|frames| number(frames)).collect();
        let expert = |number: usize| flights.number(flights.at(number).expert_id.as_ref()?);
        let film = |number: usize| self.tables.films.get(&flights.at(number).flight_id).filter(|film| **film != number);
        let beside = |number: &usize| [expert(*number), film(*number).copied()];
        let tracks = self.tracks(&numbers.iter().flat_map(beside).flatten().collect());
        let bodies = self.bodies.of(&numbers, flights);
        let in_space = self.in_space.in_space(&numbers, flights);
        let check = |frames: &Vec<PlacedFrame>| {
            let number = number(frames);
            let (bodies_file, bodies) = bodies.get(&number).map_or(("", &[][..]), |(file, rows)| (file, rows));
            let expert = expert(number).and_then(|number| tracks.get(&number));
            let film = film(number).and_then(|film| Some((flights.at(*film), tracks.get(film)?)));
            let checked = self.check_flight(
                number,
                &Rows { file, frames, bodies_file, bodies, in_space: in_space.get(&number), expert, film },
            );
            count();
            checked
        };
        batch.par_iter().map(check).collect()
    }

    /// Checks the rows and the log of a flight.
    fn check_flight(&self, number: usize, rows: &Rows<'_>) -> Result<Checked> {
        self.files.stop.check("verify")?;
        let (frames, others) = (rows.frames, rows.bodies);
        let flight = self.tables.flights.at(number);
        let id = &flight.trajectory_id;
        let mut hasher = blake3::Hasher::new();
        for frame in frames {
            hasher.update(&frame.motion_bytes());
        }
        let mut checked = Checked {
            number,
            first_row: frames[0].row,
            motion: motion_of(&hasher),
            report: VerifyReport::default(),
            log: None,
        };
        let log = self.resume.as_ref().and_then(|_| ResumeFile::log_state(&self.folder.join(&flight.mcap_path)));
        if let Some(known) = self.resume.as_ref().zip(log).and_then(|(resume, log)| resume.known(id, log)) {
            checked.report = known;
            return Ok(checked);
        }
        checked.log = log;
        let report = &mut checked.report;
        let objects = self.tables.instances.get(&flight.town);
        let all = FlightRows {
            file: rows.file,
            flight,
            frames,
            bodies_file: rows.bodies_file,
            bodies: others,
            in_space: rows.in_space,
            objects,
            pairs: &self.tables.pairs,
            losses: self.tables.losses.get(&number).map_or(&[], Vec::as_slice),
            extent: self.tables.extents.get(&flight.town),
            expert: rows.expert,
            film: rows.film,
        };
        OF_FLIGHTS.iter().for_each(|check| check(&all, report));
        if self.files.check_log(self.folder, &flight.mcap_path, report)? >= State::Regular {
            let captions = self.tables.captions.of(number);
            let boxes = rows.in_space.map_or(0, |(_, boxes)| boxes.len());
            log::check(
                self.folder,
                flight,
                frames,
                &Known { captions, objects, others, boxes, stop: &self.files.stop },
                report,
            );
        }
        report.flights += 1;
        report.frames += frames.len() as u64;
        Ok(checked)
    }

    fn check_missing(&self, motions: &[Option<Motion>], report: &mut VerifyReport) {
        for (number, flight) in self.tables.flights.iter().enumerate() {
            let is_missing = if self.wanted.has(number) { motions[number].is_none() } else { !self.has_frames(number) };
            if is_missing {
                let place = format!("row {}, `{}`", flight.place.1, flight.trajectory_id);
                report.find(&flight.place.0, place, "verify-count", "table `frames` has no readable rows of it");
            }
        }
    }

    /// Checks the logs that were not read with a flight: sizes outside of the sample, otherwise hashes.
    fn check_other_logs(&self, motions: &[Option<Motion>], report: &mut VerifyReport) -> Result<()> {
        let flights = || self.tables.flights.iter().enumerate();
        let of = |chosen: &dyn Fn(usize) -> bool| -> BTreeSet<&str> {
            flights().filter(|(number, _)| chosen(*number)).map(|(_, flight)| flight.mcap_path.as_str()).collect()
        };
        let read = of(&|number| motions[number].is_some());
        let by_size = of(&|number| !self.wanted.has(number));
        let others: Vec<&str> = self.files.logs().filter(|path| !read.contains(path)).collect();
        let check = |path: &&str| {
            let mut report = VerifyReport::default();
            if by_size.contains(path) {
                self.files.check_size(self.folder, path, &mut report)?;
            } else {
                self.files.check_log(self.folder, path, &mut report)?;
            }
            Ok(report)
        };
        let checked: Vec<Result<VerifyReport>> = others.par_iter().map(check).collect();
        checked.into_iter().try_for_each(|checked| checked.map(|checked| report.absorb(checked)))
    }
}
