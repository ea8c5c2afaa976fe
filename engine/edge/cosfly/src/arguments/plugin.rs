//! `plugin ...`: begin, check and measure plugins.

use clap::{Args, Subcommand, ValueEnum};
use std::path::PathBuf;

/// What is done with plugins.
#[derive(Debug, Subcommand)]
pub enum PluginCommand {
    /// Write the beginning of a plugin: a Rust project that builds
    #[command(after_help = "Example:\n  cosfly plugin new --kind cost-term keep_low")]
    New(PluginNewArguments),
    /// Say what a plugin is and wants, and try the laws of its kind: pure, finite, local, gradient
    #[command(after_help = "\
Examples:
  cosfly plugin check recipes/plugins/orbit.wasm
  cosfly plugin check recipes/plugins/wind.wasm --params '{\"speed_mps\": 9}'")]
    Check(PluginFileArguments),
    /// Measure what the border costs: plugins against the same terms in native code, and a cost term of your own
    #[command(after_help = "\
Examples:
  cosfly plugin bench
  cosfly plugin bench recipes/plugins/wind.wasm")]
    Bench(PluginBenchArguments),
}

/// Kinds of plugins.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum PluginKind {
    /// Says what is costly about a flight
    CostTerm,
    /// Says what to look at, from where, when
    Objective,
    /// Judges or labels finished flights
    Stage,
}

/// Arguments of `plugin new`.
#[derive(Args, Debug)]
pub struct PluginNewArguments {
    /// What it is to be
    #[arg(long, value_enum)]
    pub kind: PluginKind,
    /// Folder to write, called like the plugin
    #[arg(value_name = "NAME")]
    pub path: PathBuf,
}

/// Arguments of `plugin check`.
#[derive(Args, Debug)]
pub struct PluginFileArguments {
    /// The plugin
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Its parameters as a JSON object [default: its defaults]
    #[arg(long, value_name = "JSON")]
    pub params: Option<String>,
    /// Run it in strict mode with this many instructions per call
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    pub fuel: u64,
}

/// Arguments of `plugin bench`.
#[derive(Args, Debug)]
pub struct PluginBenchArguments {
    /// A cost term of your own, measured beside the others
    #[arg(value_name = "FILE")]
    pub file: Option<PathBuf>,
    /// Its parameters as a JSON object [default: its defaults]
    #[arg(long, value_name = "JSON")]
    pub params: Option<String>,
}
