//! [`StepOutputs`]: what a reset or step of many environments gives, a column for each quantity.

use super::member::{ACTIONS, VectorMember};
use cosfly_env::pictures::PictureBatch;
use cosfly_env::{End, FEATURES, Reward, readings};
use rayon::prelude::*;

/// Terms of a reward.
pub const TERMS: usize = Reward::NAMES.len();

/// Results of a step, one entry or row per environment.
#[derive(Clone, Debug, Default)]
pub struct StepOutputs {
    /// Features of the observations; of the next episode where one began.
    pub features: Vec<[f32; FEATURES]>,
    /// Features of the last observation of the episode that ended in this step; else those of `features`.
    pub last_features: Vec<[f32; FEATURES]>,
    /// Pictures of the observations, where they are asked for.
    pub album: PictureBatch,
    /// In [`Autoreset::SameStep`], the last pictures of the episodes that ended in this step; the others are old.
    pub last_album: PictureBatch,
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
    /// Bodies in the picture that may be taken for the target.
    pub look_alikes: Vec<u32>,
    /// The expert's actions for the observations; zeros where they are not asked for.
    pub expert_actions: Vec<[f32; ACTIONS]>,
    /// Readings of the sensors that are asked for, the numbers of one behind those of the other.
    pub readings: Vec<Vec<f32>>,
    /// Those with `last_features`.
    pub last_readings: Vec<Vec<f32>>,
    /// [`BESIDE`] numbers on each other drone of a team.
    pub beside: Vec<Vec<f32>>,
}

impl StepOutputs {
    /// Room for the results of `count` environments.
    pub(super) fn new(count: usize) -> Self {
        Self {
            features: vec![[0.0; FEATURES]; count],
            last_features: vec![[0.0; FEATURES]; count],
            rewards: vec![0.0; count],
            terms: vec![[0.0; TERMS]; count],
            terminated: vec![false; count],
            truncated: vec![false; count],
            tracked: vec![false; count],
            look_alikes: vec![0; count],
            expert_actions: vec![[0.0; ACTIONS]; count],
            readings: vec![vec![]; count],
            last_readings: vec![vec![]; count],
            ..Self::default()
        }
    }

    /// The results of one environment.
    pub(super) fn row(&mut self, number: usize) -> Row<'_> {
        Row {
            features: &mut self.features[number],
            last_features: &mut self.last_features[number],
            reward: &mut self.rewards[number],
            terms: &mut self.terms[number],
            terminated: &mut self.terminated[number],
            truncated: &mut self.truncated[number],
            tracked: &mut self.tracked[number],
            look_alikes: &mut self.look_alikes[number],
            expert_action: &mut self.expert_actions[number],
            readings: &mut self.readings[number],
            last_readings: &mut self.last_readings[number],
        }
    }

    /// The results of all environments, for several threads.
    pub(super) fn rows(&mut self) -> impl IndexedParallelIterator<Item = Row<'_>> {
        let columns = (
            &mut self.features,
            &mut self.last_features,
            &mut self.rewards,
            &mut self.terms,
            &mut self.terminated,
            &mut self.truncated,
            &mut self.tracked,
            &mut self.look_alikes,
            &mut self.expert_actions,
            &mut self.readings,
            &mut self.last_readings,
        );
        columns.into_par_iter().map(|row| {
            let (features, last_features, reward, terms, terminated, truncated, ..) = row;
            let (.., tracked, look_alikes, expert_action, readings, last_readings) = row;
            Row {
                features,
                last_features,
                reward,
                terms,
                terminated,
                truncated,
                tracked,
                look_alikes,
                expert_action,
                readings,
                last_readings,
            }
        })
    }
}

/// The results of one environment.
pub(super) struct Row<'a> {
    features: &'a mut [f32; FEATURES],
    last_features: &'a mut [f32; FEATURES],
    reward: &'a mut f64,
    terms: &'a mut [f64; TERMS],
    terminated: &'a mut bool,
    truncated: &'a mut bool,
    tracked: &'a mut bool,
    look_alikes: &'a mut u32,
    expert_action: &'a mut [f32; ACTIONS],
    readings: &'a mut Vec<f32>,
    last_readings: &'a mut Vec<f32>,
}

impl Row<'_> {
    /// Fills what is told of the present state of an environment and of its last step; the last observation stays.
    pub(super) fn tell(&mut self, member: &VectorMember) {
        let observation = member.environment.observation();
        *self.features = observation.features().map(|feature| feature as f32);
        let numbers = readings(&member.environment).into_iter().flat_map(|(_, values)| values);
        self.readings.clear();
        self.readings.extend(numbers.map(|value| value as f32));
        *self.tracked = observation.tracked;
        *self.look_alikes = member.environment.look_alikes() as u32;
        *self.reward = member.reward.sum(&member.environment.settings().weights);
        *self.terms = member.reward.terms();
        *self.terminated = matches!(member.end, Some(End::Collision | End::Lost));
        *self.truncated = member.end == Some(End::Finished);
        *self.expert_action = member.expert_action;
    }

    /// Fills what is told, the last observation too.
    pub(super) fn tell_whole(&mut self, member: &VectorMember) {
        self.tell(member);
        *self.last_features = *self.features;
        self.last_readings.clone_from(self.readings);
    }
}
