//! [`Manners`]: how policies are asked.

use super::answer::ActionKind;
use cosfly_diagnose::visible_text;
use cosfly_env::pictures::PictureFormat;
use cosfly_secrets::Secrets;
use cosfly_sensors::SensorSet;
use std::path::PathBuf;
use std::time::Duration;

/// Characters of a policy's text that are looked at.
const LONGEST_TEXT: usize = 8192;

/// How policies are asked.
#[derive(Clone, Debug)]
pub struct Manners {
    /// Kind of their actions.
    pub actions: ActionKind,
    /// Steps after which a policy is asked again, at least 1; rows of its last answer are flown meanwhile.
    pub every: u32,
    /// Pictures that observations carry.
    pub pictures: Option<PictureFormat>,
    /// Sensors whose readings observations carry, of those that the environment reads.
    pub sensors: SensorSet,
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
    pub(super) fn beginning_of(&self, text: &str, kept: usize) -> String {
        let text: String = text.trim().chars().take(LONGEST_TEXT).collect();
        self.shown(&text).chars().take(kept).collect()
    }

    /// Text of a policy cut at its beginning: tracebacks end with their reason.
    pub(super) fn end_of(&self, text: &str, kept: usize) -> String {
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
