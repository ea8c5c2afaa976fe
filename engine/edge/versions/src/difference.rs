//! Differences between two versions, and their causes, from the keys of the tasks behind every flight.

use crate::version::Version;
use cosfly_runner::{Change, definition_difference};
use cosfly_stage::{ItemId, StageName};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// Change of a dataset's version number that a difference requires.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Bump {
    /// No change: the same files.
    None,
    /// Equal records, packed or described differently.
    Patch,
    /// Unchanged old records, and new ones.
    Minor,
    /// Records changed, removed, or moved to another split.
    Major,
}

impl Bump {
    /// Name in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Patch => "patch",
            Self::Minor => "minor",
            Self::Major => "major",
        }
    }

    /// Whether the step from `old` to `new`, both `MAJOR.MINOR.PATCH`, is at least this change.
    pub fn is_kept(self, old: &str, new: &str) -> bool {
        let parts = |version: &str| -> Option<[u64; 3]> {
            let parts: Vec<u64> = version.split('.').map(|part| part.parse().ok()).collect::<Option<_>>()?;
            parts.try_into().ok()
        };
        let (Some(old), Some(new)) = (parts(old), parts(new)) else { return false };
        match self {
            Self::None => new >= old,
            Self::Patch => new > old,
            Self::Minor => new[..2] > old[..2],
            Self::Major => new[0] > old[0],
        }
    }
}

/// Difference of one flight or file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fate {
    /// New in the second version.
    Added,
    /// Missing in the second version.
    Dropped,
    /// Different bytes.
    Changed,
    /// Equal bytes, in another split.
    Moved,
}

impl Fate {
    /// Name in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Added => "added",
            Self::Dropped => "dropped",
            Self::Changed => "changed",
            Self::Moved => "moved",
        }
    }
}

/// Differences between two versions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Difference {
    /// Flights that differ, with their causes.
    pub flights: BTreeMap<String, (Fate, Vec<String>)>,
    /// Number of flights that are equal.
    pub same: usize,
    /// Files that were added, removed or changed, without the logs.
    pub files: Vec<(String, Fate)>,
    /// Changes of the stages that pack the dataset.
    pub packing: Vec<String>,
}

impl fmt::Display for Fate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl Difference {
    /// Required change of the version number.
    pub fn bump(&self) -> Bump {
        let of_fate = |(fate, _): &(Fate, Vec<String>)| if *fate == Fate::Added { Bump::Minor } else { Bump::Major };
        let files = if self.files.is_empty() { Bump::None } else { Bump::Patch };
        self.flights.values().map(of_fate).fold(files, Bump::max)
    }
}

/// Computes the differences from `old` to `new`.
pub fn difference(old: &Version, new: &Version) -> Difference {
    let mut found = Difference::default();
    let ids: BTreeSet<&String> = old.flights.keys().chain(new.flights.keys()).collect();
    for id in ids {
        let fate = match (old.flights.get(id), new.flights.get(id)) {
            (None, Some(flight)) => (Fate::Added, appearance(old, new, id, &flight.task)),
            (Some(flight), None) => (Fate::Dropped, appearance(new, old, id, &flight.task)),
            (Some(a), Some(b)) if a.log != b.log => (Fate::Changed, causes(old, new, &a.task, &b.task)),
            (Some(a), Some(b)) if a.split != b.split => {
                let moved = format!("from `{}` to `{}`", a.split, b.split);
                let mut why = packing(old, new).into_iter().filter(|it| it.contains("splits.")).collect::<Vec<_>>();
                why.insert(0, moved);
                (Fate::Moved, why)
            }
            _ => {
                found.same += 1;
                continue;
            }
        };
        found.flights.insert(id.clone(), fate);
    }
    let is_told = |path: &&String| !path.starts_with("mcap/");
    let paths: BTreeSet<&String> = old.files.keys().chain(new.files.keys()).filter(is_told).collect();
    for path in paths {
        match (old.files.get(path), new.files.get(path)) {
            (None, _) => found.files.push((path.clone(), Fate::Added)),
            (_, None) => found.files.push((path.clone(), Fate::Dropped)),
            (Some(a), Some(b)) if a.digest != b.digest => found.files.push((path.clone(), Fate::Changed)),
            _ => {}
        }
    }
    found.packing = packing(old, new);
    found
}

