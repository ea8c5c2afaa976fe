//! [`crew`]: the episodes of a suite on several threads, as `fly` and `dagger` fly them.

use crate::pilot::FirstAnswer;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Episodes in which a policy may fail before its first right answer; after them it counts as not set up.
const MOST_UNANSWERED: usize = 3;
/// Pause between two looks.
const PAUSE: Duration = Duration::from_millis(5);

/// Outcome of an episode.
pub enum EpisodeOutcome {
    /// The episode is kept.
    Kept,
    /// The policy has not answered since the command began; why.
    Unanswered(String),
    /// The policy cannot be had; why.
    Gone(String),
}

/// Outcome of all episodes.
#[derive(Debug, Default)]
pub struct Crewed {
    /// Episodes that are kept.
    pub kept: usize,
    /// Why episodes were not flown: the policy could not be had, or is not set up.
    pub gone: Option<String>,
}

/// How episodes are shared out.
pub struct Shifts<'a> {
    /// Threads.
    pub jobs: usize,
    /// Set from anywhere to stop.
    pub cancelled: &'a AtomicBool,
    /// Whether the policy has answered.
    pub first: &'a FirstAnswer,
}

/// Board that all threads read and write.
#[derive(Default)]
struct Board {
    due: VecDeque<usize>,
    /// Episodes in which the policy failed before its first right answer: flown again once it came.
    unanswered: Vec<usize>,
    gone: Option<String>,
    failed: Option<Box<Diagnostic>>,
}

/// Has each due episode flown once. `worker` makes what a thread needs, `one` flies an episode with it. Until the policy's first
/// right answer one thread flies alone, so that the outcome does not depend on threads.
///
/// # Errors
/// Those of `worker` and `one`; `fly-stopped`.
pub fn crew<W>(
    due: Vec<usize>,
    shifts: &Shifts<'_>,
    progress: &dyn Fn(u64, u64),
    worker: impl Fn() -> Result<W> + Sync,
    one: impl Fn(&mut W, usize) -> Result<EpisodeOutcome> + Sync,
) -> Result<Crewed> {
    let all = due.len();
    let board = Mutex::new(Board { due: due.into(), ..Board::default() });
    let (kept, stop) = (AtomicUsize::new(0), AtomicBool::new(false));
    let is_over = || stop.load(Ordering::Relaxed) || shifts.cancelled.load(Ordering::Relaxed);
    let work = |number: usize| -> Result<()> {
        while number > 0 && !shifts.first.came() {
            if is_over() || lock(&board).due.is_empty() {
                return Ok(());
            }
            std::thread::sleep(PAUSE);
        }
        let mut own = worker()?;
        while !is_over() {
            let Some(episode) = next(&mut lock(&board), shifts.first) else { break };
            match one(&mut own, episode)? {
                EpisodeOutcome::Kept => _ = kept.fetch_add(1, Ordering::Relaxed),
                EpisodeOutcome::Unanswered(reason) => {
                    let mut board = lock(&board);
                    board.unanswered.push(episode);
                    if board.unanswered.len() == MOST_UNANSWERED || board.due.is_empty() {
                        stop.store(true, Ordering::Relaxed);
                        board.gone = Some(reason);
                    }
                }
                // Others would wait for the policy as long, one by one.
                EpisodeOutcome::Gone(reason) => {
                    stop.store(true, Ordering::Relaxed);
                    lock(&board).gone.get_or_insert(reason);
                }
            }
        }
        Ok(())
    };
    let work = |number: usize| {
        let _panics = StopsOthers(&stop);
        if let Err(error) = work(number) {
            stop.store(true, Ordering::Relaxed);
            lock(&board).failed.get_or_insert(error);
        }
    };
    std::thread::scope(|scope| {
        let work = &work;
        let workers: Vec<_> = (0..shifts.jobs.clamp(1, all.max(1))).map(|it| scope.spawn(move || work(it))).collect();
        while workers.iter().any(|worker| !worker.is_finished()) {
            progress(kept.load(Ordering::Relaxed) as u64, all as u64);
            std::thread::sleep(PAUSE);
        }
    });
    let board = board.into_inner().unwrap_or_else(PoisonError::into_inner);
    if let Some(error) = board.failed {
        return Err(error);
    }
    if shifts.cancelled.load(Ordering::Relaxed) {
        let message = "stopped; the episodes that were flown are kept, and the same command goes on with the others";
        return Err(Diagnostic::new("fly-stopped", Fault::Stopped, message));
    }
    Ok(Crewed { kept: kept.into_inner(), gone: board.gone })
}

/// A thread that panics stops the others, which may wait for it.
struct StopsOthers<'a>(&'a AtomicBool);

impl Drop for StopsOthers<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.store(true, Ordering::Relaxed);
        }
    }
}

fn lock(board: &Mutex<Board>) -> MutexGuard<'_, Board> {
    board.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The next episode; once the policy has answered, also those in which it had not yet.
fn next(board: &mut Board, first: &FirstAnswer) -> Option<usize> {
    if first.came() {
        board.due.extend(std::mem::take(&mut board.unanswered));
    }
    board.due.pop_front()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flown(jobs: usize, episodes: usize, answers_in: impl Fn(usize) -> bool + Sync) -> (Vec<usize>, Option<String>) {
        let (first, cancelled) = (FirstAnswer::default(), AtomicBool::new(false));
        let order = Mutex::new(vec![]);
        let shifts = Shifts { jobs, cancelled: &cancelled, first: &first };
        let crewed = crew(
            (0..episodes).collect(),
            &shifts,
            &|_, _| (),
            || Ok(()),
            |(), episode| {
                if answers_in(episode) {
                    first.tell();
                }
                if !first.came() {
                    return Ok(EpisodeOutcome::Unanswered(format!("not in {episode}")));
                }
                order.lock().expect("no panic").push(episode);
                Ok(EpisodeOutcome::Kept)
            },
        );
        let crewed = crewed.expect("no error");
        let mut order = order.into_inner().expect("no panic");
        order.sort_unstable();
        assert_eq!(order.len(), crewed.kept);
        (order, crewed.gone)
    }

    #[test]
    fn a_policy_that_never_answers_is_not_set_up_and_one_that_does_later_flies_all() {
        for jobs in [1, 4] {
            assert_eq!(flown(jobs, 9, |_| false), (vec![], Some("not in 2".to_owned())));
            assert_eq!(flown(jobs, 2, |_| false), (vec![], Some("not in 1".to_owned())));
            assert_eq!(flown(jobs, 9, |episode| episode == 3), (vec![], Some("not in 2".to_owned())));
            assert_eq!(flown(jobs, 9, |episode| episode == 2), ((0..9).collect(), None));
            assert_eq!(flown(jobs, 9, |_| true), ((0..9).collect(), None));
            assert_eq!(flown(jobs, 0, |_| true), (vec![], None));
        }
    }
}
