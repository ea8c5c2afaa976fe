//! Splits of all flights at once, from the notes of their groups: the part of publishing that sees every flight.

use super::notes::FlightNote;
use super::plan::{FlightPlan, GroupName, GroupPlan, LogPaths};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_schema::config::{DatasetConfig, SplitBy, SplitShares};
use cosfly_schema::tables::Membership;
use cosfly_schema::{Rejection, Split, TownLayout};
use cosfly_splits::{Balance, FlightFacts, LintRules, area};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Name of the stage in rows of flights that are left out.
const STAGE: &str = "dataset";

/// The splits of a dataset.
#[derive(Clone, Debug, PartialEq)]
pub struct SplitPlan {
    /// The groups of walks.
    pub groups: Vec<GroupPlan>,
    /// The policy, with the areas of all towns.
    pub splits: SplitShares,
    /// Notes on the splits for the user: shares that are missed, walks that chain, flights left out.
    pub warnings: Vec<String>,
}

/// Refusal of a dataset without a flight, with the first reasons.
pub fn nothing_left(rejections: &[Rejection]) -> Box<Diagnostic> {
    let refusal =
        Diagnostic::new("dataset-empty", Fault::Input, "every trajectory was rejected: there is nothing to publish");
    let refusal = rejections
        .iter()
        .take(3)
        .fold(refusal, |refusal, rejection| {
            refusal.because(format!("`{}`: {}", rejection.trajectory_id, rejection.reason))
        })
        .hint("the planner found no safe view of any target: look at the reasons, loosen the limits of the `plan` stage, or choose other walks (another `seed`) or another town");
    if rejections.iter().any(|rejection| ["m/s^2", "m/s^3"].iter().any(|unit| rejection.reason.contains(unit))) {
        return refusal.hint("flights of a planner that bounds no acceleration or jerk (`paper.make_flyable = false`, say) are published with `limits.require_kinematics = false`");
    }
    refusal
}

/// Plans of all groups, from the notes about their flights. `layout_of` gives the ground plan of the town of a flight.
///
/// # Errors
/// Flights of other rates, towns that no flight is in, two flights of one name, splits that would leak.
pub fn plan_groups(
    config: &DatasetConfig,
    groups: Vec<(GroupName, Vec<FlightNote>)>,
    layout_of: &dyn Fn(&FlightNote) -> Result<Arc<TownLayout>>,
) -> Result<SplitPlan> {
    let of_group = |(number, notes): (usize, Vec<FlightNote>)| notes.into_iter().map(move |note| (number, note));
    let (names, groups): (Vec<GroupName>, Vec<Vec<FlightNote>>) = groups.into_iter().unzip();
    let (places, notes): (Vec<usize>, Vec<FlightNote>) = groups.into_iter().enumerate().flat_map(of_group).unzip();
    check_rates(&notes)?;
    let layouts: Vec<Arc<TownLayout>> = notes.iter().map(layout_of).collect::<Result<_>>()?;
    let facts: Vec<FlightFacts> =
        notes.into_iter().zip(layouts).map(|(note, layout)| note.into_facts(layout)).collect();
    let mut plans: Vec<GroupPlan> = names.into_iter().map(|name| GroupPlan { name, ..GroupPlan::default() }).collect();
    // Flights in guard bands are left out later: their towns are known.
    check_towns(&facts, config)?;
    let splits = match config.splits.by {
        SplitBy::Area => area::resolved(&facts, &config.splits),
        _ => config.splits.clone(),
    };
    let config = &DatasetConfig { splits, ..config.clone() };
    let (places, mut facts) = leave_out(facts, places, config, &mut plans);
    let assignment = cosfly_splits::assign(&facts, &config.splits);
    for ((it, split), group) in facts.iter_mut().zip(&assignment.splits).zip(&assignment.groups) {
        (it.split, it.group) = (split.name().to_owned(), group.clone());
    }
    check_promises(&facts, config)?;
    let left_out = plans.iter().map(|plan| plan.left_out.len()).sum();
    let balance = Balance::of(&facts, &config.splits, left_out);
    if let Some(refusal) = balance.refusal(&config.splits) {
        return Err(refusal);
    }
    if let Some(refusal) = cosfly_splits::refusal(&cosfly_splits::lint(&facts, &LintRules::of(config))) {
        return Err(refusal);
    }
    check_twins(&facts, &places)?;
    let is_seen = seen(&assignment.splits, &facts);
    let mut paths = LogPaths::default();
    for (at, (it, place)) in facts.iter().zip(places).enumerate() {
        plans[place].layouts.entry(it.town.clone()).or_insert_with(|| (*it.layout).clone());
        plans[place].flights.push(FlightPlan {
            trajectory_id: it.trajectory_id.clone(),
            town: it.town.clone(),
            mcap_path: paths.next(&it.town, &it.trajectory_id)?,
            membership: Membership {
                split: assignment.splits[at],
                split_group: assignment.groups[at].clone(),
                is_seen: is_seen[at],
                subset_rank: assignment.subset_ranks[at],
            },
        });
    }
    Ok(SplitPlan { groups: plans, splits: config.splits.clone(), warnings: balance.warnings() })
}

