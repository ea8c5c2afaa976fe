//! The result of an evaluation, and its forms: JSON, Markdown, a picture.

mod markdown;
mod plot;
pub mod result;
pub mod score;
pub(crate) mod table;

pub use result::{
    AnchorReport, AnchoredMethod, DatasetFacts, Evaluation, MethodReport, RowFacts, StratumReport, WindowFacts,
};
pub use score::{Score, Scores};
