//! Resources of tasks, for engines that place them. They decide where and when a task runs, never its result.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_recipe::{Recipe, RecipeStage};
use cosfly_stage::Resources;

const MOST_CPUS: u64 = 1024;
const MOST_BATCH: u64 = 10_000;
/// Commands of a stage below which its tasks do not share commands by themselves, so that all workers have work.
const LEAST_LEAVES: usize = 64;

/// Resources of each task of a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Request {
    /// Processors, which are also the threads of a task.
    pub cpus: u32,
    /// Memory, MiB; 0 where none is asked for.
    pub memory_mib: u64,
    /// GPUs.
    pub gpus: u32,
    /// Time that a worker must have left, seconds; 0 where none is asked for.
    pub seconds: u64,
    /// Tasks of one command: cheap tasks share the start of a process and the syncs of the disk.
    pub batch: u32,
}

impl Default for Request {
    fn default() -> Self {
        Self { cpus: 1, memory_mib: 0, gpus: 0, seconds: 0, batch: 1 }
    }
}

/// A change of the requests of one stage, or of all (`*`), such as `frames:cpus=4,memory=8GB,time=2h,gpus=1,batch=2`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RequestChange {
    stage: String,
    values: Vec<(Key, u64)>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Key {
    Cpus,
    Memory,
    Gpus,
    Time,
    Batch,
}

impl RequestChange {
    /// Reads a change.
    ///
    /// # Errors
    /// `request-malformed`.
    pub fn read(text: &str) -> Result<Self> {
        let malformed = |what: String| {
            Diagnostic::new("request-malformed", Fault::Recipe, format!("the request `{text}`: {what}")).hint(
                "write a stage, or `*` for all, and some of `cpus=4`, `memory=8GB`, `gpus=1`, `time=2h`, `batch=10`",
            )
        };
        let Some((stage, values)) = text.split_once(':').filter(|(stage, _)| !stage.is_empty()) else {
            return Err(malformed("there is no stage before a `:`".to_owned()));
        };
        let read = |pair: &str| {
            let (key, value) = pair.split_once('=').ok_or_else(|| malformed(format!("`{pair}` has no `=`")))?;
            let (key, number) = match key.trim() {
                "cpus" => (Key::Cpus, whole(value, 1, MOST_CPUS)),
                "memory" => (Key::Memory, with_unit(value, &[("MB", 1), ("GB", 1024)])),
                "gpus" => (Key::Gpus, whole(value, 0, MOST_CPUS)),
                "time" => (Key::Time, with_unit(value, &[("s", 1), ("m", 60), ("h", 3600)])),
                "batch" => (Key::Batch, whole(value, 1, MOST_BATCH)),
                other => return Err(malformed(format!("`{other}` is not a resource"))),
            };
            Ok((key, number.ok_or_else(|| malformed(format!("`{value}` is not an amount of it")))?))
        };
        Ok(Self { stage: stage.trim().to_owned(), values: values.split(',').map(read).collect::<Result<_>>()? })
    }

    fn apply(&self, request: &mut Request) {
        for (key, value) in &self.values {
            let small = u32::try_from(*value).unwrap_or(u32::MAX);
            match key {
                Key::Cpus => request.cpus = small,
                Key::Memory => request.memory_mib = *value,
                Key::Gpus => request.gpus = small,
                Key::Time => request.seconds = *value,
                Key::Batch => request.batch = small,
            }
        }
    }
}

fn whole(text: &str, least: u64, most: u64) -> Option<u64> {
    text.trim().parse().ok().filter(|number| (least..=most).contains(number))
}

/// A whole number with one of the units, or 0.
fn with_unit(text: &str, units: &[(&str, u64)]) -> Option<u64> {
    let text = text.trim();
    if text == "0" {
        return Some(0);
    }
    let (number, factor) = units.iter().find_map(|(unit, factor)| Some((text.strip_suffix(unit)?, factor)))?;
    number.trim().parse::<u64>().ok()?.checked_mul(*factor)
}

/// Requests of all stages of a recipe, in its order: what the stages declare, with the changes in the order given.
///
/// # Errors
/// `request-unknown-stage`.
pub fn requests_of(recipe: &Recipe, changes: &[RequestChange]) -> Result<Vec<Request>> {
    let of_stage = |stage: &RecipeStage| {
        let Resources { memory_mib, batch } = stage.stage.properties().resources;
        let most = u32::try_from(stage.items.len() / LEAST_LEAVES).unwrap_or(u32::MAX).max(1);
        Request { memory_mib, batch: batch.min(most), ..Request::default() }
    };
    let mut requests: Vec<Request> = recipe.stages.iter().map(of_stage).collect();
    for change in changes {
        let mut is_known = false;
        for (stage, request) in recipe.stages.iter().zip(&mut requests) {
            if change.stage == "*" || stage.name == *change.stage {
                change.apply(request);
                is_known = true;
            }
        }
        if !is_known {
            let names: Vec<_> = recipe.stages.iter().map(|stage| format!("`{}`", stage.name)).collect();
            let message = format!("a request names the stage `{}`, which the recipe does not have", change.stage);
            return Err(Diagnostic::new("request-unknown-stage", Fault::Recipe, message)
                .hint(format!("its stages are {}; `*` means all", names.join(", "))));
        }
    }
    Ok(requests)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_sets_what_it_names() {
        let mut request = Request { batch: 7, ..Request::default() };
        RequestChange::read("frames:cpus=4, memory=8GB,time=90m,gpus=1").unwrap().apply(&mut request);
        assert_eq!(request, Request { cpus: 4, memory_mib: 8192, gpus: 1, seconds: 5400, batch: 7 });
    }

    #[test]
    fn a_malformed_change_is_refused_with_what_is_allowed() {
        let texts = ["", "cpus=1", ":cpus=1", "a:", "a:cpus", "a:cpus=0", "a:cpus=2000", "a:memory=8", "a:time=-1s"];
        for text in texts.into_iter().chain(["a:ram=1GB", "a:memory=99999999999999999GB", "a:batch=x", "a:gpus=1,"]) {
            let refusal = RequestChange::read(text).unwrap_err();
            assert_eq!((refusal.code, refusal.hints.len()), ("request-malformed", 1), "{text}");
        }
    }
}
