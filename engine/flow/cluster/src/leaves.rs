//! The unfinished tasks of a plan as commands with dependencies.
//!
//! A *leaf* is one command: some tasks of one stage, or of a chain of cheap stages. Numbers of leaves depend on the recipe and the requests alone, so that
//! a driver that is started again gives the same leaf the same number, whatever is finished by then. Where many leaves read
//! many others, a *barrier* stands between them: a leaf without tasks, so that the number of dependencies stays small.

use crate::chains::first_stages;
use crate::request::Request;
use cosfly_fingerprint::Digest;
use cosfly_recipe::Connection;
use cosfly_runner::Plan;
use cosfly_stage::Fan;
use std::collections::{BTreeMap, BTreeSet};

/// A command with its dependencies.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Leaf {
    /// Number, from 1.
    pub id: u32,
    /// First task, as `stage/item`, and the number of the others; or the stage that a barrier waits for.
    pub name: String,
    /// First stage, as an index into the recipe's stages.
    pub stage: usize,
    /// Tasks as indices of stages and items, those that others read first; none in a barrier.
    pub tasks: Vec<(usize, usize)>,
    /// Plan digests of the tasks.
    pub plans: Vec<Digest>,
    /// Leaves that must end first, sorted.
    pub deps: Vec<u32>,
    /// Resources.
    pub request: Request,
}

impl Leaf {
    fn empty(id: u32, stage: usize, request: Request) -> Self {
        Self { id, name: String::new(), stage, tasks: Vec::new(), plans: Vec::new(), deps: Vec::new(), request }
    }
}

/// Parts of the command of a leaf that are the same for all.
#[derive(Clone, Debug)]
pub struct Command {
    /// Program and first arguments, such as `/opt/cosfly` or `apptainer exec cosfly.sif cosfly`.
    pub program: Vec<String>,
    /// Place of the store, as every machine knows it.
    pub store: String,
}

impl Command {
    /// Command of a leaf.
    pub fn of(&self, leaf: &Leaf) -> Vec<String> {
        let options = ["task", "run", "--store", &self.store, "--jobs"].map(str::to_owned);
        let plans = leaf.plans.iter().map(Digest::to_string);
        self.program.iter().cloned().chain(options).chain([leaf.request.cpus.to_string()]).chain(plans).collect()
    }
}

/// Stages that the driver itself runs: `wanted`, and all that read it.
pub fn kept_stages(plan: &Plan<'_>, wanted: usize) -> BTreeSet<usize> {
    let mut kept = BTreeSet::from([wanted]);
    for (index, stage) in plan.recipe.stages.iter().enumerate() {
        if stage.connections.iter().any(|connection| connection.upstreams.iter().any(|it| kept.contains(it))) {
            kept.insert(index);
        }
    }
    kept
}

/// Leaves for all unfinished tasks of the stages that are not `kept`, without those in `failed` and the tasks that read
/// them. `requests` are by stage.
pub fn leaves(
    plan: &Plan<'_>,
    kept: &BTreeSet<usize>,
    failed: impl Fn(&Digest) -> bool,
    requests: &[Request],
) -> Vec<Leaf> {
    let first_stages = first_stages(plan.recipe, kept, requests);
    let numbers = Numbers::new(plan, requests, first_stages);
    let open = open_tasks(plan, kept, failed);
    let is_open = |stage: usize| open[stage].iter().any(|is_open| *is_open);
    // By number.
    let mut leaves: BTreeMap<u32, Leaf> = BTreeMap::new();
    let mut barriers = BTreeSet::new();
    for (stage, tasks) in open.iter().enumerate() {
        let items: Vec<usize> = (0..tasks.len()).filter(|item| tasks[*item]).collect();
        let several = items.last().is_some_and(|last| numbers.leaf(stage, items[0]) != numbers.leaf(stage, *last));
        let (each, whole): (Vec<&Connection>, Vec<&Connection>) =
            plan.recipe.stages[stage].connections.iter().partition(|connection| is_by_item(connection));
        let mut shared = BTreeSet::new();
        for upstream in whole.iter().flat_map(|connection| &connection.upstreams).filter(|it| is_open(**it)) {
            let before = numbers.open_leaves(*upstream, &open[*upstream]);
            if several && before.len() > 1 {
                barriers.insert(*upstream);
                shared.insert(numbers.barrier(*upstream));
            } else {
                shared.extend(before);
            }
        }
        for items in items.chunk_by(|a, b| numbers.leaf(stage, *a) == numbers.leaf(stage, *b)) {
            let arrivals = each.iter().flat_map(|connection| items.iter().flat_map(|it| connection.arrivals_for(*it)));
            let arrivals = arrivals.filter(|arrival| open[arrival.stage][arrival.item]);
            let id = numbers.leaf(stage, items[0]);
            let leaf =
                leaves.entry(id).or_insert_with(|| Leaf::empty(id, numbers.first_stages[stage], requests[stage]));
            leaf.tasks.extend(items.iter().map(|item| (stage, *item)));
            leaf.plans.extend(items.iter().map(|item| plan.stages[stage].plans[*item]));
            let before = arrivals.map(|arrival| numbers.leaf(arrival.stage, arrival.item));
            let deps: BTreeSet<u32> = leaf.deps.iter().copied().chain(shared.iter().copied()).chain(before).collect();
            leaf.deps = deps.into_iter().filter(|dep| *dep != id).collect();
        }
    }
    let mut leaves: Vec<Leaf> = leaves.into_values().collect();
    leaves.iter_mut().for_each(|leaf| leaf.name = leaf_name(plan, &leaf.tasks));
    leaves.extend(barriers.into_iter().map(|stage| Leaf {
        id: numbers.barrier(stage),
        name: format!("all of {}", plan.stages[stage].name),
        deps: numbers.open_leaves(stage, &open[stage]).into_iter().collect(),
        ..Leaf::empty(0, stage, Request::default())
    }));
    // What others depend on comes first.
    leaves.sort_by_key(|leaf| (leaf.stage, leaf.tasks.is_empty()));
    leaves
}

