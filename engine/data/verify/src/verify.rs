//! All checks of a dataset, in order.

use crate::files::CheckedFiles;
use crate::flights::Flights;
use crate::options::{Options, Wanted};
use crate::report::VerifyReport;
use crate::resume::ResumeFile;
use crate::tables::SmallTables;
use crate::{clouds, croissant, extras, files, mesh, sensed, splits, tables, waypoints, windows};
use cosfly_diagnose::{Diagnostic, Fault, Result, absent};
use std::path::Path;
use std::sync::mpsc;

/// Checks the dataset in `folder`. `progress` hears how many of all flights are done. An error means that the
/// folder could not be read or holds no dataset, or that the check was stopped; everything else is a finding.
pub fn verify(folder: &Path, options: &Options, progress: &mut dyn FnMut(u64, u64)) -> Result<VerifyReport> {
    if let Some(problem) = folder_problem(folder) {
        let message = format!("`{}` {problem}", folder.display());
        return Err(Diagnostic::new("verify-no-dataset", Fault::Input, message)
            .hint("give the folder that `cosfly run --out` wrote"));
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(options.jobs.unwrap_or(0)).build().map_err(|error| {
        Diagnostic::new("verify-threads", Fault::Machine, "the threads cannot be started").because(error)
    })?;
    let (sender, heard) = mpsc::channel();
    std::thread::scope(|scope| {
        let work = scope.spawn(move || {
            pool.install(|| {
                // Nobody hears it any more where `progress` gave up.
                let done = |done, all| {
                    let _ = sender.send((done, all));
                };
                let report = check(folder, options, &done);
                options.stop.check("verify")?;
                report
            })
        });
        let mut most = 0;
        for (done, all) in heard {
            most = done.max(most);
            progress(most, all);
        }
        work.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}

fn check(folder: &Path, options: &Options, progress: &(dyn Fn(u64, u64) + Sync)) -> Result<VerifyReport> {
    let mut report = VerifyReport::default();
    let files = files::check(folder, &options.stop, &mut report)?;
    // The lint of the splits runs on one thread; the other threads do everything else meanwhile.
    let (leaks, rest) = rayon::join(
        || splits::lint(folder, &options.stop),
        || -> Result<_> {
            let tables = tables::read(folder, &files, &mut report);
            let mut of_flights = VerifyReport::default();
            check_flights(folder, options, &files, &tables, &mut of_flights, progress)?;
            Ok((tables, of_flights))
        },
    );
    let (tables, of_flights) = rest?;
    report.flights_of_dataset = tables.flights.len() as u64;
    splits::check(&tables, leaks, &mut report);
    report.absorb(of_flights);
    Ok(report)
}

/// Checks everything but files, small tables and splits.
fn check_flights(
    folder: &Path,
    options: &Options,
    files: &CheckedFiles,
    tables: &SmallTables,
    report: &mut VerifyReport,
    progress: &(dyn Fn(u64, u64) + Sync),
) -> Result<()> {
    let wanted = Wanted::of(&tables.flights, options.sample);
    let resume = options.resume.as_deref().map(|path| ResumeFile::open(path, folder, files)).transpose()?;
    croissant::check(folder, files, report)?;
    extras::check(folder, files, tables, report);
    let flights = Flights::new(folder, files, tables, &wanted, resume, report);
    windows::check(&flights, report);
    sensed::check(&flights, report);
    clouds::check(&flights, report);
    let motions = flights.check_all(report, progress)?;
    waypoints::check(&flights, &motions, report);
    mesh::check(&flights, options.mesh.as_deref(), report)?;
    Ok(())
}

/// Why nothing in `folder` can be checked, if so. One part of a dataset is enough: missing others are findings.
fn folder_problem(folder: &Path) -> Option<String> {
    let has = |name: &&str| std::fs::symlink_metadata(folder.join(name)).is_ok();
    absent(folder).or_else(|| {
        let is_dataset = ["files.parquet", "croissant.json", "SHA256SUMS"].iter().any(has);
        match (folder.is_dir(), is_dataset) {
            (false, _) => Some("is not a folder".to_owned()),
            (true, false) => Some("is not a finished dataset: it has no `files.parquet`".to_owned()),
            (true, true) => None,
        }
    })
}
