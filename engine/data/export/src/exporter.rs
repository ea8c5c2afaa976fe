//! The seam: what a format is, and what every export may be told.

use crate::folder::OutFolder;
use crate::source::Source;
use cosfly_diagnose::Result;
use cosfly_metrics::{DeltaFrame, WindowShape};

/// A format that published datasets can be written in.
///
/// Laws, tested over all of them: the same dataset gives the same bytes; no folder has more than 1,000 entries unless the
/// format prescribes it; a refused export leaves nothing; all chosen frames are there.
pub trait Exporter: Sync {
    /// Its name on the command line.
    fn name(&self) -> &'static str;

    /// What it is, in one line.
    fn about(&self) -> &'static str;

    /// Writes the chosen flights into `out`; gives remarks for the user.
    ///
    /// # Errors
    /// What the format cannot hold, and what is wrong with the dataset or the machine.
    fn export(&self, source: &Source<'_>, out: &OutFolder) -> Result<Vec<String>>;
}

/// Flights that models see.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    /// Perturbed ones, to learn the way back.
    Perturbed,
    /// Experts.
    Expert,
}

/// Scale of boxes in texts; families of models differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoxScale {
    /// Pixels of the pictures.
    Pixels,
    /// Thousandths of width and height.
    Thousandths,
}

/// What an export is told. Formats that a field does not concern do not read it.
#[derive(Clone, Debug)]
pub struct Options {
    /// Splits to export; all when empty.
    pub splits: Vec<String>,
    /// Flights to export; all when empty.
    pub trajectories: Vec<String>,
    /// Every how many frames there is a picture; formats of pictures only.
    pub every: usize,
    /// Language of instructions.
    pub language: String,
    /// Axes of actions and increments.
    pub delta_frame: DeltaFrame,
    /// Flights that windows are cut from.
    pub input: Input,
    /// Scale of boxes in texts.
    pub box_scale: BoxScale,
    /// How windows are cut.
    pub window: WindowShape,
    /// Names of CARLA towns for towns of other names, such as `downtown` -> `Town01`.
    pub towns: Vec<(String, String)>,
    /// Size from which on a new shard begins, bytes.
    pub shard_bytes: u64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            splits: vec![],
            trajectories: vec![],
            every: 1,
            language: "en".into(),
            delta_frame: DeltaFrame::World,
            input: Input::Perturbed,
            box_scale: BoxScale::Pixels,
            window: WindowShape::default(),
            towns: vec![],
            shard_bytes: 300_000_000,
        }
    }
}
