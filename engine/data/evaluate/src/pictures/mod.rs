//! Scores of predicted pictures: depth, labels, detected boxes and masks.
//!
//! * [`files`], [`given`] and [`raster`]: which file or row belongs to which frame, and what is in it.
//! * [`kinds`]: kinds of frames that are scored separately.
//! * [`tallies`] with [`depth`], [`labels`] and [`detections`]: what is counted, and its intervals.
//! * [`report`]: the result as JSON, Markdown and a picture.

mod depth;
mod detections;
mod distances;
mod evaluation;
mod files;
mod given;
mod kinds;
mod labels;
mod markdown;
mod plot;
mod raster;
pub mod report;
mod tallies;

pub use evaluation::evaluate;
pub use report::PictureEvaluation;

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_metrics::bootstrap;
use cosfly_read::predictions::detections as detection_rows;
use serde::Serialize;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// What is predicted of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum PictureKind {
    /// Depth of every pixel.
    Depth,
    /// Label of every pixel.
    Semantic,
    /// Boxes of things.
    Boxes,
    /// Masks of things.
    Masks,
}

impl PictureKind {
    /// The name, also of the folder in an export.
    pub fn name(self) -> &'static str {
        match self {
            Self::Depth => "depth",
            Self::Semantic => "semantic",
            Self::Boxes => "boxes",
            Self::Masks => "masks",
        }
    }
}

/// Choices; all of them are written into the report.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PictureSettings {
    /// What is predicted.
    pub kind: PictureKind,
    /// The splits to score; empty: those of the predicted flights.
    pub splits: Vec<String>,
    /// Every how many frames a prediction is expected.
    pub every: usize,
    /// Pixels whose true depth is more do not count, metres.
    pub max_depth_m: f64,
    /// What whole numbers of depth pictures count a metre as.
    pub depth_per_metre: f64,
    /// CARLA's labels that are detected; empty: all.
    pub categories: Vec<u8>,
    /// File of annotations that explains numbers of images.
    pub images: Option<PathBuf>,
    /// Resamples behind an interval.
    pub resamples: usize,
    /// Their seed.
    pub seed: u64,
}

impl PictureSettings {
    /// The usual choices.
    pub fn new(kind: PictureKind) -> Self {
        Self {
            kind,
            splits: vec![],
            every: 1,
            max_depth_m: 80.0,
            depth_per_metre: 100.0,
            categories: vec![],
            images: None,
            resamples: bootstrap::RESAMPLES,
            seed: 1,
        }
    }
}

/// What the predictions at `path` are, by what is there; `None` for waypoints.
///
/// # Errors
/// A folder whose kind cannot be told, with what to say then.
pub fn recognise(path: &Path) -> Result<Option<PictureKind>> {
    if !path.is_dir() {
        let mut start = vec![];
        let read = File::open(path).and_then(|file| file.take(1 << 16).read_to_end(&mut start));
        let detections = if read.is_ok() { detection_rows::recognise(&start) } else { None };
        return Ok(detections.map(|masks| if masks { PictureKind::Masks } else { PictureKind::Boxes }));
    }
    let unclear = |what: String| {
        let message = format!("`{}` {what}", path.display());
        Diagnostic::new("evaluation-kind", Fault::Recipe, message)
            .hint("say what it predicts with `--kind depth` or `--kind semantic`")
    };
    let (pictures, _) = files::pictures(path)?;
    let mut folders: Vec<&str> = pictures.iter().filter_map(|path| files::kind_folder(path)).collect();
    folders.sort_unstable();
    folders.dedup();
    folders.retain(|folder| ["depth", "semantic"].contains(folder));
    let found = match folders[..] {
        ["depth"] => Some(raster::Content::Depth),
        ["semantic"] => Some(raster::Content::Labels),
        [] => pictures.iter().take(8).find_map(|inner| raster::content(&path.join(inner))),
        _ => return Err(unclear(format!("has predictions of several kinds: {}", folders.join(", ")))),
    };
    match found {
        Some(raster::Content::Depth) => Ok(Some(PictureKind::Depth)),
        Some(raster::Content::Labels) => Ok(Some(PictureKind::Semantic)),
        None if pictures.is_empty() => Err(unclear("has no PNG file and no NumPy array".into())),
        None => Err(unclear("has pictures of which none of the first eight can be read".into())),
    }
}