/// Causes why a flight is in `with` and not in `without`.
fn appearance(without: &Version, with: &Version, id: &str, task: &ItemId) -> Vec<String> {
    if let Some(reason) = without.rejected.get(id) {
        let mut why = vec![format!("it was rejected in `{}`: {reason}", without.name)];
        why.extend(causes(without, with, task, task).into_iter().filter(|_| without.tasks.contains_key(task)));
        return why;
    }
    let mut why: Vec<String> = vec![];
    for stage in origins(without, with, task) {
        for cause in origin_changes(without, with, stage) {
            if !why.contains(&cause) {
                why.push(cause);
            }
        }
    }
    if why.is_empty() {
        why.push(format!("neither `{}` nor `{}` records the cause", without.name, with.name));
    }
    why
}

/// Stages where the item of a task begins to be there in `with` alone: everything that their tasks read is in both.
fn origins<'a>(without: &Version, with: &'a Version, task: &'a ItemId) -> BTreeSet<&'a StageName> {
    let mut open = vec![task];
    let mut seen: BTreeSet<&ItemId> = BTreeSet::from([task]);
    let mut found = BTreeSet::new();
    while let Some(task) = open.pop() {
        let reads = with.tasks.get(task).map_or(&[][..], |task| &task.reads);
        let mut new = reads.iter().filter(|read| !without.tasks.contains_key(*read)).peekable();
        if new.peek().is_none() {
            found.insert(&task.stage);
        }
        open.extend(new.filter(|read| seen.insert(*read)));
    }
    found
}

/// Changes of a stage that give it other items. Their number depends on settings that no item's own key contains, such as a
/// number of walkers: where one of these changed, the others are no cause.
fn origin_changes(without: &Version, with: &Version, stage: &StageName) -> Vec<String> {
    let recipe_name = stage.recipe_name();
    let (a, b) = match (without.recipe.settings.get(recipe_name), with.recipe.settings.get(recipe_name)) {
        (None, Some(_)) => return vec![format!("stage `{recipe_name}` is only in `{}`", with.name)],
        (Some(a), Some(b)) => (a, b),
        _ => return vec![],
    };
    let in_key = |path: &str| [without, with].iter().any(|version| in_force(version, stage, path).is_some());
    let (of_items, of_number): (Vec<_>, Vec<_>) = setting_changes(a, b).into_iter().partition(|it| in_key(&it.0));
    let changes = if of_number.is_empty() { of_items } else { of_number };
    let named = |version: &Version, path: &str, value: &Option<Value>| {
        let value = value.as_ref().or_else(|| in_force(version, stage, path));
        let value = value.map_or("its default".to_owned(), Value::to_string);
        format!("{value} in `{}`", version.name)
    };
    let told: Vec<String> = changes
        .iter()
        .map(|(path, a, b)| {
            format!("{recipe_name}: `{path}` is {} and {}", named(without, path, a), named(with, path, b))
        })
        .collect();
    if told.is_empty() { stage_changes(without, with, stage.as_str()) } else { told }
}

/// Value of a parameter of a stage as its definition has it, defaults filled in.
fn in_force<'a>(version: &'a Version, stage: &StageName, path: &str) -> Option<&'a Value> {
    let definition =
        [stage.as_str(), stage.recipe_name()].into_iter().find_map(|name| version.definitions.get(name))?;
    let value = path.split('.').try_fold(&definition["parameters"], |value, key| match value {
        Value::Array(values) => values.get(key.parse::<usize>().ok()?),
        value => value.get(key),
    })?;
    Some(value).filter(|value| !value.is_null())
}

/// Paths at which two trees of settings differ, with both values.
fn setting_changes(old: &Value, new: &Value) -> Vec<(String, Option<Value>, Option<Value>)> {
    let changes =
        definition_difference(&serde_json::json!({"parameters": old}), &serde_json::json!({"parameters": new}));
    let parameter = |change| match change {
        Change::Parameter { path, old, new } => Some((path, old, new)),
        _ => None,
    };
    changes.into_iter().filter_map(parameter).collect()
}

