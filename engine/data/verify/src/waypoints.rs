//! Table `waypoints` against table `frames`.

use super::flights::{Flights, Motion, motion_of};
use super::report::VerifyReport;
use super::rows;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// The motion in `waypoints` is that of `frames`, bit for bit. `motions` are those of the flights by number.
pub fn check(flights: &Flights<'_>, motions: &[Option<Motion>], report: &mut VerifyReport) {
    let list = &flights.tables.flights;
    let files: Vec<&str> = flights.files.sound_below("data/waypoints/").collect();
    let read: Vec<OfFile> = files.into_par_iter().map(|file| OfFile::read(flights, file)).collect();
    let mut found: BTreeMap<usize, Option<Motion>> = BTreeMap::new();
    let mut unknown: BTreeSet<String> = BTreeSet::new();
    for mut of_file in read {
        report.absorb(std::mem::take(&mut of_file.report));
        unknown.append(&mut of_file.unknown);
        for (number, motion) in of_file.motions {
            // Steps of one flight in two places are out of order.
            found.entry(number).and_modify(|motion| *motion = None).or_insert(Some(motion));
        }
    }
    let differs = |number: &usize| {
        let of_frames = motions[*number];
        let of_steps = found.get(number).copied();
        match (of_frames, of_steps) {
            (None, None) => false,
            (Some(frames), Some(Some(steps))) => frames != steps,
            _ => true,
        }
    };
    let wrong = (0..list.len()).filter(differs).map(|number| list.at(number).trajectory_id.clone());
    for id in wrong.chain(unknown) {
        let message = "its steps are not those of table `frames`";
        report.find("data/waypoints", format!("`{id}`"), "verify-waypoints", message);
    }
}

/// Motions of the flights of one file.
#[derive(Default)]
struct OfFile {
    motions: Vec<(usize, Motion)>,
    unknown: BTreeSet<String>,
    report: VerifyReport,
}

impl OfFile {
    fn read(flights: &Flights<'_>, file: &str) -> Self {
        let list = &flights.tables.flights;
        let mut of_file = Self::default();
        let mut open: Option<(usize, u32, blake3::Hasher)> = None;
        let is_wanted = |id: &str| list.number(id).is_none_or(|number| flights.wanted.has(number));
        let outcome = rows::waypoints(&flights.folder.join(file), &is_wanted, &mut |id, step, motion| {
            let is_same = open.as_ref().is_some_and(|(number, _, _)| list.at(*number).trajectory_id == id);
            if !is_same {
                of_file.motions.extend(open.take().map(|(number, _, hasher)| (number, motion_of(&hasher))));
                open = list.number(id).map(|number| (number, 0, blake3::Hasher::new()));
            }
            match &mut open {
                Some((_, next, hasher)) => {
                    hasher.update(&motion);
                    // A step out of order spoils the hash.
                    if step != *next {
                        hasher.update(b"order");
                    }
                    *next += 1;
                }
                None => drop(of_file.unknown.insert(id.to_owned())),
            }
        });
        of_file.motions.extend(open.take().map(|(number, _, hasher)| (number, motion_of(&hasher))));
        if let Err(message) = outcome {
            of_file.report.find(file, "", "verify-schema", message);
        }
        of_file
    }
}
