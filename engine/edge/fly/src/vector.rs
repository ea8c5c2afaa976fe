//! [`VectorEnvironment`]: many environments that are stepped together, for learners.

mod copies;
mod member;
mod outputs;
mod team;
#[cfg(test)]
mod tests;

use crate::suite::EpisodeTask;
use cosfly_env::pictures::{PictureBatch, PictureFormat, Pictures};
use cosfly_env::{ActionNumber, Environment, EnvironmentSettings, Reward};
use member::{Shared, VectorMember, stream_of};
use outputs::Row;
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuildError};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

pub use copies::Copies;
pub use member::{ACTIONS, Autoreset};
pub use outputs::{StepOutputs, TERMS};
pub use team::BESIDE;

/// Fewest environments that one thread steps: below, handing them over takes longer.
const FEWEST_A_THREAD: usize = 32;

/// Many environments that are stepped together. Each draws its episodes from a seed of its own: what one does changes no other.
pub struct VectorEnvironment {
    shared: Shared,
    members: Vec<VectorMember>,
    outputs: StepOutputs,
    pictures: Option<Pictures>,
    pool: Option<ThreadPool>,
    /// Seconds of stepping and drawing.
    shared_s: f64,
    /// Time of copies, nanoseconds.
    copied_ns: AtomicU64,
}

impl VectorEnvironment {
    /// Environments over the episodes of `tasks`, of which there must be one; before the first reset.
    pub fn new(
        tasks: Arc<[EpisodeTask]>,
        count: usize,
        settings: EnvironmentSettings,
        mode: Autoreset,
        has_experts: bool,
    ) -> Self {
        let shared = Shared { tasks, settings, mode, has_experts, is_team: false };
        let members: Vec<VectorMember> = (0..count).map(|number| VectorMember::new(number, &shared)).collect();
        let outputs = StepOutputs::new(count);
        Self { shared, members, outputs, pictures: None, pool: None, shared_s: 0.0, copied_ns: AtomicU64::new(0) }
    }

    /// Drones as a team: all fly the same episode at the same time, which the first draws, each from its own start,
    /// and they can hit each other.
    pub fn as_team(mut self) -> Self {
        self.shared.is_team = true;
        self.outputs.beside = vec![vec![]; self.len()];
        self
    }

    /// Environments that are stepped and drawn on `threads` threads: their number changes no byte.
    ///
    /// # Errors
    /// Threads that cannot be started.
    pub fn on_threads(mut self, threads: usize) -> Result<Self, ThreadPoolBuildError> {
        let build = || rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        self.pool = (threads > 1).then(build).transpose()?;
        Ok(self)
    }

    /// Environments with pictures in their observations, drawn on the threads that [`Self::on_threads`] has set before.
    pub fn with_pictures(mut self, format: PictureFormat) -> Self {
        self.outputs.album = PictureBatch::new(&format, self.len());
        if self.shared.mode == Autoreset::SameStep {
            self.outputs.last_album = self.outputs.album.clone();
        }
        self.pictures = Some(Pictures::new(format, self.threads()));
        self
    }

    /// Threads that step and draw.
    pub fn threads(&self) -> usize {
        self.pool.as_ref().map_or(1, ThreadPool::current_num_threads)
    }

    /// Copies columns of results, on the threads where there are many values.
    pub fn copy(&self, mut copies: Copies<'_>) {
        let began = Instant::now();
        match self.pool.as_ref().filter(|_| copies.is_much()) {
            Some(pool) => pool.install(|| copies.pieces.par_iter_mut().for_each(|copy| copy())),
            None => copies.pieces.iter_mut().for_each(|copy| copy()),
        }
        if copies.is_much() {
            self.copied_ns.fetch_add(began.elapsed().as_nanos() as u64, Ordering::Relaxed);
        }
    }

    /// Seconds that all calls so far spent in work that is shared between the threads.
    pub fn shared_s(&self) -> f64 {
        self.shared_s + 1e-9 * self.copied_ns.load(Ordering::Relaxed) as f64
    }

    /// Times at which ended episodes are followed by the next ones.
    pub fn mode(&self) -> Autoreset {
        self.shared.mode
    }

    /// Whether the expert's actions are asked for.
    pub fn has_experts(&self) -> bool {
        self.shared.has_experts
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
        self.pictures.as_ref().map(Pictures::format)
    }

