//! The evaluation of a tracker's files: boxes of a few sequences are in memory at a time, counts of all.

use super::files::TrackerFiles;
use super::lines::{self, FoundBox, LineFault};
use super::sequences::{TrackedSequence, sequences};
use super::target::{TargetScores, TargetTallies};
use super::tracks::{self, TrackTallies};
use crate::pictures::kinds::FrameKinds;
use crate::pictures::report::{
    ClassReport, FileFacts, FileProblem, FrameFacts, Nonsense, PictureEvaluation, SequenceReport, ranges,
};
use crate::pictures::settings::{PictureKind, PictureSettings};
use crate::pictures::tallies::{Counted, FrameCounts, reports};
use crate::report::result::DatasetFacts;
use crate::scoring::groups_of_flights;
use crate::windows::Flights;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_metrics::tracking::TrackTally;
use cosfly_read::{PublishedDataset, SightingReader};
use cosfly_schema::mot_class::COUNTED;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Sequences that are scored side by side.
const BATCH: usize = 16;

/// Counts of a sequence.
enum Found {
    Tracks { by_class: Box<[TrackTally; COUNTED.len()]>, has_classes: bool },
    Target(TargetScores),
}

/// Boxes of a tracker's file.
enum Boxes {
    Tracks(Vec<Vec<FoundBox>>),
    Target(Vec<[f64; 4]>),
}

/// Scores the tracker's files below `path`.
///
/// # Errors
/// Files of which none can be scored, a list of sequences that is none, and datasets that are damaged.
pub fn evaluate(
    dataset: &PublishedDataset,
    flights: &Flights,
    path: &Path,
    settings: &PictureSettings,
) -> Result<PictureEvaluation> {
    let all = sequences(flights, settings)?;
    let mut files = TrackerFiles::of(path, &all)?;
    let splits = splits(flights, &all, &files, settings)?;
    let expected: Vec<usize> =
        (0..all.len()).filter(|place| splits.contains(&flights.rows[all[*place].flight].split)).collect();
    let present: Vec<usize> = expected.iter().copied().filter(|place| files.files.contains_key(place)).collect();
    let mut count = Count::new(flights, settings.kind, expected.iter().map(|place| all[*place].flight).collect());
    let mut bodies = SightingReader::of(dataset)?;
    for batch in present.chunks(BATCH) {
        let flown: Vec<usize> = batch.iter().map(|place| all[*place].flight).collect();
        let loaded = flights.part(&flown)?;
        let read: Vec<(usize, std::result::Result<Boxes, LineFault>)> = batch
            .par_iter()
            .map(|place| {
                let file = path.join(&files.files[place]);
                let bytes = std::fs::read(&file)
                    .map_err(|error| Diagnostic::unread(format!("`{}`", file.display()), &error))?;
                Ok((*place, boxes(&bytes, &all[*place], settings.kind)))
            })
            .collect::<Result<_>>()?;
        let mut to_score = vec![];
        for (place, boxes) in read {
            let sequence = &all[place];
            match boxes {
                Err((line, kind, reason)) => {
                    let place = format!("{} line {line}", files.files[&place].display());
                    files.problems.push(FileProblem::new(place, kind, reason));
                }
                Ok(Boxes::Target(boxes)) => to_score.push((place, Boxes::Target(boxes), vec![])),
                Ok(boxes) => to_score.push((place, boxes, tracks::truth(dataset, &loaded, &mut bodies, sequence)?)),
            }
        }
        let found: Vec<(usize, Found)> = to_score
            .into_par_iter()
            .map(|(place, boxes, truth)| {
                let found = match boxes {
                    Boxes::Target(boxes) => Found::Target(TargetScores::of(&loaded, &count.kinds, &all[place], &boxes)),
                    Boxes::Tracks(boxes) => Found::Tracks {
                        by_class: Box::new(tracks::tallies(&truth, &boxes)),
                        has_classes: boxes.iter().flatten().any(|it| it.class.is_some_and(|it| it != COUNTED[0].0)),
                    },
                };
                (place, found)
            })
            .collect();
        found.into_iter().for_each(|(place, found)| count.take(flights, &all[place], place, found));
    }
    if count.scored.is_empty() {
        return Err(nothing_scored(&files, &all, flights, path, settings));
    }
    Ok(count.finished(flights, (&all, &expected), files, splits, path, settings))
}

