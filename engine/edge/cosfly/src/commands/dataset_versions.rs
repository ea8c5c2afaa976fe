//! `cosfly dataset tag`, `list`, `diff`, `checkout`: named versions of datasets.

use super::{Outcome, recipe, store_dir};
use crate::arguments::{CheckoutArguments, DiffArguments, ListArguments, TagArguments};
use crate::exit;
use crate::text::{bytes, count};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use cosfly_store::{Store, check_out_folder, materialise, pin};
use cosfly_versions::difference::{Bump, Difference};
use cosfly_versions::{TaskName, Version, difference, record, shelf};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

/// Flights that one reason names at most, unless all are asked for.
const NAMED: usize = 4;

/// Names what the store holds of a recipe's dataset.
pub fn tag(arguments: &TagArguments) -> Outcome {
    let recipe = recipe(&arguments.recipe)?;
    let root = store_dir(&arguments.store);
    let text = tagged(arguments, &recipe, &root).map_err(|refusal| vec![refusal])?;
    crate::print(&text)?;
    Ok(exit::SUCCESS)
}

fn tagged(arguments: &TagArguments, recipe: &cosfly_recipe::Recipe, root: &Path) -> Result<String> {
    let version = {
        let store = Store::open(root)?;
        let version = record(&arguments.name, recipe, &arguments.recipe.overrides, &store, env!("CARGO_PKG_VERSION"))?;
        check_newest(recipe, &store, &version)?;
        version
    };
    let earlier = shelf::all(root)?;
    pin(root, &cosfly_runner::recipe_id(recipe), &format!("version-{}", version.name))?;
    shelf::put(root, &version)?;
    let mut text = line(&version);
    let earlier = earlier.iter().filter(|it| it.dataset == version.dataset && it.content != version.content);
    for old in earlier {
        let bump = difference(old, &version).bump();
        if !bump.is_kept(&old.dataset_version, &version.dataset_version) {
            let _ = writeln!(
                text,
                "note: against `{}` this is a {} change, but {} follows {}: set `version` of the dataset stage",
                old.name,
                bump.name(),
                version.dataset_version,
                old.dataset_version
            );
        }
    }
    Ok(text)
}

/// Garbage collection keeps a version by the run that made it, which must be the newest one.
fn check_newest(recipe: &cosfly_recipe::Recipe, store: &Store, version: &Version) -> Result<()> {
    let newest = store.past_runs(&cosfly_runner::recipe_id(recipe)).next();
    let holds = |task: &TaskName, key: Digest| {
        (*newest.as_ref()?.stage(task.stage.as_str())?.items.get(&task.item)? == key).then_some(())
    };
    let is_newest = version
        .flights
        .values()
        .all(|flight| version.tasks.get(&flight.task).is_some_and(|task| holds(&flight.task, task.key).is_some()));
    if is_newest {
        return Ok(());
    }
    let message = format!("the newest run of recipe `{}` made something else", recipe.name);
    Err(Diagnostic::new("version-not-newest", Fault::Recipe, message)
        .hint("run it again as it is to be tagged: everything is in the store, nothing is computed"))
}

/// All versions of a store.
pub fn list(arguments: &ListArguments) -> Outcome {
    let versions = shelf::all(&store_dir(&arguments.store)).map_err(|refusal| vec![refusal])?;
    let text: String = versions.iter().map(line).collect();
    crate::print(if text.is_empty() {
        "no version has a name yet: `cosfly dataset tag NAME RECIPE`\n"
    } else {
        &text
    })?;
    Ok(exit::SUCCESS)
}

fn line(version: &Version) -> String {
    format!(
        "{}  {} {}, {} in {} of {}, content {}, made with cosfly {}\n",
        version.name,
        version.dataset,
        version.dataset_version,
        count(version.flights.len() as u64, "flight"),
        count(version.files.len() as u64, "file"),
        bytes(version.bytes()),
        version.content.short(),
        version.cosfly
    )
}

/// What two versions have not in common, and why.
pub fn diff(arguments: &DiffArguments) -> Outcome {
    let root = store_dir(&arguments.store);
    let both = shelf::get(&root, &arguments.old).and_then(|old| Ok((old, shelf::get(&root, &arguments.new)?)));
    let (old, new) = both.map_err(|refusal| vec![refusal])?;
    crate::print(&told(&old, &new, &difference(&old, &new), arguments.all))?;
    Ok(exit::SUCCESS)
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

/// A version as a folder.
pub fn checkout(arguments: &CheckoutArguments) -> Outcome {
    let root = store_dir(&arguments.store);
    let checked_out = || {
        let version = shelf::get(&root, &arguments.name)?;
        check_out_folder(&root, &arguments.out)?;
        materialise(&Store::open(&root)?, &version.files, &arguments.out)
    };
    let folder = checked_out().map_err(|refusal| vec![refusal])?;
    let state = if folder.changed { "" } else { " (unchanged)" };
    let (files, size) = (count(folder.files, "file"), bytes(folder.bytes));
    crate::print(&format!("{} in {files} of {size}{state}\n", arguments.out.display()))?;
    Ok(exit::SUCCESS)
}
