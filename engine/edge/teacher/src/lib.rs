//! Questions to a language model behind an OpenAI-compatible server: every answer is kept under its question, so that the same
//! questions have the same answers ever after, without a network as well.
//!
//! * [`TeacherConfig`]: model, sampling, server, budget.
//! * [`Question`]: texts and pictures; its digest is the key of the answer.
//! * [`Teacher`]: asks what has no kept answer, within rate, budget and retries.
//! * [`TextRequest`]: texts of a flight, judged, asked for again, replaced by the template's.

mod ask;
mod budget;
mod client;
mod config;
mod envelope;
mod frames;
mod gate;
mod question;
mod record;
#[cfg(test)]
mod tests;
mod texts;

pub use ask::{Reply, Teacher};
pub use config::{BudgetConfig, JsonMode, ServerConfig, TeacherConfig, TeacherFrames, WhenSpent};
pub use question::Question;
pub use record::Answer;
pub use texts::{TextRequest, record_of, told};
