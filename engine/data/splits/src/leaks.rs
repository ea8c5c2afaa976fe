//! The linter: pairs of flights or towns that would be in a model's training and test data at once.

use super::area;
use super::facts::{FlightFacts, published_windows};
use super::overlap::{Overlaps, overlaps};
use super::places::kind_of;
use super::route;
use cosfly_diagnose::{Diagnostic, Fault, Result, Stop, counted};
use cosfly_read::PublishedDataset;
use cosfly_schema::config::{DatasetConfig, OverlapDirection, SplitBy, SplitShares};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::path::Path;

/// Pairs kept per rule; further ones are only counted.
const KEPT: usize = 200;

/// Definition of a leak.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LintRules {
    /// Largest share of a walk that another one in another split may repeat, 0..=1.
    pub max_route_overlap: f64,
    /// Directions in which a walk repeats another one.
    pub overlap_direction: OverlapDirection,
    /// Whether a place must be in one split only, whatever its name.
    pub by_town: bool,
    /// Whether all places of a kind must be in one split.
    pub by_kind: bool,
}

impl LintRules {
    /// Rules that follow from a recipe's parameters.
    pub fn of(config: &DatasetConfig) -> Self {
        Self::of_shares(&config.splits)
    }

    /// Rules that follow from the shares of a recipe or of `splits.json`.
    pub fn of_shares(shares: &SplitShares) -> Self {
        let SplitShares { max_route_overlap, overlap_direction, by, .. } = *shares;
        let by_town = matches!(by, SplitBy::Town | SplitBy::Kind);
        Self { max_route_overlap, overlap_direction, by_town, by_kind: by == SplitBy::Kind }
    }
}

/// Two flights or towns that must not be in different splits.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Leak {
    /// `split-town`, `split-kind`, `split-pedestrian`, `split-twin`, `split-group`, `split-window`, `split-route` or `split-area`.
    pub rule: &'static str,
    /// Flight that the finding is reported for.
    pub trajectory_id: String,
    /// Description with both names and both splits.
    pub message: String,
}

impl fmt::Display for Leak {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} [{}]", self.message, self.rule)
    }
}

/// Findings of the linter.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Leaks {
    /// First findings of each rule.
    pub kept: Vec<Leak>,
    /// Number of all findings.
    pub found: usize,
    /// Numbers of kept findings by rule.
    kept_by_rule: BTreeMap<&'static str, usize>,
}

impl Leaks {
    /// Adds the flights of one dataset that are not in the split of their area.
    pub fn of_areas(&mut self, facts: &[FlightFacts], shares: &SplitShares) {
        for (it, message) in area::broken(facts, shares) {
            self.add("split-area", it, format!("{}: {message}", named(it)));
        }
    }

    fn add(&mut self, rule: &'static str, at: &FlightFacts, message: String) {
        self.found += 1;
        let kept = self.kept_by_rule.entry(rule).or_default();
        if *kept < KEPT {
            *kept += 1;
            self.kept.push(Leak { rule, trajectory_id: at.trajectory_id.clone(), message });
        }
    }
}

/// Finds everything that leaks between the splits of `facts`, which may be of several datasets.
pub fn lint(facts: &[FlightFacts], rules: &LintRules) -> Leaks {
    let mut leaks = Leaks::default();
    towns(facts, rules, &mut leaks);
    if rules.by_kind {
        kinds(facts, &mut leaks);
    }
    pedestrians(facts, &mut leaks);
    windows(facts, &mut leaks);
    routes(facts, rules, &mut leaks);
    leaks
}

/// Error that refuses to publish a dataset with leaks, with the pairs.
pub fn refusal(leaks: &Leaks) -> Option<Box<Diagnostic>> {
    if leaks.found == 0 {
        return None;
    }
    let pairs = if leaks.found == 1 { "a pair".to_owned() } else { format!("{} pairs", leaks.found) };
    let refusal = Diagnostic::new("dataset-leak", Fault::Recipe, format!("the splits leak: {pairs} across them"));
    let refusal = leaks.kept.iter().take(8).fold(refusal, |refusal, leak| refusal.because(leak));
    Some(refusal.hint(
        "lower `splits.max_route_overlap` or set `splits.overlap_direction = \"either\"` so that such walks stay together, give towns with the same ground plan the \
             same split in `splits.towns`, or put everything into one split",
    ))
}

