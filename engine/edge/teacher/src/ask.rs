//! Asking: the kept answer, or a new one that is kept before anybody sees it.

use crate::budget::{SPENT, book, settle};
use crate::client::{Client, Sent};
use crate::config::{TeacherConfig, WhenSpent};
use crate::gate::{Gate, pause};
use crate::question::Question;
use crate::record::{Answer, Record};
use cosfly_diagnose::Result;
use cosfly_fingerprint::{Digest, canonical_json};
use cosfly_stage::Answers;
use serde_json::json;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, SystemTime};

/// Pause before the first repetition of a request; each further one is twice as long.
const FIRST_PAUSE: Duration = Duration::from_millis(500);
const LONGEST_PAUSE: Duration = Duration::from_secs(30);

/// What is known of a question.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reply {
    /// The answer.
    Answer(Answer),
    /// No answer came, or none fits into the budget; why.
    Lost(String),
}

/// A model behind a server.
pub struct Teacher {
    config: TeacherConfig,
    gate: Gate,
    /// Made with the first question that has no kept answer: a run without one needs neither key nor network.
    client: Mutex<Option<std::sync::Arc<Client>>>,
}

impl Teacher {
    /// A teacher of checked parameters.
    pub fn new(config: TeacherConfig) -> Self {
        Self { config, gate: Gate::default(), client: Mutex::default() }
    }

    /// The parameters.
    pub fn config(&self) -> &TeacherConfig {
        &self.config
    }

    /// The answer to a question. What was answered or lost before is not asked again.
    ///
    /// # Errors
    /// Those of `keep_going`, of the store, of an unreachable server, of a refused key or question; `teacher-budget`.
    pub fn ask(
        &self,
        question: &Question<'_>,
        answers: &dyn Answers,
        keep_going: &dyn Fn() -> Result<()>,
    ) -> Result<Reply> {
        let key = question.digest(&self.config);
        let losses = [self.lost_key(&key, &json!({"round": self.config.round})), self.lost_key(&key, &self.budget())];
        for kept in [&key, &losses[0], &losses[1]] {
            if let Some(record) = answers.answer(kept).as_deref().and_then(Record::of_line) {
                return Ok(reply(record));
            }
        }
        let client = self.client()?;
        let body = question.body(&self.config);
        let mut wait = FIRST_PAUSE;
        let mut why = String::new();
        for request in 1..=self.config.server.retries + 1 {
            let passed = self.gate.pass(&self.config.server, keep_going)?;
            let booking = match book(&self.config, answers, question.estimated_tokens()) {
                Err(refusal) if refusal.code == SPENT && self.config.budget.when_spent == WhenSpent::Template => {
                    return keep(answers, &losses[1], &Record::Lost("the budget is spent".to_owned()));
                }
                booking => booking?,
            };
            let sent = client.send(&body);
            let estimated = question.estimated_tokens();
            let tokens = match &sent {
                Ok(Sent::Came(it)) => {
                    let written = it.content.len() as u64 / 2 + 1;
                    [it.input_tokens.unwrap_or(estimated), it.output_tokens.unwrap_or(written)]
                }
                Ok(Sent::TooLong) => [estimated, u64::from(self.config.max_tokens)],
                _ => [0, 0],
            };
            settle(&self.config, answers, &booking, tokens)?;
            let answer = |content: String, served_model: String, finish: String| Answer {
                content,
                model: self.config.model.clone(),
                served_model,
                prompt_version: self.config.prompt_version,
                finish,
                input_tokens: tokens[0],
                output_tokens: tokens[1],
                requests: request,
                unix_s: now_unix_s(),
            };
            let pause_for = match sent? {
                Sent::Came(it) => {
                    return keep(answers, &key, &Record::Answer(answer(it.content, it.served_model, it.finish)));
                }
                Sent::TooLong => {
                    let record = Record::Answer(answer(String::new(), String::new(), "too_long".to_owned()));
                    return keep(answers, &key, &record);
                }
                Sent::Later(reason, pause) => {
                    why = format!("{reason} after {request} requests");
                    pause.unwrap_or(wait)
                }
            };
            drop(passed);
            if request <= self.config.server.retries {
                pause(pause_for, keep_going)?;
                wait = (2 * wait).min(LONGEST_PAUSE);
            }
        }
        keep(answers, &losses[0], &Record::Lost(why))
    }

    fn budget(&self) -> serde_json::Value {
        let budget = &self.config.budget;
        json!({"calls": budget.calls, "tokens": budget.tokens, "money": budget.money})
    }

    /// Key of a loss: it holds under some condition only, such as a round.
    fn lost_key(&self, question: &Digest, under: &serde_json::Value) -> Digest {
        Digest::of(format!("cosfly.lost/1\n{question}\n{}", canonical_json(under)).as_bytes())
    }

    fn client(&self) -> Result<std::sync::Arc<Client>> {
        let mut client = self.client.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(client) = &*client {
            return Ok(std::sync::Arc::clone(client));
        }
        let made = std::sync::Arc::new(Client::new(&self.config.server)?);
        *client = Some(std::sync::Arc::clone(&made));
        Ok(made)
    }
}

/// Keeps a record; the one that was kept first counts.
fn keep(answers: &dyn Answers, key: &Digest, record: &Record) -> Result<Reply> {
    let kept = answers.keep(key, &record.to_line())?;
    Ok(reply(Record::of_line(&kept).unwrap_or_else(|| record.clone())))
}

fn reply(record: Record) -> Reply {
    match record {
        Record::Answer(answer) => Reply::Answer(answer),
        Record::Lost(why) => Reply::Lost(why),
    }
}

/// The date of an answer is a fact about it, kept with it; no output is computed from it.
fn now_unix_s() -> u64 {
    SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).map_or(0, |time| time.as_secs())
}
