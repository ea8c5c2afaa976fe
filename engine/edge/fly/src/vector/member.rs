//! One environment of many: its episodes, and the expert's actions for it.

use crate::suite::EpisodeTask;
use cosfly_env::policies::baseline;
use cosfly_env::{Action, End, Environment, EnvironmentSettings, Policy, Reward};
use cosfly_frames::{RandomStream, Seed};
use std::sync::Arc;

/// Numbers of an action.
pub const ACTIONS: usize = 5;

/// When an environment whose episode ended begins the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Autoreset {
    /// In the step after the last one, whose action is not read.
    NextStep,
    /// In the last step itself; the last observation is kept apart.
    SameStep,
    /// When it is told to.
    Disabled,
}

/// Parts that all environments share.
pub(super) struct Shared {
    pub(super) tasks: Arc<[EpisodeTask]>,
    pub(super) settings: EnvironmentSettings,
    pub(super) mode: Autoreset,
    pub(super) has_experts: bool,
    /// Whether all fly the same episode at the same time.
    pub(super) is_team: bool,
}

/// One of many.
pub(super) struct VectorMember {
    pub(super) environment: Environment,
    pub(super) expert: Option<Box<dyn Policy + Send + Sync>>,
    /// Draws episodes.
    pub(super) stream: RandomStream,
    /// Whether the next step begins an episode.
    pub(super) is_due: bool,
    pub(super) reward: Reward,
    pub(super) end: Option<End>,
    pub(super) expert_action: [f32; ACTIONS],
}

impl VectorMember {
    pub(super) fn new(number: usize, shared: &Shared) -> Self {
        let mut stream = stream_of(number as u64);
        let task = &shared.tasks[stream.index(shared.tasks.len())];
        let environment = Environment::new(Arc::clone(&task.episode), shared.settings);
        let (reward, expert_action) = (Reward::default(), [0.0; ACTIONS]);
        Self { environment, expert: None, stream, is_due: false, reward, end: None, expert_action }
    }

    /// Begins the next episode. What the last step gave stays.
    pub(super) fn begin(&mut self, shared: &Shared) {
        let task = self.stream.index(shared.tasks.len());
        self.begin_task(shared, task);
    }

    pub(super) fn begin_task(&mut self, shared: &Shared, task: usize) {
        let task = &shared.tasks[task];
        self.environment.reset(Arc::clone(&task.episode));
        self.is_due = false;
        if shared.has_experts {
            let make = baseline("expert").map(|expert| expert.make);
            self.expert = make.map(|make| make(&self.environment, &task.knowledge));
        }
        self.ask_expert();
    }

    /// Begins the next episode, with nothing to tell of the one before.
    pub(super) fn begin_anew(&mut self, shared: &Shared) {
        self.begin(shared);
        (self.reward, self.end) = (Reward::default(), None);
    }

    pub(super) fn step(&mut self, action: &[f32; ACTIONS], shared: &Shared) {
        if self.is_due && shared.mode == Autoreset::NextStep {
            self.begin_anew(shared);
            return;
        }
        let step = self.environment.step(Some(&Action::of_numbers(action.map(f64::from))));
        (self.reward, self.end, self.is_due) = (step.reward, step.end, step.end.is_some());
        self.ask_expert();
    }

    pub(super) fn ask_expert(&mut self) {
        if let Some(expert) = &mut self.expert {
            let action = expert.act(&self.environment);
            self.expert_action = action.numbers(self.environment.observation().yaw_rad).map(|number| number as f32);
        }
    }
}

pub(super) fn stream_of(seed: u64) -> RandomStream {
    Seed::of_item(seed, "fly", "environment").stream("episodes")
}
