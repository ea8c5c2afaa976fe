//! The evaluation of pictures, frame by frame: memory does not grow with their number.

use super::depth::DepthTallies;
use super::detections::{DetectionTallies, FrameDetections, compare};
use super::distances::Ratio;
use super::files::{PredictedFiles, pictures};
use super::given::{FrameKey, Given, detections_by_frame, nothing_to_score};
use super::kinds::FrameKinds;
use super::labels::{LabelTallies, nothing};
use super::raster::{self, Refusal};
use super::report::{ClassReport, FileFacts, FileProblem, FrameFacts, Nonsense, PictureEvaluation, ranges};
use super::settings::{PictureKind, PictureSettings};
use super::tallies::{Counted, FrameCounts, reports};
use super::trackers;
use crate::report::result::DatasetFacts;
use crate::scoring::groups_of_flights;
use crate::windows::Flights;
use cosfly_diagnose::{Diagnostic, Fault, Result, counted};
use cosfly_domain::SemanticLabel;
use cosfly_metrics::depth::{DepthScores, depth_scores};
use cosfly_metrics::segmentation::Confusion;
use cosfly_read::predictions::detections::Detection;
use cosfly_read::{LoggedFrame, PublishedDataset};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Frames that are compared side by side.
const BATCH: usize = 16;

/// Counts of one frame.
enum Found {
    Depth(Option<(DepthScores, Ratio)>),
    /// With the number of pixels whose label CARLA does not have.
    Labels(Confusion, u64),
    Things(Vec<FrameDetections>),
}

/// Scores the predictions at `path` for pictures of `dataset`, whose flights are `flights`.
///
/// # Errors
/// Predictions that cannot be read at all or of which none can be scored, and datasets that are damaged.
pub fn evaluate(
    dataset: &PublishedDataset,
    flights: &Flights,
    path: &Path,
    settings: &PictureSettings,
) -> Result<PictureEvaluation> {
    let mut given = match settings.kind {
        PictureKind::Tracks | PictureKind::Target => return trackers::evaluate(dataset, flights, path, settings),
        PictureKind::Depth | PictureKind::Semantic => {
            Given::Files(PredictedFiles::new(path, pictures(path)?, settings.kind.name(), flights))
        }
        PictureKind::Boxes | PictureKind::Masks => detections_by_frame(path, flights, settings)?,
    };
    let splits = splits(flights, &given, settings)?;
    let in_splits = |flight: usize| splits.contains(&flights.rows[flight].split);
    let expected: Vec<FrameKey> = match &given {
        Given::Rows { listed: Some(listed), .. } => {
            listed.iter().copied().filter(|(flight, _)| in_splits(*flight)).collect()
        }
        _ => {
            let of_flight = |flight: usize| (0..flights.rows[flight].frames).step_by(settings.every.max(1));
            let chosen = (0..flights.rows.len()).filter(|flight| in_splits(*flight));
            chosen.flat_map(|flight| of_flight(flight).map(move |frame| (flight, frame))).collect()
        }
    };
    let present: Vec<FrameKey> = match &given {
        Given::Files(files) => expected.iter().copied().filter(|key| files.files.contains_key(key)).collect(),
        Given::Rows { .. } => expected.clone(),
    };
    if let Some(refusal) = nothing_to_score(&given, &present, flights, path) {
        return Err(refusal);
    }
    let mut count = Count::new(flights, settings.kind, &expected);
    count.frames(dataset, flights, &given, &present, settings)?;
    if count.scored == 0 {
        return Err(nothing_scored(&count, path, settings));
    }
    Ok(count.finished(flights, &mut given, (&expected, &present), splits, path, settings))
}

/// The refusal of predictions none of which could be compared with anything.
fn nothing_scored(count: &Count, path: &Path, settings: &PictureSettings) -> Box<Diagnostic> {
    let message = format!("none of the predictions in `{}` can be scored", path.display());
    let refusal = Diagnostic::new("evaluation-no-overlap", Fault::Input, message);
    let place = |problem: &FileProblem| format!("{}: {}", inner(&problem.place, path), problem.reason);
    let refusal = count.problems.iter().take(3).map(place).fold(refusal, Diagnostic::because);
    match count.without_truth {
        0 => refusal.hint("pictures must have the size of the frames that they are of"),
        frames => {
            let most_m = settings.max_depth_m;
            refusal
                .because(format!("there is nothing nearer than {most_m} m in {}", counted(frames, "frame")))
                .hint("raise `--max-depth-m`")
        }
    }
}

