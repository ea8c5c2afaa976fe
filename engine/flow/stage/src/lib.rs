//! The stage contract: declaration of a stage, its inputs, its outputs, and the events of a run.
//!
//! * [`StageKind`]: an entry of the registry; builds stages from checked parameters.
//! * [`Stage`]: declares its [`StageProperties`] as data, then makes one item at a time.
//! * [`StageName`], [`ItemName`], [`ItemId`]: identities of stages and items.
//! * [`Inputs`], [`TaskContext`], [`cosfly_blobs::OutputSink`]: everything that a stage may access while it runs.
//! * [`Answers`]: answers of services outside, kept because nobody can compute them again.
//! * [`parameters`]: parameters between JSON and config structs, for [`StageKind`]s.
//! * [`RunEvent`]: the events of a run.

mod answers;
mod artifact;
mod blobs;
mod event;
mod kind;
mod name;
pub mod parameters;
mod properties;
mod stage;

pub use answers::{Answers, Asks, Spent};
pub use artifact::{Artifact, BlobSource, Decoded, Inputs, Ports};
pub use blobs::Blobs;
pub use event::{RunEvent, Work};
pub use kind::{Registry, StageKind, StagePart, Tool};
pub use name::{ItemId, ItemName, StageName};
pub use properties::{
    Fan, InputPort, ItemLength, ItemRule, PortSource, ReadSchema, Resources, Sees, Settle, Source, SourceCheck,
    StageNeed, StageProperties, StageRole, Takes,
};
pub use stage::{Produced, Stage, TaskContext};
