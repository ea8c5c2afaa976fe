//! All episodes of a suite, flown by one policy on several threads; episodes that are in the folder are kept.

use crate::crew::{EpisodeOutcome, Shifts, crew};
use crate::flight::{Attempt, FlownEpisode, Latency, Row, fly};
use crate::pictures::{self, Case};
use crate::pilot::{Asked, FirstAnswer, Manners, Place};
use crate::results::{Card, Folder, LogChoice, worst};
use crate::suite::{EpisodeTask, Suite};
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_env::EnvironmentSettings;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// A share of the episodes: those whose number leaves `index` when divided by `of`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EpisodeShare {
    /// Number of the share, from 0 on.
    pub index: usize,
    /// Number of shares.
    pub of: usize,
}

impl EpisodeShare {
    /// All episodes.
    pub const WHOLE: Self = Self { index: 0, of: 1 };
}

/// Order to fly a suite: episodes, policy and settings.
pub struct Order<'a> {
    /// Episodes.
    pub suite: &'a Suite,
    /// The policy.
    pub place: &'a Place,
    /// How it is asked.
    pub manners: &'a Manners,
    /// Settings of the environment, for each part of the suite.
    pub settings: &'a [EnvironmentSettings],
    /// Time that the policy takes for an action.
    pub latency: Latency,
    /// Episodes to fly.
    pub shard: EpisodeShare,
    /// Threads.
    pub jobs: usize,
    /// Set from anywhere to stop.
    pub cancelled: &'a AtomicBool,
}

/// Outcome of an order.
#[derive(Debug, Default)]
pub struct Outcome {
    /// Rows of all episodes that the folder has now, in the order of the suite.
    pub rows: Vec<Row>,
    /// Episodes flown by this call.
    pub flown: usize,
    /// Whether every episode of the suite has a row.
    pub whole: bool,
    /// Why episodes of this call were not flown: the policy could not be had, or is not set up.
    pub gone: Option<Box<Diagnostic>>,
}

/// Flies what the folder lacks. `progress` gets the numbers of finished and of all episodes. The tables are written once every
/// episode has a row.
///
/// # Errors
/// Errors of the file system; `fly-stopped`.
pub fn run(order: &Order<'_>, card: &Card, folder: &Folder, progress: &dyn Fn(u64, u64)) -> Result<Outcome> {
    let tasks = &order.suite.tasks;
    let due: Vec<usize> = (0..tasks.len())
        .filter(|at| at % order.shard.of == order.shard.index && folder.row(&tasks[*at].episode.name).is_none())
        .collect();
    let (first, all) = (FirstAnswer::default(), due.len());
    let shifts = Shifts { jobs: order.jobs, cancelled: order.cancelled, first: &first };
    let pilot = || Ok(Asked::new(order.place, order.manners, &first));
    let crewed = crew(due, &shifts, progress, pilot, |pilot, at| {
        Ok(match fly(&tasks[at], order.settings[tasks[at].part], order.latency, pilot) {
            Attempt::Flown(flown) => {
                keep(order, card, folder, &tasks[at], &flown)?;
                EpisodeOutcome::Kept
            }
            Attempt::Unanswered(reason) => EpisodeOutcome::Unanswered(reason),
            Attempt::Gone(reason) => EpisodeOutcome::Gone(reason),
        })
    })?;
    let rows: Vec<Row> = tasks.iter().filter_map(|EpisodeTask { episode, .. }| folder.row(&episode.name)).collect();
    let whole = rows.len() == tasks.len();
    if whole {
        finish(order, card, folder, &rows)?;
    }
    let gone = crewed.gone.map(|reason| first.refusal(&card.policy.name, &reason, all - crewed.kept));
    Ok(Outcome { rows, flown: crewed.kept, whole, gone })
}

/// Keeps an episode with the logs that the card asks for.
fn keep(order: &Order<'_>, card: &Card, folder: &Folder, task: &EpisodeTask, flown: &FlownEpisode) -> Result<()> {
    let is_logged = card.kept.logs != LogChoice::None;
    let mcap = is_logged.then(|| pictures::mcap(task, &order.settings[task.part], flown)).transpose()?;
    folder.keep(flown, mcap.as_deref())
}

/// Makes the clips of the worst episodes, the tables and the page, and removes logs that the card does not ask for.
fn finish(order: &Order<'_>, card: &Card, folder: &Folder, rows: &[Row]) -> Result<()> {
    let worst = worst(rows, card.kept.clips as usize);
    let cases: Vec<OnceLock<Result<Case<'_>>>> = worst.iter().map(|_| OnceLock::new()).collect();
    let next = AtomicUsize::new(0);
    let work = || {
        while let Some((row, slot)) = worst.iter().zip(&cases).nth(next.fetch_add(1, Ordering::Relaxed)) {
            slot.get_or_init(|| case(order, folder, row));
        }
    };
    std::thread::scope(|scope| (0..order.jobs.clamp(1, worst.len().max(1))).for_each(|_| _ = scope.spawn(work)));
    let cases = cases.into_iter().filter_map(OnceLock::into_inner).collect::<Result<Vec<_>>>()?;
    if card.kept.logs == LogChoice::Worst {
        let others = rows.iter().filter(|row| worst.iter().all(|kept| kept.episode != row.episode));
        others.for_each(|row| folder.forget(&format!("logs/{}.mcap", row.episode)));
    }
    folder.finish(card, rows, &pictures::page(card, rows, &cases, card.kept.logs == LogChoice::All))
}

/// The steps of an episode, and its clip.
fn case<'a>(order: &Order<'_>, folder: &Folder, row: &'a Row) -> Result<Case<'a>> {
    let name = &row.episode;
    let steps = folder.steps(name)?;
    let mut has_clip = false;
    if let Some(task) = order.suite.tasks.iter().find(|task| task.episode.name == *name) {
        let settings = &order.settings[task.part];
        has_clip = folder.keep_once(&format!("clips/{name}.gif"), &|| pictures::clip(task, settings, &steps))?;
    }
    Ok(Case { row, steps, has_clip })
}