/// The flights that an area of the splits holds, with the numbers of their groups; the others are noted in the plans.
fn leave_out(
    facts: Vec<FlightFacts>,
    places: Vec<usize>,
    config: &DatasetConfig,
    plans: &mut [GroupPlan],
) -> (Vec<usize>, Vec<FlightFacts>) {
    if config.splits.by != SplitBy::Area {
        return (places, facts);
    }
    let reasons = area::left_out(&facts, &config.splits);
    let mut kept = vec![];
    for ((it, place), reason) in facts.into_iter().zip(places).zip(reasons) {
        match reason {
            None => kept.push((place, it)),
            Some(reason) => plans[place].left_out.push(Rejection {
                trajectory_id: it.trajectory_id,
                stage: STAGE.to_owned(),
                pedestrian_id: it.pedestrian_id,
                town: it.town,
                reason,
            }),
        }
    }
    kept.into_iter().unzip()
}

/// Increments from frame to frame are one quantity in tables only if all frames of a camera are equally far apart.
fn check_rates(notes: &[FlightNote]) -> Result<()> {
    let mut rates: BTreeMap<Option<&str>, &FlightNote> = BTreeMap::new();
    let mut pairs = notes.iter().map(|note| (*rates.entry(note.camera_name.as_deref()).or_insert(note), note));
    let Some((first, other)) = pairs.find(|(first, other)| first.dt_s != other.dt_s) else { return Ok(()) };
    let message = format!(
        "frames are {} s apart in `{}` and {} s in `{}`: they cannot be in one dataset",
        first.dt_s, first.trajectory_id, other.dt_s, other.trajectory_id
    );
    Err(Diagnostic::new("dataset-rates", Fault::Recipe, message)
        .hint("give all stages that walks come from the same `dt_s`, or make two datasets"))
}

/// Twins are in one group, whose tables compare them.
fn check_twins(facts: &[FlightFacts], places: &[usize]) -> Result<()> {
    let groups: BTreeMap<&str, usize> =
        facts.iter().map(|it| it.trajectory_id.as_str()).zip(places.iter().copied()).collect();
    let is_apart = |it: &&FlightFacts| {
        let expert = it.expert_id.as_deref().and_then(|id| groups.get(id));
        expert.is_some_and(|group| groups[it.trajectory_id.as_str()] != *group)
    };
    match facts.iter().find(is_apart) {
        None => Ok(()),
        Some(it) => {
            let message = format!("`{}` and its expert are in two groups of walks", it.trajectory_id);
            Err(Diagnostic::new("dataset-twins-apart", Fault::Bug, message))
        }
    }
}

/// Towns that a recipe gives a split or areas are there.
fn check_towns(facts: &[FlightFacts], config: &DatasetConfig) -> Result<()> {
    let known: BTreeSet<&str> = facts.iter().map(|it| it.town.as_str()).collect();
    let splits = &config.splits;
    let named = splits.towns.keys().map(|town| ("towns", town)).chain(splits.areas.keys().map(|town| ("areas", town)));
    let unknown = named.into_iter().find(|(_, name)| !known.contains(name.as_str()));
    let Some((key, name)) = unknown else { return Ok(()) };
    let message = format!("`splits.{key}` names `{name}`, but no flight is in a town of that name");
    let refusal = Diagnostic::new("dataset-unknown-town", Fault::Recipe, message);
    let list = || known.iter().map(|it| format!("`{it}`")).collect::<Vec<_>>().join(", ");
    Err(match cosfly_diagnose::nearest_name(name, known.iter().copied()) {
        Some(near) => refusal.hint(format!("did you mean `{near}`?")),
        None => refusal.hint(format!("flights are in {}", list())),
    })
}

/// Every town is in the split that the recipe gives it; a place under two names cannot be in two.
fn check_promises(facts: &[FlightFacts], config: &DatasetConfig) -> Result<()> {
    let promised = |it: &FlightFacts| config.splits.towns.get(&it.town).copied();
    let broken = |it: &&FlightFacts| promised(it).is_some_and(|split| split.name() != it.split);
    let Some(it) = facts.iter().find(broken) else { return Ok(()) };
    let other =
        facts.iter().find(|other| other.town != it.town && promised(other).is_some() && other.split == it.split);
    let message = format!(
        "`splits.towns` puts `{}` and `{}` into two splits, but they have the same ground plan",
        it.town,
        other.map_or("a copy of it", |other| other.town.as_str())
    );
    Err(Diagnostic::new("dataset-leak", Fault::Recipe, message).hint("give both the same split, or leave one out"))
}

/// Whether split `train` has flights in the town of each flight.
fn seen(splits: &[Split], facts: &[FlightFacts]) -> Vec<bool> {
    let train: BTreeMap<&str, &TownLayout> = (splits.iter().zip(facts))
        .filter(|(split, _)| **split == Split::Train)
        .map(|(_, it)| (it.layout.digest.as_str(), &*it.layout))
        .collect();
    let mut known: BTreeMap<&str, bool> = BTreeMap::new();
    let is_seen = |layout: &TownLayout| train.values().any(|seen| seen.is_same_place(layout));
    facts.iter().map(|it| *known.entry(&it.layout.digest).or_insert_with(|| is_seen(&it.layout))).collect()
}
