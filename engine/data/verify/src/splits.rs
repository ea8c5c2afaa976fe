//! Splits: nothing that a model meets in training is met again in its test.

use super::report::VerifyReport;
use super::tables::SmallTables;
use cosfly_diagnose::Stop;
use cosfly_splits as splits;
use cosfly_splits::{facts_of_dataset, policy};
use std::path::Path;

/// Findings of the lint of the splits; `Err` where `splits.json` cannot be read, `None` where the tables cannot.
pub type Linted = Result<Option<Leaky>, String>;

/// Leaks, and flights in another split than `splits.json` promises for their town.
pub struct Leaky {
    leaks: splits::Leaks,
    misplaced: Vec<(String, String)>,
}

/// Lints the splits by what `splits.json` promises.
pub fn lint(folder: &Path, stop: &Stop) -> Linted {
    let policy = policy::SplitPolicy::of_dataset(folder)?;
    // Tables that cannot be read are found elsewhere.
    let Ok(facts) = facts_of_dataset(folder, 0, 0, stop) else { return Ok(None) };
    let mut leaks = splits::lint(&facts, &policy.rules());
    if leaks.of_windows(&facts, &[folder], policy.windows.shape().size(), stop).is_err() {
        return Ok(None);
    }
    leaks.of_areas(&facts, &policy.splits);
    let mut misplaced = vec![];
    for it in facts {
        if let Some(assigned) = policy.splits.towns.get(&it.town).filter(|split| split.name() != it.split) {
            let promised = assigned.name();
            let message = format!("it is in `{}`; `splits.json` promises `{promised}` for its town", it.split);
            misplaced.push((it.trajectory_id, message));
        }
    }
    Ok(Some(Leaky { leaks, misplaced }))
}

/// Reports what the lint found, each finding at the row of its flight.
pub fn check(tables: &SmallTables, linted: Linted, report: &mut VerifyReport) {
    let Leaky { leaks, misplaced } = match linted {
        Err(message) => return report.find(policy::FILE, "", "verify-schema", message),
        Ok(None) => return,
        Ok(Some(leaky)) => leaky,
    };
    let mut find = |id: &str, rule, message| {
        let place = tables.flights.get(id).map(|flight| &flight.place);
        let (file, row) = place.map_or(("data/trajectories", 0), |(file, row)| (&**file, *row));
        report.find(file, format!("row {row}, `{id}`"), rule, message);
    };
    leaks.kept.iter().for_each(|leak| find(&leak.trajectory_id, leak.rule, leak.message.clone()));
    misplaced.into_iter().for_each(|(id, message)| find(&id, "split-town", message));
    report.found += (leaks.found - leaks.kept.len()) as u64;
}
