//! Policies of an evaluation: baselines, servers, functions in Python.

mod answer;
mod baseline;
mod first_answer;
mod process;
mod python;
mod question;
mod socket;
mod source;

pub use answer::{ActionKind, Answer, wrong_number};
pub use first_answer::{Asked, FirstAnswer};
pub use source::source_of;

use cosfly_diagnose::{Diagnostic, Fault, Result, nearest_name, visible_text};
use cosfly_env::pictures::PictureFormat;
use cosfly_env::policies::{BASELINES, Knowledge};
use cosfly_env::{Action, Environment};
use cosfly_secrets::{Secrets, has_secret, without_secrets};
use std::path::PathBuf;
use std::time::Duration;

/// Characters of a policy's text that are looked at.
const LONGEST_TEXT: usize = 8192;

/// Where a policy is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// One of [`BASELINES`], by its name.
    Baseline(&'static str),
    /// `ws://HOST:PORT`, a server that speaks openpi's wire.
    Socket(String),
    /// `python:module:function`.
    Python {
        /// Module.
        module: String,
        /// Function of the module: takes an observation, gives an action.
        function: String,
    },
}

impl Place {
    /// Reads `ws://HOST:PORT`, `python:module:function` or the name of a baseline.
    ///
    /// # Errors
    /// `fly-policy`, with what is allowed.
    pub fn read(text: &str) -> Result<Self> {
        let refused = |message: String| Diagnostic::new("fly-policy", Fault::Recipe, message);
        // The address names folders and stands on cards and pages.
        if has_secret(text) {
            let message = format!("`{}` holds a name, a password or a key", without_secrets(text));
            return Err(refused(message).hint(
                "give the key of a server in the environment variable COSFLY_API_KEY, or with `--api-key`; it is written nowhere",
            ));
        }
        if text.starts_with("ws://") {
            return Ok(Self::Socket(text.to_owned()));
        }
        if text.starts_with("wss://") {
            let message = format!("`{text}` asks for an encrypted connection, which `cosfly fly` does not make");
            return Err(refused(message).hint("use ws://, through a tunnel such as `ssh -L` where the network is open"));
        }
        if let Some(rest) = text.strip_prefix("python:") {
            let parts: Vec<&str> = rest.split(':').collect();
            return match parts[..] {
                [module, function] if !module.is_empty() && !function.is_empty() => {
                    Ok(Self::Python { module: module.to_owned(), function: function.to_owned() })
                }
                _ => Err(refused(format!("`{text}` must be `python:MODULE:FUNCTION`"))),
            };
        }
        let names = || BASELINES.iter().map(|it| it.name);
        if let Some(baseline) = BASELINES.iter().find(|it| it.name == text) {
            return Ok(Self::Baseline(baseline.name));
        }
        let problem = refused(format!("there is no policy `{text}`"));
        let problem = match nearest_name(text, names()) {
            Some(near) => problem.hint(format!("did you mean `{near}`?")),
            None => problem,
        };
        let names: Vec<&str> = names().collect();
        Err(problem.hint(format!("allowed are ws://HOST:PORT, python:MODULE:FUNCTION, {}", names.join(", "))))
    }

    /// Name in tables and of folders, where none is given.
    pub fn name(&self) -> String {
        let safe = |text: &str| {
            let kept = |c: char| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '-' };
            text.chars().map(kept).collect::<String>()
        };
        match self {
            Self::Baseline(name) => (*name).to_owned(),
            Self::Socket(address) => safe(address.trim_start_matches("ws://")),
            Self::Python { module, function } => safe(&format!("{module}.{function}")),
        }
    }
}

/// How policies are asked.
#[derive(Clone, Debug)]
pub struct Manners {
    /// Kind of their actions.
    pub actions: ActionKind,
    /// Steps after which a policy is asked again, at least 1; rows of its last answer are flown meanwhile.
    pub every: u32,
    /// Pictures that observations carry.
    pub pictures: Option<PictureFormat>,
    /// Text of the task that observations carry.
    pub prompt: String,
    /// Time within which an answer must come.
    pub timeout: Duration,
    /// Time for which a policy that is absent is waited for.
    pub wait: Duration,
    /// Value of the header `Authorization: Api-Key ...`.
    pub api_key: Option<String>,
    /// The command of Python.
    pub python: PathBuf,
}

impl Manners {
    /// A text of a policy as rows and errors show it: without secrets, without what controls a terminal, cut at its end.
    fn beginning_of(&self, text: &str, kept: usize) -> String {
        let text: String = text.trim().chars().take(LONGEST_TEXT).collect();
        self.shown(&text).chars().take(kept).collect()
    }

    /// The same, cut at its beginning: what tracebacks end with.
    fn end_of(&self, text: &str, kept: usize) -> String {
        let last = |text: &str, count: usize| {
            let skipped = text.chars().count().saturating_sub(count);
            (text.chars().skip(skipped).collect::<String>(), skipped > 0)
        };
        // Cut in two steps: no secret is cut in the middle and kept in part.
        let (text, _) = last(text.trim(), LONGEST_TEXT);
        let (end, is_cut) = last(&self.shown(&text), kept);
        if is_cut { format!("... {end}") } else { end }
    }

    fn shown(&self, text: &str) -> String {
        visible_text(&Secrets::of(self.api_key.clone()).with_environment(std::env::vars_os()).hidden(text))
    }
}

/// Why a policy gave no action.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Failure {
    /// It answered wrongly or not in time: the episode ends and says so.
    Answer(String),
    /// It is gone: the episode may be flown again.
    Gone(String),
}

/// The reason for no answer in time, in words.
fn late(within: Duration) -> String {
    format!("no answer within {} s (`--timeout`)", within.as_secs_f64())
}

/// A policy as episodes see it.
pub trait Pilot {
    /// Begins an episode.
    ///
    /// # Errors
    /// The reason why the policy cannot be had, in words: it was waited for already.
    fn begin(&mut self, environment: &Environment, knowledge: &Knowledge) -> std::result::Result<(), String>;

    /// Action for the present observation.
    ///
    /// # Errors
    /// [`Failure`].
    fn act(&mut self, environment: &Environment) -> std::result::Result<Action, Failure>;
}

/// The policy at a place, for one thread.
pub fn open(place: &Place, manners: &Manners) -> Box<dyn Pilot> {
    match place {
        Place::Baseline(name) => Box::new(baseline::BaselinePilot::new(name)),
        Place::Socket(address) => Box::new(socket::SocketPilot::new(address, manners.clone())),
        Place::Python { module, function } => Box::new(python::PythonPilot::new(module, function, manners.clone())),
    }
}
