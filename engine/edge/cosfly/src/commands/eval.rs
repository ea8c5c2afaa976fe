//! `cosfly eval`: scores of predictions on a dataset, of waypoints beside baselines, or of pictures.

use super::Outcome;
use crate::arguments::{AnchorChoice, EvalArguments, FrameChoice, KindChoice, OriginChoice, RoleChoice};
use crate::exit;
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_evaluate::pictures::{self, PictureKind, PictureSettings};
use cosfly_evaluate::windows::Flights;
use cosfly_evaluate::{Evaluation, InputRole, Settings, evaluate, name_of};
use cosfly_metrics::baselines::Anchor;
use cosfly_metrics::{DeltaFrame, DeltaOrigin, WindowShape};
use cosfly_read::PublishedDataset;
use cosfly_read::predictions;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// A report in three forms.
struct Reports {
    markdown: String,
    json: String,
    svg: String,
    has_malformed: bool,
}

/// Prints the report and writes it in three forms.
pub fn eval(arguments: &EvalArguments) -> Outcome {
    let reports = reports(arguments).map_err(|refusal| vec![refusal])?;
    let folder = folder(arguments);
    write(&folder, &reports).map_err(|refusal| vec![refusal])?;
    if arguments.json {
        crate::print(&reports.json)?;
    } else {
        let text = &reports.markdown;
        crate::print(&format!("{text}\nwritten to {}: report.md, report.json, errors.svg\n", folder.display()))?;
    }
    Ok(if reports.has_malformed { exit::FOUND_PROBLEMS } else { exit::SUCCESS })
}

fn reports(arguments: &EvalArguments) -> Result<Reports> {
    if let Some((path, kind)) = picture_kind(arguments)? {
        let dataset = PublishedDataset::open(&arguments.dataset)?;
        let flights = Flights::read(&dataset)?;
        let found = pictures::evaluate(&dataset, &flights, path, &picture_settings(kind, arguments))?;
        let has_malformed = found.files.malformed > 0;
        return Ok(Reports {
            markdown: found.to_markdown(),
            json: found.to_json(),
            svg: found.to_svg(),
            has_malformed,
        });
    }
    let found = evaluation(arguments)?;
    let has_malformed = found.rows.as_ref().is_some_and(|rows| rows.malformed > 0);
    Ok(Reports { markdown: found.to_markdown(), json: found.to_json(), svg: found.to_svg(), has_malformed })
}

/// The kind that was asked for, or that the predictions look like; none for waypoints.
fn picture_kind(arguments: &EvalArguments) -> Result<Option<(&Path, PictureKind)>> {
    let Some(path) = arguments.predictions.as_deref() else { return Ok(None) };
    let kind = match arguments.kind {
        Some(KindChoice::Waypoints) => None,
        Some(KindChoice::Depth) => Some(PictureKind::Depth),
        Some(KindChoice::Semantic) => Some(PictureKind::Semantic),
        Some(KindChoice::Boxes) => Some(PictureKind::Boxes),
        Some(KindChoice::Masks) => Some(PictureKind::Masks),
        None => pictures::recognise(path)?,
    };
    Ok(kind.map(|kind| (path, kind)))
}

fn picture_settings(kind: PictureKind, arguments: &EvalArguments) -> PictureSettings {
    let of_pictures = &arguments.pictures;
    PictureSettings {
        splits: arguments.splits.clone(),
        every: of_pictures.every,
        max_depth_m: of_pictures.max_depth,
        depth_per_metre: of_pictures.depth_per_metre,
        categories: of_pictures.categories.clone(),
        images: of_pictures.images.clone(),
        resamples: arguments.resamples,
        seed: arguments.seed,
        ..PictureSettings::new(kind)
    }
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

fn write(folder: &Path, reports: &Reports) -> Result<()> {
    let refused = |path: &Path, error: &std::io::Error| Diagnostic::io(format!("write `{}`", path.display()), error);
    std::fs::create_dir_all(folder).map_err(|error| refused(folder, &error))?;
    for (name, text) in [("report.md", &reports.markdown), ("report.json", &reports.json), ("errors.svg", &reports.svg)]
    {
        let path = folder.join(name);
        std::fs::write(&path, text).map_err(|error| refused(&path, &error))?;
    }
    Ok(())
}
