//! [`Flock`]: many environments that are stepped together, for learners.

use crate::suite::Task;
use cosfly_env::policies::baseline;
use cosfly_env::{Action, End, Environment, FEATURES, Policy, Reward, Settings};
use cosfly_frames::{RandomStream, Seed};
use std::sync::Arc;

/// Numbers of an action.
pub const ACTIONS: usize = 5;
/// Terms of a reward.
pub const TERMS: usize = Reward::NAMES.len();

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

/// What a step fills, one entry or row per environment.
#[derive(Clone, Debug, Default)]
pub struct Outputs {
    /// Features of the observations; of the next episode where one began.
    pub features: Vec<[f32; FEATURES]>,
    /// Features of the last observation of the episode that ended in this step; else those of `features`.
    pub last_features: Vec<[f32; FEATURES]>,
    /// Weighted rewards.
    pub rewards: Vec<f64>,
    /// Terms of the rewards, unweighted.
    pub terms: Vec<[f64; TERMS]>,
    /// Whether the episode ended in a collision or a loss.
    pub terminated: Vec<bool>,
    /// Whether the target's track is over.
    pub truncated: Vec<bool>,
    /// Whether the target is tracked.
    pub tracked: Vec<bool>,
    /// The expert's actions for the observations, where they are asked for.
    pub expert_actions: Vec<[f32; ACTIONS]>,
}

/// One of many.
struct Bird {
    environment: Environment,
    expert: Option<Box<dyn Policy + Send + Sync>>,
    /// Draws episodes.
    stream: RandomStream,
    /// Number of the task.
    task: usize,
    /// Whether the next step begins an episode.
    is_due: bool,
}

/// Many environments that are stepped together. Each draws its episodes from a seed of its own: what one does changes no other.
pub struct Flock {
    tasks: Arc<[Task]>,
    settings: Settings,
    mode: Autoreset,
    has_experts: bool,
    birds: Vec<Bird>,
    outputs: Outputs,
}

impl Flock {
    /// Environments over the episodes of `tasks`, of which there must be one; before the first reset.
    pub fn new(tasks: Arc<[Task]>, count: usize, settings: Settings, mode: Autoreset, has_experts: bool) -> Self {
        let bird = |number: usize| {
            let mut stream = stream_of(number as u64);
            let task = stream.index(tasks.len());
            let environment = Environment::new(Arc::clone(&tasks[task].episode), settings);
            Bird { environment, expert: None, stream, task, is_due: false }
        };
        let birds: Vec<Bird> = (0..count).map(bird).collect();
        let outputs = Outputs {
            features: vec![[0.0; FEATURES]; count],
            last_features: vec![[0.0; FEATURES]; count],
            rewards: vec![0.0; count],
            terms: vec![[0.0; TERMS]; count],
            terminated: vec![false; count],
            truncated: vec![false; count],
            tracked: vec![false; count],
            expert_actions: vec![[0.0; ACTIONS]; if has_experts { count } else { 0 }],
        };
        Self { tasks, settings, mode, has_experts, birds, outputs }
    }

    /// Number of environments.
    pub fn len(&self) -> usize {
        self.birds.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.birds.is_empty()
    }

    /// Settings of the environments.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// What the last reset or step gave.
    pub fn outputs(&self) -> &Outputs {
        &self.outputs
    }

    /// Name of the episode that an environment flies.
    pub fn episode(&self, number: usize) -> &str {
        &self.birds[number].environment.episode().name
    }

    /// Begins an episode in each environment that `chosen` names; where there is a seed, its draws begin anew.
    pub fn reset(&mut self, seeds: &[Option<u64>], chosen: impl Fn(usize) -> bool) {
        for number in (0..self.birds.len()).filter(|number| chosen(*number)) {
            if let Some(seed) = seeds.get(number).copied().flatten() {
                self.birds[number].stream = stream_of(seed);
            }
            self.begin(number);
            self.outputs.last_features[number] = self.outputs.features[number];
            (self.outputs.rewards[number], self.outputs.terms[number]) = (0.0, [0.0; TERMS]);
            (self.outputs.terminated[number], self.outputs.truncated[number]) = (false, false);
        }
    }

    /// Moves every environment on by one step, with one action of [`Action::of_numbers`] each.
    pub fn step(&mut self, actions: &[[f32; ACTIONS]]) {
        for (number, action) in actions.iter().enumerate().take(self.birds.len()) {
            if self.birds[number].is_due && self.mode == Autoreset::NextStep {
                self.begin(number);
                self.outputs.last_features[number] = self.outputs.features[number];
                (self.outputs.rewards[number], self.outputs.terms[number]) = (0.0, [0.0; TERMS]);
                (self.outputs.terminated[number], self.outputs.truncated[number]) = (false, false);
                continue;
            }
            let bird = &mut self.birds[number];
            let action = Action::of_numbers(action.map(f64::from));
            let step = bird.environment.step(Some(&action));
            let outputs = &mut self.outputs;
            outputs.rewards[number] = step.reward.sum(&self.settings.weights);
            outputs.terms[number] = step.reward.terms();
            outputs.terminated[number] = matches!(step.end, Some(End::Collision | End::Lost));
            outputs.truncated[number] = step.end == Some(End::Finished);
            bird.is_due = step.end.is_some();
            self.tell(number);
            self.outputs.last_features[number] = self.outputs.features[number];
            if step.end.is_some() && self.mode == Autoreset::SameStep {
                self.begin(number);
            }
        }
    }

