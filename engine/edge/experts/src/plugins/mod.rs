//! Plugins in recipes: cost terms and objectives of `muco` stages, and stages of their own.
//!
//! * [`config`]: plugins as recipes name them; it exists with and without the feature `plugins`.
//! * [`stage`]: plugins as stages; [`tables`]: checks of their declarations.
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

use cosfly_objectives::reference::Reference;

/// Reference drawn by an objective's plugin.
pub struct DrawnReference {
    /// Places to be at, and points to look at.
    pub reference: Reference,
    /// Notes for the summary.
    pub notes: Vec<(String, String)>,
    /// Warnings of the plugin.
    pub warnings: Vec<String>,
}

/// Role of a plugin in a recipe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A cost term.
    Term,
    /// An objective.
    Objective,
    /// A stage with this output.
    Stage(config::Makes),
}
