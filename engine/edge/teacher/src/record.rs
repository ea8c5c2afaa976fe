//! Kept answers: what a model wrote, or that nothing came.

use cosfly_fingerprint::canonical_json;
use serde::{Deserialize, Serialize};

/// An answer of a model.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Answer {
    /// Text of the model; empty where it was too long to be read.
    pub content: String,
    /// Model, as the recipe names it.
    pub model: String,
    /// Model, as the server names it.
    pub served_model: String,
    /// Version of the prompt.
    pub prompt_version: u32,
    /// Why the answer ends, as the server says, or `too_long`.
    pub finish: String,
    /// Tokens of the question.
    pub input_tokens: u64,
    /// Tokens of the answer.
    pub output_tokens: u64,
    /// Number of requests that the answer took.
    pub requests: u32,
    /// Time of the answer, seconds since 1970.
    pub unix_s: u64,
}

/// Record kept under a key.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Record {
    /// An answer.
    Answer(Answer),
    /// No answer came; why.
    Lost(String),
}

impl Record {
    /// One line of text.
    pub fn to_line(&self) -> String {
        canonical_json(self)
    }

    /// Reads a line; `None` where it is none of this version.
    pub fn of_line(line: &str) -> Option<Self> {
        serde_json::from_str(line).ok()
    }
}
