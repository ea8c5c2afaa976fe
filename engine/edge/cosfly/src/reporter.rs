//! Reports of a run for people: bars on a terminal, plain lines when piped.

use crate::output;
use crate::text::count;
use cosfly_diagnose::{Diagnostic, render};
use cosfly_stage::{ItemId, RunEvent, StageName};
use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::collections::BTreeMap;
use std::io::IsTerminal;
use std::sync::{Mutex, PoisonError};

/// Number of failures of one stage and code that are shown in full.
const SHOWN_ALIKE: usize = 3;

/// Amount of text that is printed during a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// Errors only.
    Quiet,
    /// One line per stage.
    Lines,
    /// A bar per stage.
    Bars,
}

/// Prints the events of a run to standard error. Workers call it from all threads.
pub struct Reporter {
    detail: Detail,
    bars: MultiProgress,
    stages: Mutex<BTreeMap<StageName, Progress>>,
    /// Failed items by stage and code.
    failures: Mutex<BTreeMap<(StageName, &'static str), Failures>>,
}

/// Items that failed with one code.
#[derive(Default)]
struct Failures {
    count: usize,
    /// Messages that were shown.
    shown: Vec<String>,
}

struct Progress {
    bar: ProgressBar,
    total: u64,
    done: u64,
    failed: u64,
}

impl Reporter {
    /// A reporter of bars where standard error is a terminal, of lines otherwise, of errors alone when `quiet`.
    pub fn new(quiet: bool) -> Self {
        let detail = match (quiet, std::io::stderr().is_terminal()) {
            (true, _) => Detail::Quiet,
            (false, true) => Detail::Bars,
            (false, false) => Detail::Lines,
        };
        let target = if detail == Detail::Bars { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        Self {
            detail,
            bars: MultiProgress::with_draw_target(target),
            stages: Mutex::default(),
            failures: Mutex::default(),
        }
    }

    /// Shows one event.
    pub fn show(&self, event: RunEvent) {
        match event {
            RunEvent::Planned { stages } => self.planned(&stages),
            RunEvent::Finished { id, produced, .. } => {
                for warning in &produced.warnings {
                    self.line(&format!("warning: {id}: {warning}"));
                }
                self.advance(&id.stage, false);
            }
            RunEvent::Failed { id, diagnostic } => {
                self.failed(&id, &diagnostic);
                self.advance(&id.stage, true);
            }
            RunEvent::Stopping => self.always("stopping: finished items are kept"),
        }
    }

    /// Shows a failure, unless enough items of the same stage failed in the same way: a thousand items, three messages; one where
    /// all of them say the same.
    fn failed(&self, id: &ItemId, diagnostic: &Diagnostic) {
        let text = cosfly_secrets::without_secrets(&render(diagnostic, colour()));
        let mut failures = self.failures.lock().unwrap_or_else(PoisonError::into_inner);
        let alike = failures.entry((id.stage.clone(), diagnostic.code)).or_default();
        alike.count += 1;
        if alike.shown.len() < SHOWN_ALIKE && !alike.shown.contains(&text) {
            self.always(&format!("{text}\n  (in `{id}`)"));
            alike.shown.push(text);
        }
    }

    /// Removes the bars, and prints the number of failures that were not shown.
    fn finish(&self) {
        for ((stage, code), alike) in self.failures.lock().unwrap_or_else(PoisonError::into_inner).iter() {
            let more = alike.count - alike.shown.len();
            if more > 0 {
                self.always(&format!("{} of `{stage}` failed with `{code}`", count(more as u64, "more item")));
            }
        }
        for progress in self.stages.lock().unwrap_or_else(PoisonError::into_inner).values() {
            progress.bar.finish_and_clear();
        }
    }

    fn planned(&self, planned: &[(StageName, u64, u64)]) {
        let width = planned.iter().map(|(stage, ..)| stage.as_str().len()).max().unwrap_or(0);
        let style =
            ProgressStyle::with_template("{prefix} {wide_bar:.cyan/blue} {pos}/{len} {per_sec:>10} {eta:>5} left")
                .unwrap_or_else(|_| ProgressStyle::default_bar());
        let mut stages = self.stages.lock().unwrap_or_else(PoisonError::into_inner);
        for (stage, total, cached) in planned {
            let bar = self.bars.add(ProgressBar::new(*total).with_style(style.clone()));
            bar.set_prefix(format!("{stage:width$}"));
            bar.set_position(*cached);
            bar.reset_eta();
            if *cached == *total {
                bar.finish();
            } else if self.detail == Detail::Lines {
                self.line(&format!("{stage:width$}  {}, {cached} cached", count(*total, "item")));
            }
            stages.insert(stage.clone(), Progress { bar, total: *total, done: *cached, failed: 0 });
        }
    }

    fn advance(&self, stage: &StageName, failed: bool) {
        let mut stages = self.stages.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(progress) = stages.get_mut(stage) else { return };
        progress.done += 1;
        progress.bar.set_position(progress.done);
        progress.failed += u64::from(failed);
        let (done, total, failed) = (progress.done, progress.total, progress.failed);
        if done == total {
            progress.bar.finish();
        }
        // When piped: a line at each tenth of a long stage, and at its end.
        let tenth = (total / 10).max(1);
        if self.detail == Detail::Lines && (done == total || (total >= 100 && done % tenth == 0)) {
            let failed = if failed == 0 { String::new() } else { format!(", {failed} failed") };
            self.line(&format!("{stage}  {done}/{total} done{failed}"));
        }
    }

    /// Prints a line unless quiet.
    fn line(&self, text: &str) {
        if self.detail != Detail::Quiet {
            self.always(text);
        }
    }

    fn always(&self, text: &str) {
        if self.detail == Detail::Bars {
            self.bars.suspend(|| output::tell(text));
        } else {
            output::tell(text);
        }
    }
}

impl Drop for Reporter {
    fn drop(&mut self) {
        self.finish();
    }
}

/// True where standard error takes colour.
pub fn colour() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}
