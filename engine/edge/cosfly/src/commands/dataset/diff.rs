//! `cosfly dataset diff`: differences of two named versions, and their reasons.

use crate::arguments::StoreArguments;
use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use crate::text::count;
use clap::Parser;
use cosfly_versions::difference::{Bump, Difference};
use cosfly_versions::{Version, difference, shelf};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Flights that one reason names at most, unless all are asked for.
const NAMED: usize = 4;

/// Say which flights were added, dropped, changed or moved between two versions, and why
#[derive(Debug, Parser)]
#[command(name = "diff", after_help = "Example:\n  cosfly dataset diff v1.0.0 v1.1.0")]
pub struct Arguments {
    /// The earlier version
    #[arg(value_name = "OLD")]
    old: String,
    /// The later version
    #[arg(value_name = "NEW")]
    new: String,
    /// Name every flight and file
    #[arg(long)]
    all: bool,
    #[command(flatten)]
    store: StoreArguments,
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        let root = self.store.with_versions()?;
        let (old, new) = (shelf::get(&root, &self.old)?, shelf::get(&root, &self.new)?);
        console.print(&told(&old, &new, &difference(&old, &new), self.all))?;
        Ok(exit::SUCCESS)
    }
}

fn told(old: &Version, new: &Version, found: &Difference, all: bool) -> String {
    let mut text = format!(
        "from `{}` ({} {}) to `{}` ({} {})\n{} the same\n",
        old.name,
        old.dataset,
        old.dataset_version,
        new.name,
        new.dataset,
        new.dataset_version,
        count(found.same as u64, "flight")
    );
    let mut groups: BTreeMap<(_, &Vec<String>), Vec<&str>> = BTreeMap::new();
    for (id, (fate, why)) in &found.flights {
        groups.entry((*fate, why)).or_default().push(id);
    }
    for ((fate, why), ids) in groups {
        let shown = if all { ids.len() } else { NAMED.min(ids.len()) };
        let more = if shown < ids.len() { format!(" and {} more", ids.len() - shown) } else { String::new() };
        let _ = writeln!(text, "{} {fate}: {}{more}", count(ids.len() as u64, "flight"), ids[..shown].join(", "));
        why.iter().for_each(|reason| {
            let _ = writeln!(text, "  because {reason}");
        });
    }
    if !found.packing.is_empty() {
        text.push_str("packed differently:\n");
        found.packing.iter().for_each(|change| {
            let _ = writeln!(text, "  {change}");
        });
    }
    if old.cosfly != new.cosfly {
        let _ = writeln!(text, "made with cosfly {} and {}", old.cosfly, new.cosfly);
    }
    if !found.files.is_empty() {
        let _ = writeln!(text, "{} beside the logs differ", count(found.files.len() as u64, "file"));
        let shown = if all { found.files.len() } else { 0 };
        found.files[..shown].iter().for_each(|(path, fate)| {
            let _ = writeln!(text, "  {fate} {path}");
        });
    }
    let bump = found.bump();
    let meaning = match bump {
        Bump::None => "the same files",
        Bump::Patch => "records are the same, packed or described in another way",
        Bump::Minor => "old records are unchanged, new ones came",
        Bump::Major => "records changed, went, or moved to another split",
    };
    let _ = writeln!(text, "a {} change: {meaning}", bump.name());
    text
}
