//! The verdict over flights that are about to be published: which are left out, with their reasons, decided over all of them at
//! once.

use crate::checks;
use crate::hardness::{difficulty, too_many};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_episodes::{ExaminedEpisode, Severity};
use cosfly_frames::Seed;
use cosfly_schema::RenderedTrajectory;
use cosfly_windows::Difficulty;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Parameters of the `inspect` stage.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct InspectConfig {
    /// Flights of which less is visible on average (by pixels) are imperfect.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub min_visibility: f64,
    /// Flights that lose their target (less than half visible) for longer are imperfect, seconds.
    #[schemars(range(min = 0.0))]
    pub max_lost_s: f64,
    /// Share of imperfect flights among all that are kept.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub imperfect_share: f64,
    /// Shares of flights that must lose their target for a certain time; flights that do not are left out until they are
    /// met.
    pub quotas: Vec<LossQuota>,
    /// Share of hard flights among all that are kept, by the column `difficulty` of windows of the usual shape; flights of which
    /// there are too many are left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub hard_share: Option<f64>,
}

impl Default for InspectConfig {
    fn default() -> Self {
        Self { min_visibility: 0.0, max_lost_s: 3600.0, imperfect_share: 0.05, quotas: vec![], hard_share: None }
    }
}

/// A share of flights with a loss of a certain length, such as 20 % with one of 2 to 4 s.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-gone" = { "from_s": "write `min_s`", "to_s": "write `max_s`" }))]
pub struct LossQuota {
    /// Share that is wanted.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub share: f64,
    /// Shortest loss, seconds.
    #[schemars(range(min = 0.0))]
    pub min_s: f64,
    /// Longest loss, seconds.
    #[schemars(range(min = 0.0))]
    pub max_s: f64,
}

/// Reasons why items are left out, by name.
pub type Verdict = BTreeMap<String, String>;

/// View of a flight's target from the camera that sees most of it.
#[derive(Clone, Debug, PartialEq)]
struct View {
    /// Mean share of the target that is visible.
    visible: f64,
    /// Times for which the target is lost, seconds.
    losses_s: Vec<f64>,
    /// Imperfection, where the target is seen too little.
    imperfection: Option<String>,
}

/// An expert with its twins, in the films of all cameras and weathers: kept or left out together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Family {
    /// Names of its items.
    pub items: Vec<String>,
    /// Damage, where there is one.
    damage: Option<String>,
    /// Imperfection, where there is one.
    imperfection: Option<String>,
    /// Losses of all members, seconds.
    losses_s: Vec<f64>,
    /// Best view of each flight, until all films are there.
    views: BTreeMap<String, View>,
    /// Difficulty of the expert.
    difficulty: Option<Difficulty>,
}

impl Family {
    /// Adds what the checks find in a film of the family. How much of the target is seen counts in the film that sees most of it: the other
    /// cameras of a drone may look elsewhere.
    pub fn add(&mut self, episode: &ExaminedEpisode, config: &InspectConfig) {
        let mut unseen = None;
        for flag in checks::of_episode(episode) {
            let reason = match flag.severity {
                _ if flag.name == checks::LOST => &mut unseen,
                Severity::Damage => &mut self.damage,
                Severity::Imperfect => &mut self.imperfection,
            };
            reason.get_or_insert_with(|| flag.to_string());
        }
        let (id, losses_s) = (&episode.id, episode.losses_s());
        let longest = losses_s.iter().copied().fold(0.0, f64::max);
        if longest > config.max_lost_s && !episode.is_perturbed {
            unseen.get_or_insert_with(|| format!("{id}: its target is lost for {longest:.1} s"));
        }
        let shares = episode.moments.iter().filter_map(|it| it.visible);
        let visible = shares.sum::<f64>() / episode.moments.len().max(1) as f64;
        if visible < config.min_visibility && !episode.is_perturbed {
            unseen.get_or_insert_with(|| format!("{id}: {:.1} % of its target is visible", 100.0 * visible));
        }
        let flight = if episode.flight.is_empty() { id } else { &episode.flight };
        let best = self.views.get(flight).is_none_or(|best| best.visible < visible);
        if best {
            self.views.insert(flight.clone(), View { visible, losses_s, imperfection: unseen });
        }
    }

    /// The family with the best views of its flights, when all films are there.
    fn seen(mut self) -> Self {
        for view in std::mem::take(&mut self.views).into_values() {
            self.losses_s.extend(view.losses_s);
            self.imperfection = self.imperfection.or(view.imperfection);
        }
        self
    }

    /// Adds the difficulty of a flight, if it is the expert.
    pub fn rate(&mut self, record: &RenderedTrajectory) {
        if record.pair.is_none() && (self.difficulty.is_none() || record.every == 1) {
            self.difficulty = Some(difficulty(record));
        }
    }

    /// Whether its expert is hard to predict.
    pub fn is_hard(&self) -> bool {
        self.difficulty == Some(Difficulty::Hard)
    }

