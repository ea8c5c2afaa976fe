//! Tasks of earlier runs of a recipe, for `cosfly why` and as roots of garbage collection.

use crate::fault::PublishStep;
use crate::hex::{digest_of_hex, push_digest, push_quoted, unquoted};
use crate::layout::read_dir_or_nothing;
use crate::store::Store;
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_fingerprint::Digest;
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::Path;

/// Number of runs of a recipe that are kept.
const REMEMBERED: usize = 10;
const HEADER: &str = "cosfly-run 2 ";

/// Finished tasks of one run.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PastRun {
    /// Stages in the order of the recipe.
    pub stages: Vec<PastStage>,
}

/// Finished tasks of one stage of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PastStage {
    /// Name of the stage, as text.
    pub name: String,
    /// Digest of the stage's definition document.
    pub definition: Digest,
    /// Plan digests by the names of items, as text.
    pub items: BTreeMap<String, Digest>,
    /// Blobs of the items that nothing needs any more: everything that reads them is finished.
    pub spent: Vec<String>,
}

impl PastStage {
    /// A stage without finished items.
    pub fn new(name: String, definition: Digest) -> Self {
        Self { name, definition, items: BTreeMap::new(), spent: Vec::new() }
    }
}

impl PastRun {
    /// Stage called `name`.
    pub fn stage(&self, name: &str) -> Option<&PastStage> {
        self.stages.iter().find(|stage| stage.name == name)
    }

    fn encode(&self) -> String {
        let (mut body, start) = unsealed(HEADER);
        let mut line = |what: &str, digest: &Digest, name: &str| {
            body.push_str(what);
            push_digest(&mut body, digest);
            body.push(' ');
            push_quoted(&mut body, name);
            body.push('\n');
        };
        for stage in &self.stages {
            line("stage ", &stage.definition, &stage.name);
            stage.spent.iter().for_each(|blob| line("spent ", &stage.definition, blob));
            stage.items.iter().for_each(|(item, plan)| line("item ", plan, item));
        }
        seal(&mut body, start);
        body
    }

    /// Parses the file of a run; `None` where it is not exactly as written.
    pub(crate) fn decode(text: &str) -> Option<Self> {
        let (digest, body) = text.strip_prefix(HEADER)?.split_once('\n')?;
        if digest.parse::<Digest>().ok()? != Digest::of(body.as_bytes()) {
            return None;
        }
        let mut run = Self::default();
        for line in body.lines() {
            let mut words = line.splitn(3, ' ');
            let (what, digest, name) = (words.next()?, digest_of_hex(words.next()?)?, unquoted(words.next()?)?);
            match what {
                "stage" => run.stages.push(PastStage::new(name, digest)),
                "spent" => run.stages.last_mut()?.spent.push(name),
                _ => drop(run.stages.last_mut()?.items.insert(name, digest)),
            }
        }
        Some(run)
    }

    /// All plan and definition digests of the run.
    pub(crate) fn digests(&self) -> impl Iterator<Item = Digest> {
        self.stages.iter().flat_map(|stage| std::iter::once(stage.definition).chain(stage.items.values().copied()))
    }
}

impl Store {
    /// Kept runs of `recipe`, newest first, each read on demand. Damaged ones are skipped.
    pub fn past_runs(&self, recipe: &str) -> impl Iterator<Item = PastRun> {
        let folder = self.layout.folder("runs").join(recipe);
        let numbers = run_numbers(&folder).unwrap_or_default();
        numbers.into_iter().rev().filter_map(move |n| read_run(&folder.join(file_name(n))))
    }

    /// Records a run, unless it equals the newest one.
    pub fn record_run(&self, recipe: &str, run: &PastRun) -> Result<()> {
        let folder = self.layout.folder("runs").join(recipe);
        let failed = |error: io::Error| Diagnostic::io(format!("write `{}`", folder.display()), &error);
        let mut numbers = run_numbers(&folder).map_err(failed)?;
        let text = run.encode();
        // Machines do not know each other's numbers; garbage collection goes by the times of objects.
        self.upload(&folder.join(Digest::of(text.as_bytes()).to_string()), text.as_bytes())?;
        if numbers.last().is_some_and(|n| fs::read(folder.join(file_name(*n))).is_ok_and(|old| old == text.as_bytes()))
        {
            return Ok(());
        }
        let next = numbers.last().map_or(1, |n| n.saturating_add(1));
        self.write_file(&folder.join(file_name(next)), text.as_bytes(), PublishStep::WriteRun, PublishStep::RenameRun)?;
        numbers.push(next);
        for old in numbers.iter().rev().skip(REMEMBERED) {
            let _ = fs::remove_file(folder.join(file_name(*old)));
        }
        Ok(())
    }
}

/// A text that begins with `header` and room for the digest of what follows, which begins at the number given with it.
pub(crate) fn unsealed(header: &str) -> (String, usize) {
    let text = format!("{header}{}\n", Digest([0; 32]));
    let start = text.len();
    (text, start)
}

/// Writes the digest of everything from `start` on before it, in place: these texts are long.
pub(crate) fn seal(text: &mut String, start: usize) {
    let digest = Digest::of(&text.as_bytes()[start..]).to_string();
    text.replace_range(start - 1 - digest.len()..start - 1, &digest);
}

fn file_name(number: u64) -> String {
    format!("{number:08}")
}

/// Numbers of the runs in a folder, oldest first.
pub(crate) fn run_numbers(folder: &Path) -> io::Result<Vec<u64>> {
    let mut numbers = Vec::new();
    for entry in read_dir_or_nothing(folder)? {
        numbers.extend(entry?.file_name().to_str().and_then(|name| name.parse::<u64>().ok()));
    }
    numbers.sort_unstable();
    Ok(numbers)
}

/// Newest `count` runs in a folder.
pub(crate) fn newest_runs(folder: &Path, count: usize) -> io::Result<Vec<PastRun>> {
    let numbers = run_numbers(folder)?;
    Ok(numbers.into_iter().rev().filter_map(|n| read_run(&folder.join(file_name(n)))).take(count).collect())
}

pub(crate) fn read_run(path: &Path) -> Option<PastRun> {
    PastRun::decode(&fs::read_to_string(path).ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(seed: u64) -> PastRun {
        let items = (0..3).map(|n| (format!("p{n} \"x\"\n"), Digest::of(&[seed as u8, n])));
        let stage = PastStage {
            name: "walkers".to_owned(),
            definition: Digest::of(&seed.to_le_bytes()),
            items: items.collect(),
            spent: vec!["pack".to_owned()],
        };
        PastRun { stages: vec![stage] }
    }

    #[test]
    fn the_last_ten_different_runs_are_remembered_newest_first() {
        let root = tempfile::tempdir().unwrap();
        let store = Store::open(root.path()).unwrap();
        for seed in 0..14 {
            store.record_run("r", &run(seed)).unwrap();
            store.record_run("r", &run(seed)).unwrap();
        }
        let remembered: Vec<PastRun> = store.past_runs("r").collect();
        assert_eq!(remembered, (4..14).rev().map(run).collect::<Vec<_>>());
        assert_eq!(store.past_runs("other").count(), 0);
    }

    #[test]
    fn a_damaged_run_is_passed_over() {
        let text = run(1).encode();
        assert_eq!(PastRun::decode(&text), Some(run(1)));
        for cut in 0..text.len() {
            assert_eq!(PastRun::decode(&text[..cut]), None, "cut at {cut}");
        }
    }
}
