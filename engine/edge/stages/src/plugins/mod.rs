//! Plugins in recipes: cost terms and objectives of `muco` stages, and stages of their own.
//!
//! * [`config`]: how recipes name them; there with and without the feature `plugins`.
//! * [`stage`]: plugins as stages; [`tables`]: their declarations, held against what there is to be read and written.
//! * `running`: the host at work; `absent` takes its place in a build without plugins.

#[cfg(not(feature = "plugins"))]
mod absent;
pub mod config;
#[cfg(feature = "plugins")]
mod running;
pub mod stage;
pub mod tables;

#[cfg(not(feature = "plugins"))]
pub use absent::{AfterPlanning, Answered, Column, Declaration, Effect, Plugins, ValueKind, source};
#[cfg(feature = "plugins")]
pub use running::{AfterPlanning, Plugins, host, keep_compiled_in, source};

#[cfg(feature = "plugins")]
pub use cosfly_plugin_host::{Answered, Column, Declaration, Effect, ValueKind};

use cosfly_planner::objectives::reference::Reference;

/// What an objective's plugin gave.
pub struct DrawnReference {
    /// Where to be and what to look at.
    pub reference: Reference,
    /// For the summary.
    pub notes: Vec<(String, String)>,
    /// What the plugin said.
    pub warnings: Vec<String>,
}

/// What a plugin can be in a recipe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A cost term.
    Term,
    /// An objective.
    Objective,
    /// A stage that makes this.
    Stage(config::Makes),
}
