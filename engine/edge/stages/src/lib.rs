//! The built-in stages: thin adapters with the simulated world or the dataset on one side and [`Stage`] on the other.
//!
//! Adding a stage: one new file here, its `mod` line, and its line in [`registry`].

mod backends;
mod body_rays;
mod caption;
mod codec;
mod companions;
mod crowd;
mod dataset;
pub mod expert;
mod flight;
mod inspect;
mod logs;
mod map;
mod memo;
mod muco;
mod nearby;
mod parameters;
mod pedestrians;
mod perturb;
mod planner_comparison;
mod planners;
pub mod plugins;
mod ports;
mod published_towns;
pub mod read;
mod rejections;
mod render;
pub mod requests;
mod shooting;
mod verdict;
mod walks;
pub mod world;

use cosfly_stage::{Registry, Stage};

/// All built-in stage kinds, sorted by name.
pub fn registry() -> Registry {
    Registry::new(vec![
        Box::new(caption::Caption),
        Box::new(dataset::Dataset),
        Box::new(inspect::Inspect),
        Box::new(map::Map),
        Box::new(muco::Muco),
        Box::new(pedestrians::Pedestrians),
        Box::new(perturb::Perturb),
        Box::new(render::Render),
        Box::new(plugins::stage::Wasm),
    ])
}

/// A stage kind of a single part.
fn single(stage: impl Stage + 'static) -> Vec<cosfly_stage::StagePart> {
    vec![cosfly_stage::StagePart { suffix: "", stage: Box::new(stage) }]
}
