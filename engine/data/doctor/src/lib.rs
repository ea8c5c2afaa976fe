//! Finds faults in data of flights behind a target: datasets of cosfly, the published v7 layout, LeRobot's.
//!
//! * [`episode`]: a flight as the checks see it, whatever files it came from.
//! * [`sources`]: one reader per layout.
//! * [`checks`]: one file per kind of fault; each looks at an episode and raises flags.
//! * [`examine`]: reads a folder and runs all checks.
//! * [`verdict`]: which flights are left out of a dataset.
//!
//! To add a check: one file in `checks/` and its line in [`checks::of_episode`].

pub mod checks;
pub mod episode;
mod examination;
mod files;
pub mod flag;
mod hardness;
mod shortcuts;
pub mod sources;
#[cfg(test)]
mod tests;
mod texts;
pub mod verdict;
mod walk;
pub mod walls;
mod whole_files;

pub use cosfly_metrics::shortcuts::{Probe, ShortcutFigures};
pub use episode::{ExaminedEpisode, ExaminedLook, ExaminedMoment};
pub use examination::{Examination, HeldAgainst, Layout, Quota, examine, examine_given};
pub use flag::{Flag, Severity};
pub use texts::{GivenTexts, Judged, TextFigures, TextVerdict};