/// Changes of the stages where two tasks begin to differ.
fn causes(old: &Version, new: &Version, old_task: &ItemId, new_task: &ItemId) -> Vec<String> {
    let mut open = vec![(old_task, new_task)];
    let mut seen: BTreeSet<(&ItemId, &ItemId)> = open.iter().copied().collect();
    let mut why: Vec<String> = vec![];
    while let Some((was, is)) = open.pop() {
        let (Some(a), Some(b)) = (old.tasks.get(was), new.tasks.get(is)) else { continue };
        if a.key == b.key {
            continue;
        }
        for change in stage_changes(old, new, is.stage.as_str()) {
            if !why.contains(&change) {
                why.push(change);
            }
        }
        let is_read = |name: &&ItemId| b.reads.contains(*name);
        for gone in a.reads.iter().filter(|name| !is_read(name)) {
            why.push(format!("{is}: it no longer reads `{gone}`"));
        }
        for read in &b.reads {
            match a.reads.contains(read) {
                true if seen.insert((read, read)) => open.push((read, read)),
                true => {}
                false => why.push(format!("{is}: it reads `{read}` now")),
            }
        }
    }
    if why.is_empty() {
        let tools =
            if old.cosfly == new.cosfly { String::new() } else { format!(" ({} and {})", old.cosfly, new.cosfly) };
        why.push(format!("recipe and inputs are the same: cosfly{tools} or a plugin made other bytes"));
    }
    why
}

fn stage_changes(old: &Version, new: &Version, stage: &str) -> Vec<String> {
    match (old.definitions.get(stage), new.definitions.get(stage)) {
        (Some(a), Some(b)) => definition_difference(a, b).iter().map(|change| format!("{stage}: {change}")).collect(),
        _ => vec![],
    }
}