/// Id and split of a flight in words, with the dataset where there are several.
fn named(it: &FlightFacts) -> String {
    let dataset = if it.dataset == 0 { String::new() } else { format!(" of dataset {}", it.dataset + 1) };
    format!("`{}`{dataset} in `{}`", it.trajectory_id, it.split)
}

/// Finds places under several names, or in several splits where the rules want one.
fn towns(facts: &[FlightFacts], rules: &LintRules, leaks: &mut Leaks) {
    let mut towns: BTreeMap<(&str, &str), BTreeMap<&str, &FlightFacts>> = BTreeMap::new();
    for it in facts {
        towns.entry((&it.layout.digest, &it.town)).or_default().entry(&it.split).or_insert(it);
    }
    let towns: Vec<((&str, &str), Vec<&FlightFacts>)> =
        towns.into_iter().map(|(key, splits)| (key, splits.into_values().collect())).collect();
    for (at, ((_, name), flights)) in towns.iter().enumerate() {
        if rules.by_town && flights.len() > 1 {
            let message = format!("town `{name}` is in two splits: {} and {}", named(flights[0]), named(flights[1]));
            leaks.add("split-town", flights[1], message);
        }
        for ((_, other), others) in &towns[at + 1..] {
            let likeness = flights[0].layout.likeness(&others[0].layout);
            let is_judged = rules.by_town || name != other;
            if !is_judged || !flights[0].layout.is_same_place(&others[0].layout) {
                continue;
            }
            let mut pairs = flights.iter().flat_map(|a| others.iter().map(move |b| (a, b)));
            if let Some((a, b)) = pairs.find(|(a, b)| a.split != b.split) {
                let alike = if a.layout.digest == b.layout.digest {
                    format!("have the same ground plan {}", a.layout.short())
                } else {
                    format!("have {:.0} % of their ground plan in common", 100.0 * likeness)
                };
                let message = format!("towns `{name}` and `{other}` {alike}: {} and {}", named(a), named(b));
                leaks.add("split-town", b, message);
            }
        }
    }
}

/// Finds kinds of places in several splits.
fn kinds(facts: &[FlightFacts], leaks: &mut Leaks) {
    let mut kinds: BTreeMap<&str, BTreeMap<&str, &FlightFacts>> = BTreeMap::new();
    for it in facts {
        kinds.entry(kind_of(&it.town)).or_default().entry(&it.split).or_insert(it);
    }
    for (kind, splits) in kinds {
        let mut flights = splits.into_values();
        let Some(first) = flights.next() else { continue };
        for it in flights {
            let message = format!("kind `{kind}` is in two splits: {} and {}", named(first), named(it));
            leaks.add("split-kind", it, message);
        }
    }
}

/// Finds split pedestrians, split twins and split groups.
fn pedestrians(facts: &[FlightFacts], leaks: &mut Leaks) {
    // Pedestrians of two towns may have the same id; names of groups contain the town.
    let mut first: BTreeMap<(usize, &str, &str, &str), &FlightFacts> = BTreeMap::new();
    let by_id: BTreeMap<(usize, &str), &FlightFacts> =
        facts.iter().map(|it| ((it.dataset, it.trajectory_id.as_str()), it)).collect();
    for it in facts {
        let mut is_apart = false;
        for (rule, what, place, name) in [
            ("split-pedestrian", "pedestrian", it.layout.digest.as_str(), &it.pedestrian_id),
            ("split-group", "group", "", &it.group),
        ] {
            let other = *first.entry((it.dataset, rule, place, name)).or_insert(it);
            if !is_apart && !name.is_empty() && other.split != it.split {
                is_apart = true;
                leaks.add(rule, it, format!("{what} `{name}` is in two splits: {} and {}", named(other), named(it)));
            }
        }
        let expert = it.expert_id.as_deref().and_then(|id| by_id.get(&(it.dataset, id)));
        if let Some(expert) = expert.filter(|expert| !is_apart && expert.split != it.split) {
            leaks.add("split-twin", it, format!("twins are apart: {} and its expert {}", named(it), named(expert)));
        }
    }
}

/// Whether two flights follow the same pedestrian; their separation is already reported by that rule.
fn is_one_walk(a: &FlightFacts, b: &FlightFacts) -> bool {
    (a.dataset, &a.layout.digest, &a.pedestrian_id) == (b.dataset, &b.layout.digest, &b.pedestrian_id)
}

/// Windows that are compared at a time: 64 MB of them.
const WINDOWS_AT_ONCE: u64 = 4_000_000;

