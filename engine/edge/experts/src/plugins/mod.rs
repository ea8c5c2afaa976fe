//! Plugins in recipes: cost terms and objectives of `plan` stages, and stages of their own.
//!
//! * [`config`]: plugins as recipes name them; it exists with and without the feature `plugins`.
//! * [`tables`]: checks of the declarations of plugins that are stages.
//! * `running`: the host at work; `absent` takes its place in a build without plugins.

#[cfg(not(feature = "plugins"))]
mod absent;
pub mod config;
#[cfg(feature = "plugins")]
mod running;
pub mod tables;

#[cfg(not(feature = "plugins"))]
pub use absent::{Answered, Column, Declaration, Effect, Plugins, ValueKind, source};
#[cfg(feature = "plugins")]
pub use running::{Plugins, host, keep_compiled_in, source};

#[cfg(feature = "plugins")]
pub use cosfly_plugin_host::{Answered, Column, Declaration, Effect, ValueKind};

/// Role of a plugin in a recipe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PluginRole {
    /// A cost term.
    Term,
    /// An objective.
    Objective,
    /// A stage with this output.
    Stage(config::Makes),
}
