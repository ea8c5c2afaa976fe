//! [`Benchmark`]: a list of suites, and tiers that take episodes from them by one rule.
//!
//! The rule: the episodes of each stage of each suite are listed by kind of target, weather, and how well the expert's flight sees
//! the target (the best first). A tier takes as many as it says, evenly spaced along the list; all where there are fewer. So each
//! tier has the kinds, weathers and difficulties of its suites in their proportions.

use crate::suite::{EpisodeTask, Suite};
use cosfly_diagnose::{Diagnostic, Fault, Result, nearest_name};
use cosfly_domain::BodyKind;
use cosfly_fingerprint::Digest;
use serde_json::{Map, Value};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Keys of the file, sorted.
const KEYS: [&str; 4] = ["episodes", "name", "suites", "tiers"];
/// Keys of a suite that is a table, sorted.
const SUITE_KEYS: [&str; 2] = ["recipe", "set"];

/// Suites, and tiers that take episodes from them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Benchmark {
    /// Name, with the version.
    pub name: String,
    /// The suites.
    pub suites: Vec<Entry>,
    /// Tiers, by their names.
    pub tiers: BTreeMap<String, Tier>,
}

/// A suite of a benchmark: a recipe with changes as of `--set`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The recipe.
    pub recipe: PathBuf,
    /// Changes to it, `PATH=VALUE`.
    pub set: Vec<String>,
}

/// A tier of a benchmark.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tier {
    /// Name of the benchmark and of the tier.
    pub name: String,
    /// Most episodes of each stage of each suite.
    pub episodes: usize,
    /// Names of the only episodes that the benchmark has; `None`: all of its suites.
    pub only: Option<Arc<BTreeSet<String>>>,
}

impl Benchmark {
    /// Reads a file; `None` where it is no benchmark, such as a recipe.
    ///
    /// # Errors
    /// `fly-benchmark` for a benchmark that is not well formed.
    pub fn read(path: &Path) -> Result<Option<Self>> {
        // What cannot be read or is no TOML is told by the reader of recipes.
        let table = std::fs::read_to_string(path).ok().and_then(|text| cosfly_recipe::table(path, &text).ok());
        let Some(table) = table.filter(|table| table.contains_key("tiers")) else { return Ok(None) };
        let read = Self::of_table(&table, path.parent().unwrap_or(Path::new("")));
        read.map(Some).map_err(|rule| {
            let message = format!("`{}` is no benchmark: {rule}", path.display());
            Diagnostic::new("fly-benchmark", Fault::Recipe, message).hint(
                "it has `name`, `suites` (a list of recipes), `tiers` (a table: tier = episodes of each stage), and it may have `episodes` (a list of names)",
            )
        })
    }

    fn of_table(table: &Map<String, Value>, folder: &Path) -> std::result::Result<Self, String> {
        if let Some(unknown) = table.keys().find(|key| !KEYS.contains(&key.as_str())) {
            let near = nearest_name(unknown, KEYS).map_or(String::new(), |near| format!("; did you mean `{near}`?"));
            return Err(format!("`{unknown}` is no key of it{near}"));
        }
        let name = table.get("name").and_then(Value::as_str).ok_or("`name` must be a text")?;
        is_safe(name)?;
        let suites = table.get("suites").and_then(Value::as_array).ok_or("`suites` must be a list of files")?;
        let texts = |value: &Value| -> Option<Vec<String>> {
            value.as_array()?.iter().map(|text| text.as_str().map(str::to_owned)).collect()
        };
        let only = table.get("episodes").map(|names| texts(names).ok_or("`episodes` must be a list of names"));
        let only = only.transpose()?.map(|names| Arc::new(names.into_iter().collect()));
        let entry = |suite: &Value| -> std::result::Result<Entry, String> {
            if let Some(unknown) =
                suite.as_object().and_then(|it| it.keys().find(|it| !SUITE_KEYS.contains(&it.as_str())))
            {
                return Err(format!("`{unknown}` is no key of a suite: it has `recipe` and `set`"));
            }
            let recipe = suite.as_str().or_else(|| suite.get("recipe")?.as_str());
            let recipe = recipe.ok_or("`suites` must be files, or tables with a `recipe`")?;
            let set = suite.get("set").map_or(Some(vec![]), texts);
            Ok(Entry { recipe: folder.join(recipe), set: set.ok_or("`set` of a suite must be a list of changes")? })
        };
        let tiers = table.get("tiers").and_then(Value::as_object).ok_or("`tiers` must be a table")?;
        let tier = |(tier, episodes): (&String, &Value)| {
            is_safe(tier)?;
            let episodes = episodes.as_u64().filter(|episodes| *episodes > 0);
            let episodes = episodes.ok_or_else(|| format!("`tiers.{tier}` must be a whole number from 1 on"))?;
            Ok((tier.clone(), Tier { name: format!("{name}-{tier}"), episodes: episodes as usize, only: only.clone() }))
        };
        if suites.is_empty() || tiers.is_empty() {
            return Err("`suites` and `tiers` have one entry at least".to_owned());
        }
        if let Some(twice) = suites.iter().enumerate().find(|(at, suite)| suites[..*at].contains(suite)) {
            return Err(format!("`suites` has {} twice", twice.1));
        }
        Ok(Self {
            name: name.to_owned(),
            suites: suites.iter().map(entry).collect::<std::result::Result<_, _>>()?,
            tiers: tiers.iter().map(tier).collect::<std::result::Result<_, String>>()?,
        })
    }

