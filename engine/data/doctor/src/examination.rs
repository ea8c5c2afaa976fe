//! Reads a folder, runs all checks, and lists the episodes without a flag.

use crate::checks::Trace;
use crate::sources::ours;
use crate::texts::{GivenTexts, Judged, TextFigures, TextTally};
use crate::{checks, shortcuts};
use cosfly_diagnose::{Diagnostic, Fault, Result, Stop, absent};
use cosfly_episodes::{ExaminedEpisode, Flag, Severity, is_of_cosfly, lerobot, v7};
use cosfly_metrics::scanned_mesh::ScannedMesh;
use cosfly_metrics::shortcuts::ShortcutFigures;
use cosfly_read::{Identity, PublishedDataset};
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
    /// Digest that tells the dataset from others; datasets of cosfly only.
    pub dataset: Option<String>,
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
    /// Lower end of each class of visibility, and its numbers of frames: of unperturbed and of perturbed episodes.
    pub visibility: Vec<(f64, [usize; 2])>,
    /// Quotas, each with the share in the data.
    pub quotas: Vec<(Quota, f64)>,
    /// Signs that give targets away; datasets of cosfly only.
    pub shortcuts: Option<ShortcutFigures>,
    /// Figures of the instructions, by language.
    pub texts: Vec<TextFigures>,
    /// Verdicts on texts that were given in the place of the data's own.
    pub judged: Option<Judged>,
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
    examine_given(folder, quotas, &HeldAgainst::default(), (&Stop::default(), progress))
}

/// References that the data are held against, beside themselves.
#[derive(Debug, Default)]
pub struct HeldAgainst {
    /// Texts in the place of the data's own instructions.
    pub texts: Option<GivenTexts>,
    /// The mesh of the scan that was flown in, in the world of the flights; of no town: of all.
    pub mesh: Option<ScannedMesh>,
}

/// Like [`examine`], against what is given. The flag ends the work within a second.
///
/// # Errors
/// Those of [`examine`]; `doctor-texts` for texts about an episode that is not there; the user stopped the work.
pub fn examine_given(
    folder: &Path,
    quotas: &[Quota],
    HeldAgainst { texts, mesh }: &HeldAgainst,
    (stop, progress): (&Stop, &mut dyn FnMut(u64, u64)),
) -> Result<Examination> {
    let mut tally = Tally::new(quotas);
    tally.texts.judged = texts.as_ref().map(|_| Judged::default());
    let mut add = |mut episode: ExaminedEpisode| {
        if let Some(texts) = texts {
            texts.give(&mut episode);
        }
        if let Some(mesh) = mesh {
            tally.flags.extend(checks::scan::check(&episode, mesh).into_iter().map(|flag| (String::new(), flag)));
        }
        tally.add(&episode);
    };
    let (layout, flags, notes) = if is_of_cosfly(folder) {
        let mut flags = ours::files(folder, stop)?;
        stop.check("doctor")?;
        ours::episodes(folder, &mut flags, &mut add, (stop, progress))?;
        (Layout::Cosfly, flags, vec![])
    } else if let Some(root) = v7::root(folder) {
        (Layout::V7, v7::episodes(&root, &mut add, progress)?, vec![])
    } else {
        let roots = lerobot::roots(folder);
        let (episodes, flags, notes) = match &roots[..] {
            [] => return Err(unknown(folder)),
            [root] if root == folder => lerobot::episodes(folder, progress)?,
            _ => lerobot::episodes_of_splits(&roots, progress)?,
        };
        episodes.into_iter().for_each(add);
        (Layout::Lerobot, flags, notes)
    };
    stop.check("doctor")?;
    if let Some(stranger) = texts.as_ref().and_then(|texts| texts.stranger(tally.traces.iter().map(Trace::id))) {
        let message = format!("there are texts about `{stranger}`, which is no episode of `{}`", folder.display());
        return Err(Diagnostic::new("doctor-texts", Fault::Input, message));
    }
    // Damage of the tables has its flag.
    let published = if layout == Layout::Cosfly { PublishedDataset::open(folder).ok() } else { None };
    let shortcuts = published.as_ref().and_then(|published| shortcuts::figures(published).ok());
    let things = published.and_then(|published| published.object_places().ok()).unwrap_or_default();
    let flags = [flags, checks::extent(&tally.traces, things)].concat();
    let dataset = (layout == Layout::Cosfly).then(|| Identity::of(folder).digest().to_owned());
    Ok(Examination { shortcuts, dataset, ..tally.summed(layout, flags, notes) })
}

/// Tally of the episodes: each is checked when it is read, and gone before the next.
struct Tally<'a> {
    quotas: &'a [Quota],
    /// Flags of episodes, with the flights that they show.
    flags: Vec<(String, Flag)>,
    /// Flights whose target some film shows.
    seen: BTreeSet<String>,
    traces: Vec<Trace>,
    frames: usize,
    visibility: [[usize; 2]; SHARES.len()],
    /// Episodes that meet each quota.
    kept_quotas: Vec<usize>,
    texts: TextTally,
    stated: Stated,
}

/// Values that some episode has.
#[derive(Default)]
struct Stated {
    split: bool,
    limits: bool,
    captions: bool,
    camera: bool,
    clearance: bool,
    visible: bool,
}

