//! Choices of an evaluation of pictures.

use cosfly_metrics::bootstrap;
use serde::Serialize;
use std::path::PathBuf;

/// Kind of predicted pictures.
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
    /// Tracks of many bodies.
    Tracks,
    /// Boxes of the target alone.
    Target,
}

impl PictureKind {
    /// The name, also of the folder in an export.
    pub fn name(self) -> &'static str {
        match self {
            Self::Depth => "depth",
            Self::Semantic => "semantic",
            Self::Boxes => "boxes",
            Self::Masks => "masks",
            Self::Tracks => "tracks",
            Self::Target => "target",
        }
    }
}

/// Choices; all of them are written into the report.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PictureSettings {
    /// Kind of predictions.
    pub kind: PictureKind,
    /// The splits to score; empty: those of the predicted flights.
    pub splits: Vec<String>,
    /// Frames from one expected prediction to the next.
    pub every: usize,
    /// Pixels whose true depth is more do not count, metres.
    pub max_depth_m: f64,
    /// Whole number of a depth picture that is one metre.
    pub depth_per_metre: f64,
    /// CARLA's labels that are detected; empty: all.
    pub categories: Vec<u8>,
    /// File of annotations that names the images behind numbers.
    pub images: Option<PathBuf>,
    /// List of the sequences that a tracker saw, or the export that has it; none: all flights under their names.
    pub sequences: Option<PathBuf>,
    /// Resamples behind an interval.
    pub resamples: usize,
    /// Seed of the resamples.
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
            sequences: None,
            resamples: bootstrap::RESAMPLES,
            seed: 1,
        }
    }
}