    /// The tier of a name.
    ///
    /// # Errors
    /// `fly-benchmark`, with the names of all.
    pub fn tier(&self, name: Option<&str>) -> Result<&Tier> {
        if let Some(tier) = name.and_then(|name| self.tiers.get(name)) {
            return Ok(tier);
        }
        let message = match name {
            Some(name) => format!("`{}` has no tier `{name}`", self.name),
            None => format!("`{}` is a benchmark: a tier is missing", self.name),
        };
        let names: Vec<String> = self.tiers.keys().map(|name| format!("`--tier {name}`")).collect();
        Err(Diagnostic::new("fly-benchmark", Fault::Recipe, message).hint(format!("allowed are {}", names.join(", "))))
    }
}

/// Names are parts of names of folders.
fn is_safe(name: &str) -> std::result::Result<(), String> {
    let fits = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    match !name.is_empty() && name.chars().all(fits) {
        true => Ok(()),
        false => Err(format!("`{name}` is no name: letters, digits and `_` are allowed")),
    }
}

impl Tier {
    /// Refuses names of `episodes` that no suite has.
    ///
    /// # Errors
    /// `fly-benchmark`, with the names.
    pub fn check(&self, suites: &[Suite]) -> Result<()> {
        let of_suite = |suite: &Suite| -> Vec<String> {
            suite.tasks.iter().map(|task| format!("{}-{}", suite.name, task.episode.name)).collect()
        };
        let names: BTreeSet<String> = suites.iter().flat_map(of_suite).collect();
        let unknown: Vec<&str> =
            self.only.iter().flat_map(|only| only.difference(&names)).map(String::as_str).collect();
        if unknown.is_empty() {
            return Ok(());
        }
        let message = format!("no suite of `{}` has the episodes `{}`", self.name, unknown.join("`, `"));
        let refusal = Diagnostic::new("fly-benchmark", Fault::Recipe, message);
        Err(refusal
            .hint("a name is SUITE-EPISODE, such as `street-street-p00007`: correct it in `episodes`, or leave it out"))
    }

    /// The episodes that the tier takes from suites, as one suite.
    pub fn of(&self, suites: Vec<Suite>) -> Suite {
        let (mut tasks, mut parts, mut listed, mut rejected) = (vec![], vec![], String::new(), 0);
        for suite in suites {
            let several = suite.tasks.iter().map(|task| &task.episode.stratum).collect::<BTreeSet<_>>().len() > 1;
            let named = suite.tasks.into_iter().map(|task| named(task, &suite.name, several));
            let is_of_it = |task: &EpisodeTask| self.only.as_ref().is_none_or(|only| only.contains(&task.episode.name));
            let known: Vec<EpisodeTask> = named.filter(is_of_it).collect();
            let taken = taken(&known, self.episodes);
            for (_, task) in known.into_iter().enumerate().filter(|(at, _)| taken.contains(at)) {
                let task = EpisodeTask { part: parts.len(), ..task };
                let _ = writeln!(listed, "{} {}", task.episode.name, task.digest);
                tasks.push(task);
            }
            rejected += suite.rejected;
            parts.extend(suite.parts);
        }
        Suite { name: self.name.clone(), digest: Digest::of(listed.as_bytes()), parts, tasks, rejected }
    }
}

/// A task whose names begin with that of its suite.
fn named(mut task: EpisodeTask, suite: &str, several: bool) -> EpisodeTask {
    let episode = Arc::make_mut(&mut task.episode);
    episode.name = format!("{suite}-{}", episode.name);
    episode.stratum = if several { format!("{suite}/{}", episode.stratum) } else { suite.to_owned() };
    task
}