impl Leaks {
    /// Adds equal windows of `size` frames in the flights of the datasets in `folders`. Memory is bounded: large datasets are
    /// read several times, each time for a part of the hashes.
    ///
    /// # Errors
    /// Damage of the datasets; the user stopped the work.
    pub fn of_windows(&mut self, facts: &[FlightFacts], folders: &[&Path], size: usize, stop: &Stop) -> Result<()> {
        let places: BTreeMap<(usize, &str), u32> =
            facts.iter().zip(0..).map(|(it, place)| ((it.dataset, it.trajectory_id.as_str()), place)).collect();
        let datasets: Vec<PublishedDataset> =
            folders.iter().map(|it| PublishedDataset::open(it)).collect::<Result<_>>()?;
        let frames: u64 = datasets.iter().flat_map(PublishedDataset::flights).map(|it| it.frames as u64).sum();
        let passes = frames.div_ceil(WINDOWS_AT_ONCE).max(1);
        let mut pairs = Pairs::new();
        for pass in 0..passes {
            let mut all: Vec<(u64, u32, u32)> = vec![];
            for (number, dataset) in datasets.iter().enumerate() {
                dataset.ways(&mut |id, poses, feet| {
                    let flight = dataset.place(id).map(|place| &dataset.flights()[place]);
                    stop.check("splits")?;
                    let Some((flight, place)) = flight.zip(places.get(&(number, id))) else { return Ok(()) };
                    let hashes = published_windows(flight, poses, feet, size).into_iter().zip(0..);
                    all.extend(
                        hashes.filter(|(hash, _)| hash % passes == pass).map(|(hash, frame)| (hash, *place, frame)),
                    );
                    Ok(())
                })?;
            }
            compare(&mut all, facts, &mut pairs);
        }
        self.add_windows(facts, pairs);
        Ok(())
    }

    fn add_windows(&mut self, facts: &[FlightFacts], pairs: Pairs) {
        for ((a, b), (frame_of_a, frame_of_b, count)) in pairs {
            let (a, b) = (&facts[a as usize], &facts[b as usize]);
            if is_one_walk(a, b) {
                continue;
            }
            let message = format!(
                "{} of {} {} of {}: from frame {frame_of_a} and from frame {frame_of_b} on",
                counted(count, "window"),
                named(a),
                if count == 1 { "is one" } else { "are windows" },
                named(b)
            );
            self.add("split-window", b, message);
        }
    }
}

/// Pairs of flights in different splits with equal windows: the first of each, and their number.
type Pairs = BTreeMap<(u32, u32), (u32, u32, usize)>;

/// Finds equal windows under two names.
fn windows(facts: &[FlightFacts], leaks: &mut Leaks) {
    let mut all: Vec<(u64, u32, u32)> = vec![];
    for (flight, it) in facts.iter().enumerate() {
        all.extend(it.windows.iter().enumerate().map(|(frame, hash)| (*hash, flight as u32, frame as u32)));
    }
    let mut pairs = Pairs::new();
    compare(&mut all, facts, &mut pairs);
    leaks.add_windows(facts, pairs);
}

/// Adds the pairs of equal windows: hash, flight, first frame.
fn compare(all: &mut [(u64, u32, u32)], facts: &[FlightFacts], pairs: &mut Pairs) {
    all.sort_unstable();
    for same in all.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() > 1) {
        // One flight of each split is enough to name a pair; all flights behind a walk share its windows.
        let mut of_split: BTreeMap<&str, (u32, u32)> = BTreeMap::new();
        for (_, flight, frame) in same {
            of_split.entry(&facts[*flight as usize].split).or_insert((*flight, *frame));
        }
        let of_split: Vec<(u32, u32)> = of_split.into_values().collect();
        for (at, (a, frame_of_a)) in of_split.iter().enumerate() {
            for (b, frame_of_b) in &of_split[at + 1..] {
                let pair = pairs.entry((*a, *b)).or_insert((*frame_of_a, *frame_of_b, 0));
                // Parts of the hashes come in any order of frames.
                (pair.0, pair.1) = (pair.0, pair.1).min((*frame_of_a, *frame_of_b));
                pair.2 += 1;
            }
        }
    }
}

/// Finds walks that repeat one another.
fn routes(facts: &[FlightFacts], rules: &LintRules, leaks: &mut Leaks) {
    let walks = Walks::of(facts);
    let found = walks.repeated(rules.max_route_overlap, rules.overlap_direction);
    leaks.found += found.found - found.kept.len();
    for (a, b, share) in found.kept {
        let (a, b) = (walks.flights[a], walks.flights[b]);
        let message = format!(
            "{} % of a walk is repeated in another split: {} and {}",
            (100.0 * share).round(),
            named(a),
            named(b)
        );
        leaks.add("split-route", b, message);
    }
}

