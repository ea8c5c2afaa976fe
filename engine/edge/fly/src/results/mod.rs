//! The result of an evaluation: a folder with a card, a row and logs per episode, tables, clips and a page.

mod card;
mod differences;
mod folder;
mod metrics;
mod report;

pub use card::{Card, EnvironmentCard, KeptCard, LogChoice, PicturesCard, PolicyCard, SuiteCard};
pub use differences::differences;
pub use folder::Folder;
pub use metrics::{METRICS, Metric, MetricSummary, mean_of, strata, summary};
pub use report::{beside, cell, ending, markdown, of_summaries, scores, worst};