/// Places of the tasks that the rule takes, at most `most` of each stage.
fn taken(tasks: &[EpisodeTask], most: usize) -> BTreeSet<usize> {
    let mut stages: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (at, task) in tasks.iter().enumerate() {
        stages.entry(&task.episode.stratum).or_default().push(at);
    }
    let kind = |task: &EpisodeTask| task.episode.followed.as_ref().map_or(BodyKind::Pedestrian, |plan| plan.kind);
    let weather = |task: &EpisodeTask| task.episode.weather.as_ref().map(|weather| weather.name.clone());
    let mut taken = BTreeSet::new();
    for stage in stages.values_mut() {
        stage.sort_by(|a, b| {
            let (a, b) = (&tasks[*a], &tasks[*b]);
            let by_group = (kind(a), weather(a)).cmp(&(kind(b), weather(b)));
            let by_sight = b.certified_visibility.total_cmp(&a.certified_visibility);
            by_group.then(by_sight).then_with(|| a.episode.name.cmp(&b.episode.name))
        });
        let spaced = evenly(stage.len(), most);
        taken.extend(spaced.into_iter().map(|at| stage[at]));
    }
    taken
}

/// Places of at most `most` of `all` entries of a list: the middles of as many equal parts of it.
fn evenly(all: usize, most: usize) -> Vec<usize> {
    let count = most.min(all);
    (0..count).map(|part| (2 * part + 1) * all / (2 * count)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_are_taken_from_the_middles_of_equal_parts() {
        assert_eq!(evenly(12, 1), [6]);
        assert_eq!(evenly(12, 2), [3, 9]);
        assert_eq!(evenly(8, 3), [1, 4, 6]);
        assert_eq!(evenly(3, 5), [0, 1, 2]);
        assert!(evenly(0, 2).is_empty());
    }

    #[test]
    fn a_benchmark_is_read_and_what_is_wrong_is_told() {
        let folder = Path::new("recipes");
        let read = |text: &str| Benchmark::of_table(&cosfly_recipe::table(folder, text).expect("TOML"), folder);
        let good = read("name = \"track_1\"\nsuites = [\"a.toml\"]\ntiers = { mini = 2 }").expect("a benchmark");
        let first = Entry { recipe: "recipes/a.toml".into(), set: vec![] };
        assert_eq!((&good.suites[0], good.tiers["mini"].episodes), (&first, 2));
        let changed = "name = \"x\"\nepisodes = [\"b\"]\nsuites = [{ recipe = \"a.toml\", set = [\"seed=2\"] }]\ntiers = { all = 9 }";
        let changed = read(changed).expect("a benchmark");
        assert_eq!(changed.suites, [Entry { set: vec!["seed=2".to_owned()], ..first }]);
        assert!(changed.tiers["all"].only.as_ref().is_some_and(|only| only.contains("b")));
        assert_eq!(good.tier(Some("mini")).expect("a tier").name, "track_1-mini");
        assert!(good.tier(None).is_err() && good.tier(Some("maxi")).is_err());
        for (text, words) in [
            ("name = \"../x\"\nsuites = []\ntiers = {}", "is no name"),
            ("name = \"x\"\nsuites = [1]\ntiers = { mini = 1 }", "`suites` must be files"),
            ("name = \"x\"\nsuites = [\"a\"]\ntiers = { mini = 0 }", "`tiers.mini` must be a whole number"),
            ("name = \"x\"\nsuites = []\ntiers = { mini = 1 }", "one entry at least"),
            ("name = \"x\"\nsuites = [\"a\"]\ntiers = {}", "one entry at least"),
            ("name = \"x\"\nsuites = [\"a\", \"a\"]\ntiers = { mini = 1 }", "twice"),
            ("name = \"x\"\nsuite = []\ntiers = {}", "did you mean `suites`?"),
            (
                "name = \"x\"\nsuites = [{ recipe = \"a\", sets = [] }]\ntiers = { mini = 1 }",
                "`sets` is no key of a suite",
            ),
            ("name = \"x\"\nsuites = [{ recipe = \"a\", set = [1] }]\ntiers = { mini = 1 }", "`set` of a suite"),
            ("name = \"x\"\nepisodes = 3\nsuites = [\"a\"]\ntiers = { mini = 1 }", "`episodes` must be a list"),
        ] {
            let wrong = read(text).expect_err(text);
            assert!(wrong.contains(words), "{text}: {wrong}");
        }
    }
}
