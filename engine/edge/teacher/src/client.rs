//! One request to a server.

use crate::config::ServerConfig;
use crate::envelope::{Envelope, MOST_BYTES};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_secrets::Secrets;
use std::time::Duration;
use ureq::{Agent, Error, Timeout};

/// Time for a connection.
const CONNECT: Duration = Duration::from_secs(10);
/// Longest pause that a server may ask for.
const LONGEST_PAUSE: Duration = Duration::from_secs(60);

/// A blocking client of one server.
pub struct Client {
    agent: Agent,
    url: String,
    /// Key, never shown.
    key: Option<String>,
    secrets: Secrets,
}

/// Outcome of a request.
pub enum Sent {
    /// An answer of the protocol.
    Came(Envelope),
    /// An answer that is too long to be read.
    TooLong,
    /// No answer, and a later request may have one.
    Later {
        /// Why.
        why: String,
        /// The pause that the server asks for.
        pause: Option<Duration>,
        /// Whether the server itself said so, with a status.
        is_refusal: bool,
    },
}

impl Client {
    /// A client with the key of the environment.
    ///
    /// # Errors
    /// `teacher-key` where the variable holds no key.
    pub fn new(config: &ServerConfig) -> Result<Self> {
        let agent = Agent::config_builder()
            .http_status_as_error(false)
            .max_redirects(0)
            .timeout_connect(Some(CONNECT.min(Duration::from_secs_f64(config.timeout_s))))
            .timeout_global(Some(Duration::from_secs_f64(config.timeout_s)))
            .build();
        let url = format!("{}/chat/completions", config.address.trim_end_matches('/'));
        let key = key_of(&config.key_variable)?;
        Ok(Self { agent: agent.into(), url, secrets: Secrets::of(key.clone()), key })
    }

    /// Text without the key, should a server send it back.
    pub fn without_key(&self, text: &str) -> String {
        self.secrets.hidden(text)
    }

    /// Sends a request; `idempotency_key` is its name for servers that answer a repeated request with the first one's answer.
    ///
    /// # Errors
    /// Faults that a repetition does not help against: no server there, a wrong key, a refused request.
    pub fn send(&self, body: &[u8], idempotency_key: &str) -> Result<Sent> {
        let mut request = self.agent.post(&self.url).header("content-type", "application/json");
        request = request.header("idempotency-key", idempotency_key);
        if let Some(key) = &self.key {
            request = request.header("authorization", &format!("Bearer {key}"));
        }
        let mut response = match request.send(body) {
            Ok(response) => response,
            Err(error) => return self.failed(&error),
        };
        let status = response.status().as_u16();
        let header = response.headers().get("retry-after").and_then(|value| value.to_str().ok());
        let pause = header.and_then(|text| text.trim().parse().ok()).map(Duration::from_secs);
        match response.body_mut().with_config().limit(MOST_BYTES).read_to_vec() {
            _ if matches!(status, 408 | 409 | 425 | 429) || status >= 500 => {
                let pause = pause.map(|pause| pause.min(LONGEST_PAUSE));
                Ok(Sent::Later { why: format!("status {status}"), pause, is_refusal: true })
            }
            body if status != 200 => Err(self.refused(status, &body.unwrap_or_default())),
            Ok(body) => Ok(Envelope::read(&body).map_or_else(
                || Sent::Later {
                    why: "an answer that is no answer of the protocol".to_owned(),
                    pause: None,
                    is_refusal: true,
                },
                |envelope| {
                    Sent::Came(Envelope {
                        content: self.without_key(&envelope.content),
                        served_model: self.without_key(&envelope.served_model),
                        finish: self.without_key(&envelope.finish),
                        ..envelope
                    })
                },
            )),
            Err(Error::BodyExceedsLimit(_)) => Ok(Sent::TooLong),
            Err(_) => Ok(silence("a cut answer")),
        }
    }

    fn failed(&self, error: &Error) -> Result<Sent> {
        match error {
            Error::Timeout(Timeout::Connect | Timeout::Resolve)
            | Error::ConnectionFailed
            | Error::HostNotFound
            | Error::BadUri(_)
            | Error::Tls(_)
            | Error::Rustls(_) => Err(self.unreachable(error)),
            Error::Io(io) if io.kind() == std::io::ErrorKind::ConnectionRefused => Err(self.unreachable(error)),
            Error::Timeout(_) => Ok(silence("no answer in time")),
            _ => Ok(silence("a cut connection")),
        }
    }

    fn unreachable(&self, error: &Error) -> Box<Diagnostic> {
        let message = format!("there is no teacher at `{}`", self.url);
        Diagnostic::new("teacher-unreachable", Fault::Machine, message)
            .because(self.without_key(&error.to_string()))
            .hint("start the server, or correct `server.address`, and run the same command again: kept answers are not asked for again")
    }

    fn refused(&self, status: u16, body: &[u8]) -> Box<Diagnostic> {
        if matches!(status, 401 | 403) {
            // What such an answer says may hold parts of the key.
            let message = format!("the teacher at `{}` refuses the key (status {status})", self.url);
            return Diagnostic::new("teacher-key", Fault::Machine, message)
                .hint("put the key into the environment variable that `server.key_variable` names");
        }
        let text = self.without_key(&String::from_utf8_lossy(body));
        let text: String = text.split_whitespace().collect::<Vec<_>>().join(" ").chars().take(300).collect();
        let message = format!("the teacher at `{}` refuses the question (status {status})", self.url);
        Diagnostic::new("teacher-refused", Fault::Recipe, message)
            .because(if text.is_empty() { "it says nothing more".to_owned() } else { text })
            .hint("check `model`, `json` and `frames`: not every server knows all of them")
    }
}

/// No word of the server: the answer may have been computed.
fn silence(why: &str) -> Sent {
    Sent::Later { why: why.to_owned(), pause: None, is_refusal: false }
}

/// The key in an environment variable; none without a variable.
fn key_of(variable: &str) -> Result<Option<String>> {
    if variable.is_empty() {
        return Ok(None);
    }
    let key = std::env::var(variable).unwrap_or_default().trim().to_owned();
    if key.is_empty() || key.chars().any(|c| !c.is_ascii_graphic()) {
        let message = format!("the environment variable `{variable}` of `server.key_variable` holds no key");
        return Err(Diagnostic::new("teacher-key", Fault::Machine, message)
            .hint("set it to the key of the server, or leave `key_variable` out for a server without keys"));
    }
    Ok(Some(key))
}
