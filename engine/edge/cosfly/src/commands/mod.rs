//! The commands, one file or folder each.
//!
//! To add one, write its file and add two lines here: its `mod` and its entry in [`COMMANDS`].

pub mod ask_expert;
mod carla_job;
mod cluster;
mod dagger;
mod dataset;
mod doctor;
mod elsewhere;
mod eval;
mod export;
mod fly;
mod gc;
mod graph;
mod hunt;
mod init;
mod leaderboard;
mod map;
mod plan;
#[cfg(feature = "plugins")]
mod plugin;
#[cfg(feature = "plugins")]
mod plugin_check;
#[cfg(feature = "plugins")]
mod plugin_new;
mod preview;
mod run;
mod scanned_mesh;
mod schema;
mod task;
mod town;
mod verify;
mod view;
mod why;

use crate::command::Entry;

/// The commands, sorted by name.
pub const COMMANDS: &[Entry] = &[
    Entry::of::<ask_expert::Arguments>(),
    Entry::of::<carla_job::Arguments>(),
    cluster::CLUSTER,
    Entry::of::<dagger::Arguments>(),
    dataset::DATASET,
    Entry::of::<doctor::Arguments>(),
    Entry::of::<eval::Arguments>(),
    Entry::of::<export::Arguments>(),
    Entry::of::<fly::Arguments>(),
    Entry::of::<gc::Arguments>(),
    Entry::of::<graph::Arguments>(),
    Entry::of::<hunt::Arguments>(),
    Entry::of::<init::Arguments>(),
    Entry::of::<leaderboard::Arguments>(),
    map::MAP,
    Entry::of::<plan::Arguments>(),
    #[cfg(feature = "plugins")]
    plugin::PLUGIN,
    Entry::of::<preview::Arguments>(),
    Entry::of::<run::Arguments>(),
    Entry::of::<schema::Arguments>(),
    task::TASK,
    Entry::of::<town::Arguments>(),
    Entry::of::<verify::Arguments>(),
    Entry::of::<view::Arguments>(),
    Entry::of::<why::Arguments>(),
];
