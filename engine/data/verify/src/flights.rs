//! All flights, one at a time: table `frames` with the tables beside it, and the log of each flight.

use super::files::CheckedFiles;
use super::frames::{check_frames, check_occluders, check_pair};
use super::log::{self, Known};
use super::report::VerifyReport;
use super::rows;
use super::tables::SmallTables;
use super::twins::Twins;
use super::{labels, people, sums, waypoints};
use std::collections::BTreeMap;
use std::path::Path;

/// Checks all flights: rows of `frames`, then the log of each, then `waypoints` and twins.
pub fn check_all(
    folder: &Path,
    files: &CheckedFiles,
    tables: &SmallTables,
    report: &mut VerifyReport,
    progress: &mut dyn FnMut(u64, u64),
) {
    let total = tables.flights.len() as u64;
    let mut motions: BTreeMap<String, blake3::Hasher> = BTreeMap::new();
    let mut twins = Twins::of(tables);
    for file in files.sound_below("data/frames/") {
        let mut others = people::read(folder, files, file, report);
        let people_file = people::file_beside(file);
        let outcome = rows::frames(&folder.join(file), &mut |frames| {
            let id = frames[0].trajectory_id.clone();
            let Some(flight) = tables.flights.get(&id) else {
                let place = format!("row {}, `{id}`", frames[0].row);
                report.find(file, place, "verify-reference", "there is no such flight");
                return;
            };
            if motions.contains_key(&id) {
                report.find(file, format!("row {}, `{id}`", frames[0].row), "verify-duplicate", "its rows are apart");
                return;
            }
            let mut motion = blake3::Hasher::new();
            for frame in &frames {
                motion.update(&frame.motion_bytes());
            }
            motions.insert(id.clone(), motion);
            check_frames(file, flight, &frames, report);
            sums::check_frames(flight, &frames, report);
            labels::compare(file, flight, &frames, report);
            let (others, objects) = (others.remove(&id).unwrap_or_default(), tables.instances.get(&flight.town));
            people::check(&people_file, flight, &frames, &others, objects, report);
            check_occluders(file, objects, &others, &frames, report);
            check_pair(&tables.pairs, flight, &frames, report);
            twins.keep(&frames);
            if files.regular.contains(&flight.mcap_path) {
                let captions = tables.captions.get(&id).map_or(&[][..], Vec::as_slice);
                log::check(folder, flight, &frames, &Known { captions, objects, others: &others }, report);
            }
            report.flights += 1;
            report.frames += frames.len() as u64;
            progress(report.flights, total);
        });
        if let Err(message) = outcome {
            report.find(file, "", "verify-schema", message);
        }
        for (id, rows) in others {
            let place = format!("row {}, `{id}`", rows[0].row);
            report.find(&people_file, place, "verify-reference", "its frames are not in the file of this name");
        }
    }
    for (id, flight) in tables.flights.iter().filter(|(id, _)| !motions.contains_key(*id)) {
        let place = format!("row {}, `{id}`", flight.place.1);
        report.find(&flight.place.0, place, "verify-count", "table `frames` has no readable rows of it");
    }
    waypoints::check(folder, files, &motions, report);
    twins.check(tables, report);
}
