//! The built-in stages: thin adapters with the simulated world or the dataset on one side and [`Stage`] on the other.
//!
//! Adding a stage: one new file here, its `mod` line, and its line in [`registry`].

mod caption;
mod companions;
mod crowd;
mod dataset;
mod formation;
mod group_notes;
mod group_splits;
mod inspect;
mod logs;
mod map;
mod nearby;
mod pedestrians;
mod perturb;
mod plan;
mod planners;
mod planning;
mod plugin;
mod ports;
mod quotas;
mod rejections;
mod render;
mod scan;
mod sense;
mod shards;
#[cfg(test)]
mod tests;
mod traffic;
mod verdict;

use cosfly_env::SuiteTable;
use cosfly_stage::{Registry, Stage, StageKind, Tool};

/// All built-in stage kinds, sorted by name.
pub fn registry() -> Registry {
    registry_with(vec![])
}

/// All built-in stage kinds and `others`, for measurements.
pub fn registry_with(others: Vec<Box<dyn StageKind>>) -> Registry {
    let mut kinds: Vec<Box<dyn StageKind>> = vec![
        Box::new(caption::Caption),
        Box::new(dataset::Dataset),
        Box::new(inspect::Inspect),
        Box::new(map::Map),
        Box::new(pedestrians::Pedestrians),
        Box::new(perturb::Perturb),
        Box::new(plan::Plan),
        Box::new(render::Render),
        Box::new(scan::Scan),
        Box::new(sense::Sense),
        Box::new(traffic::TrafficKind),
        Box::new(plugin::Wasm),
    ];
    kinds.extend(others);
    let fly = Tool { name: "fly", schema: cosfly_stage::parameters::schema_of::<SuiteTable>() };
    Registry::new(kinds).with_tool(fly)
}

/// A stage kind of a single part.
fn single(stage: impl Stage + 'static) -> Vec<cosfly_stage::StagePart> {
    vec![cosfly_stage::StagePart { suffix: "", stage: Box::new(stage) }]
}