    fn meets(&self, quota: &LossQuota) -> bool {
        self.losses_s.iter().any(|lost| *lost >= quota.min_s && *lost <= quota.max_s)
    }
}

/// Leaves flights out, family by family; families by the name of their expert. The order of leaving out is drawn from `seed` and
/// the family's own name: other families do not change it.
///
/// # Errors
/// `inspect-quota`.
pub fn verdict(families: BTreeMap<String, Family>, seed: Seed, config: &InspectConfig) -> Result<Decided> {
    let draw = |name: &str| seed.child(name, 0).stream("inspect").unit().to_bits();
    let mut drawn: Vec<(u64, Family)> =
        families.into_iter().map(|(name, family)| (draw(&name), family.seen())).collect();
    drawn.sort_by_key(|(draw, _)| *draw);
    let families: Vec<Family> = drawn.into_iter().map(|(_, family)| family).collect();
    let verdict = decide(&families, config)?;
    Ok(Decided { notes: notes(&families, &verdict, config), verdict })
}

/// A verdict and what the stage says about it.
pub struct Decided {
    /// Items that are left out.
    pub verdict: Verdict,
    /// Shares that came, by what they are of.
    pub notes: BTreeMap<String, String>,
}

fn notes(families: &[Family], verdict: &Verdict, config: &InspectConfig) -> BTreeMap<String, String> {
    let all: usize = families.iter().map(|family| family.items.len()).sum();
    let mut notes = BTreeMap::from([("kept".to_owned(), format!("{} of {all}", all - verdict.len()))]);
    if let Some(share) = config.hard_share {
        let kept = families.iter().filter(|family| family.items.iter().all(|item| !verdict.contains_key(item)));
        let [mut hard, mut flights] = [0, 0];
        kept.for_each(|family| (hard, flights) = (hard + usize::from(family.is_hard()), flights + 1));
        let percent = 100.0 * hard as f64 / (flights as f64).max(1.0);
        let asked = 100.0 * share;
        notes
            .insert("hard".to_owned(), format!("{hard} of {flights} experts, {percent:.1} %; {asked} % are asked for"));
    }
    notes
}

