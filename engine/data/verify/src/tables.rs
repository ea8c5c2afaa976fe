//! Tables against each other: references, splits, counts, captions.

use super::files::CheckedFiles;
use super::report::VerifyReport;
use super::rows::{self, PlacedFlight, ReadResult, split_of};
use super::sums;
use cosfly_diagnose::Result;
use cosfly_read::Rows;
use cosfly_schema::tables::{self, Captions, Objects, Pairs, Rejected};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Rows of the small tables that later checks read.
pub struct SmallTables {
    /// Flights by name.
    pub flights: BTreeMap<String, PlacedFlight>,
    /// Twins by name.
    pub pairs: BTreeMap<String, PairRow>,
    /// Captions by flight: language and text.
    pub captions: BTreeMap<String, Vec<(String, String)>>,
    /// Instance ids by town.
    pub instances: BTreeMap<String, BTreeSet<u32>>,
}

/// A row of table `pairs`.
pub struct PairRow {
    /// File and row it stands in.
    pub place: (String, usize),
    expert_id: String,
    /// The pedestrian of both.
    pub pedestrian_id: String,
    /// Frames, position events, rotation events.
    pub counts: [u32; 3],
    /// Largest displacement, metres.
    pub max_offset_m: f64,
    /// The expert's frame of each frame.
    pub expert_frames: Vec<i64>,
}

/// Reads the small tables and checks them against each other.
pub fn read(folder: &Path, files: &CheckedFiles, report: &mut VerifyReport) -> SmallTables {
    let mut small = SmallTables {
        flights: BTreeMap::new(),
        pairs: BTreeMap::new(),
        captions: BTreeMap::new(),
        instances: BTreeMap::new(),
    };
    read_flights(folder, files, &mut small, report);
    let rejected = read_rejected(folder, files, report);
    for id in small.flights.keys().filter(|id| rejected.contains(*id)) {
        report.find("data/rejected", id.clone(), "verify-reference", "it is rejected and has a flight");
    }
    read_objects(folder, files, &mut small, report);
    check_weathers(&small, report);
    read_captions(folder, files, &mut small, report);
    read_pairs(folder, files, &mut small, report);
    small
}

fn note<T>(report: &mut VerifyReport, file: &str, outcome: ReadResult<T>) -> Option<T> {
    outcome.map_err(|message| report.find(file, "", "verify-schema", message)).ok()
}

fn read_flights(folder: &Path, files: &CheckedFiles, small: &mut SmallTables, report: &mut VerifyReport) {
    for file in files.sound_below("data/trajectories/") {
        for flight in note(report, file, rows::flights(&folder.join(file), file)).unwrap_or_default() {
            let (id, row) = (flight.trajectory_id.clone(), flight.place.1);
            let listed = files.listed.get(&flight.mcap_path);
            if listed.is_none_or(|it| (it.bytes, &it.sha256) != (flight.mcap.0, &flight.mcap.1)) {
                let message = format!("`{}` is not in `files.parquet` with this size and hash", flight.mcap_path);
                report.find(file, format!("row {row}, `{id}`"), "verify-reference", message);
            }
            sums::check_row(&flight, report);
            if small.flights.insert(id.clone(), flight).is_some() {
                report.find(file, format!("row {row}"), "verify-duplicate", format!("a second flight `{id}`"));
            }
        }
    }
    let logs = files.listed.keys().filter(|path| path.starts_with("mcap/")).count();
    if logs != small.flights.len() {
        let message = format!("{} flights, but {logs} logs in `files.parquet`", small.flights.len());
        report.find("data/trajectories", "", "verify-count", message);
    }
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
    for file in files.sound_below("data/objects/") {
        let outcome = rows::read(&folder.join(file), &tables::of_objects(), &mut |rows| {
            for row in 0..rows.len() {
                let ids = small.instances.entry(rows.get(Objects::town, row)?).or_default();
                ids.insert(rows.get(Objects::instance, row)?);
            }
            Ok(())
        });
        note(report, file, outcome);
    }
}