    /// Begins the next episode of an environment.
    fn begin(&mut self, number: usize) {
        let bird = &mut self.birds[number];
        bird.task = bird.stream.index(self.tasks.len());
        let task = &self.tasks[bird.task];
        bird.environment.reset(Arc::clone(&task.episode));
        bird.is_due = false;
        if self.has_experts {
            let make = baseline("expert").map(|expert| expert.make);
            bird.expert = make.map(|make| make(&bird.environment, &task.knowledge));
        }
        self.tell(number);
    }

    /// Fills what is told of the present state of an environment.
    fn tell(&mut self, number: usize) {
        let (bird, outputs) = (&mut self.birds[number], &mut self.outputs);
        let observation = bird.environment.observation();
        outputs.features[number] = observation.features().map(|feature| feature as f32);
        outputs.tracked[number] = observation.tracked;
        if let (Some(expert), Some(told)) = (&mut bird.expert, outputs.expert_actions.get_mut(number)) {
            let action = expert.act(&bird.environment);
            *told = action.numbers(observation.yaw_rad).map(|number| number as f32);
        }
    }
}

fn stream_of(seed: u64) -> RandomStream {
    Seed::of_item(seed, "fly", "environment").stream("episodes")
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_env::policies::Knowledge;
    use cosfly_env::{Episode, Place, Start};
    use cosfly_frames::{DVec3, TargetState, TargetTrack};

    /// Targets that stand for 1 to 4 s.
    fn tasks() -> Arc<[Task]> {
        let place = Arc::new(Place::on_flat_ground(vec![]));
        let task = |seconds: usize| {
            let state = TargetState { feet_in_world: 20.0 * DVec3::X, heading_rad: 0.0, speed_mps: 0.0 };
            let states = vec![state; 2 * seconds + 1];
            let episode = Episode {
                name: format!("e{seconds}"),
                stratum: String::new(),
                place: Arc::clone(&place),
                target: Arc::new(TargetTrack { dt_s: 0.5, height_m: 1.7, radius_m: 0.25, states }),
                start: Start { position_in_world: 20.0 * DVec3::Z, velocity_in_world: DVec3::ZERO },
                seed: Seed([0; 32]),
            };
            let knowledge = Knowledge { flight: Arc::new([20.0 * DVec3::Z]), config: Arc::default() };
            Task { episode: Arc::new(episode), knowledge, certified_visibility: 1.0 }
        };
        (1..=4).map(task).collect()
    }

    fn flock(mode: Autoreset) -> Flock {
        let mut flock = Flock::new(tasks(), 3, Settings::default(), mode, true);
        flock.reset(&[Some(5), Some(6), Some(5)], |_| true);
        flock
    }

    #[test]
    fn equal_seeds_fly_equal_episodes_beside_any_others() {
        let mut flock = flock(Autoreset::SameStep);
        for step in 0..200 {
            flock.step(&[[1.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, step as f32, 0.0, 9.0], [1.0, 0.0, 0.0, 0.0, 0.0]]);
            let outputs = flock.outputs();
            assert_eq!(outputs.features[0], outputs.features[2]);
            assert_eq!((outputs.rewards[0], flock.episode(0)), (outputs.rewards[2], flock.episode(2)));
            assert_eq!(outputs.expert_actions[0], outputs.expert_actions[2]);
        }
    }

    #[test]
    fn episodes_end_and_begin_as_each_mode_says() {
        for mode in [Autoreset::NextStep, Autoreset::SameStep, Autoreset::Disabled] {
            let mut flock = flock(mode);
            let mut steps = 0;
            while !flock.outputs().truncated[0] {
                flock.step(&[[0.0; ACTIONS]; 3]);
                steps += 1;
            }
            assert_eq!(steps % 10, 0, "whole seconds");
            let is_first = |flock: &Flock| flock.birds[0].environment.observation().step == 0;
            assert_eq!(is_first(&flock), mode == Autoreset::SameStep);
            let last = flock.outputs().clone();
            flock.step(&[[0.0; ACTIONS]; 3]);
            assert_eq!(is_first(&flock), mode == Autoreset::NextStep);
            match mode {
                Autoreset::NextStep => {
                    assert_eq!((flock.outputs().rewards[0], flock.outputs().truncated[0]), (0.0, false))
                }
                Autoreset::SameStep => assert!(!flock.outputs().truncated[0]),
                Autoreset::Disabled => {
                    assert!(flock.outputs().truncated[0] && flock.outputs().features[0] == last.features[0]);
                    flock.reset(&[], |number| number == 0);
                    assert!(is_first(&flock) && !flock.outputs().truncated[0]);
                }
            }
        }
    }
}