/// The splits to score.
fn splits(flights: &Flights, given: &Given, settings: &PictureSettings) -> Result<BTreeSet<String>> {
    if let Some(refusal) = crate::evaluation::unknown_split(flights, &settings.splits) {
        return Err(refusal);
    }
    if !settings.splits.is_empty() {
        return Ok(settings.splits.iter().cloned().collect());
    }
    if let Given::Rows { listed: None, facts, .. } = given
        && facts.read == 0
    {
        // An empty list names no split.
        return Ok(crate::evaluation::unseen_splits(flights));
    }
    let keys: BTreeSet<usize> = match given {
        Given::Files(files) => files.files.keys().map(|(flight, _)| *flight).collect(),
        Given::Rows { listed: Some(listed), .. } => listed.iter().map(|(flight, _)| *flight).collect(),
        Given::Rows { of_frame, .. } => of_frame.keys().map(|(flight, _)| *flight).collect(),
    };
    Ok(keys.into_iter().map(|flight| flights.rows[flight].split.clone()).collect())
}

/// The count of one kind of prediction.
enum Tallies {
    Depth(DepthTallies),
    Labels(LabelTallies),
    Things(DetectionTallies),
}

struct Count {
    kinds: FrameKinds,
    groups: Vec<usize>,
    group_count: usize,
    counts: FrameCounts,
    tallies: Tallies,
    ratio: Ratio,
    scored: usize,
    without_truth: usize,
    nonsense: Nonsense,
    problems: Vec<FileProblem>,
}

impl Count {
    fn new(flights: &Flights, kind: PictureKind, expected: &[FrameKey]) -> Self {
        let mut chosen: Vec<usize> = expected.iter().map(|(flight, _)| *flight).collect();
        chosen.dedup();
        let of_chosen = groups_of_flights(flights, &chosen);
        let mut groups = vec![0; flights.rows.len()];
        chosen.iter().zip(&of_chosen).for_each(|(flight, group)| groups[*flight] = *group);
        let group_count = of_chosen.iter().max().map_or(0, |last| last + 1);
        let kinds = FrameKinds::new(flights);
        let number = kinds.names.len();
        let tallies = match kind {
            PictureKind::Depth => Tallies::Depth(DepthTallies::new(number, group_count)),
            PictureKind::Semantic => Tallies::Labels(LabelTallies::new(number, group_count)),
            _ => Tallies::Things(DetectionTallies::new(number, group_count)),
        };
        let counts = FrameCounts::new(number, group_count);
        Self {
            kinds,
            groups,
            group_count,
            counts,
            tallies,
            ratio: Ratio::default(),
            scored: 0,
            without_truth: 0,
            nonsense: Nonsense::default(),
            problems: vec![],
        }
    }

    /// Compares all frames of `present`, in order.
    fn frames(
        &mut self,
        dataset: &PublishedDataset,
        flights: &Flights,
        given: &Given,
        present: &[FrameKey],
        settings: &PictureSettings,
    ) -> Result<()> {
        for of_flight in present.chunk_by(|a, b| a.0 == b.0) {
            let flight = of_flight[0].0;
            let loaded = flights.part(&[flight])?;
            for batch in of_flight.chunks(BATCH) {
                let found: Vec<std::result::Result<Found, Refusal>> = batch
                    .par_iter()
                    .map_init(
                        || dataset.log(&flights.rows[flight]),
                        |log, key| {
                            let log = log.as_mut().map_err(|error| error.clone())?;
                            let logged = match given {
                                Given::Files(_) => log.frame(key.1)?,
                                Given::Rows { .. } => log.frame_with_instances(key.1)?,
                            };
                            Ok(compared(&logged, *key, given, self.groups[flight], settings))
                        },
                    )
                    .collect::<Result<_>>()?;
                for (key, found) in batch.iter().zip(found) {
                    self.take(&loaded, *key, found, given);
                }
            }
        }
        Ok(())
    }

    fn take(&mut self, flights: &Flights, key: FrameKey, found: std::result::Result<Found, Refusal>, given: &Given) {
        let path = || match given {
            Given::Files(files) => files.files.get(&key).map(|path| path.display().to_string()),
            Given::Rows { .. } => None,
        };
        let found = match found {
            Ok(found) => found,
            Err((kind, reason)) => {
                self.problems.push(FileProblem::new(path().unwrap_or_default(), kind, reason));
                return;
            }
        };
        let nonsense = match &found {
            Found::Depth(scores) => scores.as_ref().map_or(0, |(_, ratio)| ratio.nonsense),
            Found::Labels(_, pixels) => *pixels,
            Found::Things(_) => 0,
        };
        if nonsense > 0 {
            self.nonsense.pixels += nonsense;
            self.nonsense.frames += 1;
            self.nonsense.first = self.nonsense.first.take().or_else(path);
        }
        let kinds = self.kinds.of(flights, key.0, key.1);
        let group = self.groups[key.0];
        match (&mut self.tallies, found) {
            (_, Found::Depth(None)) => {
                self.without_truth += 1;
                return;
            }
            (Tallies::Depth(tallies), Found::Depth(Some((scores, ratio)))) => {
                tallies.add(&kinds, group, &scores);
                self.ratio.add(&ratio);
            }
            (Tallies::Labels(tallies), Found::Labels(image, _)) => tallies.add(&kinds, group, &image),
            (Tallies::Things(tallies), Found::Things(things)) => tallies.add(&kinds, group, &things),
            _ => {}
        }
        self.counts.add(&kinds, group);
        self.scored += 1;
    }