fn leaf_name(plan: &Plan<'_>, tasks: &[(usize, usize)]) -> String {
    let more = if tasks.len() > 1 { format!(" + {}", tasks.len() - 1) } else { String::new() };
    tasks.first().map_or_else(String::new, |(stage, item)| format!("{}{more}", plan.recipe.id(*stage, *item)))
}

/// Whether items of the stage read items of their own through a connection.
fn is_by_item(connection: &Connection) -> bool {
    matches!(connection.port.fan, Fan::Each | Fan::Group)
}

/// By stage and item: whether a leaf is to run it.
fn open_tasks(plan: &Plan<'_>, kept: &BTreeSet<usize>, failed: impl Fn(&Digest) -> bool) -> Vec<Vec<bool>> {
    let mut open: Vec<Vec<bool>> = Vec::with_capacity(plan.stages.len());
    // Tasks that failed and those that read them; stages come in dependency order.
    let mut dead: Vec<Vec<bool>> = Vec::with_capacity(plan.stages.len());
    for (index, (stage, described)) in plan.stages.iter().zip(&plan.recipe.stages).enumerate() {
        let shared = described.connections.iter().filter(|connection| !is_by_item(connection));
        let shared = shared.flat_map(|connection| connection.arrivals.iter());
        let all_are_dead = shared.into_iter().any(|arrival| dead[arrival.stage][arrival.item]);
        let each = || described.connections.iter().filter(|connection| is_by_item(connection));
        let is_dead = |item: usize| {
            let reads = || each().flat_map(move |connection| connection.arrivals_for(item));
            stage.finished[item].is_none()
                && (all_are_dead || failed(&stage.plans[item]) || reads().any(|it| dead[it.stage][it.item]))
        };
        dead.push((0..stage.plans.len()).map(is_dead).collect());
        let is_open = |item: usize| !kept.contains(&index) && stage.will_run(item) && !dead[index][item];
        open.push((0..stage.plans.len()).map(is_open).collect());
    }
    open
}

/// Numbers of leaves.
struct Numbers {
    /// First leaf of each stage; then the first barrier.
    first: Vec<u32>,
    batch: Vec<usize>,
    /// First stage of the chain of each stage.
    first_stages: Vec<usize>,
}

impl Numbers {
    fn new(plan: &Plan<'_>, requests: &[Request], first_stages: Vec<usize>) -> Self {
        let batch: Vec<usize> = requests.iter().map(|request| request.batch.max(1) as usize).collect();
        let mut first = vec![1_u32];
        for (stage, batch) in plan.stages.iter().zip(&batch) {
            let leaves = u32::try_from(stage.plans.len().div_ceil(*batch)).unwrap_or(u32::MAX);
            first.push(first[first.len() - 1].saturating_add(leaves));
        }
        Self { first, batch, first_stages }
    }

    fn leaf(&self, stage: usize, item: usize) -> u32 {
        self.first[self.first_stages[stage]] + (item / self.batch[stage]) as u32
    }

    fn barrier(&self, stage: usize) -> u32 {
        self.first[self.first.len() - 1] + stage as u32
    }

    /// Leaves of a stage that have tasks.
    fn open_leaves(&self, stage: usize, open: &[bool]) -> BTreeSet<u32> {
        (0..open.len()).filter(|item| open[*item]).map(|item| self.leaf(stage, item)).collect()
    }
}
