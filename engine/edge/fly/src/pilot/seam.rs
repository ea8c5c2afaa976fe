//! [`Pilot`]: a policy as episodes see it.

use cosfly_env::policies::Knowledge;
use cosfly_env::{Action, Environment};
use std::time::Duration;

/// Why a policy gave no action.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PilotFailure {
    /// A wrong answer, or none in time: the episode ends and says so.
    Answer(String),
    /// The policy is gone: the episode may be flown again.
    Gone(String),
}

/// The reason for no answer in time, in words.
pub(super) fn late(within: Duration) -> String {
    format!("no answer within {} s (`--timeout-s`)", within.as_secs_f64())
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
    /// [`PilotFailure`].
    fn act(&mut self, environment: &Environment) -> std::result::Result<Action, PilotFailure>;
}
