//! Order of tasks: counters instead of a graph of tasks, so that memory grows by a few words per item.

use cosfly_recipe::Recipe;
use cosfly_stage::Fan;
use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// Number of a task, counted over all stages.
pub(crate) type TaskIndex = usize;

/// State of a task.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum State {
    /// Its inputs are not finished.
    Waiting,
    /// Ready to start.
    Ready,
    /// Running on a thread.
    Running,
    /// Its blobs can be read.
    Finished,
    /// Ended with a diagnostic.
    Failed,
    /// A task that it reads failed.
    Skipped,
}

/// Relation of the items of one stage to those of a stage that reads it.
enum Link {
    /// Pairs (upstream item, downstream item), sorted.
    Each { downstream: usize, pairs: Vec<(u32, u32)> },
    /// Every item of the upstream feeds every item of the downstream.
    Whole { downstream: usize },
}

/// State of all tasks of a run.
pub(crate) struct Schedule {
    /// First task of each stage, and the number of all tasks.
    offsets: Vec<TaskIndex>,
    links: Vec<Vec<Link>>,
    states: Vec<State>,
    /// By stage: unfinished tasks at ports that take a whole stage.
    barriers: Vec<u64>,
    /// By task: unfinished tasks at ports that pair items.
    pairs_left: Vec<u32>,
    /// Tasks whose end was counted already; they run again when their blobs are lost.
    counted: Vec<bool>,
    /// Tasks that are ready, those of stages that make intermediate blobs last: what is there is read and removed before more is made.
    ready: BTreeSet<(bool, TaskIndex)>,
    /// By stage: whether its artifacts have intermediate blobs.
    makes_intermediates: Vec<bool>,
    running: usize,
    /// Tasks waiting for one whose blobs were lost.
    rewaiting: BTreeMap<TaskIndex, Vec<TaskIndex>>,
    rewaits_left: BTreeMap<TaskIndex, usize>,
}

impl Schedule {
    /// Schedule with nothing running; `finished(stage, item)` is true for tasks that need not run.
    pub(crate) fn new(recipe: &Recipe, finished: impl Fn(usize, usize) -> bool) -> Self {
        let mut offsets = vec![0];
        for stage in &recipe.stages {
            offsets.push(offsets[offsets.len() - 1] + stage.items.len());
        }
        let tasks = offsets[offsets.len() - 1];
        let mut schedule = Self {
            links: recipe.stages.iter().map(|_| Vec::new()).collect(),
            states: vec![State::Waiting; tasks],
            barriers: vec![0; recipe.stages.len()],
            pairs_left: vec![0; tasks],
            counted: vec![false; tasks],
            ready: BTreeSet::new(),
            makes_intermediates: vec![false; recipe.stages.len()],
            running: 0,
            rewaiting: BTreeMap::new(),
            rewaits_left: BTreeMap::new(),
            offsets,
        };
        for (stage, described) in recipe.stages.iter().enumerate() {
            schedule.makes_intermediates[stage] = !described.stage.properties().intermediate.is_empty();
            for item in 0..described.items.len() {
                if finished(stage, item) {
                    let task = schedule.task(stage, item);
                    schedule.states[task] = State::Finished;
                    schedule.counted[task] = true;
                }
            }
        }
        for downstream in 0..recipe.stages.len() {
            schedule.connect(recipe, downstream);
            schedule.release_stage(downstream);
        }
        schedule
    }

    fn connect(&mut self, recipe: &Recipe, downstream: usize) {
        for connection in &recipe.stages[downstream].connections {
            // Pairs of (upstream item, downstream item) by upstream stage.
            let mut arriving: BTreeMap<usize, Vec<(u32, u32)>> = BTreeMap::new();
            let is_paired = matches!(connection.port.fan, Fan::Each | Fan::Group);
            let items = if is_paired { recipe.stages[downstream].items.len() } else { 1 };
            for item in 0..items {
                for arrival in connection.arrivals_for(item) {
                    arriving.entry(arrival.stage).or_default().push((arrival.item as u32, item as u32));
                }
            }
            for (upstream, mut pairs) in arriving {
                pairs.sort_unstable();
                if is_paired {
                    for (from, to) in &pairs {
                        let open = !self.counted[self.task(upstream, *from as usize)];
                        let to = self.task(downstream, *to as usize);
                        self.pairs_left[to] += u32::from(open);
                    }
                    self.links[upstream].push(Link::Each { downstream, pairs });
                } else {
                    pairs.dedup_by_key(|(from, _)| *from);
                    let open = pairs.iter().filter(|(from, _)| !self.counted[self.task(upstream, *from as usize)]);
                    self.barriers[downstream] += open.count() as u64;
                    self.links[upstream].push(Link::Whole { downstream });
                }
            }
        }
    }

    /// Task of an item.
    pub(crate) fn task(&self, stage: usize, item: usize) -> TaskIndex {
        self.offsets[stage] + item
    }

    /// Stage and item of a task.
    pub(crate) fn place(&self, task: TaskIndex) -> (usize, usize) {
        let stage = self.offsets.partition_point(|offset| *offset <= task) - 1;
        (stage, task - self.offsets[stage])
    }

