//! Predictions by frame.

use super::files::PredictedFiles;
use super::raster::Refusal;
use super::report::{FileFacts, FileProblem};
use super::settings::{PictureKind, PictureSettings};
use crate::windows::Flights;
use cosfly_diagnose::{Diagnostic, Fault, Result, counted};
use cosfly_domain::SemanticLabel;
use cosfly_read::predictions::detections as rows;
use cosfly_read::predictions::detections::{Detection, ImageKey};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Place of a flight, and a frame of it.
pub type FrameKey = (usize, usize);

/// Predictions by frame.
pub enum Given {
    /// Pictures.
    Files(PredictedFiles),
    /// Detections, and the frames that `--images` lists.
    Rows {
        /// By frame.
        of_frame: BTreeMap<FrameKey, Vec<Detection>>,
        /// All that are listed, with detections or without.
        listed: Option<BTreeSet<FrameKey>>,
        /// Numbers of rows.
        facts: FileFacts,
    },
}

/// The refusal of predictions of which none can be scored.
pub fn nothing_to_score(
    given: &Given,
    present: &[FrameKey],
    flights: &Flights,
    path: &Path,
) -> Option<Box<Diagnostic>> {
    let problems = match given {
        Given::Files(files) => &files.problems,
        Given::Rows { facts, .. } => &facts.problems,
    };
    let none = match given {
        Given::Files(_) => present.is_empty(),
        // An empty list is a result: everything is missed.
        Given::Rows { facts, .. } if facts.read == 0 => present.is_empty(),
        Given::Rows { of_frame, .. } => !present.iter().any(|key| of_frame.contains_key(key)),
    };
    if !none {
        return None;
    }
    let message = format!("none of the predictions in `{}` fits a frame of `{}`", path.display(), flights.folder);
    let mut refusal = Diagnostic::new("evaluation-no-overlap", Fault::Input, message);
    for problem in problems.iter().take(3) {
        refusal = refusal.because(format!("{}: {}", problem.place, problem.reason));
    }
    let id = flights.rows.first().map_or("", |row| row.trajectory_id.as_str());
    Some(refusal.hint(match given {
        Given::Files(_) => format!("a picture that fits is `{id}/000000.png`: a folder of the trajectory, the frame's number"),
        Given::Rows { .. } => format!(
            "a row that fits is {{\"trajectory_id\": \"{id}\", \"frame\": 0, \"category_id\": 12, \"bbox\": [left, top, width, height], \"score\": 0.9}}; \
             `image_id` needs `--images annotations/instances_<split>.json`"
        ),
    }))
}

/// Reads detections and looks up their frames.
pub fn detections_by_frame(path: &Path, flights: &Flights, settings: &PictureSettings) -> Result<Given> {
    let found = rows::read(path)?;
    let mut numbers: BTreeMap<i64, FrameKey> = BTreeMap::new();
    if let Some(images) = &settings.images {
        for image in rows::read_images(images)? {
            let frame = usize::try_from(image.frame).unwrap_or(usize::MAX);
            let flight = flights.place(&image.trajectory_id).filter(|flight| frame < flights.rows[*flight].frames);
            let Some(flight) = flight else {
                let message = format!(
                    "`{}` is of another dataset: there is no frame {} of `{}`",
                    images.display(),
                    image.frame,
                    image.trajectory_id
                );
                return Err(Diagnostic::new("predictions-images", Fault::Input, message));
            };
            numbers.insert(image.id, (flight, frame));
        }
    }
    let listed = settings.images.is_some().then(|| numbers.values().copied().collect::<BTreeSet<_>>());
    let mut facts = FileFacts {
        name: crate::name_of(path),
        read: (found.rows.len() + found.problems.len()) as u64,
        scored: 0,
        elsewhere: 0,
        passed_over: 0,
        malformed: 0,
        kinds: BTreeMap::new(),
        problems: vec![],
    };
    let line = |line: u64| format!("line {line}");
    facts.problems = found
        .problems
        .into_iter()
        .map(|problem| FileProblem::new(line(problem.line), problem.kind, problem.reason))
        .collect();
    let mut of_frame: BTreeMap<FrameKey, Vec<Detection>> = BTreeMap::new();
    for row in found.rows {
        match frame_of(&row, &numbers, flights, settings) {
            Ok(Some(key)) if listed.as_ref().is_none_or(|listed| listed.contains(&key)) => {
                of_frame.entry(key).or_default().push(row);
            }
            Ok(_) => facts.elsewhere += 1,
            Err((kind, reason)) => facts.problems.push(FileProblem::new(line(row.line), kind, reason)),
        }
    }
    Ok(Given::Rows { of_frame, listed, facts })
}

/// The frame of a detection; `None` for a class that was not asked for.
fn frame_of(
    row: &Detection,
    numbers: &BTreeMap<i64, FrameKey>,
    flights: &Flights,
    settings: &PictureSettings,
) -> std::result::Result<Option<FrameKey>, Refusal> {
    let key = match &row.image {
        ImageKey::Number(number) if settings.images.is_none() => {
            return Err(("image", format!("which frame image {number} is cannot be known without `--images`")));
        }
        ImageKey::Number(number) => {
            *numbers.get(number).ok_or_else(|| ("image", format!("the list of images has no number {number}")))?
        }
        ImageKey::Frame(id, frame) => {
            let unknown = || ("unknown-trajectory", format!("the dataset has no trajectory `{id}`"));
            let flight = flights.place(id).ok_or_else(unknown)?;
            let (frame, frames) = (usize::try_from(*frame).unwrap_or(usize::MAX), flights.rows[flight].frames);
            if frame >= frames {
                return Err((
                    "no-frame",
                    format!("`{id}` has {frames}: there is no frame {frame}", frames = counted(frames, "frame")),
                ));
            }
            (flight, frame)
        }
    };
    let category = u8::try_from(row.category).ok().filter(|id| usize::from(*id) < SemanticLabel::ALL.len());
    let Some(category) = category else {
        return Err(("category", format!("`category_id` {} is none of CARLA's labels, 0 to 28", row.category)));
    };
    match (settings.kind, &row.mask, &row.edges) {
        (PictureKind::Masks, None, _) => return Err((
            "field-missing",
            "the row has no `segmentation` of run lengths: {\"size\": [h, w], \"counts\": ...}; polygons are not read"
                .into(),
        )),
        (PictureKind::Boxes, _, None) => return Err(("field-missing", "the row has no `bbox`".into())),
        _ => {}
    }
    let camera = &flights.rows[key.0].camera;
    if let (PictureKind::Masks, Some(mask)) = (settings.kind, &row.mask)
        && mask.size != [camera.width, camera.height]
    {
        let [width, height] = mask.size;
        let reason =
            format!("the mask has {width} x {height} pixels; the frame has {} x {}", camera.width, camera.height);
        return Err(("size", reason));
    }
    Ok((settings.categories.is_empty() || settings.categories.contains(&category)).then_some(key))
}
