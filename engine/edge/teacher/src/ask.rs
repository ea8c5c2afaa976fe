//! Asking: the kept answer, or a new one that is kept before anybody sees it.

use crate::budget::{SPENT, book, settle};
use crate::client::{Client, Sent};
use crate::config::{TeacherConfig, WhenSpent};
use crate::envelope::Envelope;
use crate::gate::{Gate, pause};
use crate::question::Question;
use crate::record::{Answer, Record};
use cosfly_diagnose::{Result, counted};
use cosfly_fingerprint::{Digest, canonical_json};
use cosfly_stage::Answers;
use serde_json::json;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, SystemTime};

/// Pause before the first repetition of a request; each further one is twice as long.
const FIRST_PAUSE: Duration = Duration::from_millis(500);
const LONGEST_PAUSE: Duration = Duration::from_secs(30);

/// State of a question.
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
        let (mut why, mut failures) = (String::new(), 0);
        for request in 1..=self.config.server.retries + 1 {
            let passed = self.gate.pass(&self.config.server, keep_going)?;
            let booking = match book(&self.config, answers, question.estimated_tokens()) {
                Err(refusal) if refusal.code == SPENT && self.config.budget.when_spent == WhenSpent::Template => {
                    return keep(answers, &losses[1], &Record::Lost("the budget is spent".to_owned()));
                }
                booking => booking?,
            };
            let sent = client.send(&body, &idempotency_key(&key, self.config.round, failures));
            let tokens = self.tokens(&sent, question.estimated_tokens());
            // What arrived is durable before anything else happens, the account too: a booking that is never corrected is only
            // too high, an answer that is lost would be asked for and paid again.
            let kept = match &sent {
                Ok(Sent::Came(it)) => {
                    Some(keep(answers, &key, &Record::Answer(self.answer(it.clone(), tokens, request)))?)
                }
                Ok(Sent::TooLong) => {
                    let unread = Envelope { finish: "too_long".to_owned(), ..Envelope::default() };
                    Some(keep(answers, &key, &Record::Answer(self.answer(unread, tokens, request)))?)
                }
                _ => None,
            };
            settle(&self.config, answers, &booking, tokens)?;
            if let Some(reply) = kept {
                return Ok(reply);
            }
            let pause_for = match sent? {
                Sent::Later { why: reason, pause, is_refusal } => {
                    why = format!("{reason} after {request}", request = counted(request, "request"));
                    failures += u32::from(is_refusal);
                    pause.unwrap_or(wait)
                }
                Sent::Came(_) | Sent::TooLong => wait,
            };
            drop(passed);
            if request <= self.config.server.retries {
                pause(pause_for, keep_going)?;
                wait = (2 * wait).min(LONGEST_PAUSE);
            }
        }
        keep(answers, &losses[0], &Record::Lost(why))
    }

    /// Tokens of a question and its answer: those that the server counts, else an estimate; none where no answer came.
    fn tokens(&self, sent: &Result<Sent>, estimated: u64) -> [u64; 2] {
        match sent {
            Ok(Sent::Came(it)) => {
                let written = it.content.len() as u64 / 2 + 1;
                [it.input_tokens.unwrap_or(estimated), it.output_tokens.unwrap_or(written)]
            }
            Ok(Sent::TooLong) => [estimated, u64::from(self.config.max_tokens)],
            _ => [0, 0],
        }
    }

    fn answer(&self, came: Envelope, tokens: [u64; 2], requests: u32) -> Answer {
        Answer {
            content: came.content,
            model: self.config.model.clone(),
            served_model: came.served_model,
            prompt_version: self.config.prompt_version,
            finish: came.finish,
            input_tokens: tokens[0],
            output_tokens: tokens[1],
            requests,
            unix_s: now_unix_s(),
        }
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

/// Name of a request for servers that know `Idempotency-Key`: sent again after a kill, a cut connection or a time-out, the request
/// gets the answer that was computed then. After an error of the server it has another name, so that no error is repeated.
fn idempotency_key(question: &Digest, round: u32, failures: u32) -> String {
    format!("cosfly-{question}-{round}-{failures}")
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
