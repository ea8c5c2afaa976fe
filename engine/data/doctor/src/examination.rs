//! Reads a folder, runs all checks, and lists the episodes without a flag.

use crate::sources::{lerobot, ours, v7};
use crate::{Episode, Flag, Moment, Severity, checks, shortcuts};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_metrics::shortcuts::ShortcutFigures;
use cosfly_read::PublishedDataset;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Edges of the classes of visibility that are counted.
const SHARES: [f64; 4] = [0.0, 0.5, 0.8, 0.95];

/// Layout of a folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Layout {
    /// A dataset of cosfly.
    Cosfly,
    /// The published CosFly-Track release.
    V7,
    /// A dataset of LeRobot.
    Lerobot,
}

/// A share of episodes that have a loss of a certain length.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Quota {
    /// Smallest share, 0..=1.
    pub wanted: f64,
    /// Least and greatest length of the loss, seconds.
    pub lost_s: (f64, f64),
}

/// Result of an examination.
#[derive(Clone, Debug, Serialize)]
pub struct Examination {
    /// Layout of the folder.
    pub layout: Layout,
    /// Number of episodes.
    pub episodes: usize,
    /// Number of frames.
    pub frames: usize,
    /// All findings: files first, then episode by episode, then splits.
    pub flags: Vec<Flag>,
    /// Ids of the episodes without a flag.
    pub kept: Vec<String>,
    /// Number of episodes with flags but without damage.
    pub imperfect: usize,
    /// Number of episodes with damage.
    pub damaged: usize,
    /// Lower end of each class of visibility, and its number of frames.
    pub visibility: Vec<(f64, usize)>,
    /// Quotas, each with the share in the data.
    pub quotas: Vec<(Quota, f64)>,
    /// Signs that give targets away; datasets of cosfly only.
    pub shortcuts: Option<ShortcutFigures>,
    /// Checks that were impossible, with reasons.
    pub unchecked: Vec<String>,
}

impl Examination {
    /// Whether there is a damage.
    pub fn has_damage(&self) -> bool {
        self.flags.iter().any(|flag| flag.severity == Severity::Damage)
    }

    /// Share of imperfect episodes among those without damage.
    pub fn imperfect_share(&self) -> f64 {
        self.imperfect as f64 / (self.episodes - self.damaged).max(1) as f64
    }
}

/// Examines the data in `folder`. `progress` is called with the number of episodes that are read and of all.
///
/// # Errors
/// `doctor-layout` for an unknown layout; refusals of the machine. Faults of the data are flags.
pub fn examine(folder: &Path, quotas: &[Quota], progress: &mut dyn FnMut(u64, u64)) -> Result<Examination> {
    let (layout, episodes, mut flags, mut unchecked) = if ours::recognises(folder) {
        let mut flags = ours::files(folder)?;
        let episodes = ours::episodes(folder, &mut flags, progress)?;
        (Layout::Cosfly, episodes, flags, vec![])
    } else if let Some(root) = v7::root(folder) {
        let (episodes, flags) = v7::episodes(&root, progress)?;
        (Layout::V7, episodes, flags, vec![])
    } else if lerobot::recognises(folder) {
        let (episodes, flags, notes) = lerobot::episodes(folder, progress)?;
        (Layout::Lerobot, episodes, flags, notes)
    } else {
        return Err(unknown(folder));
    };
    for episode in episodes.iter().filter(|it| !it.moments.is_empty()) {
        flags.extend(checks::of_episode(episode));
    }
    flags.extend(checks::leaks(&episodes));
    unchecked.extend(unstated(layout, &episodes));
    // Damage of the tables has its flag.
    let figures = || shortcuts::figures(&PublishedDataset::open(folder).ok()?).ok();
    let shortcuts = if layout == Layout::Cosfly { figures() } else { None };
    Ok(Examination { unchecked, shortcuts, ..summed(layout, &episodes, flags, quotas) })
}

/// Values that no episode has, whose checks were skipped.
fn unstated(layout: Layout, episodes: &[Episode]) -> Vec<String> {
    let is_stated = |what: &dyn Fn(&Episode) -> bool| episodes.is_empty() || episodes.iter().any(what);
    let moments = |what: fn(&Moment) -> bool| is_stated(&|it| it.moments.iter().any(what));
    let mut gaps = vec![
        (is_stated(&|it| it.split.is_some()), "leaks between splits: no splits are stated"),
        (is_stated(&|it| it.limits[1..].iter().any(Option::is_some)), "limits of motion: none are stated"),
        (is_stated(&|it| !it.captions.is_empty()), "instructions: none can be parsed"),
    ];
    if layout != Layout::Lerobot {
        gaps.extend([
            (is_stated(&|it| it.camera.is_some()), "projection of the target: no camera without a bent lens is stated"),
            (moments(|it| it.clearance_m.is_some()), "clearance: it is not stated"),
            (moments(|it| it.visible.is_some()), "visibility: it is not stated"),
        ]);
    }
    gaps.into_iter().filter(|(is_stated, _)| !is_stated).map(|(_, gap)| gap.to_owned()).collect()
}

fn summed(layout: Layout, episodes: &[Episode], flags: Vec<Flag>, quotas: &[Quota]) -> Examination {
    let mut worst: BTreeMap<&str, Severity> = BTreeMap::new();
    for flag in &flags {
        let severity = worst.entry(&flag.place).or_insert(flag.severity);
        *severity = flag.severity.max(*severity);
    }
    let ids: BTreeSet<&str> = episodes.iter().map(|it| it.id.as_str()).collect();
    let of = |severity: Severity| ids.iter().filter(|id| worst.get(**id) == Some(&severity)).count();
    let (imperfect, damaged) = (of(Severity::Imperfect), of(Severity::Damage));
    let kept = ids.iter().filter(|id| !worst.contains_key(**id)).map(|id| (*id).to_owned()).collect();
    let stated: Vec<f64> = episodes.iter().flat_map(|it| &it.moments).filter_map(|it| it.visible).collect();
    let visibility = SHARES.iter().enumerate().map(|(at, least)| {
        let below = SHARES.get(at + 1).copied().unwrap_or(f64::INFINITY);
        (*least, stated.iter().filter(|share| (*least..below).contains(*share)).count())
    });
    let share = |quota: &Quota| {
        let has = |it: &&Episode| it.losses_s().iter().any(|lost| *lost >= quota.lost_s.0 && *lost <= quota.lost_s.1);
        episodes.iter().filter(has).count() as f64 / ids.len().max(1) as f64
    };
    Examination {
        layout,
        episodes: ids.len(),
        frames: episodes.iter().map(|it| it.moments.len()).sum(),
        kept,
        imperfect,
        damaged,
        visibility: visibility.collect(),
        quotas: quotas.iter().map(|quota| (quota.clone(), share(quota))).collect(),
        shortcuts: None,
        unchecked: vec![],
        flags,
    }
}

fn unknown(folder: &Path) -> Box<Diagnostic> {
    let message = if folder.is_dir() {
        format!("`{}` holds no data of a known layout", folder.display())
    } else {
        format!("`{}` is not a folder", folder.display())
    };
    Diagnostic::new("doctor-layout", Fault::Input, message)
        .hint("give the folder of a dataset of cosfly (with `data/trajectories`), one with `<Town>/trajectory_<id>/<trace>/trajectory.json`, or one of LeRobot (with `meta/info.json`)")
}
