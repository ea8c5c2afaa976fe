//! Answers of services outside: inputs that nobody can compute again.

use cosfly_diagnose::Result;
use cosfly_fingerprint::Digest;
use serde::{Deserialize, Serialize};

/// Requests to a service, counted on one account.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spent {
    /// Number of requests sent.
    pub calls: u64,
    /// Tokens sent.
    pub input_tokens: u64,
    /// Tokens received.
    pub output_tokens: u64,
}

/// Requests that an item may send to a service outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asks {
    /// Number of questions that every item has.
    pub questions: u64,
    /// Largest number of questions of an item, with those that repeat a refused answer.
    pub most_questions: u64,
    /// Estimated tokens of a question.
    pub input_tokens: u64,
    /// Estimated tokens of an answer.
    pub output_tokens: u64,
    /// Price of a million tokens of questions and of answers, in any currency; 0 where nobody said.
    pub prices: [f64; 2],
}

/// Kept answers, each under the digest of its question. Implemented by the store.
pub trait Answers: Send + Sync {
    /// The kept answer to a question, one line of text; `None` where there is none or it is damaged.
    fn answer(&self, question: &Digest) -> Option<String>;

    /// Keeps an answer, one line of text, durable on return. The first answer to a question stays; gives the one that is kept.
    ///
    /// # Errors
    /// Those of the disk.
    fn keep(&self, question: &Digest, answer: &str) -> Result<String>;

    /// Changes an account, one process at a time; an error of `change` leaves it as it was.
    ///
    /// # Errors
    /// Those of `change` and of the disk, and `store-damaged-account`.
    fn account(&self, account: &Digest, change: &mut dyn FnMut(&mut Spent) -> Result<()>) -> Result<()>;
}

impl Asks {
    /// Price of so many questions.
    pub fn price(&self, questions: u64) -> f64 {
        let tokens = [self.input_tokens, self.output_tokens].map(|tokens| questions.saturating_mul(tokens) as f64);
        (tokens[0] * self.prices[0] + tokens[1] * self.prices[1]) / 1e6
    }
}
