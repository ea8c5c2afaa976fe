//! The result of an evaluation: a folder with a card, a row and a log per episode, and tables.

mod card;
mod folder;
mod metrics;
mod report;

pub use card::{Card, PolicyCard, SuiteCard};
pub use folder::Folder;
pub use metrics::{METRICS, Metric, Summary, mean_of, strata, summary};
pub use report::{beside, markdown, scores};