/// Changes of the stages that pack, by name: splits, tables and texts.
fn packing(old: &Version, new: &Version) -> Vec<String> {
    let packs = |stage: &&String| StageName::read(stage).recipe_name() == new.published_by;
    new.definitions.keys().filter(packs).flat_map(|stage| stage_changes(old, new, stage)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::version::{RecipeText, SCHEMA, Task, VersionFlight};
    use cosfly_fingerprint::Digest;
    use cosfly_stage::{Blobs, ItemName};
    use serde_json::json;

    fn version(name: &str, walkers: u32, weight: f64) -> Version {
        let settings = BTreeMap::from([("walkers".to_owned(), json!({"count": walkers}))]);
        let key = |text: String| Digest::of(text.as_bytes());
        let (mut tasks, mut flights) = (BTreeMap::new(), BTreeMap::new());
        for id in (0..walkers).map(|number| format!("p{number}")) {
            let name = |stage: &str| ItemId { stage: StageName::read(stage), item: ItemName::own(id.as_str()) };
            let (walk, expert, task) = (name("walkers"), name("expert"), name("dataset.logs"));
            tasks.insert(walk.clone(), Task { key: key(id.clone()), reads: vec![] });
            tasks.insert(task.clone(), Task { key: key(format!("{id} {weight}")), reads: vec![expert.clone()] });
            tasks.insert(expert, Task { key: key(format!("{id}{weight}")), reads: vec![walk] });
            flights
                .insert(id.clone(), VersionFlight { split: "train".into(), log: key(format!("{id}.{weight}")), task });
        }
        let definition = |kind: &str, parameters| json!({"kind": kind, "version": 1, "parameters": parameters});
        Version {
            schema: SCHEMA.into(),
            name: name.into(),
            dataset: "d".into(),
            dataset_version: "1.0.0".into(),
            cosfly: "0.1.0".into(),
            recipe: RecipeText { path: "r.toml".into(), text: String::new(), overrides: vec![], settings },
            sources: BTreeMap::new(),
            content: key(format!("{walkers} {weight}")),
            files: Blobs::default(),
            published_by: "dataset".into(),
            definitions: BTreeMap::from([
                ("expert".to_owned(), definition("plan", json!({"weights": {"visibility": weight}}))),
                ("dataset".to_owned(), definition("dataset", json!({"splits": {"seed": 0}}))),
            ]),
            tasks,
            flights,
            rejected: BTreeMap::new(),
        }
    }

    #[test]
    fn more_walkers_are_added_because_of_their_number_and_the_old_ones_stay() {
        let found = difference(&version("a", 2, 1.0), &version("b", 3, 1.0));
        assert_eq!((found.same, found.bump()), (2, Bump::Minor));
        let (fate, why) = &found.flights["p2"];
        assert_eq!((*fate, why[0].as_str()), (Fate::Added, "walkers: `count` is 2 in `a` and 3 in `b`"));
    }

    #[test]
    fn what_changed_beside_the_number_is_no_cause_of_an_added_flight() {
        let (old, mut new) = (version("a", 2, 1.0), version("b", 3, 5.0));
        new.recipe.settings.insert("dataset".into(), json!({"version": "1.1.0"}));
        new.recipe.settings.insert("expert".into(), json!({"weights": {"visibility": 5.0}}));
        new.recipe.settings.get_mut("walkers").unwrap()["speed_mps"] = json!(2.0);
        let mut old = old;
        for version in [&mut old, &mut new] {
            version.recipe.settings.entry("dataset".into()).or_insert(json!({}));
            version
                .definitions
                .insert("walkers".into(), json!({"kind": "pedestrians", "parameters": {"speed_mps": 1.3}}));
        }
        for (from, to) in [(&old, &new), (&new, &old)] {
            let (_, why) = &difference(from, to).flights["p2"];
            assert_eq!(why.len(), 1, "{why:?}");
            assert!(why[0].contains("walkers: `count` is") && !why[0].contains("version"), "{why:?}");
        }
    }

    #[test]
    fn values_that_a_recipe_leaves_out_are_told_as_they_are_in_force() {
        let (mut old, mut new) = (version("a", 2, 1.0), version("b", 3, 1.0));
        old.recipe.settings.insert("walkers".into(), json!({}));
        for (version, count) in [(&mut old, 2), (&mut new, 3)] {
            version.definitions.insert("walkers".into(), json!({"kind": "tracks", "parameters": {"count": count}}));
        }
        assert_eq!(difference(&old, &new).flights["p2"].1, ["walkers: `count` is 2 in `a` and 3 in `b`"]);
        old.definitions.get_mut("expert").unwrap()["parameters"] = json!({"limits": {"yaw_rate_deg_s": null}});
        new.definitions.get_mut("expert").unwrap()["parameters"] = json!({"limits": {"yaw_rate_deg_s": 7.5}});
        new.flights.get_mut("p0").unwrap().log = Digest::of(b"other");
        let task = ItemId { stage: StageName::read("expert"), item: ItemName::own("p0") };
        new.tasks.get_mut(&task).unwrap().key = Digest::of(b"other");
        let logs = ItemId { stage: StageName::read("dataset.logs"), item: ItemName::own("p0") };
        new.tasks.get_mut(&logs).unwrap().key = Digest::of(b"other log");
        let why = difference(&old, &new).flights["p0"].1.join("; ");
        assert!(why.contains("from its default to `7.5`") && !why.contains("null"), "{why}");
    }

    #[test]
    fn a_changed_weight_is_the_reason_of_all_changed_flights() {
        let found = difference(&version("a", 2, 1.0), &version("b", 2, 5.0));
        assert_eq!(found.bump(), Bump::Major);
        let why = &found.flights["p0"].1;
        assert_eq!(why, &["expert: `weights.visibility` changed from `1.0` to `5.0`"]);
    }

    #[test]
    fn moved_dropped_and_unexplained_flights_say_so() {
        let old = version("a", 2, 1.0);
        let mut new = version("b", 2, 1.0);
        new.definitions.get_mut("dataset").unwrap()["parameters"]["splits"]["seed"] = json!(7);
        new.flights.get_mut("p0").unwrap().split = "test".into();
        new.flights.get_mut("p1").unwrap().log = Digest::of(b"other");
        let found = difference(&old, &new);
        assert_eq!(found.flights["p0"].0, Fate::Moved);
        assert!(found.flights["p0"].1[1].contains("`splits.seed` changed from `0` to `7`"), "{found:?}");
        assert!(found.flights["p1"].1[0].contains("recipe and inputs are the same"), "{found:?}");
        new.flights.remove("p0");
        new.rejected.insert("p0".into(), "too near".into());
        let dropped = difference(&old, &new);
        assert_eq!(dropped.flights["p0"].0, Fate::Dropped);
        assert!(dropped.flights["p0"].1[0].contains("rejected in `b`: too near"));
        assert_eq!(difference(&old, &old), Difference { same: 2, ..Difference::default() });
    }

    #[test]
    fn numbers_of_versions_keep_the_rules() {
        for (bump, old, new, kept) in [
            (Bump::Patch, "1.0.0", "1.0.1", true),
            (Bump::Patch, "1.0.0", "1.0.0", false),
            (Bump::Minor, "1.0.9", "1.1.0", true),
            (Bump::Minor, "1.0.0", "1.0.1", false),
            (Bump::Major, "1.9.9", "2.0.0", true),
            (Bump::Major, "1.0.0", "1.1.0", false),
            (Bump::None, "1.0.0", "1.0.0", true),
        ] {
            assert_eq!(bump.is_kept(old, new), kept, "{bump:?} {old} {new}");
        }
    }
}
