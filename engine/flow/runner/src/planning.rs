//! Planning: a recipe against a store.

use crate::document::{Definition, PortDocument, plan_document, port_document};
use crate::plan::{Plan, PlannedStage, planned_input, recipe_id, sees};
use crate::reasons;
use crate::sources::{HashedSource, SourceReader};
use cosfly_diagnose::Result;
use cosfly_fingerprint::Digest;
use cosfly_recipe::{Arrival, Recipe, RecipeStage};
use cosfly_stage::{Blobs, Fan, ItemLength, ItemName, StageNeed, StageProperties};
use cosfly_store::{FinishedTask, FolderTimes, Store};
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Files of a finished item beside its blobs: plan document, action record, done record.
const RECORDS_PER_ITEM: u64 = 3;
/// Fewer items than this are not worth another thread.
const PER_THREAD: usize = 256;
/// Finished items of a stage that a prediction is made from.
const MEASURED: usize = 256;
/// Length of an item where no stage says it.
const UNTOLD: ItemLength = ItemLength { frames: 200, duration_s: 100.0 };

/// Plan of a recipe against a store. The stages that no other reads are asked for.
///
/// # Errors
/// Refusals of the machine while sources are hashed.
pub fn plan<'r>(recipe: &'r Recipe, store: &Store) -> Result<Plan<'r>> {
    plan_for(recipe, store, None)
}

/// Plan of a recipe for the stage number `asked`; without one, for all stages that no other reads.
///
/// # Errors
/// Refusals of the machine while sources are hashed.
pub fn plan_for<'r>(recipe: &'r Recipe, store: &Store, asked: Option<usize>) -> Result<Plan<'r>> {
    made(recipe, store, asked, false)
}

/// Like [`plan_for`], for tasks on other machines, which cannot ask for a removed blob while they run: an item without an
/// intermediate blob that a task to run may read is to run again.
///
/// # Errors
/// Refusals of the machine while sources are hashed.
pub fn plan_elsewhere<'r>(recipe: &'r Recipe, store: &Store, asked: Option<usize>) -> Result<Plan<'r>> {
    made(recipe, store, asked, true)
}

fn made<'r>(recipe: &'r Recipe, store: &Store, asked: Option<usize>, make_again: bool) -> Result<Plan<'r>> {
    let mut plan = digest_tasks(recipe)?;
    find_finished(&mut plan, store);
    store.check_remote()?;
    find_needed(&mut plan, asked, make_again);
    if plan.to_run() > 0 {
        predict(&mut plan);
        predict_files(&mut plan);
        predict_time(&mut plan, store);
        reasons::give_reasons(&mut plan, store);
    }
    Ok(plan)
}

/// Plan with the digests of all tasks, not held against a store yet.
fn digest_tasks(recipe: &Recipe) -> Result<Plan<'_>> {
    let mut sources = SourceReader::default();
    let mut stages: Vec<PlannedStage> = Vec::with_capacity(recipe.stages.len());
    for stage in &recipe.stages {
        let planned = digest_stage(recipe, stage, &stages, &mut sources)?;
        stages.push(planned);
    }
    let (index_is_current, folders) = (false, FolderTimes::default());
    Ok(Plan { recipe, recipe_id: recipe_id(recipe), stages, index_is_current, folders })
}

fn digest_stage(
    recipe: &Recipe,
    stage: &RecipeStage,
    earlier: &[PlannedStage],
    reader: &mut SourceReader,
) -> Result<PlannedStage> {
    let read = |source: &cosfly_recipe::SourceFile| reader.read(&source.parameter, &source.path);
    let sources: Vec<HashedSource> = stage.sources.iter().map(read).collect::<Result<_>>()?;
    let definition = Definition::new(&stage.name, recipe.seed, &*stage.stage, &sources);
    let connections = stage.connections.iter().enumerate();
    let mut ports: Vec<PortDocument> = connections
        .map(|(number, connection)| {
            let inputs = connection.arrivals.iter().map(|arrival| planned_input(recipe, earlier, arrival));
            port_document(connection.port.name, connection.port.fan, number, inputs)
        })
        .collect();
    ports.sort_by_key(PortDocument::port);
    let plan_of = |(index, item): (usize, &ItemName)| {
        let arrivals = |connection: usize| stage.connections[connection].arrivals_for(index).iter();
        let each = |connection: usize| arrivals(connection).map(|arrival| planned_input(recipe, earlier, arrival));
        Digest::of(plan_document(&definition.digest, item, &ports, each).as_bytes())
    };
    let plans: Vec<Digest> = stage.items.par_iter().enumerate().with_min_len(PER_THREAD).map(plan_of).collect();
    Ok(PlannedStage {
        name: stage.name.clone(),
        kind: stage.kind.clone(),
        finished: vec![None; plans.len()],
        needed: vec![false; plans.len()],
        spent: 0,
        was_whole: Vec::new(),
        plans,
        predicted_bytes: 0,
        predicted_files: 0,
        predicted_s: None,
        reasons: Vec::new(),
        definition,
        sources,
        ports,
    })
}

