//! `cosfly run --on ...`: the tasks on other machines, the result here.

use crate::arguments::ClusterArguments;
use crate::command::Outcome;
use crate::console::Console;
use crate::exit;
use cosfly_cluster::{ClusterOutcome, Command, Driver, Hq, json_lines, kept_stages, leaves};
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_recipe::Recipe;
use cosfly_runner::{Delivery, RunOptions, RunOutcome, plan_elsewhere};
use cosfly_stage::RunEvent;
use cosfly_store::Store;
use std::path::Path;

/// Prints the commands of everything that is left to do, as JSON lines; their documents are in the store then.
pub fn emit(
    recipe: &Recipe,
    store: &Store,
    wanted: usize,
    asked: Option<usize>,
    arguments: &ClusterArguments,
    console: &dyn Console,
) -> Outcome {
    let requests = arguments.requests(recipe)?;
    let command = command(store, arguments)?;
    let plan = plan_elsewhere(recipe, store, asked)?;
    let leaves = leaves(&plan, &kept_stages(&plan, wanted), |_| false, &requests);
    plan.publish_documents(store)?;
    console.print(&json_lines(&leaves, &command))?;
    console.tell(&format!(
        "{} to run, in any order that their `deps` allow; then `cosfly run` with the same recipe and store makes the rest",
        crate::text::count(leaves.len() as u64, "command"),
    ));
    Ok(exit::SUCCESS)
}

/// Runs on HyperQueue everything before the stage `wanted`, and then delivers that stage from here.
pub fn deliver(
    recipe: &Recipe,
    store: &Store,
    wanted: usize,
    out: &Path,
    options: RunOptions,
    arguments: &ClusterArguments,
    (report, console): (&(dyn Fn(RunEvent) + Sync), &dyn Console),
) -> Result<Delivery> {
    let requests = arguments.requests(recipe)?;
    let command = command(store, arguments)?;
    let hq = Hq::connect()?;
    // A server that goes away here is asked again by the driver.
    if hq.workers().is_ok_and(|workers| workers == 0) {
        console.tell("note: no worker is connected to the server of HyperQueue; the run waits for one");
    }
    let driver =
        Driver { recipe, store, wanted, asked: options.asked, command, requests, cancelled: options.cancelled.clone() };
    let ClusterOutcome { failed, divergences } = driver.run(&hq, report)?;
    // What was reported already is not reported again.
    let rest = |event: RunEvent| match event {
        RunEvent::Planned { .. } | RunEvent::Stopping => {}
        RunEvent::Failed { diagnostic, .. } if failed.values().any(|it| *it == diagnostic) => {}
        event => report(event),
    };
    let options = RunOptions { failed_elsewhere: failed.clone(), ..options };
    let mut delivery = cosfly_runner::deliver(recipe, store, wanted, out, &options, &rest)?;
    if !divergences.is_empty() && delivery.summary.outcome == RunOutcome::Complete {
        delivery.summary.outcome = RunOutcome::Failed;
    }
    delivery.summary.diagnostics.extend(divergences);
    Ok(delivery)
}

fn command(store: &Store, arguments: &ClusterArguments) -> Result<Command> {
    let refused = |error: std::io::Error| Diagnostic::io("find the place of the store or of cosfly", &error);
    let store = match store.remote_place() {
        Some(place) => place.to_owned(),
        None => std::path::absolute(store.root()).map_err(refused)?.to_string_lossy().into_owned(),
    };
    let program = match &arguments.leaf {
        Some(leaf) => leaf.split_whitespace().map(str::to_owned).collect(),
        None => this_program().map_err(refused)?,
    };
    Ok(Command { program, store })
}

/// Words that start this program: the Python package has no program of its own.
pub fn this_program() -> std::io::Result<Vec<String>> {
    let path = std::env::current_exe()?;
    let is_python = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("python"));
    let module: &[&str] = if is_python { &["-m", "cosfly"] } else { &[] };
    let words = std::iter::once(path.to_string_lossy().into_owned());
    Ok(words.chain(module.iter().map(|word| (*word).to_owned())).collect())
}

impl ClusterArguments {
    /// Requests of the recipe's stages.
    fn requests(&self, recipe: &Recipe) -> Result<Vec<cosfly_cluster::Request>> {
        let changes = self.request.iter().map(|text| cosfly_cluster::RequestChange::read(text));
        cosfly_cluster::requests_of(recipe, &changes.collect::<Result<Vec<_>>>()?)
    }
}