/// Pairs of walks in two splits that lead over the same ground in opposite directions, which the rules do not forbid: more than
/// `rules.max_route_overlap` of one of them is repeated there or back. None where the rules forbid them.
pub fn ways_back(facts: &[FlightFacts], rules: &LintRules) -> Leaks {
    let mut notes = Leaks::default();
    if rules.overlap_direction == OverlapDirection::Either {
        return notes;
    }
    let walks = Walks::of(facts);
    let [same, either] = [OverlapDirection::Same, OverlapDirection::Either]
        .map(|counted| walks.repeated_at_most(rules.max_route_overlap, counted, usize::MAX));
    let known: BTreeSet<(usize, usize)> = same.kept.iter().map(|(a, b, _)| (*a, *b)).collect();
    for (a, b, share) in either.kept.into_iter().filter(|(a, b, _)| !known.contains(&(*a, *b))) {
        let (a, b) = (walks.flights[a], walks.flights[b]);
        let share = (100.0 * share).round();
        let message =
            format!("{share} % of a walk is walked the other way in another split: {} and {}", named(a), named(b));
        notes.add("split-way-back", b, message);
    }
    notes
}

/// One flight for each walk of each split.
struct Walks<'a> {
    flights: Vec<&'a FlightFacts>,
    /// Number of the place of each, and the number of its split.
    places: Vec<usize>,
    colours: Vec<u32>,
}

impl<'a> Walks<'a> {
    fn of(facts: &'a [FlightFacts]) -> Self {
        let mut places: Vec<&FlightFacts> = vec![];
        let mut place_of: BTreeMap<&str, usize> = BTreeMap::new();
        for it in facts {
            if !place_of.contains_key(it.layout.digest.as_str()) {
                let same = places.iter().position(|place| place.layout.is_same_place(&it.layout));
                place_of.insert(&it.layout.digest, same.unwrap_or(places.len()));
                places.extend(same.is_none().then_some(it));
            }
        }
        let mut flights: Vec<&FlightFacts> = vec![];
        let mut seen: BTreeSet<(usize, &str, &str)> = BTreeSet::new();
        for it in facts {
            if seen.insert((it.dataset, &it.pedestrian_id, &it.split)) {
                flights.push(it);
            }
        }
        let splits: BTreeSet<&str> = flights.iter().map(|it| it.split.as_str()).collect();
        let splits: BTreeMap<&str, u32> = splits.into_iter().zip(0..).collect();
        let places = flights.iter().map(|it| place_of[it.layout.digest.as_str()]).collect();
        let colours = flights.iter().map(|it| splits[it.split.as_str()]).collect();
        Self { flights, places, colours }
    }

    /// Pairs in two splits that repeat more than `least` of each other; the first ones are kept.
    fn repeated(&self, least: f64, counted: OverlapDirection) -> Overlaps {
        self.repeated_at_most(least, counted, KEPT)
    }

