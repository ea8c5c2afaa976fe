//! Laws of evaluations on a tiny dataset: true predictions have no error, planted mistakes have, threads do not matter.

use cosfly_evaluate::windows::{Flights, WindowSet};
use cosfly_evaluate::{Evaluation, InputRole, Settings, evaluate};
use cosfly_frames::{Pose, action};
use cosfly_metrics::baselines::Anchor;
use cosfly_metrics::{DeltaFrame, DeltaOrigin};
use cosfly_read::PublishedDataset;
use cosfly_read::predictions::{Prediction, Predictions};
use cosfly_sample as sample;
use cosfly_schema::{DatasetConfig, EncodingConfig};
use cosfly_windows::WindowShape;

fn dataset() -> (tempfile::TempDir, PublishedDataset) {
    let folder = tempfile::tempdir().unwrap();
    sample::write_to_folder(folder.path(), &DatasetConfig::default(), EncodingConfig::default()).unwrap();
    let dataset = PublishedDataset::open(folder.path()).unwrap();
    (folder, dataset)
}

/// The sample flights have five frames only.
fn settings() -> Settings {
    let window = WindowShape { history: 2, horizon: 2, stride: 1 };
    Settings { window, resamples: 20, ..Settings::default() }
}

/// Predictions of a perfect model, with `mistake` made to every pose that it means.
fn perfect(dataset: &PublishedDataset, settings: &Settings, mistake: impl Fn(&mut Pose)) -> Vec<Prediction> {
    let flights = Flights::read(dataset).unwrap();
    let splits = flights.rows.iter().map(|row| row.split.clone()).collect();
    let windows = WindowSet::new(&flights, settings, &splits);
    let mut rows = vec![];
    for (number, window) in windows.all(&flights).enumerate() {
        let mut from = flights.anchor(window, &settings.window, settings.anchor);
        let mut deltas = vec![];
        for mut pose in flights.truth(window, &settings.window) {
            mistake(&mut pose);
            deltas.push(match settings.delta_frame {
                DeltaFrame::World => action::in_world(&from, &pose),
                DeltaFrame::Body => action::in_body(&from, &pose),
            });
            if settings.delta_origin == DeltaOrigin::Previous {
                from = pose;
            }
        }
        rows.push(Prediction {
            line: number as u64 + 1,
            trajectory_id: flights.rows[window.flight].trajectory_id.clone(),
            frame: window.start as u64,
            deltas,
            boxes: flights.true_boxes(window, &settings.window).collect(),
        });
    }
    rows
}

fn predictions(rows: &[Prediction]) -> Predictions {
    Predictions::of(rows, vec![])
}

fn score(evaluation: &Evaluation, method: usize, key: &str) -> f64 {
    evaluation.methods[method].scores[key].value
}

#[test]
fn true_predictions_have_no_error_whatever_the_frame_origin_and_anchor() {
    let (_folder, dataset) = dataset();
    for delta_frame in [DeltaFrame::World, DeltaFrame::Body] {
        for delta_origin in [DeltaOrigin::Previous, DeltaOrigin::Current] {
            for (anchor, input) in [
                (Anchor::Input, InputRole::Perturbed),
                (Anchor::Expert, InputRole::Perturbed),
                (Anchor::Input, InputRole::Expert),
            ] {
                let settings = Settings { delta_frame, delta_origin, anchor, input, ..settings() };
                let found = evaluate(
                    &Flights::read(&dataset).unwrap(),
                    Some(("true", predictions(&perfect(&dataset, &settings, |_| ())))),
                    &settings,
                )
                .unwrap();
                assert!(
                    score(&found, 0, "ade_m") < 1e-9 && score(&found, 0, "rotation_mae_deg") < 1e-9,
                    "{settings:?}"
                );
                assert_eq!((score(&found, 0, "sr_0_5m"), score(&found, 0, "joint_sr_0_5m_1deg")), (1.0, 1.0));
                assert_eq!(score(&found, 0, "miou"), 1.0);
                assert_eq!(found.windows.scored, found.windows.expected);
            }
        }
    }
}

#[test]
fn a_shifted_frame_and_a_flipped_yaw_show() {
    let (_folder, dataset) = dataset();
    let settings = settings();
    let shifted = perfect(&dataset, &settings, |pose| pose.position_in_world.x += 3.0);
    let found =
        evaluate(&Flights::read(&dataset).unwrap(), Some(("shifted", predictions(&shifted))), &settings).unwrap();
    assert!((score(&found, 0, "fde_m") - 3.0).abs() < 1e-9 && score(&found, 0, "sr_2m") == 0.0);
    // A flight turns, so that an error along the world's x does not stay ahead of it; an error of height does.
    assert!(score(&found, 0, "lasting_m") <= 3.0 + 1e-9 && score(&found, 0, "lasting_turn_deg") < 1e-9);
    let high = perfect(&dataset, &settings, |pose| pose.position_in_world.z += 2.0);
    let found = evaluate(&Flights::read(&dataset).unwrap(), Some(("high", predictions(&high))), &settings).unwrap();
    assert!((score(&found, 0, "lasting_m") - 2.0).abs() < 1e-9);
    assert!(
        found.methods[0]
            .strata
            .values()
            .flat_map(|names| names.values())
            .all(|stratum| { stratum.scores.get("lasting_m").is_none_or(|score| (score.value - 2.0).abs() < 1e-9) })
    );
    let flipped = perfect(&dataset, &settings, |pose| pose.yaw_rad = -pose.yaw_rad);
    let found =
        evaluate(&Flights::read(&dataset).unwrap(), Some(("flipped", predictions(&flipped))), &settings).unwrap();
    assert!(score(&found, 0, "yaw_mae_deg") > 10.0 && score(&found, 0, "fde_m") < 1e-9);
}

