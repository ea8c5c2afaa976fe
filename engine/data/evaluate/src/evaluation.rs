//! The evaluation itself, step by step.

use crate::join::Joined;
use crate::methods::{Method, baselines};
use crate::report::result::{
    AnchorReport, AnchoredMethod, DatasetFacts, Evaluation, MethodReport, RowFacts, StratumReport, WindowFacts,
};
use crate::report::score::{Score, Scores};
use crate::scoring::{MethodTallies, Scored, clusters, score, total};
use crate::settings::{InputRole, Settings};
use crate::strata::STRATA;
use crate::windows::{Flights, WindowSet};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_metrics::baselines::Anchor;
use cosfly_metrics::{METRICS, Tally, bootstrap};
use cosfly_read::predictions::Predictions;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// Scores the predictions of the file called `.0`, beside the baselines, on `flights`; without predictions the
/// baselines alone.
///
/// # Errors
/// A dataset that has no windows, and predictions none of which can be scored.
pub fn evaluate(
    flights: &Flights,
    predictions: Option<(&str, Predictions)>,
    settings: &Settings,
) -> Result<Evaluation> {
    let predicted = predictions.as_ref().map(|(_, given)| predicted(flights, given)).unwrap_or_default();
    let splits = splits(flights, predictions.is_some(), &predicted, settings)?;
    let settings = &Settings { cameras: cameras(flights, &predicted, settings)?, ..settings.clone() };
    let windows = WindowSet::new(flights, settings, &splits);
    if windows.len == 0 {
        return Err(no_windows(flights, &splits, settings));
    }
    one_step(flights, &windows)?;
    let (file, mut given) = predictions.map_or((None, Predictions::default()), |(file, given)| (Some(file), given));
    let mut joined = Joined::new(&given, flights, &windows, settings);
    let read = given.len() + given.problems.len();
    joined.problems.append(&mut given.problems);
    joined.problems.sort_by_key(|problem| problem.line);
    if let Some(file) = file.filter(|_| joined.predicted == 0) {
        return Err(nothing_to_score(file, flights, &windows, &joined));
    }
    let everything = file.is_none() || settings.missing_as_zero;
    let wanted = |window: usize| everything || joined.row(window).is_some();
    let scored = if everything { windows.len } else { joined.predicted };

    let mut notes = vec![];
    let mut methods: Vec<Method<'_>> = vec![];
    methods.extend(file.is_some().then_some(Method::Predictions(&given, &joined)));
    methods.extend(baselines(flights, settings, scored, splits.contains("train"), &mut notes)?);
    // The same methods over all windows with the other anchor.
    let other = Settings {
        anchor: match settings.anchor {
            Anchor::Input => Anchor::Expert,
            Anchor::Expert => Anchor::Input,
        },
        ..settings.clone()
    };
    let mut others: Vec<Method<'_>> = vec![];
    others.extend(file.is_some().then_some(Method::Predictions(&given, &joined)));
    others.extend(baselines(flights, &other, scored, false, &mut vec![])?);
    let of_anchor = methods.iter().map(|method| Scored { method, settings, by_stratum: true });
    let of_other = others.iter().map(|method| Scored { method, settings: &other, by_stratum: false });
    let mut tallies = score(&of_anchor.chain(of_other).collect::<Vec<_>>(), flights, &windows, &wanted)?;
    let tallies_of_others = tallies.split_off(methods.len());
    let reports = (methods.par_iter().zip(&tallies)).map(|(method, it)| method_report(method, it, settings)).collect();
    let anchored = |(method, tallies): (&Method<'_>, &MethodTallies)| {
        let scores = scores(&tallies.overall, settings.resamples, settings.seed);
        AnchoredMethod { name: method.name().to_owned(), scores }
    };
    let others = others.par_iter().zip(&tallies_of_others).map(anchored).collect();
    let beside = AnchorReport { anchor: other.anchor, methods: others };
    let groups: BTreeSet<usize> = clusters(flights, &windows).into_iter().collect();
    Ok(Evaluation {
        format: "cosfly-evaluation",
        version: 3,
        settings: settings.clone(),
        dataset: DatasetFacts {
            name: flights.name.clone(),
            splits: splits.into_iter().collect(),
            flights: windows.flights.len(),
            clusters: groups.len(),
        },
        windows: WindowFacts {
            expected: windows.len,
            scored,
            without_prediction: if file.is_some() { windows.len - joined.predicted } else { 0 },
        },
        rows: file.map(|file| row_facts(file, read, joined)),
        metrics: METRICS.to_vec(),
        methods: reports,
        other_anchor: beside,
        notes,
        is_partial: file.is_some() && scored < windows.len,
    })
}

