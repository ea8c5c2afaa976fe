//! Splits of all flights at once, from the notes of their groups: the part of publishing that sees every flight.

use super::notes::FlightNote;
use super::plan::{FlightPlan, GroupPlan, LogPaths};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_frames::Seed;
use cosfly_schema::config::DatasetConfig;
use cosfly_schema::tables::Membership;
use cosfly_schema::{Split, TownLayout};
use cosfly_splits::{FlightFacts, LintRules};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Flights that the report draws one by one; of more, a sample.
const MOST_DRAWN: usize = 400;

/// Plans of all groups, from the notes about their flights. `layout_of` gives the ground plan of the town of a flight.
///
/// # Errors
/// Flights of other rates, towns that no flight is in, two flights of one name, splits that would leak.
pub fn plan_groups(
    config: &DatasetConfig,
    groups: Vec<Vec<FlightNote>>,
    layout_of: &dyn Fn(&FlightNote) -> Result<Arc<TownLayout>>,
) -> Result<Vec<GroupPlan>> {
    let sizes: Vec<usize> = groups.iter().map(Vec::len).collect();
    let notes: Vec<FlightNote> = groups.into_iter().flatten().collect();
    check_rates(&notes)?;
    let layouts: Vec<Arc<TownLayout>> = notes.iter().map(layout_of).collect::<Result<_>>()?;
    let mut facts: Vec<FlightFacts> =
        notes.into_iter().zip(&layouts).map(|(note, layout)| note.into_facts(Arc::clone(layout))).collect();
    check_towns(&facts, config)?;
    let assignment = cosfly_splits::assign(&facts, &config.splits);
    for ((it, split), group) in facts.iter_mut().zip(&assignment.splits).zip(&assignment.groups) {
        (it.split, it.group) = (split.name().to_owned(), group.clone());
    }
    check_promises(&facts, config)?;
    if let Some(refusal) = cosfly_splits::refusal(&cosfly_splits::lint(&facts, &LintRules::of(config))) {
        return Err(refusal);
    }
    let is_seen = seen(&assignment.splits, &layouts);
    let is_drawn = drawn(&facts);
    let mut paths = LogPaths::default();
    let mut flights = vec![];
    for (at, it) in facts.iter().enumerate() {
        flights.push(FlightPlan {
            trajectory_id: it.trajectory_id.clone(),
            town: it.town.clone(),
            mcap_path: paths.next(&it.town, &it.trajectory_id)?,
            membership: Membership {
                split: assignment.splits[at],
                split_group: assignment.groups[at].clone(),
                is_seen: is_seen[at],
                subset_rank: assignment.subset_ranks[at],
            },
            is_drawn: is_drawn[at],
        });
    }
    check_twins(&facts, &sizes)?;
    let mut flights = flights.into_iter();
    let mut of_flight = layouts.iter();
    let group = |(number, size): (u64, &usize)| {
        let flights: Vec<FlightPlan> = flights.by_ref().take(*size).collect();
        let towns = flights.iter().map(|flight| flight.town.clone());
        let layouts = towns.zip(of_flight.by_ref().take(*size)).map(|(town, layout)| (town, (**layout).clone()));
        GroupPlan { number, layouts: layouts.collect(), flights }
    };
    Ok((0..).zip(&sizes).map(group).collect())
}

/// Increments from frame to frame are one quantity in tables only if all frames are equally far apart.
fn check_rates(notes: &[FlightNote]) -> Result<()> {
    let Some((first, rest)) = notes.split_first() else { return Ok(()) };
    let Some(other) = rest.iter().find(|other| other.dt_s != first.dt_s) else { return Ok(()) };
    let message = format!(
        "frames are {} s apart in `{}` and {} s in `{}`: they cannot be in one dataset",
        first.dt_s, first.trajectory_id, other.dt_s, other.trajectory_id
    );
    Err(Diagnostic::new("dataset-rates", Fault::Recipe, message)
        .hint("give all stages that walks come from the same `dt_s`, or make two datasets"))
}

/// Twins are in one group, whose tables compare them.
fn check_twins(facts: &[FlightFacts], sizes: &[usize]) -> Result<()> {
    let groups = sizes.iter().enumerate().flat_map(|(group, size)| std::iter::repeat_n(group, *size));
    let groups: BTreeMap<&str, usize> = facts.iter().map(|it| it.trajectory_id.as_str()).zip(groups).collect();
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

/// Flights that the report draws: all of them, or a share drawn from their ids that halves whenever the flights double, so
/// that a few further flights change no earlier choice.
fn drawn(facts: &[FlightFacts]) -> Vec<bool> {
    let mut share = 1.0;
    while facts.len() as f64 * share > MOST_DRAWN as f64 {
        share *= 0.5;
    }
    let draw = |it: &FlightFacts| Seed::of_item(0, "report", &it.trajectory_id).stream("report").unit();
    facts.iter().map(|it| draw(it) < share).collect()
}

/// Towns that a recipe gives a split are there.
fn check_towns(facts: &[FlightFacts], config: &DatasetConfig) -> Result<()> {
    let known: BTreeSet<&str> = facts.iter().map(|it| it.town.as_str()).collect();
    let Some(name) = config.splits.towns.keys().find(|name| !known.contains(name.as_str())) else { return Ok(()) };
    let message = format!("`splits.towns` names `{name}`, but no flight is in a town of that name");
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
fn seen(splits: &[Split], layouts: &[Arc<TownLayout>]) -> Vec<bool> {
    let train: BTreeMap<&str, &TownLayout> = (splits.iter().zip(layouts))
        .filter(|(split, _)| **split == Split::Train)
        .map(|(_, layout)| (layout.digest.as_str(), &**layout))
        .collect();
    let mut known: BTreeMap<&str, bool> = BTreeMap::new();
    let is_seen = |layout: &TownLayout| train.values().any(|seen| seen.is_same_place(layout));
    layouts.iter().map(|layout| *known.entry(&layout.digest).or_insert_with(|| is_seen(layout))).collect()
}
