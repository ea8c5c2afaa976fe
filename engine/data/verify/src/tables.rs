//! Tables against each other: references, splits, counts, captions.

use super::captions::CaptionList;
use super::files::CheckedFiles;
use super::flight_list::FlightList;
use super::report::VerifyReport;
use super::rows::{self, PlacedFlight, ReadResult};
use super::sums;
use cosfly_diagnose::{Result, counted};
use cosfly_metrics::spread::{APART_M, widest_gap_m};
use cosfly_read::{Rows, Shared};
use cosfly_schema::tables::{self, Objects, Pairs, Rejected, TargetLosses};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

/// Rows of the small tables that later checks read.
pub struct SmallTables {
    /// Flights by name.
    pub flights: FlightList,
    /// Twins by name.
    pub pairs: BTreeMap<String, PairRow>,
    /// Losses of the target by number of the flight.
    pub losses: BTreeMap<usize, Vec<LossRow>>,
    /// Captions by flight.
    pub captions: CaptionList,
    /// Instance ids by town.
    pub instances: BTreeMap<String, BTreeSet<u32>>,
    /// The film with the most frames of each flight that several cameras film.
    pub films: BTreeMap<String, usize>,
    /// Extents of the objects by town: least and largest x and y, metres.
    pub extents: BTreeMap<String, Extent>,
}

/// Least and largest x and y, metres.
pub type Extent = [[f64; 2]; 2];

/// A row of table `pairs`.
pub struct PairRow {
    /// File and row it stands in.
    pub place: (Arc<str>, usize),
    expert_id: String,
    /// The pedestrian of both.
    pub pedestrian_id: String,
    /// Frames, position events, rotation events.
    pub counts: [u32; 3],
    /// Largest displacement, metres.
    pub max_offset_m: f64,
    /// Digest of the expert's frames of all frames.
    pub expert_frames: blake3::Hash,
}

/// A row of table `target_losses`.
#[derive(Clone)]
pub struct LossRow {
    /// File and row it stands in.
    pub place: (Arc<str>, usize),
    /// First frame, and the one after the last.
    pub frames: (u32, u32),
    /// Length, seconds.
    pub duration_s: f64,
    /// Instance id of the cause.
    pub cause_instance: u32,
    /// Frames in which the target is outside of the image.
    pub frames_out_of_view: u32,
    /// Whether the flight sees the target again.
    pub reacquired: bool,
    /// Others in its clothes in the frame in which it is seen again.
    pub look_alikes: Option<u32>,
}

/// Digest of frames of an expert.
pub fn digest(frames: impl Iterator<Item = i64>) -> blake3::Hash {
    let mut hasher = blake3::Hasher::new();
    for frame in frames {
        hasher.update(&frame.to_le_bytes());
    }
    hasher.finalize()
}

/// Reads the small tables and checks them against each other.
pub fn read(folder: &Path, files: &CheckedFiles, report: &mut VerifyReport) -> SmallTables {
    let flights = read_flights(folder, files, report);
    let captions = CaptionList::read(folder, files, &flights, report);
    let losses = read_losses(folder, files, &flights, report);
    let (pairs, instances, extents) = (BTreeMap::new(), BTreeMap::new(), BTreeMap::new());
    let films = most_frames(&flights);
    let mut small = SmallTables { flights, pairs, losses, captions, instances, films, extents };
    let rejected = read_rejected(folder, files, report);
    for flight in small.flights.iter().filter(|flight| rejected.contains(&flight.trajectory_id)) {
        report.find(
            "data/rejected",
            flight.trajectory_id.clone(),
            "verify-reference",
            "it is rejected and has a flight",
        );
    }
    read_objects(folder, files, &mut small, report);
    check_films(&small, report);
    read_pairs(folder, files, &mut small, report);
    small
}

fn note<T>(report: &mut VerifyReport, file: &str, outcome: ReadResult<T>) -> Option<T> {
    outcome.map_err(|message| report.find(file, "", "verify-schema", message)).ok()
}

fn read_flights(folder: &Path, files: &CheckedFiles, report: &mut VerifyReport) -> FlightList {
    let (mut flights, mut shared): (Vec<PlacedFlight>, _) = (vec![], Shared::default());
    for file in files.sound_below("data/trajectories/") {
        let outcome = rows::flights(&folder.join(file), file, &mut shared, &mut |flight, mcap| {
            if files.listed(&flight.mcap_path).is_none_or(|listed| listed != (mcap.0, &*mcap.1)) {
                let message = format!("`{}` is not in `files.parquet` with this size and hash", flight.mcap_path);
                let place = format!("row {}, `{}`", flight.place.1, flight.trajectory_id);
                report.find(file, place, "verify-reference", message);
            }
            sums::check_row(&flight, report);
            flights.push(flight);
        });
        note(report, file, outcome);
    }
    let flights = FlightList::of(flights, report);
    let logs = files.logs().count();
    if logs != flights.len() {
        let message =
            format!("{}, but {logs} in `files.parquet`", counted(flights.len(), "flight"), logs = counted(logs, "log"));
        report.find("data/trajectories", "", "verify-count", message);
    }
    flights
}