    /// Results of the last reset or step.
    pub fn outputs(&self) -> &StepOutputs {
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
        self.outputs.row(number).tell_whole(member);
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
    pub fn reset(&mut self, seeds: &[Option<u64>], chosen: impl Fn(usize) -> bool + Sync) {
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
            self.outputs.row(number).tell_whole(member);
        }
        self.draw(chosen);
    }

    /// Moves every environment on by one step, with one action of [`cosfly_env::Action::of_numbers`] each, `f32` or `f64`.
    pub fn step<N: ActionNumber>(&mut self, actions: &[[N; ACTIONS]]) {
        let began = Instant::now();
        let Self { shared, members, outputs, pool, .. } = self;
        // As exact as the action space.
        let fly = |member: &mut VectorMember, action: &[N; ACTIONS]| {
            member.step(&action.map(|number| number.into() as f32), shared);
        };
        if shared.is_team {
            let before = team::places(members);
            members.iter_mut().zip(actions).for_each(|(member, action)| fly(member, action));
            team::meet(members, &before, shared);
            self.tell_team();
        } else {
            let step = |((member, action), mut row): ((&mut VectorMember, _), Row<'_>)| {
                fly(member, action);
                row.tell_whole(member);
            };
            match pool.as_ref().filter(|_| members.len() >= 2 * FEWEST_A_THREAD) {
                Some(pool) => pool.install(|| {
                    let all = members.par_iter_mut().zip(actions).zip(outputs.rows());
                    all.with_min_len(FEWEST_A_THREAD).for_each(step);
                }),
                None => (0..).zip(members.iter_mut().zip(actions)).for_each(|(n, it)| step((it, outputs.row(n)))),
            }
        }
        self.shared_s += began.elapsed().as_secs_f64();
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
        self.tell_team();
        self.draw(|_| true);
    }

    fn tell_team(&mut self) {
        (0..).zip(&self.members).for_each(|(number, member)| self.outputs.row(number).tell_whole(member));
        for (number, told) in self.outputs.beside.iter_mut().enumerate() {
            *told = team::beside(&self.members, number);
        }
    }

    /// Begins the next episode wherever one ended in this step; its last observation is kept.
    fn begin_ended(&mut self) {
        let Self { shared, members, outputs, pool, .. } = self;
        if !members.iter().any(|member| member.is_due) {
            return;
        }
        let began = Instant::now();
        for (number, _) in members.iter().enumerate().filter(|(_, member)| member.is_due) {
            outputs.last_album.copy(&outputs.album, number);
        }
        let begin = |(member, mut row): (&mut VectorMember, Row<'_>)| {
            if member.is_due {
                member.begin(shared);
                row.tell(member);
            }
        };
        match pool {
            Some(pool) => pool.install(|| {
                let all = members.par_iter_mut().zip(outputs.rows());
                all.with_min_len(FEWEST_A_THREAD).for_each(begin);
            }),
            None => (0..).zip(members.iter_mut()).for_each(|(n, member)| begin((member, outputs.row(n)))),
        }
        self.shared_s += began.elapsed().as_secs_f64();
        let ended: Vec<bool> = self.members.iter().map(|member| member.end.is_some()).collect();
        self.draw(|number| ended[number]);
    }

    /// Draws the pictures of the chosen environments, neighbours together.
    fn draw(&mut self, chosen: impl Fn(usize) -> bool + Sync) {
        let Self { shared, members, outputs, pictures: Some(pictures), pool, shared_s, .. } = self else { return };
        let environments: Vec<&Environment> = members.iter().map(|member| &member.environment).collect();
        let began = Instant::now();
        let album = &mut outputs.album;
        let mut draw = || {
            if shared.is_team {
                return pictures.draw_team(&environments, album);
            }
            let mut first = 0;
            while first < environments.len() {
                let end = (first..environments.len()).find(|number| !chosen(*number)).unwrap_or(environments.len());
                if end > first {
                    pictures.draw(&environments[first..end], album, first);
                }
                first = end + 1;
            }
        };
        match pool {
            Some(pool) => pool.install(draw),
            None => draw(),
        }
        *shared_s += began.elapsed().as_secs_f64();
    }
}