fn find_finished(plan: &mut Plan<'_>, store: &Store) {
    let known = store.known_tasks(&plan.recipe_id);
    for (stage, described) in plan.stages.iter_mut().zip(&plan.recipe.stages) {
        let intermediate = described.stage.properties().intermediate;
        let plans = stage.plans.par_iter().with_min_len(PER_THREAD);
        let found: Vec<Option<FinishedTask>> = plans.map(|digest| known.finished(digest, intermediate)).collect();
        stage.was_whole = found.iter().map(|known| known.as_ref().map(|known| known.whole)).collect();
        stage.finished = found.into_iter().map(|known| known.map(|known| known.finished)).collect();
    }
    plan.index_is_current = known.is_current(&plan.run_digest());
    plan.folders = known.unchanged_folders();
}

/// Walks from what is asked for to what it reads: an item is needed where something that will run reads it. With
/// `make_again`, finished items without an intermediate blob that may be read count as unfinished.
fn find_needed(plan: &mut Plan<'_>, asked: Option<usize>, make_again: bool) {
    let recipe = plan.recipe;
    let read: BTreeSet<usize> =
        recipe.stages.iter().flat_map(|stage| &stage.connections).flat_map(|it| it.upstreams.iter().copied()).collect();
    let is_asked = |stage: usize| asked.map_or_else(|| !read.contains(&stage), |asked| asked == stage);
    let mut spent: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); recipe.stages.len()];
    for (stage, described) in recipe.stages.iter().enumerate().rev() {
        if is_asked(stage) {
            plan.stages[stage].needed.fill(true);
        }
        let will_run: Vec<usize> =
            (0..described.items.len()).filter(|item| plan.stages[stage].will_run(*item)).collect();
        for connection in &described.connections {
            let mut mark = |arrival: &Arrival| {
                let upstream = &mut plan.stages[arrival.stage];
                upstream.needed[arrival.item] = true;
                let properties = recipe.stages[arrival.stage].stage.properties();
                let sees = properties.intermediate.iter().any(|name| sees(connection, name));
                if sees && upstream.was_whole[arrival.item] == Some(false) {
                    spent[arrival.stage].insert(arrival.item);
                    if make_again {
                        upstream.finished[arrival.item] = None;
                    }
                }
            };
            match connection.port.fan {
                Fan::Each | Fan::Group => {
                    will_run.iter().flat_map(|item| connection.arrivals_for(*item)).for_each(&mut mark)
                }
                Fan::Broadcast | Fan::Gather if will_run.is_empty() => {}
                Fan::Broadcast | Fan::Gather => connection.arrivals.iter().for_each(&mut mark),
            }
        }
    }
    plan.stages.iter_mut().zip(spent).for_each(|(stage, spent)| stage.spent = spent.len() as u64);
}

/// Predicts the files of the items left to do: as many blobs as the stage states. (Finished items tell only the names of their
/// blobs, many of which belong to the items that they were handed on from.)
fn predict_files(plan: &mut Plan<'_>) {
    for (stage, described) in plan.stages.iter_mut().zip(&plan.recipe.stages) {
        let stated = described.stage.properties().files_per_item;
        stage.predicted_files = stage.to_run().saturating_mul(stated.saturating_add(RECORDS_PER_ITEM));
    }
}

/// Predicts the time of the items left to do from measured ones.
fn predict_time(plan: &mut Plan<'_>, store: &Store) {
    for stage in plan.stages.iter_mut().filter(|stage| stage.to_run() > 0) {
        let measured = store.costs(&stage.definition.digest, &stage.kind_and_part()).per_item_s();
        stage.predicted_s = measured.map(|seconds| seconds * stage.to_run() as f64);
    }
}