impl<'a> Tally<'a> {
    fn new(quotas: &'a [Quota]) -> Self {
        Self {
            quotas,
            flags: vec![],
            seen: BTreeSet::new(),
            traces: vec![],
            frames: 0,
            visibility: [[0; 2]; SHARES.len()],
            kept_quotas: vec![0; quotas.len()],
            texts: TextTally::default(),
            stated: Stated::default(),
        }
    }

    /// Checks an episode and counts it.
    fn add(&mut self, episode: &ExaminedEpisode) {
        if !episode.moments.is_empty() {
            let flags = checks::of_episode(episode);
            let is_seen = episode.moments.iter().any(|it| it.visible.is_some());
            if is_seen && flags.iter().all(|flag| flag.name != checks::LOST) {
                self.seen.insert(episode.flight.clone());
            }
            self.flags.extend(flags.into_iter().map(|flag| (episode.flight.clone(), flag)));
        }
        self.texts.add(episode);
        self.traces.push(Trace::of(episode));
        self.frames += episode.moments.len();
        for share in episode.moments.iter().filter_map(|it| it.visible) {
            if let Some(class) = SHARES.iter().rposition(|least| share >= *least) {
                self.visibility[class][usize::from(episode.is_perturbed)] += 1;
            }
        }
        let losses_s = episode.losses_s();
        for (kept, quota) in self.kept_quotas.iter_mut().zip(self.quotas) {
            let (least, most) = quota.lost_s;
            *kept += usize::from(losses_s.iter().any(|lost| (least..=most).contains(lost)));
        }
        let stated = &mut self.stated;
        stated.split |= episode.split.is_some();
        stated.limits |= episode.limits[1..].iter().any(Option::is_some);
        stated.captions |= !episode.captions.is_empty();
        stated.camera |= episode.camera.is_some();
        stated.clearance |= episode.moments.iter().any(|it| it.clearance_m.is_some());
        stated.visible |= episode.moments.iter().any(|it| it.visible.is_some());
    }

    /// Values that no episode has, whose checks were skipped.
    fn unstated(&self, layout: Layout) -> Vec<String> {
        let stated = &self.stated;
        let mut gaps = vec![
            (stated.split, "leaks between splits: no splits are stated"),
            (stated.limits, "limits of motion: none are stated"),
        ];
        if layout != Layout::Lerobot {
            gaps.extend([
                (stated.captions, "instructions: none are stated"),
                (
                    stated.camera,
                    "projection of the target: no camera with a straight lens whose rows see at one time is stated",
                ),
                (stated.clearance, "clearance: it is not stated"),
                (stated.visible, "visibility: it is not stated"),
            ]);
        }
        let is_gap = |is_stated: bool| !is_stated && !self.traces.is_empty();
        gaps.into_iter().filter(|(is_stated, _)| is_gap(*is_stated)).map(|(_, gap)| gap.to_owned()).collect()
    }

    /// The examination, with flags of files and notes on checks that were impossible.
    fn summed(self, layout: Layout, flags_of_files: Vec<Flag>, notes: Vec<String>) -> Examination {
        let unchecked = [notes, self.unstated(layout)].concat();
        let is_of_another = |flight: &String, flag: &Flag| {
            flag.name == checks::LOST && !flight.is_empty() && self.seen.contains(flight)
        };
        let flags = self.flags.into_iter().filter(|(flight, flag)| !is_of_another(flight, flag)).map(|(_, flag)| flag);
        let flags = [flags_of_files, flags.collect(), checks::leaks(&self.traces)].concat();
        let mut worst: BTreeMap<&str, Severity> = BTreeMap::new();
        for flag in &flags {
            let severity = worst.entry(&flag.place).or_insert(flag.severity);
            *severity = flag.severity.max(*severity);
        }
        let ids: BTreeSet<&str> = self.traces.iter().map(Trace::id).collect();
        let of = |severity: Severity| ids.iter().filter(|id| worst.get(**id) == Some(&severity)).count();
        let (imperfect, damaged) = (of(Severity::Imperfect), of(Severity::Damage));
        let kept = ids.iter().filter(|id| !worst.contains_key(**id)).map(|id| (*id).to_owned()).collect();
        let share = |count: usize| count as f64 / ids.len().max(1) as f64;
        Examination {
            layout,
            dataset: None,
            episodes: ids.len(),
            frames: self.frames,
            kept,
            imperfect,
            damaged,
            visibility: SHARES.into_iter().zip(self.visibility).collect(),
            quotas: self.quotas.iter().cloned().zip(self.kept_quotas.into_iter().map(share)).collect(),
            shortcuts: None,
            texts: self.texts.figures(),
            judged: self.texts.judged,
            unchecked,
            flags,
        }
    }
}

fn unknown(folder: &Path) -> Box<Diagnostic> {
    let message = if folder.is_dir() {
        format!("`{}` holds no data of a known layout", folder.display())
    } else {
        format!("`{}` {}", folder.display(), absent(folder).unwrap_or_else(|| "is not a folder".to_owned()))
    };
    Diagnostic::new("doctor-layout", Fault::Input, message)
        .hint("give the folder of a dataset of cosfly (with `data/trajectories`), one with `<Town>/trajectory_<id>/<trace>/trajectory.json`, or one of LeRobot (with `meta/info.json`)")
}