fn read_rejected(folder: &Path, files: &CheckedFiles, report: &mut VerifyReport) -> BTreeSet<String> {
    let mut rejected = BTreeSet::new();
    for file in files.sound_below("data/rejected/") {
        let mut rows: Vec<String> = vec![];
        let outcome = rows::read(&folder.join(file), &tables::of_rejections(), &mut |it| {
            (0..it.len()).try_for_each(|row| {
                rows.push(it.get(Rejected::trajectory_id, row)?);
                Ok(())
            })
        });
        note(report, file, outcome);
        for (row, id) in rows.into_iter().enumerate() {
            if !rejected.insert(id.clone()) {
                report.find(file, format!("row {row}, `{id}`"), "verify-duplicate", "a second row of this item");
            }
        }
    }
    rejected
}

fn read_objects(folder: &Path, files: &CheckedFiles, small: &mut SmallTables, report: &mut VerifyReport) {
    let mut places: BTreeMap<String, Vec<[f64; 2]>> = BTreeMap::new();
    for file in files.sound_below("data/objects/") {
        let outcome = rows::read(&folder.join(file), &tables::of_objects(), &mut |rows| {
            for row in 0..rows.len() {
                let town = rows.get(Objects::town, row)?;
                let [x, y, _] = rows.get(Objects::center_in_world_m, row)?;
                places.entry(town.clone()).or_default().push([x, y]);
                small.instances.entry(town).or_default().insert(rows.get(Objects::instance, row)?);
            }
            Ok(())
        });
        note(report, file, outcome);
    }
    for (town, places) in places {
        let extent = places.iter().fold([[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], |[low, high], place| {
            [[0, 1].map(|axis| low[axis].min(place[axis])), [0, 1].map(|axis| high[axis].max(place[axis]))]
        });
        small.extents.insert(town.clone(), extent);
        let gap_m = widest_gap_m(&places);
        if gap_m > APART_M {
            let message = format!("its things are {:.0} km apart", gap_m / 1000.0);
            report.find("data/objects", format!("town `{town}`"), "verify-town", message);
        }
    }
}

/// Rows of the same flight are behind one target, and in different weathers or by different cameras, else one of them is there twice.
fn check_films(small: &SmallTables, report: &mut VerifyReport) {
    let mut seen: BTreeMap<(&str, &str, Option<&str>), &str> = BTreeMap::new();
    let mut first_of: BTreeMap<&str, &PlacedFlight> = BTreeMap::new();
    for flight in small.flights.iter() {
        let id = &flight.trajectory_id;
        let first = *first_of.entry(&flight.flight_id).or_insert(flight);
        let target = |it: &PlacedFlight| (it.town.clone(), it.pedestrian_id.clone(), it.target_kind.clone());
        if target(first) != target(flight) {
            let (place, film) = (format!("row {}, `{id}`", flight.place.1), &first.trajectory_id);
            let message = format!("it shows flight `{}` as `{film}` does, behind another target", flight.flight_id);
            report.find(&flight.place.0, place, "verify-flight", message);
        }
        let film = (flight.flight_id.as_str(), flight.weather.as_str(), flight.camera_name.as_deref());
        if let Some(first) = seen.insert(film, id) {
            let place = format!("row {}, `{id}`", flight.place.1);
            let message = format!(
                "it shows flight `{}` in the same weather and by the same camera as `{first}`",
                flight.flight_id
            );
            report.find(&flight.place.0, place, "verify-duplicate", message);
        }
    }
}

/// The film of each flight with the most frames a second, of cameras of a rig.
fn most_frames(flights: &FlightList) -> BTreeMap<String, usize> {
    let mut films: BTreeMap<String, usize> = BTreeMap::new();
    for (number, flight) in flights.iter().enumerate().filter(|(_, flight)| flight.camera_name.is_some()) {
        let best = films.entry(flight.flight_id.clone()).or_insert(number);
        let rank = |number: usize| (flights.at(number).dt_s, flights.at(number).begins_ns);
        if rank(number) < rank(*best) {
            *best = number;
        }
    }
    films
}

fn read_pairs(folder: &Path, files: &CheckedFiles, small: &mut SmallTables, report: &mut VerifyReport) {
    for file in files.sound_below("data/pairs/") {
        let name: Arc<str> = file.into();
        let mut all = vec![];
        let outcome = rows::read(&folder.join(file), &rows::table("pairs"), &mut |rows| {
            (0..rows.len()).try_for_each(|row| {
                all.push(pair_row(rows, row)?);
                Ok(())
            })
        });
        note(report, file, outcome);
        for (row, (perturbed, mut pair)) in all.into_iter().enumerate() {
            pair.place = (Arc::clone(&name), row);
            let (place, expert) = (format!("row {row}, `{perturbed}`"), pair.expert_id.clone());
            let twin = small.flights.get(&perturbed);
            if twin.is_none_or(|twin| twin.expert_id.as_ref() != Some(&expert)) {
                report.find(
                    file,
                    place.clone(),
                    "verify-pair",
                    format!("table `trajectories` has no twin of `{expert}` so called"),
                );
            }
            if small.pairs.insert(perturbed, pair).is_some() {
                report.find(file, place, "verify-duplicate", "a second row of this twin");
            }
        }
    }
    check_experts(small, report);
}

fn read_losses(
    folder: &Path,
    files: &CheckedFiles,
    flights: &FlightList,
    report: &mut VerifyReport,
) -> BTreeMap<usize, Vec<LossRow>> {
    let mut losses: BTreeMap<usize, Vec<LossRow>> = BTreeMap::new();
    for file in files.sound_below("data/target_losses/") {
        let (name, mut place): (Arc<str>, usize) = (file.into(), 0);
        let mut unknown = vec![];
        let outcome = rows::read(&folder.join(file), &rows::table("target_losses"), &mut |rows| {
            for row in 0..rows.len() {
                let id = rows.get(TargetLosses::trajectory_id, row)?;
                let loss = loss_row(rows, row, (Arc::clone(&name), place))?;
                match flights.number(&id) {
                    Some(number) => losses.entry(number).or_default().push(loss),
                    None => unknown.push((place, id)),
                }
                place += 1;
            }
            Ok(())
        });
        note(report, file, outcome);
        for (row, id) in unknown {
            report.find(file, format!("row {row}, `{id}`"), "verify-reference", "there is no such flight");
        }
    }
    losses
}

fn loss_row(rows: &Rows<'_>, row: usize, place: (Arc<str>, usize)) -> Result<LossRow> {
    Ok(LossRow {
        place,
        frames: (rows.get(TargetLosses::start_frame, row)?, rows.get(TargetLosses::end_frame, row)?),
        duration_s: rows.get(TargetLosses::duration_s, row)?,
        cause_instance: rows.get(TargetLosses::cause_instance, row)?,
        frames_out_of_view: rows.get(TargetLosses::frames_out_of_view, row)?,
        reacquired: rows.get(TargetLosses::reacquired, row)?,
        look_alikes: rows.get(TargetLosses::look_alikes, row)?,
    })
}

fn pair_row(rows: &Rows<'_>, row: usize) -> Result<(String, PairRow)> {
    let pair = PairRow {
        place: (Arc::default(), row),
        expert_id: rows.get(Pairs::expert_id, row)?,
        pedestrian_id: rows.get(Pairs::pedestrian_id, row)?,
        counts: [
            rows.get(Pairs::frames, row)?,
            rows.get(Pairs::position_events, row)?,
            rows.get(Pairs::rotation_events, row)?,
        ],
        max_offset_m: rows.get(Pairs::max_offset_m, row)?,
        expert_frames: digest(rows.get(Pairs::expert_frames, row)?.into_iter()),
    };
    Ok((rows.get(Pairs::perturbed_id, row)?, pair))
}

/// Every twin has its expert and its row in `pairs`.
fn check_experts(small: &SmallTables, report: &mut VerifyReport) {
    // A dataset may consist of perturbed trajectories alone; then there is none to compare them with.
    let has_experts = small.flights.iter().any(|flight| flight.expert_id.is_none());
    for flight in small.flights.iter() {
        let id = &flight.trajectory_id;
        let Some(expert_id) = &flight.expert_id else { continue };
        let place = format!("row {}, `{id}`", flight.place.1);
        match small.flights.get(expert_id) {
            Some(expert) if expert.pedestrian_id != flight.pedestrian_id => {
                report.find(&flight.place.0, place, "verify-pair", "its expert follows another pedestrian");
            }
            Some(_) if small.pairs.contains_key(id) => {}
            Some(_) => report.find(&flight.place.0, place, "verify-pair", "table `pairs` has no row for it"),
            None if !has_experts && small.pairs.contains_key(id) => {}
            None => {
                let message = format!("its expert `{expert_id}` is not in the dataset");
                report.find(&flight.place.0, place, "verify-pair", message);
            }
        }
    }
}
