//! Tables against each other: references, splits, counts, captions.

use super::files::CheckedFiles;
use super::report::VerifyReport;
use super::rows::{self, FlightRow, ReadResult};
use crate::tables;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// What later checks need of the small tables.
pub struct SmallTables {
    /// Flights by name.
    pub flights: BTreeMap<String, FlightRow>,
    /// Captions by flight: language and text.
    pub captions: BTreeMap<String, Vec<(String, String)>>,
}

/// Reads the small tables and checks them against each other.
pub fn read(folder: &Path, files: &CheckedFiles, report: &mut VerifyReport) -> SmallTables {
    let mut small = SmallTables { flights: BTreeMap::new(), captions: BTreeMap::new() };
    read_flights(folder, files, &mut small, report);
    let rejected = read_rejected(folder, files, report);
    for id in small.flights.keys().filter(|id| rejected.contains(*id)) {
        report.find("data/rejected", id.clone(), "verify-reference", "it is rejected and has a flight");
    }
    read_captions(folder, files, &mut small, report);
    read_pairs(folder, files, &small, report);
    check_splits(&small, report);
    small
}

/// The split that a file belongs to.
fn split_of(path: &str) -> &str {
    path.rsplit('/').next().and_then(|name| name.split('-').next()).unwrap_or_default()
}

fn note<T>(report: &mut VerifyReport, file: &str, outcome: ReadResult<T>) -> Option<T> {
    outcome.map_err(|message| report.find(file, "", "verify-schema", message)).ok()
}

fn read_flights(folder: &Path, files: &CheckedFiles, small: &mut SmallTables, report: &mut VerifyReport) {
    for file in files.sound_below("data/trajectories/") {
        for flight in note(report, file, rows::flights(&folder.join(file), file)).unwrap_or_default() {
            let (id, row) = (flight.trajectory_id.clone(), flight.place.1);
            let listed = files.listed.get(&flight.mcap_path);
            if listed.is_none_or(|it| (it.bytes as i64, &it.sha256) != (flight.mcap.0, &flight.mcap.1)) {
                let message = format!("`{}` is not in `files.parquet` with this size and hash", flight.mcap_path);
                report.find(file, format!("row {row}, `{id}`"), "verify-reference", message);
            }
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
        let outcome = rows::batches(&folder.join(file), &tables::of_rejections(), &mut |batch| {
            rejected.extend((0..batch.rows()).map(|row| batch.text("trajectory_id", row)));
        });
        note(report, file, outcome);
    }
    rejected
}

fn read_captions(folder: &Path, files: &CheckedFiles, small: &mut SmallTables, report: &mut VerifyReport) {
    let table = tables::of_trajectories().into_iter().find(|table| table.name == "captions").expect("it exists");
    for file in files.sound_below("data/captions/") {
        let mut all = vec![];
        let outcome = rows::batches(&folder.join(file), &table, &mut |batch| {
            all.extend(
                (0..batch.rows()).map(|row| ["trajectory_id", "language", "text"].map(|it| batch.text(it, row))),
            );
        });
        note(report, file, outcome);
        for (row, [id, language, text]) in all.into_iter().enumerate() {
            let place = format!("row {row}, `{id}`");
            if text.trim().is_empty() {
                report.find(file, place.clone(), "verify-caption", "the text is empty");
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

fn read_pairs(folder: &Path, files: &CheckedFiles, small: &SmallTables, report: &mut VerifyReport) {
    let table = tables::of_trajectories().into_iter().find(|table| table.name == "pairs").expect("it exists");
    let mut twins = BTreeSet::new();
    for file in files.sound_below("data/pairs/") {
        let mut all = vec![];
        let outcome = rows::batches(&folder.join(file), &table, &mut |batch| {
            all.extend((0..batch.rows()).map(|row| ["perturbed_id", "expert_id"].map(|it| batch.text(it, row))));
        });
        note(report, file, outcome);
        for (row, [perturbed, expert]) in all.into_iter().enumerate() {
            let place = format!("row {row}, `{perturbed}`");
            let twin = small.flights.get(&perturbed);
            if twin.is_none_or(|twin| twin.expert_id != expert) {
                report.find(
                    file,
                    place,
                    "verify-pair",
                    format!("table `trajectories` has no twin of `{expert}` so called"),
                );
            }
            twins.insert(perturbed);
        }
    }
    // A dataset may consist of perturbed flights alone; then there is nobody to compare them with.
    let has_experts = small.flights.values().any(|flight| flight.expert_id.is_empty());
    for (id, flight) in small.flights.iter().filter(|(_, flight)| !flight.expert_id.is_empty()) {
        let place = format!("row {}, `{id}`", flight.place.1);
        match small.flights.get(&flight.expert_id) {
            Some(expert) if expert.pedestrian_id != flight.pedestrian_id => {
                report.find(&flight.place.0, place, "verify-pair", "its expert follows another pedestrian");
            }
            Some(_) if twins.contains(id) => {}
            Some(_) => report.find(&flight.place.0, place, "verify-pair", "table `pairs` has no row for it"),
            None if !has_experts && twins.contains(id) => {}
            None => {
                let message = format!("its expert `{}` is not in the dataset", flight.expert_id);
                report.find(&flight.place.0, place, "verify-pair", message);
            }
        }
    }
}

/// All flights behind one pedestrian are in one split.
fn check_splits(small: &SmallTables, report: &mut VerifyReport) {
    let mut splits: BTreeMap<&str, &str> = BTreeMap::new();
    for (id, flight) in &small.flights {
        let split = split_of(&flight.place.0);
        let first = *splits.entry(&flight.pedestrian_id).or_insert(split);
        if first != split {
            let message = format!("pedestrian `{}` is in `{first}` and in `{split}`", flight.pedestrian_id);
            report.find(&flight.place.0, format!("row {}, `{id}`", flight.place.1), "verify-split", message);
        }
    }
}
