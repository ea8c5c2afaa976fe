//! [`VectorEnvironment`]: many environments that are stepped together, for learners.

mod member;
mod team;
#[cfg(test)]
mod tests;

use crate::suite::Task;
use cosfly_env::pictures::{PictureBatch, PictureFormat, Pictures};
use cosfly_env::{End, Environment, EnvironmentSettings, FEATURES, Reward, readings};
use member::{Shared, VectorMember, stream_of};
use rayon::{ThreadPool, ThreadPoolBuildError};
use std::sync::Arc;

pub use member::{ACTIONS, Autoreset};
pub use team::BESIDE;

/// Terms of a reward.
pub const TERMS: usize = Reward::NAMES.len();

/// Results of a step, one entry or row per environment.
#[derive(Clone, Debug, Default)]
pub struct Outputs {
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
    /// The expert's actions for the observations, where they are asked for.
    pub expert_actions: Vec<[f32; ACTIONS]>,
    /// Readings of the sensors that are asked for, the numbers of one behind those of the other.
    pub readings: Vec<Vec<f32>>,
    /// Those with `last_features`.
    pub last_readings: Vec<Vec<f32>>,
    /// [`BESIDE`] numbers on each other drone of a team.
    pub beside: Vec<Vec<f32>>,
}

/// Pictures of a vector environment, and the threads that draw them.
struct PicturePool {
    pictures: Pictures,
    pool: Option<ThreadPool>,
}

impl PicturePool {
    /// Draws the pictures of some environments that follow each other from number `first` on.
    fn draw(&mut self, members: &[VectorMember], album: &mut PictureBatch, first: usize) {
        let environments: Vec<&Environment> = members.iter().map(|member| &member.environment).collect();
        self.work(|pictures| pictures.draw(&environments, album, first));
    }

    /// Draws the pictures of a whole team.
    fn draw_team(&mut self, members: &[VectorMember], album: &mut PictureBatch) {
        let environments: Vec<&Environment> = members.iter().map(|member| &member.environment).collect();
        self.work(|pictures| pictures.draw_team(&environments, album));
    }

    fn work(&mut self, draw: impl FnOnce(&mut Pictures) + Send) {
        let pictures = &mut self.pictures;
        match &self.pool {
            Some(pool) => pool.install(|| draw(pictures)),
            None => draw(pictures),
        }
    }
}

/// Many environments that are stepped together. Each draws its episodes from a seed of its own: what one does changes no other.
pub struct VectorEnvironment {
    shared: Shared,
    members: Vec<VectorMember>,
    outputs: Outputs,
    studio: Option<PicturePool>,
}

impl VectorEnvironment {
    /// Environments over the episodes of `tasks`, of which there must be one; before the first reset.
    pub fn new(
        tasks: Arc<[Task]>,
        count: usize,
        settings: EnvironmentSettings,
        mode: Autoreset,
        has_experts: bool,
    ) -> Self {
        let shared = Shared { tasks, settings, mode, has_experts, is_team: false };
        let members: Vec<VectorMember> = (0..count).map(|number| VectorMember::new(number, &shared)).collect();
        let outputs = Outputs {
            features: vec![[0.0; FEATURES]; count],
            last_features: vec![[0.0; FEATURES]; count],
            rewards: vec![0.0; count],
            terms: vec![[0.0; TERMS]; count],
            terminated: vec![false; count],
            truncated: vec![false; count],
            tracked: vec![false; count],
            look_alikes: vec![0; count],
            readings: vec![vec![]; count],
            last_readings: vec![vec![]; count],
            expert_actions: vec![[0.0; ACTIONS]; if has_experts { count } else { 0 }],
            ..Outputs::default()
        };
        Self { shared, members, outputs, studio: None }
    }

    /// Drones as a team: all fly the same episode at the same time, which the first draws, each from its own start,
    /// and they can hit each other.
    pub fn as_team(mut self) -> Self {
        self.shared.is_team = true;
        self.outputs.beside = vec![vec![]; self.len()];
        self
    }

    /// Environments with pictures in their observations, drawn on `threads` threads: their number changes no byte.
    ///
    /// # Errors
    /// Threads that cannot be started.
    pub fn with_pictures(mut self, format: PictureFormat, threads: usize) -> Result<Self, ThreadPoolBuildError> {
        let build = || rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = (threads > 1).then(build).transpose()?;
        self.outputs.album = PictureBatch::new(&format, self.len());
        if self.shared.mode == Autoreset::SameStep {
            self.outputs.last_album = self.outputs.album.clone();
        }
        self.studio = Some(PicturePool { pictures: Pictures::new(format, threads), pool });
        Ok(self)
    }

    /// Number of environments.
    pub fn len(&self) -> usize {
        self.members.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.members.is_empty()
    }

    /// Settings of the environments.
    pub fn settings(&self) -> &EnvironmentSettings {
        &self.shared.settings
    }

    /// Format of their pictures, where there are any.
    pub fn format(&self) -> Option<&PictureFormat> {
        self.studio.as_ref().map(|studio| studio.pictures.format())
    }

    /// Results of the last reset or step.
    pub fn outputs(&self) -> &Outputs {
        &self.outputs
    }

    /// Name of the episode that an environment flies.
    pub fn episode(&self, number: usize) -> &str {
        &self.members[number].environment.episode().name
    }

    /// Names of all episodes.
    pub fn episodes(&self) -> impl Iterator<Item = &str> {
        self.shared.tasks.iter().map(|task| task.episode.name.as_str())
    }

