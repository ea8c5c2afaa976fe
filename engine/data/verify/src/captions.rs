//! Table `captions`, as far as logs are compared with it: hashes of texts and the languages of each flight.

use super::files::CheckedFiles;
use super::flight_list::FlightList;
use super::report::VerifyReport;
use super::rows::{self, split_of};
use cosfly_domain::BodyKind;
use cosfly_schema::tables::Captions;
use std::collections::BTreeSet;
use std::path::Path;

/// Languages that every flight behind a person has captions in, where one has captions.
const LANGUAGES: [&str; 2] = ["en", "zh"];

/// A caption of a flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Caption {
    flight: u32,
    /// Start of the hash of its text.
    text: u64,
    language: Option<u8>,
}

impl Caption {
    /// Whether it has this text.
    pub fn is(&self, text: &str) -> bool {
        self.text == hash(&[text]) as u64
    }
}

/// The captions of all flights.
#[derive(Default)]
pub struct CaptionList(Vec<Caption>);

impl CaptionList {
    /// Captions of a flight.
    pub fn of(&self, flight: usize) -> &[Caption] {
        let first = self.0.partition_point(|it| (it.flight as usize) < flight);
        let count = self.0[first..].partition_point(|it| it.flight as usize == flight);
        &self.0[first..first + count]
    }

    /// Reads all captions and compares them with the flights.
    pub fn read(folder: &Path, files: &CheckedFiles, flights: &FlightList, report: &mut VerifyReport) -> Self {
        let (mut keys, mut captions): (BTreeSet<u128>, Vec<Caption>) = (BTreeSet::new(), vec![]);
        for file in files.sound_below("data/captions/") {
            let mut first = 0;
            let mut found: Vec<(usize, String, &'static str, &'static str)> = vec![];
            let outcome = rows::read(&folder.join(file), &rows::table("captions"), &mut |rows| {
                for row in 0..rows.len() {
                    let id = rows.get(Captions::trajectory_id, row)?;
                    let language = rows.get(Captions::language, row)?;
                    let style = rows.get(Captions::style, row)?;
                    let text = rows.get(Captions::text, row)?;
                    let mut find = |rule, message| found.push((first + row, id.clone(), rule, message));
                    if text.trim().is_empty() {
                        find("verify-caption", "the text is empty");
                    }
                    if !keys.insert(hash(&[&id, &language, &style, &text])) {
                        find("verify-duplicate", "the same caption twice");
                    }
                    match flights.number(&id) {
                        None => find("verify-reference", "there is no such flight"),
                        Some(flight) => {
                            if split_of(&flights.at(flight).place.0) != split_of(file) {
                                find("verify-split", "its flight is in another split");
                            }
                            captions.push(Caption {
                                flight: flight as u32,
                                text: hash(&[&text]) as u64,
                                language: LANGUAGES.iter().position(|it| *it == language).map(|at| at as u8),
                            });
                        }
                    }
                }
                first += rows.len();
                Ok(())
            });
            for (row, id, rule, message) in found {
                report.find(file, format!("row {row}, `{id}`"), rule, message);
            }
            if let Err(message) = outcome {
                report.find(file, "", "verify-schema", message);
            }
        }
        captions.sort_unstable();
        let captions = Self(captions);
        if !keys.is_empty() {
            captions.check_languages(flights, report);
        }
        captions
    }

    fn check_languages(&self, flights: &FlightList, report: &mut VerifyReport) {
        let is_on_foot = |kind: &str| BodyKind::ON_THE_GROUND.iter().any(|it| it.is_on_foot() && it.name() == kind);
        for (number, flight) in
            flights.iter().enumerate().filter(|(_, flight)| flight.target_kind.as_deref().is_some_and(is_on_foot))
        {
            let of_flight = self.of(number);
            for (at, language) in LANGUAGES.into_iter().enumerate() {
                if !of_flight.iter().any(|caption| caption.language == Some(at as u8)) {
                    let place = format!("row {}, `{}`", flight.place.1, flight.trajectory_id);
                    report.find(&flight.place.0, place, "verify-caption", format!("it has no caption in `{language}`"));
                }
            }
        }
    }
}

fn hash(texts: &[&str]) -> u128 {
    let mut hasher = blake3::Hasher::new();
    for text in texts {
        hasher.update(&(text.len() as u64).to_le_bytes()).update(text.as_bytes());
    }
    u128::from_le_bytes(hasher.finalize().as_bytes()[..16].try_into().unwrap_or_default())
}
