//! The stage contract: what a stage declares, what it is given, what it makes, and what a run reports.
//!
//! * [`StageKind`]: one entry of the registry; turns a stage's checked parameters into stages.
//! * [`Stage`]: declares its [`StageProperties`] as data, then makes one item at a time.
//! * [`StageName`], [`ItemName`], [`ItemId`]: who is who.
//! * [`Inputs`], [`TaskContext`], [`cosfly_blobs::OutputSink`]: everything a stage may touch while it runs.
//! * [`RunEvent`]: everything a run tells its reporters.

mod artifact;
mod event;
mod kind;
mod name;
mod properties;
mod stage;

pub use artifact::{Artifact, BlobSource, Blobs, Decoded, Inputs, Ports};
pub use event::{RunEvent, Work};
pub use kind::{Registry, StageKind, StagePart};
pub use name::{ItemId, ItemName, StageName};
pub use properties::{
    Fan, InputPort, ItemRule, PortSource, ReadSchema, Settle, Source, SourceCheck, StageProperties, Takes,
};
pub use stage::{Produced, Stage, TaskContext};