/// Rows of the same flight are in different weathers, else one of them is there twice.
fn check_weathers(small: &SmallTables, report: &mut VerifyReport) {
    let mut seen: BTreeMap<(&str, &str), &str> = BTreeMap::new();
    for (id, flight) in &small.flights {
        if let Some(first) = seen.insert((&flight.flight_id, &flight.weather), id) {
            let place = format!("row {}, `{id}`", flight.place.1);
            let message = format!("it shows flight `{}` in the same weather as `{first}`", flight.flight_id);
            report.find(&flight.place.0, place, "verify-duplicate", message);
        }
    }
}

fn read_captions(folder: &Path, files: &CheckedFiles, small: &mut SmallTables, report: &mut VerifyReport) {
    let mut keys = BTreeSet::new();
    for file in files.sound_below("data/captions/") {
        let mut all = vec![];
        let outcome = rows::read(&folder.join(file), &rows::table("captions"), &mut |rows| {
            for row in 0..rows.len() {
                all.push([
                    rows.get(Captions::trajectory_id, row)?,
                    rows.get(Captions::language, row)?,
                    rows.get(Captions::style, row)?,
                    rows.get(Captions::text, row)?,
                ]);
            }
            Ok(())
        });
        note(report, file, outcome);
        for (row, [id, language, style, text]) in all.into_iter().enumerate() {
            let place = format!("row {row}, `{id}`");
            if text.trim().is_empty() {
                report.find(file, place.clone(), "verify-caption", "the text is empty");
            }
            if !keys.insert((id.clone(), language.clone(), style, text.clone())) {
                report.find(file, place.clone(), "verify-duplicate", "the same caption twice");
            }
            match small.flights.get(&id) {
                None => report.find(file, place, "verify-reference", "there is no such flight"),
                Some(flight) if split_of(&flight.place.0) != split_of(file) => {
                    report.find(file, place, "verify-split", "its flight is in another split");
                }
                Some(_) => {}
            }
            small.captions.entry(id).or_default().push((language, text));
        }
    }
    if small.captions.is_empty() {
        return;
    }
    for (id, flight) in &small.flights {
        for language in ["en", "zh"] {
            let captions = small.captions.get(id);
            if !captions.is_some_and(|captions| captions.iter().any(|caption| caption.0 == language)) {
                let place = format!("row {}, `{id}`", flight.place.1);
                report.find(&flight.place.0, place, "verify-caption", format!("it has no caption in `{language}`"));
            }
        }
    }
}

fn read_pairs(folder: &Path, files: &CheckedFiles, small: &mut SmallTables, report: &mut VerifyReport) {
    for file in files.sound_below("data/pairs/") {
        let mut all = vec![];
        let outcome = rows::read(&folder.join(file), &rows::table("pairs"), &mut |rows| {
            (0..rows.len()).try_for_each(|row| {
                all.push(pair_row(rows, row)?);
                Ok(())
            })
        });
        note(report, file, outcome);
        for (row, (perturbed, mut pair)) in all.into_iter().enumerate() {
            pair.place = (file.to_owned(), row);
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

fn pair_row(rows: &Rows<'_>, row: usize) -> Result<(String, PairRow)> {
    let pair = PairRow {
        place: (String::new(), row),
        expert_id: rows.get(Pairs::expert_id, row)?,
        pedestrian_id: rows.get(Pairs::pedestrian_id, row)?,
        counts: [
            rows.get(Pairs::frames, row)?,
            rows.get(Pairs::position_events, row)?,
            rows.get(Pairs::rotation_events, row)?,
        ],
        max_offset_m: rows.get(Pairs::max_offset_m, row)?,
        expert_frames: rows.get(Pairs::expert_frames, row)?,
    };
    Ok((rows.get(Pairs::perturbed_id, row)?, pair))
}

/// Every twin has its expert and its row in `pairs`.
fn check_experts(small: &SmallTables, report: &mut VerifyReport) {
    // A dataset may consist of perturbed trajectories alone; then there is none to compare them with.
    let has_experts = small.flights.values().any(|flight| flight.expert_id.is_none());
    for (id, flight) in &small.flights {
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