#[test]
fn rows_that_fit_nothing_are_named_and_windows_without_rows_are_counted() {
    let (_folder, dataset) = dataset();
    let settings = settings();
    let mut given = perfect(&dataset, &settings, |_| ());
    let all = given.len();
    let change = |line: u64, row: &Prediction| Prediction { line, ..row.clone() };
    let first = given[0].clone();
    given.truncate(all - 1);
    given.push(change(100, &first));
    given.push(Prediction { trajectory_id: "nobody".into(), ..change(101, &first) });
    given.push(Prediction { trajectory_id: "expert-p00000".into(), ..change(102, &first) });
    given.push(Prediction { frame: 77, ..change(103, &first) });
    given.push(Prediction { deltas: vec![[0.0; 6]; 3], ..change(104, &first) });
    given.push(Prediction { boxes: vec![None], ..change(105, &first) });
    let found = evaluate(&Flights::read(&dataset).unwrap(), Some(("some", predictions(&given))), &settings).unwrap();
    let rows = found.rows.as_ref().unwrap();
    let kinds: Vec<_> = rows.problems.iter().map(|problem| (problem.line, problem.kind)).collect();
    assert_eq!(
        kinds,
        [
            (100, "duplicate"),
            (101, "unknown-trajectory"),
            (102, "not-an-input"),
            (103, "no-window"),
            (104, "length"),
            (105, "length")
        ]
    );
    assert_eq!((rows.read, rows.scored, rows.malformed), (all as u64 + 5, all as u64 - 1, 6));
    assert_eq!((found.windows.scored, found.windows.without_prediction), (all - 1, 1));
    let strict = Settings { missing_as_zero: true, ..settings };
    let found = evaluate(&Flights::read(&dataset).unwrap(), Some(("some", predictions(&given))), &strict).unwrap();
    assert!(found.windows.scored == all && score(&found, 0, "fde_m") > 0.0);
}

#[test]
fn zero_increments_score_exactly_as_the_baseline_that_predicts_zero() {
    let (_folder, dataset) = dataset();
    for anchor in [Anchor::Input, Anchor::Expert] {
        let settings = Settings { anchor, ..settings() };
        let mut given = perfect(&dataset, &settings, |_| ());
        given.iter_mut().for_each(|row| row.deltas.iter_mut().for_each(|delta| *delta = [0.0; 6]));
        let found =
            evaluate(&Flights::read(&dataset).unwrap(), Some(("zero", predictions(&given))), &settings).unwrap();
        assert_eq!(found.methods[1].name, "predict zero");
        for key in ["lasting_m", "lasting_turn_deg", "ade_m", "fde_m", "yaw_mae_deg", "mae", "sr_1m"] {
            assert_eq!(found.methods[0].scores[key], found.methods[1].scores[key], "{key}");
        }
    }
}

#[test]
fn threads_do_not_change_a_byte() {
    let (_folder, dataset) = dataset();
    let settings = settings();
    let report = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let given = perfect(&dataset, &settings, |pose| pose.position_in_world.y += 0.3);
        let found = pool
            .install(|| evaluate(&Flights::read(&dataset).unwrap(), Some(("some", predictions(&given))), &settings))
            .unwrap();
        (found.to_json(), found.to_markdown(), found.to_svg())
    };
    let alone = report(1);
    assert!(alone == report(4));
    assert!(alone.0.contains("\"cosfly-evaluation\"") && alone.1.contains("| SR@1m %") && alone.2.contains("</svg>"));
}

#[test]
fn tracks_in_memory_do_not_change_a_byte() {
    let (_folder, dataset) = dataset();
    let settings = settings();
    let rows = perfect(&dataset, &settings, |pose| pose.position_in_world.x += 0.3);
    let [all, few] = [1_000_000, 1].map(|frames| {
        let flights = Flights::with_frames_at_once(&dataset, frames).unwrap();
        let found = evaluate(&flights, Some(("some", predictions(&rows))), &settings).unwrap();
        found.to_json()
    });
    assert!(all == few);
}

#[test]
fn what_cannot_be_scored_is_refused() {
    let (_folder, dataset) = dataset();
    let empty = |settings: &Settings| evaluate(&Flights::read(&dataset).unwrap(), None, settings).unwrap_err();
    assert_eq!(empty(&Settings::default()).code, "evaluation-no-windows");
    let error = empty(&Settings { splits: vec!["exam".into()], ..settings() });
    assert!(error.code == "evaluation-split" && error.hints[0].contains("train"), "{error:?}");
    let none =
        evaluate(&Flights::read(&dataset).unwrap(), Some(("empty", Predictions::default())), &settings()).unwrap_err();
    assert!(none.code == "evaluation-no-overlap" && none.hints[0].contains("perturbed-p0000"), "{none:?}");
}
