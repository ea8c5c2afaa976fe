//! Scores of predictions on a published dataset, beside baselines, by strata, with intervals.
//!
//! * [`settings`]: choices of an evaluation.
//! * [`windows`]: the windows of a dataset that are to be predicted.
//! * [`join`]: the prediction of each window, and rows that belong to none.
//! * [`methods`]: predictions and baselines, asked alike for the waypoints of a window.
//! * [`strata`] and [`scoring`]: errors, added up by trajectory and stratum.
//! * [`pictures`]: the same for predicted pictures: depth, labels, boxes, masks.
//! * [`report`]: the result as JSON, Markdown and a picture.

pub mod join;
pub mod methods;
pub mod pictures;
pub mod report;
pub mod scoring;
pub mod settings;
pub mod strata;
pub mod windows;

mod evaluation;

pub use evaluation::evaluate;
pub use report::Evaluation;
pub use settings::{InputRole, Settings};

/// The last part of a path, as reports name it.
pub fn name_of(path: &std::path::Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}
