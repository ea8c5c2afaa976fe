//! Plugins: WebAssembly components in a sandbox, as cost terms, objectives and stages. The interface is in `plugins/wit`.
//!
//! * [`Host`]: engines, and the way from a file to compiled code: checked, made a component, compiled, kept.
//! * [`Plugin`]: a compiled file and its description; [`Session`]: one instance of it, with its limits.
//! * [`PluginTerm`], [`draw_reference`], [`run_stage`]: a plugin as a cost term, an objective, a stage.
//! * [`PluginError`]: the failure, the function, and the limit that was met.
//!
//! A plugin that traps is done for: its session answers nothing more, and the next item gets a new one.

mod compiled_code;
mod component_term;
mod cost_term;
mod direct_abi;
mod direct_term;
mod failure;
mod host;
mod imports;
mod interface_0_1;
mod kind;
pub mod laws;
mod layer;
mod limits;
mod objective;
mod parameters;
mod plugin;
mod sandbox;
mod session;
mod tables;
mod term_border;
mod town;

pub use cost_term::{Began, PluginTerm};
pub use failure::PluginError;
pub use host::{Host, MAX_FILE_BYTES};
pub use interface_0_1::{Column, Declaration, Effect, Metadata, Plan, RunContext, SiteContext, TermShape, ValueKind};
pub use kind::Kind;
pub use limits::PluginLimits;
pub use objective::{Drawn, draw_reference};
pub use parameters::{check_given, check_schema, with_defaults};
pub use plugin::Plugin;
pub use sandbox::{Effort, Said};
pub use session::Session;
pub use tables::{Answered, declaration, run_stage};
pub use town::{NoTown, TownView};