fn boxes(bytes: &[u8], sequence: &TrackedSequence, kind: PictureKind) -> std::result::Result<Boxes, LineFault> {
    match kind {
        PictureKind::Target => lines::target(bytes, sequence.pictures).map(Boxes::Target),
        _ => lines::tracks(bytes, sequence.pictures).map(Boxes::Tracks),
    }
}

/// The splits to score.
fn splits(
    flights: &Flights,
    all: &[TrackedSequence],
    files: &TrackerFiles,
    settings: &PictureSettings,
) -> Result<BTreeSet<String>> {
    if let Some(refusal) = crate::evaluation::unknown_split(flights, &settings.splits) {
        return Err(refusal);
    }
    let of_files = files.files.keys().map(|place| flights.rows[all[*place].flight].split.clone());
    Ok(if settings.splits.is_empty() { of_files.collect() } else { settings.splits.iter().cloned().collect() })
}

fn nothing_scored(
    files: &TrackerFiles,
    all: &[TrackedSequence],
    flights: &Flights,
    path: &Path,
    settings: &PictureSettings,
) -> Box<Diagnostic> {
    let message = format!("no file in `{}` can be scored on `{}`", path.display(), flights.folder);
    let place = |problem: &FileProblem| format!("{}: {}", problem.place, problem.reason);
    let refusal = Diagnostic::new("evaluation-no-overlap", Fault::Input, message);
    let refusal = files.problems.iter().take(3).map(place).fold(refusal, Diagnostic::because);
    let name = all.first().map_or("", |sequence| sequence.name.as_str());
    let fits = match settings.kind {
        PictureKind::Target => "a line per picture: left,top,width,height",
        _ => "lines such as 1,7,10,20,30,40,0.9,-1,-1,-1: picture, id, left, top, width, height, score",
    };
    let refusal = refusal.hint(format!("a file that fits is `{name}.txt` with {fits}"));
    match settings.sequences {
        Some(_) => refusal,
        None => refusal
            .hint("`--sequences` takes the export whose pictures the tracker saw, for the names of its sequences"),
    }
}

/// The count of one kind of results.
enum Tallies {
    Tracks(TrackTallies),
    Target(TargetTallies),
}

struct Count {
    kinds: FrameKinds,
    flights: Vec<usize>,
    groups: BTreeMap<usize, usize>,
    counts: FrameCounts,
    tallies: Tallies,
    has_classes: bool,
    scored: BTreeSet<usize>,
    sequences: Vec<(Option<usize>, SequenceReport)>,
}

impl Count {
    /// Nothing counted yet of the sequences of `flown`, a flight each.
    fn new(flights: &Flights, kind: PictureKind, mut flown: Vec<usize>) -> Self {
        flown.sort_unstable();
        flown.dedup();
        let groups = groups_of_flights(flights, &flown);
        let number = groups.iter().max().map_or(0, |last| last + 1);
        let kinds = FrameKinds::new(flights);
        let tallies = match kind {
            PictureKind::Target => Tallies::Target(TargetTallies::new(kinds.names.len(), number)),
            _ => Tallies::Tracks(TrackTallies::new(kinds.names.len())),
        };
        Self {
            counts: FrameCounts::new(kinds.names.len(), number),
            groups: flown.iter().copied().zip(groups).collect(),
            flights: flown,
            kinds,
            tallies,
            has_classes: false,
            scored: BTreeSet::new(),
            sequences: vec![],
        }
    }

