//! [`FirstAnswer`]: whether a policy has answered at all. Before that, nothing is an episode.

use super::manners::Manners;
use super::open::open;
use super::place::Place;
use super::seam::{Pilot, PilotFailure};
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_env::policies::Knowledge;
use cosfly_env::{Action, Environment};
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether a policy has given a right answer since the command began.
#[derive(Debug, Default)]
pub struct FirstAnswer {
    came: AtomicBool,
}

impl FirstAnswer {
    /// Whether it came.
    pub fn came(&self) -> bool {
        self.came.load(Ordering::Acquire)
    }

    /// Notes that it came.
    pub fn tell(&self) {
        self.came.store(true, Ordering::Release);
    }

    /// The refusal where a policy could not be had for `missing` episodes: it is not set up, or went away after it had answered.
    pub fn refusal(&self, policy: &str, reason: &str, missing: usize) -> Box<Diagnostic> {
        if self.came() {
            let message = format!("`{policy}` could not be had for {missing} of the episodes");
            return Diagnostic::new("fly-policy-gone", Fault::Machine, message)
                .because(reason)
                .hint("the episodes that were flown are kept: the same command flies the others");
        }
        let message = format!("`{policy}` has given no right answer, so no episode was flown");
        Diagnostic::new("fly-policy-unready", Fault::Machine, message)
            .because(reason)
            .hint("mend the cause and run the same command again: nothing of this try is kept")
    }
}

/// The policy at a place, for one thread, which tells of its first answer.
pub struct Asked<'a> {
    pilot: Box<dyn Pilot>,
    first: &'a FirstAnswer,
}

impl<'a> Asked<'a> {
    /// The policy at a place.
    pub fn new(place: &Place, manners: &Manners, first: &'a FirstAnswer) -> Self {
        Self { pilot: open(place, manners), first }
    }

    /// Whether the policy has answered since the command began, in whatever episode.
    pub fn has_answered(&self) -> bool {
        self.first.came()
    }
}

impl Pilot for Asked<'_> {
    fn begin(&mut self, environment: &Environment, knowledge: &Knowledge) -> Result<(), String> {
        self.pilot.begin(environment, knowledge)
    }

    fn act(&mut self, environment: &Environment) -> Result<Action, PilotFailure> {
        let action = self.pilot.act(environment)?;
        self.first.tell();
        Ok(action)
    }
}
