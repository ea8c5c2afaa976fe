//! The command line of `cosfly dataset ...`.

use super::{RecipeArguments, StoreArguments};
use clap::{Args, Subcommand};
use std::path::PathBuf;

/// What to do with finished datasets.
#[derive(Debug, Subcommand)]
pub enum DatasetCommand {
    /// Look for leaks between the splits of one or several datasets, and name the pairs
    #[command(after_help = "\
Examples:
  cosfly dataset lint out/carla_town
  cosfly dataset lint out/Town01 out/Town02_Opt --by-town   no place may be in two splits, whatever it is called

Found are towns with the same ground plan under two names, pedestrians and twins that are apart, walks that repeat each
other, and windows that are the same. Each finding names both flights and both splits; the exit code is then 1.")]
    Lint(LintArguments),
    /// Give a name to what the store holds of a recipe's dataset, and keep it from `cosfly gc`
    #[command(after_help = "\
Example:
  cosfly dataset tag v1.0.0 recipes/carla_town.toml

A version is a manifest in the store's folder `versions`: hash and size of every file, the exact recipe with its `--set`,
the version of cosfly, the hashes of plugins and of all files that the recipe reads, and the keys of the tasks behind
every flight. Patch: the same records, packed in another way. Minor: old records unchanged. Major: records changed,
went, or moved to another split.")]
    Tag(TagArguments),
    /// List the named versions
    List(ListArguments),
    /// Say which flights were added, dropped, changed or moved between two versions, and why
    #[command(after_help = "Example:\n  cosfly dataset diff v1.0.0 v1.1.0")]
    Diff(DiffArguments),
    /// Write a named version into a folder, byte by byte as it was
    #[command(after_help = "Example:\n  cosfly dataset checkout v1.0.0 --out out/v1")]
    Checkout(CheckoutArguments),
}

/// Arguments of `dataset lint`.
#[derive(Debug, Args)]
pub struct LintArguments {
    /// Folders of finished datasets, which are judged as one
    #[arg(required = true, value_name = "DIR")]
    pub dirs: Vec<PathBuf>,
    /// A place must be in one split only, so that `val` and `test` show unseen towns
    #[arg(long)]
    pub by_town: bool,
    /// Share of a walk that another one may repeat in another split; what the first dataset promises unless given
    #[arg(long, value_name = "SHARE")]
    pub max_route_overlap: Option<f64>,
}

/// Arguments of `dataset tag`.
#[derive(Debug, Args)]
pub struct TagArguments {
    /// Name of the version, such as v1.0.0
    #[arg(value_name = "NAME")]
    pub name: String,
    #[command(flatten)]
    pub recipe: RecipeArguments,
    #[command(flatten)]
    pub store: StoreArguments,
}

/// Arguments of `dataset list`.
#[derive(Debug, Args)]
pub struct ListArguments {
    #[command(flatten)]
    pub store: StoreArguments,
}

/// Arguments of `dataset diff`.
#[derive(Debug, Args)]
pub struct DiffArguments {
    /// The earlier version
    #[arg(value_name = "OLD")]
    pub old: String,
    /// The later version
    #[arg(value_name = "NEW")]
    pub new: String,
    /// Name every flight and file
    #[arg(long)]
    pub all: bool,
    #[command(flatten)]
    pub store: StoreArguments,
}

/// Arguments of `dataset checkout`.
#[derive(Debug, Args)]
pub struct CheckoutArguments {
    /// Name of the version
    #[arg(value_name = "NAME")]
    pub name: String,
    /// Folder for the dataset
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    #[command(flatten)]
    pub store: StoreArguments,
}
