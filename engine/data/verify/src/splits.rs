//! Splits: nothing that a model meets in training is met again in its test.

use super::report::VerifyReport;
use super::tables::SmallTables;
use cosfly_splits as splits;
use cosfly_splits::{facts_of_dataset, policy};
use std::path::Path;

/// Lints the splits by what `splits.json` promises.
pub fn check(folder: &Path, tables: &SmallTables, report: &mut VerifyReport) {
    let policy = match policy::SplitPolicy::of_dataset(folder) {
        Ok(policy) => policy,
        Err(message) => return report.find(policy::FILE, "", "verify-schema", message),
    };
    // Tables that cannot be read were found before.
    let Ok(facts) = facts_of_dataset(folder, 0, 0) else { return };
    let mut leaks = splits::lint(&facts, &policy.rules());
    if leaks.of_windows(&facts, &[folder], policy.windows.shape().size()).is_err() {
        return;
    }
    leaks.of_areas(&facts, &policy.splits);
    for leak in &leaks.kept {
        let place = tables.flights.get(&leak.trajectory_id).map(|flight| &flight.place);
        let (file, row) = place.map_or(("data/trajectories", 0), |(file, row)| (&**file, *row));
        report.find(file, format!("row {row}, `{}`", leak.trajectory_id), leak.rule, leak.message.clone());
    }
    for it in &facts {
        let Some(assigned) = policy.splits.towns.get(&it.town).filter(|split| split.name() != it.split) else {
            continue;
        };
        let place = tables.flights.get(&it.trajectory_id).map(|flight| &flight.place);
        let (file, row) = place.map_or(("data/trajectories", 0), |(file, row)| (&**file, *row));
        let message = format!("it is in `{}`; `splits.json` promises `{}` for its town", it.split, assigned.name());
        report.find(file, format!("row {row}, `{}`", it.trajectory_id), "split-town", message);
    }
    report.found += (leaks.found - leaks.kept.len()) as u64;
}
