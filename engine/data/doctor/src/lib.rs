//! Finds faults in data of flights behind a target: datasets of cosfly, the published v7 layout, LeRobot's.
//!
//! * [`sources`]: episodes of cosfly's own; those of other layouts are read by `cosfly_episodes`.
//! * [`checks`]: one file per kind of fault; each looks at an episode and raises flags.
//! * [`examine`]: reads a folder and runs all checks.
//! * [`verdict`]: which flights are left out of a dataset.
//!
//! To add a check: one file in `checks/` and its line in [`checks::of_episode`].

pub mod checks;
mod examination;
mod hardness;
mod shortcuts;
pub mod sources;
#[cfg(test)]
mod tests;
mod texts;
pub mod verdict;
mod walk;
pub mod walls;

pub use examination::{Examination, HeldAgainst, Layout, Quota, examine, examine_given};
pub use texts::{GivenTexts, Judged, TextFigures, TextVerdict};