    fn take(&mut self, flights: &Flights, sequence: &TrackedSequence, place: usize, found: Found) {
        self.scored.insert(place);
        let group = self.groups[&sequence.flight];
        let row = &flights.rows[sequence.flight];
        let report = |class: Option<&'static str>, truth: u64, scores| SequenceReport {
            sequence: sequence.name.clone(),
            trajectory_id: row.trajectory_id.clone(),
            split: row.split.clone(),
            class,
            pictures: sequence.pictures,
            truth,
            scores,
        };
        match (&mut self.tallies, found) {
            (Tallies::Tracks(tallies), Found::Tracks { by_class, has_classes }) => {
                let kinds = self.kinds.of_flight(sequence.flight);
                tallies.add(&kinds, group, &by_class);
                self.has_classes |= has_classes;
                for kind in [0].into_iter().chain(kinds.iter().map(|kind| kind + 1)) {
                    self.counts.add_many(kind, group, sequence.pictures as u64);
                }
                for (class, tally) in by_class.iter().enumerate() {
                    if let Some(scores) = tracks::named(tally) {
                        let report = report(Some(COUNTED[class].1), tally.identity.truth as u64, scores);
                        self.sequences.push((Some(class), report));
                    }
                }
            }
            (Tallies::Target(tallies), Found::Target(scores)) => {
                tallies.add(group, &scores, &mut self.counts);
                self.sequences.push((None, report(None, scores.seen(), scores.named())));
            }
            _ => {}
        }
    }

    /// Scores by class, and a note where true boxes of other classes do not count. Without classes, all boxes are of pedestrians.
    fn classes(&mut self) -> (Vec<ClassReport>, Option<String>) {
        let Tallies::Tracks(tallies) = &mut self.tallies else { return (vec![], None) };
        tallies.classes = if self.has_classes { COUNTED.len() } else { 1 };
        let of_scored = tallies.classes;
        self.sequences.retain(|(class, _)| class.is_none_or(|class| class < of_scored));
        let others = tallies.passed_over();
        let note = format!(
            "no result has a class (column 8) other than pedestrian: {others} true boxes of other classes do not count, and boxes \
             around them are false, as TrackEval has it"
        );
        (tallies.classes(), (others > 0).then_some(note))
    }

    /// Puts the report together, of `all` sequences those that were `expected`.
    fn finished(
        mut self,
        flights: &Flights,
        (all, expected): (&[TrackedSequence], &[usize]),
        files: TrackerFiles,
        splits: BTreeSet<String>,
        path: &Path,
        settings: &PictureSettings,
    ) -> PictureEvaluation {
        let (classes, note) = self.classes();
        let counted: &dyn Counted = match &self.tallies {
            Tallies::Tracks(tallies) => tallies,
            Tallies::Target(tallies) => tallies,
        };
        let (scores, strata) = reports(counted, &self.counts, &self.kinds.names, settings.resamples, settings.seed);
        let frames = frame_facts(flights, all, expected, &self.scored);
        PictureEvaluation {
            format: "cosfly-picture-evaluation",
            version: 1,
            settings: settings.clone(),
            dataset: DatasetFacts {
                name: flights.name.clone(),
                splits: splits.into_iter().collect(),
                flights: self.flights.len(),
                clusters: self.groups.values().collect::<BTreeSet<_>>().len(),
            },
            files: file_facts(files, expected, self.scored.len(), path),
            is_partial: frames.without_prediction > 0,
            frames,
            metrics: counted.metrics().to_vec(),
            scores,
            kinds: self.kinds.names.clone(),
            strata,
            classes,
            distances: vec![],
            sequences: self.sequences.into_iter().map(|(_, report)| report).collect(),
            notes: note.into_iter().collect(),
        }
    }
}

/// Pictures of the sequences in places `expected`, of which those in `scored` have results.
fn frame_facts(flights: &Flights, all: &[TrackedSequence], expected: &[usize], scored: &BTreeSet<usize>) -> FrameFacts {
    let mut facts = FrameFacts {
        expected: 0,
        scored: 0,
        missing: BTreeMap::new(),
        without_prediction: 0,
        nonsense: Nonsense::default(),
    };
    for place in expected {
        let sequence = &all[*place];
        facts.expected += sequence.pictures;
        if scored.contains(place) {
            facts.scored += sequence.pictures;
        } else {
            let id = flights.rows[sequence.flight].trajectory_id.clone();
            facts.missing.insert(id, ranges(&sequence.frames().collect::<Vec<_>>()));
        }
    }
    facts.without_prediction = facts.expected - facts.scored;
    facts
}

/// A tracker's files, of which so many were scored; `expected` are places of sequences, ascending.
fn file_facts(mut files: TrackerFiles, expected: &[usize], scored: usize, path: &Path) -> FileFacts {
    files.problems.sort();
    let mut kinds = BTreeMap::new();
    files.problems.iter().for_each(|problem| *kinds.entry(problem.kind).or_default() += 1);
    FileFacts {
        name: crate::name_of(path),
        read: files.read,
        scored: scored as u64,
        elsewhere: files.files.keys().filter(|place| expected.binary_search(place).is_err()).count() as u64,
        passed_over: files.passed_over,
        malformed: files.problems.len() as u64,
        kinds,
        problems: files.problems,
    }
}
