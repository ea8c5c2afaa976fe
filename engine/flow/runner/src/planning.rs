//! Planning: a recipe against a store.

use crate::document::{Definition, PortDocument, plan_document, port_document};
use crate::plan::{Plan, PlannedStage, planned_input, recipe_id};
use crate::reasons;
use crate::sources::{HashedSource, SourceReader};
use cosfly_diagnose::Result;
use cosfly_fingerprint::Digest;
use cosfly_recipe::{Recipe, RecipeStage};
use cosfly_stage::{Fan, ItemName};
use cosfly_store::Store;
use rayon::prelude::*;

/// Fewer items than this are not worth another thread.
const PER_THREAD: usize = 256;

/// Plan of a recipe against a store. All stages are wanted.
///
/// # Errors
/// Refusals of the machine while sources are hashed.
pub fn plan<'r>(recipe: &'r Recipe, store: &Store) -> Result<Plan<'r>> {
    let mut plan = digest_tasks(recipe)?;
    find_finished(&mut plan, store);
    store.check_remote()?;
    predict(&mut plan);
    reasons::give_reasons(&mut plan, store);
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
    Ok(Plan { recipe, recipe_id: recipe_id(recipe), stages, index_is_current: false })
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
        let arrival = |connection: usize| stage.connections[connection].arrivals.get(index);
        let each = |connection: usize| arrival(connection).map(|arrival| planned_input(recipe, earlier, arrival));
        Digest::of(plan_document(&definition.digest, item, &ports, each).as_bytes())
    };
    let plans: Vec<Digest> = stage.items.par_iter().enumerate().with_min_len(PER_THREAD).map(plan_of).collect();
    Ok(PlannedStage {
        name: stage.name.clone(),
        kind: stage.kind.clone(),
        finished: vec![None; plans.len()],
        plans,
        predicted_bytes: 0,
        reasons: Vec::new(),
        definition,
        sources,
        ports,
    })
}

fn find_finished(plan: &mut Plan<'_>, store: &Store) {
    let known = store.known_tasks(&plan.recipe_id);
    for stage in &mut plan.stages {
        stage.finished = stage.plans.par_iter().with_min_len(PER_THREAD).map(|digest| known.finished(digest)).collect();
    }
    plan.index_is_current = known.is_current(&plan.run_digest());
}

/// Predicts the bytes of the items left to do: as many as the stage's finished items have, else as it states itself.
fn predict(plan: &mut Plan<'_>) {
    let mut expected: Vec<u64> = Vec::with_capacity(plan.stages.len());
    for (stage, described) in plan.stages.iter_mut().zip(&plan.recipe.stages) {
        let known: Vec<u64> = stage.finished.iter().flatten().map(|finished| finished.record.bytes()).collect();
        let stated = described.stage.properties().bytes_per_item;
        let arriving = || {
            let each = described.connections.iter().filter(|connection| connection.port.fan == Fan::Each);
            each.filter_map(|connection| connection.upstreams.iter().map(|upstream| expected[*upstream]).max()).sum()
        };
        let each = match (known.len() as u64, stated) {
            (0, 0) => arriving(),
            (0, stated) => stated,
            (items, _) => known.iter().fold(0, |sum: u64, bytes| sum.saturating_add(*bytes)) / items,
        };
        stage.predicted_bytes = stage.to_run().saturating_mul(each);
        expected.push(each);
    }
}
