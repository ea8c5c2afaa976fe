//! Splits: nothing that a model meets in training is met again in its test.

use super::report::VerifyReport;
use super::tables::SmallTables;
use cosfly_splits as splits;
use cosfly_splits::{facts_of_dataset, promise};
use std::path::Path;

/// Lints the splits by what `splits.json` promises.
pub fn check(folder: &Path, tables: &SmallTables, report: &mut VerifyReport) {
    let promise = match promise::Promise::of_dataset(folder) {
        Ok(promise) => promise,
        Err(message) => return report.find(promise::FILE, "", "verify-schema", message),
    };
    // Tables that cannot be read were found before.
    let Ok(facts) = facts_of_dataset(folder, 0, promise.windows.shape().size()) else { return };
    let leaks = splits::lint(&facts, &promise.rules());
    for leak in &leaks.kept {
        let place = tables.flights.get(&leak.trajectory_id).map(|flight| &flight.place);
        let (file, row) = place.map_or(("data/trajectories", 0), |(file, row)| (file, *row));
        report.find(file, format!("row {row}, `{}`", leak.trajectory_id), leak.rule, leak.message.clone());
    }
    for it in &facts {
        let Some(promised) = promise.splits.towns.get(&it.town).filter(|split| split.name() != it.split) else {
            continue;
        };
        let place = tables.flights.get(&it.trajectory_id).map(|flight| &flight.place);
        let (file, row) = place.map_or(("data/trajectories", 0), |(file, row)| (file, *row));
        let message = format!("it is in `{}`; `splits.json` promises `{}` for its town", it.split, promised.name());
        report.find(file, format!("row {row}, `{}`", it.trajectory_id), "split-town", message);
    }
    report.found += (leaks.found - leaks.kept.len()) as u64;
}
