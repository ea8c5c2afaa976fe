//! Questions to a language model behind an OpenAI-compatible server: every answer is kept under its question, so that the same
//! questions have the same answers ever after, without a network as well.
//!
//! * [`TeacherConfig`]: model, sampling, server, budget.
//! * [`Question`]: texts and pictures; its digest is the key of the answer.
//! * [`Teacher`]: asks what has no kept answer, within rate, budget and retries.

mod ask;
mod budget;
mod client;
mod config;
mod envelope;
mod gate;
mod question;
mod record;
#[cfg(test)]
mod tests;

pub use ask::{Reply, Teacher};
pub use config::{BudgetConfig, Frames, JsonMode, ServerConfig, TeacherConfig, WhenSpent};
pub use question::Question;
pub use record::Answer;
