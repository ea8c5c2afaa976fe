//! Artifacts at the ports of tasks; those that all items of a stage read are made once and shared.

use cosfly_recipe::{Arrival, Recipe};
use cosfly_stage::{Artifact, Blobs, Fan, ItemName, Ports, Sees};
use cosfly_store::Finished;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Results of tasks by stage and item.
pub(crate) type Results = Vec<Vec<Option<Finished>>>;

/// Artifacts of the ports that do not differ between the items of a stage.
#[derive(Default)]
pub(crate) struct SharedInputs {
    /// By stage and connection.
    known: BTreeMap<(usize, usize), Arc<[Artifact]>>,
}

impl SharedInputs {
    /// Inputs of one task by port.
    pub(crate) fn of_task(&mut self, recipe: &Recipe, results: &Results, stage: usize, item: usize) -> Ports {
        let connections = recipe.stages[stage].connections.iter().enumerate();
        let ports = connections.map(|(number, connection)| {
            let reader = &recipe.stages[stage].items[item];
            let seen = |arrival| artifact(recipe, results, connection.port.sees, reader, arrival);
            let artifacts = || connection.arrivals_for(item).iter().map(seen).collect();
            let artifacts = match connection.port.fan {
                Fan::Each | Fan::Group => artifacts(),
                Fan::Broadcast | Fan::Gather if connection.port.sees == Sees::Own => artifacts(),
                Fan::Broadcast | Fan::Gather => Arc::clone(self.known.entry((stage, number)).or_insert_with(artifacts)),
            };
            (connection.port.name, artifacts)
        });
        ports.collect()
    }

    /// Forgets inputs from `upstream`, an item of which has a new result.
    pub(crate) fn forget(&mut self, recipe: &Recipe, upstream: usize) {
        self.known
            .retain(|(stage, number), _| !recipe.stages[*stage].connections[*number].upstreams.contains(&upstream));
    }
}

fn artifact(recipe: &Recipe, results: &Results, sees: Sees, reader: &ItemName, arrival: &Arrival) -> Artifact {
    let result = results[arrival.stage][arrival.item].as_ref();
    let outputs = result.map(|finished| Arc::clone(&finished.record.outputs)).unwrap_or_default();
    Artifact {
        id: recipe.id(arrival.stage, arrival.item),
        name: arrival.name.clone(),
        blobs: seen_by(reader, sees, outputs),
    }
}

/// The blobs of an item that the item `reader` of a stage sees.
pub(crate) fn seen_by(reader: &ItemName, sees: Sees, outputs: Arc<Blobs>) -> Arc<Blobs> {
    let seen: Blobs = match sees {
        Sees::All => return outputs,
        Sees::Only(names) => names.iter().filter_map(|name| Some(((*name).to_owned(), *outputs.get(name)?))).collect(),
        Sees::Own => {
            let name = reader.to_string();
            outputs.get(&name).map(|blob| (name, *blob)).into_iter().collect()
        }
    };
    Arc::new(seen)
}
