//! Intermediate blobs of a run: each is removed once everything that reads it is finished.

use crate::inputs::Results;
use crate::plan::sees;
use crate::schedule::{Schedule, TaskIndex};
use cosfly_blobs::BlobRef;
use cosfly_fingerprint::Digest;
use cosfly_recipe::{Arrival, Recipe};
use cosfly_store::ActionRecord;
use std::collections::BTreeMap;

/// Readers of intermediate blobs that are not finished yet. Blobs that nothing reads stay: they were asked for.
pub(crate) struct Intermediates<'r> {
    recipe: &'r Recipe,
    /// By task: unfinished tasks that see its intermediate blobs.
    readers_left: BTreeMap<TaskIndex, u32>,
    /// By blob: finished tasks that made it and still have readers. An artifact may hand on the blob of another.
    holders: BTreeMap<Digest, u32>,
}

impl<'r> Intermediates<'r> {
    /// Counts the unfinished readers, also those that will not run now, and the results that are there already.
    pub(crate) fn new(recipe: &'r Recipe, schedule: &Schedule, results: &Results) -> Self {
        let mut all = Self { recipe, readers_left: BTreeMap::new(), holders: BTreeMap::new() };
        for (stage, described) in recipe.stages.iter().enumerate() {
            for item in (0..described.items.len()).filter(|item| results[stage][*item].is_none()) {
                for arrival in all.seen_by(stage, item).collect::<Vec<_>>() {
                    *all.readers_left.entry(schedule.task(arrival.stage, arrival.item)).or_default() += 1;
                }
            }
        }
        for (stage, results) in results.iter().enumerate() {
            for (item, finished) in results.iter().enumerate() {
                if let Some(finished) = finished {
                    all.hold(schedule, stage, item, &finished.record);
                }
            }
        }
        all
    }

    /// Items whose intermediate blobs an item sees.
    fn seen_by(&self, stage: usize, item: usize) -> impl Iterator<Item = &'r Arrival> + use<'r> {
        let recipe = self.recipe;
        recipe.stages[stage].connections.iter().flat_map(move |connection| {
            let sees = |arrival: &&Arrival| {
                let names = recipe.stages[arrival.stage].stage.properties().intermediate;
                names.iter().any(|name| sees(connection, name))
            };
            connection.arrivals_for(item).iter().filter(sees)
        })
    }

    fn hold(&mut self, schedule: &Schedule, stage: usize, item: usize, record: &ActionRecord) {
        if self.readers_left.get(&schedule.task(stage, item)).is_some_and(|left| *left > 0) {
            for blob in self.blobs_of(stage, record) {
                *self.holders.entry(blob.digest).or_default() += 1;
            }
        }
    }

    /// Intermediate blobs of a result of `stage`.
    fn blobs_of(&self, stage: usize, record: &ActionRecord) -> Vec<BlobRef> {
        let names = self.recipe.stages[stage].stage.properties().intermediate;
        names.iter().filter_map(|name| record.outputs.get(name).copied()).collect()
    }

    /// Notes that a task is finished for good, with `record`; gives the blobs that nothing needs any more.
    pub(crate) fn finished(
        &mut self,
        schedule: &Schedule,
        results: &Results,
        task: TaskIndex,
        record: &ActionRecord,
    ) -> Vec<BlobRef> {
        let (stage, item) = schedule.place(task);
        self.hold(schedule, stage, item, record);
        let mut spent = vec![];
        for arrival in self.seen_by(stage, item) {
            let maker = schedule.task(arrival.stage, arrival.item);
            let Some(left) = self.readers_left.get_mut(&maker).filter(|left| **left > 0) else { continue };
            *left -= 1;
            let made = results[arrival.stage][arrival.item].as_ref().filter(|_| *left == 0);
            let blobs = made.map_or(vec![], |made| self.blobs_of(arrival.stage, &made.record));
            for blob in &blobs {
                let holders = self.holders.entry(blob.digest).or_insert(1);
                *holders = holders.saturating_sub(1);
            }
            spent.extend(blobs);
        }
        spent.retain(|blob| self.holders.get(&blob.digest).is_none_or(|holders| *holders == 0));
        spent
    }
}