/// Leaves out damaged families, then imperfect ones beyond their share, then those that exceed a quota.
fn decide(families: &[Family], config: &InspectConfig) -> Result<Verdict> {
    let mut verdict = Verdict::new();
    let mut leave = |family: &Family, reason: &str| {
        family.items.iter().for_each(|item| {
            verdict.insert(item.clone(), reason.to_owned());
        });
    };
    let (damaged, sound): (Vec<&Family>, Vec<&Family>) = families.iter().partition(|it| it.damage.is_some());
    damaged.iter().for_each(|family| leave(family, family.damage.as_deref().unwrap_or_default()));
    let (imperfect, perfect): (Vec<&Family>, Vec<&Family>) =
        sound.into_iter().partition(|it| it.imperfection.is_some());
    // n imperfect ones among p + n: n <= share (p + n).
    let share = config.imperfect_share;
    let allowed = match share {
        _ if share >= 1.0 => imperfect.len(),
        _ => ((share * perfect.len() as f64 / (1.0 - share) + 1e-9) as usize).min(imperfect.len()),
    };
    let (kept, surplus) = imperfect.split_at(allowed);
    for family in surplus {
        let reason = family.imperfection.as_deref().unwrap_or_default();
        leave(family, &format!("{reason}; more than {:.1} % would be imperfect", 100.0 * share));
    }
    let mut kept: Vec<&Family> = perfect.into_iter().chain(kept.iter().copied()).collect();
    for quota in &config.quotas {
        let members = kept.iter().filter(|family| family.meets(quota)).count();
        let (min_s, max_s, percent) = (quota.min_s, quota.max_s, 100.0 * quota.share);
        if members == 0 && quota.share > 0.0 && !kept.is_empty() {
            let message = format!("no flight loses its target for {min_s} to {max_s} s; {percent} % are wanted");
            return Err(Diagnostic::new("inspect-quota", Fault::Recipe, message)
                .hint("lower the quota's share, widen its times, or make more flights"));
        }
        let most = if quota.share > 0.0 { (members as f64 / quota.share + 1e-9) as usize } else { kept.len() };
        let mut surplus = kept.len().saturating_sub(most);
        kept.retain(|family| {
            let goes = surplus > 0 && !family.meets(quota);
            if goes {
                surplus -= 1;
                leave(
                    family,
                    &format!("the quota: {percent} % of the flights are to lose their target for {min_s} to {max_s} s"),
                );
            }
            !goes
        });
    }
    if let Some(share) = config.hard_share {
        let is_hard: Vec<bool> = kept.iter().map(|family| family.is_hard()).collect();
        for at in too_many(&is_hard, share)? {
            leave(kept[at], &format!("{} % of the flights are to be hard", 100.0 * share));
        }
    }
    Ok(verdict)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_episodes::ExaminedMoment;
    use cosfly_frames::{DVec3, Pose};

    fn families(count: usize, change: impl Fn(usize, &mut Family)) -> Vec<Family> {
        let one = |at: usize| {
            let mut family = Family { items: vec![format!("e{at}"), format!("p{at}")], ..Family::default() };
            change(at, &mut family);
            family
        };
        (0..count).map(one).collect()
    }

    /// A film of ten frames that show `visible` of the target.
    fn film(id: &str, flight: &str, visible: f64) -> ExaminedEpisode {
        let pose = Pose { position_in_world: DVec3::Z * 20.0, pitch_rad: -0.5, yaw_rad: 0.0, roll_rad: 0.0 };
        let moment = |at: u32| ExaminedMoment {
            time_s: 0.5 * f64::from(at),
            drone: pose,
            camera: pose,
            next_in_world: None,
            turn_deg: None,
            target_in_world: None,
            heading_and_speed: None,
            in_image: None,
            visible_box: None,
            visible: Some(visible),
            clearance_m: None,
        };
        let moments = (0..10).map(moment).collect();
        ExaminedEpisode { id: id.into(), flight: flight.into(), dt_s: 0.5, moments, ..ExaminedEpisode::default() }
    }

    #[test]
    fn a_camera_that_looks_elsewhere_loses_no_target() {
        let config = InspectConfig { min_visibility: 0.8, max_lost_s: 2.0, ..InspectConfig::default() };
        let imperfection = |films: &[ExaminedEpisode]| {
            let mut family = Family::default();
            films.iter().for_each(|film| family.add(film, &config));
            family.seen().imperfection
        };
        let (front, down) = (film("e0-front", "e0", 0.9), film("e0-down", "e0", 0.0));
        assert_eq!(imperfection(&[front.clone(), down.clone()]), None);
        assert_eq!(imperfection(&[down.clone(), front]), None);
        let lost = imperfection(&[down.clone(), film("e0-tele", "e0", 0.1)]).unwrap();
        assert!(lost.starts_with("e0-tele: less than half of the target is visible in 10 of 10 frames"), "{lost}");
        assert!(imperfection(&[down, film("e1-front", "e1", 0.9)]).is_some(), "another flight sees another target");
    }

    #[test]
    fn damaged_families_go_and_a_few_imperfect_ones_stay() {
        let families = families(22, |at, family| match at {
            0 => family.damage = Some("the yaw".into()),
            1..=3 => family.imperfection = Some("a car".into()),
            _ => {}
        });
        let verdict = decide(&families, &InspectConfig::default()).unwrap();
        // 18 sound ones allow none; 19 would allow one.
        assert_eq!(verdict.len(), 8);
        assert_eq!(verdict["p0"], "the yaw");
        let loose = InspectConfig { imperfect_share: 0.1, ..InspectConfig::default() };
        assert_eq!(decide(&families, &loose).unwrap().len(), 4, "2 of 20 are 10 %");
    }

    #[test]
    fn a_quota_leaves_out_as_many_as_it_must() {
        let families = families(10, |at, family| family.losses_s = if at < 2 { vec![3.0] } else { vec![0.5] });
        let quota = |share: f64| InspectConfig {
            quotas: vec![LossQuota { share, min_s: 2.0, max_s: 4.0 }],
            ..InspectConfig::default()
        };
        assert!(decide(&families, &quota(0.2)).unwrap().is_empty());
        assert_eq!(decide(&families, &quota(0.5)).unwrap().len(), 12, "2 of 4 families are half");
        let config = InspectConfig {
            quotas: vec![LossQuota { share: 0.1, min_s: 8.0, max_s: 9.0 }],
            ..InspectConfig::default()
        };
        assert_eq!(decide(&families, &config).unwrap_err().code, "inspect-quota");
    }

    #[test]
    fn the_share_of_hard_flights_is_met_from_both_sides() {
        let of = |hard: usize, share: f64| {
            let rated = |at, family: &mut Family| {
                family.difficulty = Some(if at < hard { Difficulty::Hard } else { Difficulty::Easy });
            };
            let families = families(400, rated);
            let config = InspectConfig { hard_share: Some(share), ..InspectConfig::default() };
            let verdict = decide(&families, &config).unwrap();
            let kept: Vec<&Family> = families.iter().filter(|it| !verdict.contains_key(&it.items[0])).collect();
            (kept.iter().filter(|it| it.is_hard()).count(), kept.len())
        };
        assert_eq!(of(40, 0.25), (40, 160));
        assert_eq!(of(300, 0.25), (33, 133));
        assert_eq!(of(100, 0.25), (100, 400));
        assert_eq!((of(7, 0.0), of(7, 1.0)), ((0, 393), (7, 7)));
        let config = InspectConfig { hard_share: Some(0.1), ..InspectConfig::default() };
        assert_eq!(decide(&families(9, |_, _| {}), &config).unwrap_err().code, "inspect-hard");
    }
}