    /// Steps of the whole episode that an environment flies.
    pub fn planned_steps(&self, number: usize) -> u32 {
        self.members[number].environment.score().planned_steps
    }

    /// Begins the episode of a name in one environment; false where there is none.
    pub fn begin_episode(&mut self, number: usize, name: &str) -> bool {
        let Some(task) = self.shared.tasks.iter().position(|task| task.episode.name == name) else { return false };
        if self.shared.is_team {
            self.begin_team(task);
            return true;
        }
        let member = &mut self.members[number];
        member.begin_task(&self.shared, task);
        (member.reward, member.end) = (Reward::default(), None);
        self.outputs.tell(number, member);
        self.outputs.keep_last(number);
        self.draw(|chosen| chosen == number);
        true
    }

    /// Begins the draws of each environment that has a seed anew, without an episode.
    pub fn seed(&mut self, seeds: &[Option<u64>]) {
        for (member, seed) in self.members.iter_mut().zip(seeds) {
            if let Some(seed) = *seed {
                member.stream = stream_of(seed);
            }
        }
    }

    /// Begins an episode in each environment that `chosen` names; where there is a seed, its draws begin anew.
    pub fn reset(&mut self, seeds: &[Option<u64>], chosen: impl Fn(usize) -> bool) {
        if self.shared.is_team {
            let Some(first) = self.members.first_mut() else { return };
            if let Some(seed) = seeds.first().copied().flatten() {
                first.stream = stream_of(seed);
            }
            let task = first.stream.index(self.shared.tasks.len());
            self.begin_team(task);
            return;
        }
        for (number, member) in self.members.iter_mut().enumerate().filter(|(number, _)| chosen(*number)) {
            if let Some(seed) = seeds.get(number).copied().flatten() {
                member.stream = stream_of(seed);
            }
            member.begin_anew(&self.shared);
            self.outputs.tell(number, member);
            self.outputs.keep_last(number);
        }
        self.draw(chosen);
    }

    /// Moves every environment on by one step, with one action of [`cosfly_env::Action::of_numbers`] each.
    pub fn step(&mut self, actions: &[[f32; ACTIONS]]) {
        let before = if self.shared.is_team { team::places(&self.members) } else { vec![] };
        self.members.iter_mut().zip(actions).for_each(|(member, action)| member.step(action, &self.shared));
        if self.shared.is_team {
            team::meet(&mut self.members, &before, &self.shared);
        }
        self.tell_all();
        self.draw(|_| true);
        if self.shared.mode == Autoreset::SameStep {
            self.begin_ended();
        }
    }

    /// Begins an episode with the whole team.
    fn begin_team(&mut self, task: usize) {
        let episode = &self.shared.tasks[task].episode;
        let episodes = team::episodes(episode, self.members.len(), self.shared.settings.radius_m);
        for (member, episode) in self.members.iter_mut().zip(episodes) {
            member.begin_task(&self.shared, task);
            member.environment.reset(episode);
            (member.reward, member.end) = (Reward::default(), None);
        }
        self.tell_all();
        self.draw(|_| true);
    }

    fn tell_all(&mut self) {
        for (number, member) in self.members.iter().enumerate() {
            self.outputs.tell(number, member);
            self.outputs.keep_last(number);
        }
        for (number, told) in self.outputs.beside.iter_mut().enumerate() {
            *told = team::beside(&self.members, number);
        }
    }

    /// Begins the next episode wherever one ended in this step; its last observation is kept.
    fn begin_ended(&mut self) {
        for (number, member) in self.members.iter_mut().enumerate().filter(|(_, member)| member.is_due) {
            self.outputs.last_album.copy(&self.outputs.album, number);
            member.begin(&self.shared);
            self.outputs.tell(number, member);
        }
        let ended: Vec<bool> = self.members.iter().map(|member| member.end.is_some()).collect();
        self.draw(|number| ended[number]);
    }

    /// Draws the pictures of the chosen environments, neighbours together.
    fn draw(&mut self, chosen: impl Fn(usize) -> bool) {
        let Some(studio) = &mut self.studio else { return };
        if self.shared.is_team {
            studio.draw_team(&self.members, &mut self.outputs.album);
            return;
        }
        let mut first = 0;
        while first < self.members.len() {
            let end = (first..self.members.len()).find(|number| !chosen(*number)).unwrap_or(self.members.len());
            if end > first {
                studio.draw(&self.members[first..end], &mut self.outputs.album, first);
            }
            first = end + 1;
        }
    }
}

impl Outputs {
    /// Keeps the observation of an environment as the last one of its episode so far.
    fn keep_last(&mut self, number: usize) {
        self.last_features[number] = self.features[number];
        self.last_readings[number].clone_from(&self.readings[number]);
    }

    /// Fills what is told of the present state of an environment and of its last step.
    fn tell(&mut self, number: usize, member: &VectorMember) {
        let observation = member.environment.observation();
        self.features[number] = observation.features().map(|feature| feature as f32);
        let numbers = readings(&member.environment).into_iter().flat_map(|(_, values)| values);
        self.readings[number] = numbers.map(|value| value as f32).collect();
        self.tracked[number] = observation.tracked;
        self.look_alikes[number] = member.environment.look_alikes() as u32;
        self.rewards[number] = member.reward.sum(&member.environment.settings().weights);
        self.terms[number] = member.reward.terms();
        self.terminated[number] = matches!(member.end, Some(End::Collision | End::Lost));
        self.truncated[number] = member.end == Some(End::Finished);
        if let Some(told) = self.expert_actions.get_mut(number) {
            *told = member.expert_action;
        }
    }
}