    /// Puts the report together of the frames that were expected and those that are there.
    fn finished(
        self,
        flights: &Flights,
        given: &mut Given,
        (expected, present): (&[FrameKey], &[FrameKey]),
        splits: BTreeSet<String>,
        path: &Path,
        settings: &PictureSettings,
    ) -> PictureEvaluation {
        let (names, counts) = (&self.kinds.names, &self.counts);
        let of = |counted: &dyn Counted| reports(counted, counts, names, settings.resamples, settings.seed);
        let (metrics, (scores, strata), classes): (_, _, Vec<ClassReport>) = match self.tallies {
            Tallies::Depth(tallies) => (tallies.metrics(), of(&tallies), vec![]),
            Tallies::Labels(tallies) => (tallies.metrics(), of(&tallies), tallies.classes()),
            Tallies::Things(tallies) => {
                let ranked = tallies.ranked();
                (ranked.metrics(), of(&ranked), ranked.classes())
            }
        };
        let is_depth = settings.kind == PictureKind::Depth;
        let first = self.nonsense.first.as_deref().map(|it| inner(it, path));
        let nonsense = Nonsense { first, ..self.nonsense };
        let mut notes = notes(&self.ratio, self.without_truth, is_depth, given, settings);
        notes.extend(nonsense_note(&nonsense, is_depth, settings));
        let (missing, without_prediction) = missing(flights, given, expected, present);
        let is_empty = matches!(given, Given::Rows { facts, .. } if facts.read == 0);
        let mut chosen: Vec<usize> = expected.iter().map(|(flight, _)| *flight).collect();
        chosen.dedup();
        PictureEvaluation {
            format: "cosfly-picture-evaluation",
            version: 1,
            settings: settings.clone(),
            dataset: DatasetFacts {
                name: flights.name.clone(),
                splits: splits.into_iter().collect(),
                flights: chosen.len(),
                clusters: self.group_count,
            },
            files: file_facts(given, self.problems, self.scored, present, path),
            frames: FrameFacts { expected: expected.len(), scored: self.scored, missing, without_prediction, nonsense },
            metrics: metrics.to_vec(),
            scores,
            kinds: names.clone(),
            strata,
            classes,
            distances: if is_depth { self.ratio.reports(settings.max_depth_m) } else { vec![] },
            sequences: vec![],
            notes,
            is_partial: is_empty || without_prediction > 0,
        }
    }
}

/// A path from the folder that was handed in.
fn inner(place: &str, folder: &Path) -> String {
    Path::new(place).strip_prefix(folder).map_or(place.to_owned(), |it| it.display().to_string())
}

fn compared(
    logged: &LoggedFrame,
    key: FrameKey,
    given: &Given,
    group: usize,
    settings: &PictureSettings,
) -> std::result::Result<Found, Refusal> {
    let size = [logged.width, logged.height];
    match given {
        Given::Files(files) => {
            let path = files.files.get(&key).ok_or_else(|| ("missing", "it is not there".to_owned()))?;
            if settings.kind == PictureKind::Semantic {
                let mut image = nothing();
                let labels = raster::labels(path, size)?;
                image.add(&labels, &logged.semantic);
                let unknown = labels.iter().filter(|label| usize::from(**label) >= SemanticLabel::ALL.len());
                return Ok(Found::Labels(image, unknown.count() as u64));
            }
            let predicted = raster::depth_m(path, size, settings.depth_per_metre)?;
            let scores = depth_scores(&predicted, &logged.depth_m, settings.max_depth_m);
            Ok(Found::Depth(
                scores.map(|scores| (scores, Ratio::of(&predicted, &logged.depth_m, settings.max_depth_m))),
            ))
        }
        Given::Rows { of_frame, .. } => {
            let own: Vec<Detection> = of_frame.get(&key).cloned().unwrap_or_default();
            let own: Vec<Detection> = own
                .into_iter()
                .map(|it| if settings.kind == PictureKind::Boxes { Detection { mask: None, ..it } } else { it })
                .collect();
            let all: Vec<u8> = SemanticLabel::ALL.iter().map(|label| label.id()).collect();
            let categories = if settings.categories.is_empty() { &all } else { &settings.categories };
            Ok(Found::Things(compare(logged, &own.iter().collect::<Vec<_>>(), categories, group)))
        }
    }
}