/// Flights of the dataset that predictions name.
fn predicted(flights: &Flights, given: &Predictions) -> BTreeSet<usize> {
    let mut named: Vec<&str> = given.rows().map(|row| row.trajectory_id).collect();
    named.dedup();
    let named: BTreeSet<&str> = named.into_iter().collect();
    named.iter().filter_map(|id| flights.place(id)).collect()
}

/// The splits to score.
fn splits(
    flights: &Flights,
    is_predicted: bool,
    predicted: &BTreeSet<usize>,
    settings: &Settings,
) -> Result<BTreeSet<String>> {
    if let Some(refusal) = unknown_split(flights, &settings.splits) {
        return Err(refusal);
    }
    if !settings.splits.is_empty() {
        return Ok(settings.splits.iter().cloned().collect());
    }
    if !is_predicted {
        return Ok(unseen_splits(flights));
    }
    let chosen: BTreeSet<String> = predicted.iter().map(|place| flights.rows[*place].split.clone()).collect();
    Ok(if chosen.is_empty() { flights.rows.iter().map(|row| row.split.clone()).collect() } else { chosen })
}

/// The cameras to score; none where all are.
fn cameras(flights: &Flights, predicted: &BTreeSet<usize>, settings: &Settings) -> Result<Vec<String>> {
    let there: BTreeSet<&str> = flights.rows.iter().filter_map(|row| row.camera_name.as_deref()).collect();
    if let Some(unknown) = settings.cameras.iter().find(|camera| !there.contains(camera.as_str())) {
        let refusal =
            Diagnostic::new("evaluation-camera", Fault::Recipe, format!("no film is of a camera `{unknown}`"));
        let names: Vec<&str> = there.into_iter().collect();
        return Err(match names.is_empty() {
            true => refusal.hint("the dataset has one camera, without a name"),
            false => refusal.hint(format!("its cameras are {}", names.join(", "))),
        });
    }
    if !settings.cameras.is_empty() {
        return Ok(settings.cameras.clone());
    }
    let cameras: BTreeSet<Option<&String>> =
        predicted.iter().map(|flight| flights.rows[*flight].camera_name.as_ref()).collect();
    Ok(match cameras.contains(&None) {
        true => vec![],
        false => cameras.into_iter().flatten().cloned().collect(),
    })
}

/// Refuses windows of several steps: the same error is another mistake after half the time.
fn one_step(flights: &Flights, windows: &WindowSet) -> Result<()> {
    let mut steps: Vec<(f64, &str)> = vec![];
    for row in windows.flights.iter().map(|(flight, _)| &flights.rows[*flight]) {
        if steps.iter().all(|(dt_s, _)| *dt_s != row.dt_s) {
            steps.push((row.dt_s, row.camera_name.as_deref().unwrap_or_default()));
        }
    }
    let [(first_s, camera), (other_s, other), ..] = steps[..] else { return Ok(()) };
    let message = format!("windows of `{}` have frames {first_s} s and {other_s} s apart", flights.folder);
    let refusal = Diagnostic::new("evaluation-steps", Fault::Input, message)
        .because("errors after other times have no mean that says anything");
    Err(match camera != other {
        true => refusal.hint(format!("`--camera {camera}` or `--camera {other}` scores the films of one camera")),
        false => refusal.hint("make a dataset of flights with one time between frames"),
    })
}

/// All splits but train; all where there is no other.
pub(crate) fn unseen_splits(flights: &Flights) -> BTreeSet<String> {
    let there: BTreeSet<String> = flights.rows.iter().map(|row| row.split.clone()).collect();
    let unseen: BTreeSet<String> = there.iter().filter(|split| *split != "train").cloned().collect();
    if unseen.is_empty() { there } else { unseen }
}

/// The refusal of a name in `wanted` that is not a split of the dataset.
pub(crate) fn unknown_split(flights: &Flights, wanted: &[String]) -> Option<Box<Diagnostic>> {
    let there: BTreeSet<&str> = flights.rows.iter().map(|row| row.split.as_str()).collect();
    let unknown = wanted.iter().find(|split| !there.contains(split.as_str()))?;
    let names: Vec<&str> = there.into_iter().collect();
    let message = format!("the dataset has no split `{unknown}`");
    Some(
        Diagnostic::new("evaluation-split", Fault::Recipe, message)
            .hint(format!("its splits are {}", names.join(", "))),
    )
}