/// Predicts the bytes of the items left to do: as many as the stage's finished items have, else as it states itself.
fn predict(plan: &mut Plan<'_>) {
    let mut expected: Vec<u64> = Vec::with_capacity(plan.stages.len());
    for ((stage, described), length) in plan.recipe.stages.iter().enumerate().zip(lengths(plan.recipe)) {
        let arriving = |counts: &dyn Fn(usize) -> bool| {
            let connections = described.connections.iter();
            let by_item = connections.filter(|connection| matches!(connection.port.fan, Fan::Each | Fan::Group));
            let of = by_item.flat_map(|connection| connection.arrivals.iter()).filter(|arrival| counts(arrival.stage));
            let all = of.map(|arrival| expected[arrival.stage]).fold(0, u64::saturating_add);
            all / (described.items.len() as u64).max(1)
        };
        let gives = |stage: usize| plan.recipe.stages[stage].stage.properties().gives.is_some();
        let stated = || match stated_bytes(described.stage.properties(), length.unwrap_or(UNTOLD)) {
            0 => arriving(&|_| true),
            stated => {
                let share = share_of_variants(described, &plan.recipe.stages);
                // What a stage gives by a name is there once more in the tables that hold it.
                ((stated as f64 * share) as u64).saturating_add(arriving(&gives))
            }
        };
        let each = measured_bytes(plan, stage).unwrap_or_else(stated);
        let planned = &mut plan.stages[stage];
        planned.predicted_bytes = planned.to_run().saturating_mul(each);
        expected.push(each);
    }
}

/// Mean bytes of the finished items of a stage, without the blobs that they were handed; `None` where none is finished.
fn measured_bytes(plan: &Plan<'_>, stage: usize) -> Option<u64> {
    let numbered = plan.stages[stage].finished.iter().enumerate();
    let finished = numbered.filter_map(|(item, found)| Some((item, &found.as_ref()?.record.outputs)));
    let finished: Vec<(usize, &Arc<Blobs>)> = finished.take(MEASURED).collect();
    if finished.is_empty() {
        return None; // before all that arrives is gone through
    }
    let mut handed: BTreeSet<Digest> = BTreeSet::new();
    let mut hand = |arrival: &Arrival| {
        if let Some(found) = &plan.stages[arrival.stage].finished[arrival.item] {
            handed.extend(found.record.outputs.values().map(|blob| blob.digest));
        }
    };
    for connection in &plan.recipe.stages[stage].connections {
        match connection.port.fan {
            Fan::Each | Fan::Group => {
                finished.iter().flat_map(|(item, _)| connection.arrivals_for(*item)).for_each(&mut hand)
            }
            Fan::Broadcast | Fan::Gather => connection.arrivals.iter().for_each(&mut hand),
        }
    }
    let own = finished.iter().flat_map(|(_, blobs)| blobs.values()).filter(|blob| !handed.contains(&blob.digest));
    Some(own.fold(0, |sum: u64, blob| sum.saturating_add(blob.bytes)) / finished.len() as u64)
}

/// Bytes of an item of this length, as its stage states them.
fn stated_bytes(properties: &StageProperties, length: ItemLength) -> u64 {
    let of_frames = properties.bytes_per_frame.saturating_mul(length.frames);
    let of_seconds = properties.bytes_per_s as f64 * length.duration_s;
    properties.bytes_per_item.saturating_add(of_frames).saturating_add(of_seconds as u64)
}

/// Share of the items of a stage that are of the variant that it needs, as a sensor reads along the films of one camera.
fn share_of_variants(described: &RecipeStage, stages: &[RecipeStage]) -> f64 {
    let needs = described.stage.properties().needs.iter();
    let shares = needs.filter_map(|need| {
        let StageNeed::Variant { port, name, .. } = need else { return None };
        let at_port = described.connections.iter().filter(|connection| connection.port.name == *port);
        let arrivals: Vec<&Arrival> = at_port.flat_map(|connection| connection.arrivals.iter()).collect();
        let of_variant = |arrival: &&&Arrival| stages[arrival.stage].items[arrival.item].variant() == Some(name);
        Some(arrivals.iter().filter(of_variant).count() as f64 / arrivals.len().max(1) as f64)
    });
    shares.product()
}

/// Length of one item of each stage: what the stage sets, else the longest that it is made of; all of a group, one after the other.
fn lengths(recipe: &Recipe) -> Vec<Option<ItemLength>> {
    let mut lengths: Vec<Option<ItemLength>> = Vec::with_capacity(recipe.stages.len());
    for described in &recipe.stages {
        let arriving = described.connections.iter().filter_map(|connection| {
            let upstreams = connection.upstreams.iter().filter_map(|upstream| lengths[*upstream]);
            let longest = upstreams.max_by_key(|length| length.frames)?;
            match connection.port.fan {
                Fan::Each => Some(longest),
                Fan::Group => Some(longest.times(connection.arrivals.len().div_ceil(described.items.len().max(1)))),
                Fan::Broadcast | Fan::Gather => None,
            }
        });
        let longest = arriving.max_by_key(|length| length.frames);
        lengths.push(described.stage.properties().length.or(longest));
    }
    lengths
}
