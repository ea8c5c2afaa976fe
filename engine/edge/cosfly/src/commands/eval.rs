//! `cosfly eval`: scores of predictions on a dataset, beside baselines.

use super::Outcome;
use crate::arguments::{AnchorChoice, EvalArguments, FrameChoice, OriginChoice, RoleChoice};
use crate::exit;
use cosfly_dataset::predictions;
use cosfly_dataset::read::PublishedDataset;
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_evaluate::windows::Flights;
use cosfly_evaluate::{Evaluation, InputRole, Settings, evaluate};
use cosfly_metrics::baselines::Anchor;
use cosfly_metrics::{DeltaFrame, DeltaOrigin, WindowShape};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// Prints the report and writes it in three forms.
pub fn eval(arguments: &EvalArguments) -> Outcome {
    let evaluation = evaluation(arguments).map_err(|refusal| vec![refusal])?;
    let folder = folder(arguments);
    write(&folder, &evaluation).map_err(|refusal| vec![refusal])?;
    if arguments.json {
        crate::print(&evaluation.to_json())?;
    } else {
        let text = evaluation.to_markdown();
        crate::print(&format!("{text}\nwritten to {}: report.md, report.json, errors.svg\n", folder.display()))?;
    }
    let malformed = evaluation.rows.as_ref().is_some_and(|rows| rows.malformed > 0);
    Ok(if malformed { exit::FOUND_PROBLEMS } else { exit::SUCCESS })
}

fn evaluation(arguments: &EvalArguments) -> Result<Evaluation> {
    // Both take seconds when they are large.
    let (flights, given) = std::thread::scope(|scope| {
        let reader = scope.spawn(|| PublishedDataset::open(&arguments.dataset).and_then(|it| Flights::read(&it)));
        let given =
            arguments.predictions.as_deref().map(|path| predictions::read(path).map(|rows| (name_of(path), rows)));
        (reader.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)), given.transpose())
    });
    let (flights, given) = (flights?, given?);
    let (name, rows) = given.unzip();
    evaluate(&flights, name.as_deref().zip(rows), &settings(arguments))
}

fn name_of(path: &Path) -> String {
    path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

fn settings(arguments: &EvalArguments) -> Settings {
    Settings {
        window: WindowShape { history: arguments.history, horizon: arguments.horizon, stride: arguments.stride },
        delta_frame: match arguments.frame {
            FrameChoice::World => DeltaFrame::World,
            FrameChoice::Body => DeltaFrame::Body,
        },
        delta_origin: match arguments.from {
            OriginChoice::Previous => DeltaOrigin::Previous,
            OriginChoice::Current => DeltaOrigin::Current,
        },
        anchor: match arguments.anchor {
            AnchorChoice::Input => Anchor::Input,
            AnchorChoice::Expert => Anchor::Expert,
        },
        input: match arguments.input {
            RoleChoice::Perturbed => InputRole::Perturbed,
            RoleChoice::Expert => InputRole::Expert,
        },
        splits: arguments.splits.clone(),
        missing_as_zero: arguments.missing_as_zero,
        resamples: arguments.resamples,
        seed: arguments.seed,
        train: arguments.train,
        ..Settings::default()
    }
}

/// Beside the predictions, or beside the dataset when there are none.
fn folder(arguments: &EvalArguments) -> PathBuf {
    if let Some(out) = &arguments.out {
        return out.clone();
    }
    let beside = arguments.predictions.as_deref().map_or(arguments.dataset.as_path(), |path| path);
    let stem = if arguments.predictions.is_some() { beside.file_stem() } else { beside.file_name() };
    let mut name = stem.map_or_else(|| OsString::from("baselines"), OsString::from);
    name.push("-evaluation");
    beside.with_file_name(name)
}

fn write(folder: &Path, evaluation: &Evaluation) -> Result<()> {
    let refused = |path: &Path, error: &std::io::Error| Diagnostic::io(format!("write `{}`", path.display()), error);
    std::fs::create_dir_all(folder).map_err(|error| refused(folder, &error))?;
    for (name, text) in [
        ("report.md", evaluation.to_markdown()),
        ("report.json", evaluation.to_json()),
        ("errors.svg", evaluation.to_svg()),
    ] {
        let path = folder.join(name);
        std::fs::write(&path, text).map_err(|error| refused(&path, &error))?;
    }
    Ok(())
}