fn no_windows(flights: &Flights, splits: &BTreeSet<String>, settings: &Settings) -> Box<Diagnostic> {
    let (size, folder) = (settings.window.size(), &flights.folder);
    let role = match settings.input {
        InputRole::Perturbed => "perturbed",
        InputRole::Expert => "expert",
    };
    let names: Vec<&str> = splits.iter().map(String::as_str).collect();
    let message =
        format!("`{folder}` has no window to predict: no {role} flight of {size} frames in split {}", names.join(", "));
    let refusal = Diagnostic::new("evaluation-no-windows", Fault::Input, message);
    let experts = Settings { input: InputRole::Expert, ..settings.clone() };
    match settings.input {
        InputRole::Perturbed if WindowSet::new(flights, &experts, splits).len > 0 => {
            refusal.hint("with `--input expert` windows are cut from experts' flights")
        }
        _ => refusal.hint("a shorter `--history` or `--horizon` needs fewer frames; `--split` chooses others"),
    }
}

fn nothing_to_score(file: &str, flights: &Flights, windows: &WindowSet, joined: &Joined) -> Box<Diagnostic> {
    let message = match joined.problems.len() as u64 + joined.elsewhere {
        0 => format!("there is no prediction in `{file}`"),
        rows => format!("none of {rows} predictions in `{file}` fits a window of `{}`", flights.folder),
    };
    let mut refusal = Diagnostic::new("evaluation-no-overlap", Fault::Input, message);
    for problem in joined.problems.iter().take(3) {
        refusal = refusal.because(format!("line {}: {}", problem.line, problem.reason));
    }
    match windows.flights.first() {
        Some((flight, _)) => {
            let zero = vec!["[0, 0, 0, 0, 0, 0]"; windows.shape.horizon].join(", ");
            let id = &flights.rows[*flight].trajectory_id;
            refusal = refusal.hint(format!(
                "a row that fits is {{\"trajectory_id\": \"{id}\", \"frame\": 0, \"waypoint_deltas\": [{zero}]}}"
            ));
            match joined.problems.iter().any(|problem| matches!(problem.kind, "length" | "no-window")) {
                true => {
                    refusal.hint("`--history`, `--horizon` and `--stride` cut other windows: give the predictions' own")
                }
                false => refusal,
            }
        }
        None => refusal,
    }
}

fn row_facts(file: &str, read: usize, joined: Joined) -> RowFacts {
    let mut kinds = BTreeMap::new();
    for problem in &joined.problems {
        *kinds.entry(problem.kind).or_default() += 1;
    }
    RowFacts {
        file: file.to_owned(),
        read: read as u64,
        scored: joined.predicted as u64,
        elsewhere: joined.elsewhere,
        malformed: joined.problems.len() as u64,
        kinds,
        problems: joined.problems,
    }
}

fn method_report(method: &Method<'_>, tallies: &MethodTallies, settings: &Settings) -> MethodReport {
    let all: Vec<&Vec<Tally>> = [&tallies.overall].into_iter().chain(&tallies.strata).collect();
    let mut scores: Vec<Scores> =
        all.par_iter().map(|tallies| scores(tallies, settings.resamples, settings.seed)).collect();
    let overall = scores.remove(0);
    let mut strata: BTreeMap<_, BTreeMap<_, _>> = BTreeMap::new();
    for (((kind, name), tallies), scores) in STRATA.iter().zip(&tallies.strata).zip(scores) {
        if !tallies.is_empty() {
            let windows = total(tallies).windows as usize;
            strata.entry(*kind).or_default().insert(*name, StratumReport { windows, clusters: tallies.len(), scores });
        }
    }
    MethodReport { name: method.name().to_owned(), scores: overall, by_step_m: tallies.by_step_m.clone(), strata }
}

fn scores(tallies: &[Tally], resamples: usize, seed: u64) -> Scores {
    let intervals = bootstrap::intervals(tallies, resamples, seed);
    let means = total(tallies).means();
    let named = METRICS.iter().zip(means.into_iter().zip(intervals));
    named
        .filter_map(|(metric, (mean, interval))| {
            let score = Score { value: mean?, low: interval.map(|it| it.0), high: interval.map(|it| it.1) };
            Some((metric.key, score))
        })
        .collect()
}