    fn repeated_at_most(&self, least: f64, counted: OverlapDirection, limit: usize) -> Overlaps {
        let given: Vec<(usize, &route::Route)> =
            self.places.iter().copied().zip(self.flights.iter().map(|it| &it.route)).collect();
        let is_judged = |a: usize, b: usize| !is_one_walk(self.flights[a], self.flights[b]);
        overlaps(&given, &self.colours, (least, counted), &is_judged, limit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::route::Route;
    use cosfly_frames::DVec3;
    use cosfly_schema::TownLayout;
    use std::sync::Arc;

    fn flight(id: &str, split: &str, street: f64) -> FlightFacts {
        let feet: Vec<DVec3> = (0..50).map(|k| DVec3::new(f64::from(k), street, 0.0)).collect();
        FlightFacts {
            dataset: 0,
            trajectory_id: format!("expert-{id}"),
            expert_id: None,
            pedestrian_id: id.into(),
            group: id.into(),
            split: split.into(),
            town: "north".into(),
            layout: Arc::new(TownLayout { digest: "ab".repeat(32), sketch: (0..64).collect() }),
            route: Route::of(&feet),
            windows: (0..40).map(|k| k + (street * 1000.0) as u64).collect(),
        }
    }

    const RULES: LintRules =
        LintRules { max_route_overlap: 0.5, overlap_direction: OverlapDirection::Same, by_town: false, by_kind: false };

    #[test]
    fn sound_splits_have_no_leak() {
        let facts = [flight("a", "train", 0.0), flight("b", "test", 40.0), flight("c", "train", 80.0)];
        assert_eq!(lint(&facts, &RULES), Leaks::default());
        assert!(refusal(&Leaks::default()).is_none());
    }

    #[test]
    fn the_way_back_in_another_split_is_counted_and_a_leak_where_the_rules_forbid_it() {
        let (there, beside) = (flight("a", "train", 0.0), flight("c", "test", 80.0));
        let feet: Vec<DVec3> = (0..50).rev().map(|k| DVec3::new(f64::from(k), 1.0, 0.0)).collect();
        let back = FlightFacts { route: Route::of(&feet), ..flight("b", "test", 1.0) };
        let facts = [there, back.clone(), beside];
        assert_eq!(lint(&facts, &RULES).found, 0);
        let notes = ways_back(&facts, &RULES);
        assert_eq!((notes.found, notes.kept[0].rule), (1, "split-way-back"));
        assert!(notes.kept[0].message.contains("100 % of a walk is walked the other way"), "{}", notes.kept[0]);
        let forbidden = LintRules { overlap_direction: OverlapDirection::Either, ..RULES };
        let found = lint(&facts, &forbidden);
        assert_eq!(found.kept.iter().map(|leak| leak.rule).collect::<Vec<_>>(), ["split-route"]);
        assert_eq!(ways_back(&facts, &forbidden), Leaks::default());
        // In one split it is no leak.
        let together = [flight("a", "test", 0.0), back];
        assert_eq!((lint(&together, &forbidden).found, ways_back(&together, &RULES).found), (0, 0));
        assert!(refusal(&found).unwrap().hints[0].contains("overlap_direction"));
    }

    #[test]
    fn every_planted_leak_is_named() {
        let (a, b) = (flight("a", "train", 0.0), flight("b", "test", 40.0));
        let renamed = FlightFacts { town: "south".into(), ..b.clone() };
        let mut edited = renamed.clone();
        let sketch = (0..64).map(|k| if k < 20 { -1 } else { k }).collect();
        edited.layout = Arc::new(TownLayout { digest: "cd".repeat(32), sketch });
        let same_pedestrian = FlightFacts { pedestrian_id: "a".into(), ..b.clone() };
        let same_group = FlightFacts { group: "a".into(), ..b.clone() };
        let twin = FlightFacts { expert_id: Some("expert-a".into()), ..b.clone() };
        let same_windows = FlightFacts { windows: a.windows[5..].to_vec(), ..b.clone() };
        let same_way = FlightFacts { route: flight("b", "", 1.0).route, ..b.clone() };
        for (other, rule, said) in [
            (renamed, "split-town", "towns `north` and `south` have the same ground plan abababababab"),
            (edited, "split-town", "have 69 % of their ground plan in common"),
            (same_pedestrian, "split-pedestrian", "pedestrian `a` is in two splits: `expert-a` in `train`"),
            (same_group, "split-group", "`expert-b` in `test`"),
            (twin, "split-twin", "`expert-b` in `test` and its expert `expert-a` in `train`"),
            (same_windows, "split-window", "from frame 0 and from frame 5 on"),
            (same_way, "split-route", "100 % of a walk"),
        ] {
            let found = lint(&[a.clone(), other], &RULES);
            assert_eq!(found.kept.iter().map(|leak| leak.rule).collect::<Vec<_>>(), [rule], "{found:?}");
            assert!(found.kept[0].message.contains(said), "{}", found.kept[0]);
            assert!(refusal(&found).unwrap().to_string().contains("splits leak"));
        }
        let by_town = LintRules { by_town: true, ..RULES };
        assert_eq!(lint(&[a.clone(), b.clone()], &by_town).kept[0].rule, "split-town");
        let by_kind = LintRules { by_kind: true, ..RULES };
        let mut another = FlightFacts { town: "north_2".into(), ..b };
        another.layout = Arc::new(TownLayout { digest: "cd".repeat(32), sketch: vec![-1; 64] });
        let found = lint(&[a.clone(), another.clone()], &by_kind);
        assert!(found.kept[0].message.starts_with("kind `north` is in two splits"), "{found:?}");
        another.split = a.split.clone();
        assert_eq!(lint(&[a, another], &by_kind).found, 0);
    }
}