fn notes(
    ratio: &Ratio,
    without_truth: usize,
    is_depth: bool,
    given: &Given,
    settings: &PictureSettings,
) -> Vec<String> {
    let mut notes = vec![];
    let times = ratio.predicted_m / ratio.true_m.max(1e-9);
    if is_depth && ratio.true_m > 0.0 && !(0.4..2.5).contains(&times) {
        notes.push(format!(
            "predicted depths are {times:.3} times the true ones on the average: a wrong unit? Whole numbers were read as \
             {} a metre (`--depth-per-metre`), NumPy arrays of floats as metres",
            settings.depth_per_metre
        ));
    }
    if without_truth > 0 {
        notes.push(format!(
            "left out, with nothing nearer than {} m: {}",
            settings.max_depth_m,
            counted(without_truth, "frame")
        ));
    }
    if let Given::Rows { listed, facts, .. } = given {
        if facts.read == 0 {
            notes.push("the list is empty: there is no detection at all, and everything is missed".to_owned());
        }
        notes.push(match listed {
            Some(_) => "scored are the images of the list; an image without a detection has missed all that is in it".to_owned(),
            None => format!(
                "scored is every {}frame of the scored splits; a frame without a detection has missed all that is in it",
                if settings.every > 1 { format!("{}th ", settings.every) } else { String::new() }
            ),
        });
    }
    notes
}

/// Note on predicted pixels that are neither depths nor labels.
fn nonsense_note(nonsense: &Nonsense, is_depth: bool, settings: &PictureSettings) -> Option<String> {
    let Nonsense { pixels, frames, first } = nonsense;
    let first = first.as_ref().map_or(String::new(), |path| format!("; the first is in `{path}`"));
    let most_m = settings.max_depth_m;
    let what = match is_depth {
        true => format!(
            "a depth that is not a number or above 1e9 m, which counts as {most_m} m, or below 0, which counts as 0.001 m"
        ),
        false => "a label that CARLA does not have (0 to 28): each is a miss".to_owned(),
    };
    (*pixels > 0).then(|| format!("{} in {}: {what}{first}", counted(pixels, "scored pixel"), counted(frames, "frame")))
}

/// Expected frames that have no prediction, by trajectory; for detections no frame is missing.
fn missing(
    flights: &Flights,
    given: &Given,
    expected: &[FrameKey],
    present: &[FrameKey],
) -> (BTreeMap<String, String>, usize) {
    if matches!(given, Given::Rows { .. }) {
        return (BTreeMap::new(), 0);
    }
    let there: BTreeSet<&FrameKey> = present.iter().collect();
    let mut by_flight: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (flight, frame) in expected.iter().filter(|key| !there.contains(key)) {
        by_flight.entry(flights.rows[*flight].trajectory_id.clone()).or_default().push(*frame);
    }
    let number = by_flight.values().map(Vec::len).sum();
    (by_flight.into_iter().map(|(id, frames)| (id, ranges(&frames))).collect(), number)
}

fn file_facts(
    given: &mut Given,
    problems: Vec<FileProblem>,
    scored: usize,
    present: &[FrameKey],
    path: &Path,
) -> FileFacts {
    let mut facts = match given {
        Given::Files(files) => FileFacts {
            name: crate::name_of(path),
            read: files.read,
            scored: scored as u64,
            elsewhere: (files.files.len() - present.len()) as u64,
            passed_over: files.passed_over,
            malformed: 0,
            kinds: BTreeMap::new(),
            problems: std::mem::take(&mut files.problems),
        },
        Given::Rows { of_frame, facts, .. } => {
            let there: BTreeSet<&FrameKey> = present.iter().collect();
            let mut facts = facts.clone();
            for (key, rows) in of_frame.iter() {
                if there.contains(key) {
                    facts.scored += rows.len() as u64
                } else {
                    facts.elsewhere += rows.len() as u64
                }
            }
            facts
        }
    };
    facts.problems.extend(problems.into_iter().map(|it| FileProblem { place: inner(&it.place, path), ..it }));
    if matches!(given, Given::Files(_)) {
        facts.problems.sort();
    }
    for problem in &facts.problems {
        *facts.kinds.entry(problem.kind).or_default() += 1;
    }
    facts.malformed = facts.problems.len() as u64;
    facts
}