    /// State of a task.
    pub(crate) fn state(&self, task: TaskIndex) -> State {
        self.states[task]
    }

    /// Takes the first task that is ready.
    pub(crate) fn next(&mut self) -> Option<TaskIndex> {
        let (_, task) = self.ready.pop_first()?;
        self.states[task] = State::Running;
        self.running += 1;
        Some(task)
    }

    /// True while tasks are running.
    pub(crate) fn is_busy(&self) -> bool {
        self.running > 0
    }

    /// Makes a running task ready again: another process is working on it.
    pub(crate) fn put_back(&mut self, task: TaskIndex) {
        self.running -= 1;
        self.make_ready(task);
    }

    /// Gives up a running task, because the run stops.
    pub(crate) fn abandon(&mut self, task: TaskIndex) {
        self.running -= 1;
        self.states[task] = State::Waiting;
    }

    /// Ends a running task that is finished.
    pub(crate) fn finish(&mut self, task: TaskIndex) {
        self.running -= 1;
        self.states[task] = State::Finished;
        for waiting in self.rewaiting.remove(&task).unwrap_or_default() {
            let left = self.rewaits_left.entry(waiting).or_insert(1);
            *left -= 1;
            if *left == 0 {
                self.rewaits_left.remove(&waiting);
                self.make_ready_if_free(waiting);
            }
        }
        if std::mem::replace(&mut self.counted[task], true) {
            return;
        }
        let (stage, item) = self.place(task);
        let links = std::mem::take(&mut self.links[stage]);
        for link in &links {
            match link {
                Link::Each { downstream, pairs } => {
                    for to in fed_by(pairs, item) {
                        let to = self.task(*downstream, to);
                        self.pairs_left[to] -= 1;
                        self.make_ready_if_free(to);
                    }
                }
                Link::Whole { downstream } => {
                    self.barriers[*downstream] -= 1;
                    self.release_stage(*downstream);
                }
            }
        }
        self.links[stage] = links;
    }

    /// Ends a running task that failed: everything that reads it, directly or not, is skipped.
    pub(crate) fn fail(&mut self, task: TaskIndex) {
        self.end_badly(task, State::Failed);
    }

    fn end_badly(&mut self, task: TaskIndex, state: State) {
        self.running -= 1;
        self.states[task] = state;
        let mut dead = VecDeque::from([task]);
        while let Some(task) = dead.pop_front() {
            let mut readers = self.rewaiting.remove(&task).unwrap_or_default();
            let (stage, item) = self.place(task);
            for link in &self.links[stage] {
                match link {
                    Link::Each { downstream, pairs } => {
                        readers.extend(fed_by(pairs, item).map(|to| self.task(*downstream, to)));
                    }
                    Link::Whole { downstream } => {
                        readers.extend(self.offsets[*downstream]..self.offsets[*downstream + 1]);
                    }
                }
            }
            for reader in readers {
                if matches!(self.states[reader], State::Waiting | State::Ready) {
                    self.states[reader] = State::Skipped;
                    self.ready.remove(&self.in_order(reader));
                    dead.push_back(reader);
                }
            }
        }
    }

    /// Makes a running task wait for `lost`, whose blobs are gone and which run again first.
    pub(crate) fn wait_again(&mut self, task: TaskIndex, lost: &[TaskIndex]) {
        if lost.iter().any(|upstream| matches!(self.states[*upstream], State::Failed | State::Skipped)) {
            return self.end_badly(task, State::Skipped);
        }
        self.running -= 1;
        self.states[task] = State::Waiting;
        for upstream in lost {
            self.rewaiting.entry(*upstream).or_default().push(task);
            *self.rewaits_left.entry(task).or_insert(0) += 1;
            if self.states[*upstream] == State::Finished {
                self.make_ready(*upstream);
            }
        }
    }

    fn release_stage(&mut self, stage: usize) {
        if self.barriers[stage] == 0 {
            (self.offsets[stage]..self.offsets[stage + 1]).for_each(|task| self.make_ready_if_free(task));
        }
    }

    fn make_ready_if_free(&mut self, task: TaskIndex) {
        let free = self.states[task] == State::Waiting
            && self.pairs_left[task] == 0
            && !self.rewaits_left.contains_key(&task)
            && self.barriers[self.place(task).0] == 0;
        if free {
            self.make_ready(task);
        }
    }

    fn make_ready(&mut self, task: TaskIndex) {
        self.states[task] = State::Ready;
        self.ready.insert(self.in_order(task));
    }

    /// A task with its place in the order of ready tasks.
    fn in_order(&self, task: TaskIndex) -> (bool, TaskIndex) {
        (self.makes_intermediates[self.place(task).0], task)
    }
}

/// Downstream items that read upstream item `item`.
fn fed_by(pairs: &[(u32, u32)], item: usize) -> impl Iterator<Item = usize> {
    let first = pairs.partition_point(|(from, _)| (*from as usize) < item);
    pairs[first..].iter().take_while(move |(from, _)| *from as usize == item).map(|(_, to)| *to as usize)
}
