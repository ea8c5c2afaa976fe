//! Commands that print what cosfly generates: schemas, pages, towns.

use clap::Args;

/// Arguments of `schema`.
#[derive(Args, Debug)]
pub struct SchemaArguments {
    /// The recipe reference as Markdown instead
    #[arg(long, conflicts_with = "tables")]
    pub reference: bool,
    /// The dataset's tables and channels as Markdown instead
    #[arg(long)]
    pub tables: bool,
}

/// Arguments of `town`.
#[derive(Args, Debug)]
pub struct TownArguments {
    /// Seed; every seed is another town
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
}
