//! Areas of towns: cuts of the map by straight lines with guard bands, so that the walks of two splits are apart.
//!
//! A walk belongs to an area when all of it is at least half a guard band away from the area's lines; walks that enter a
//! band are left out. They cannot go to `train` instead: they would cover ground of the area behind the band.

use super::facts::FlightFacts;
use super::places::Places;
use super::route::Route;
use cosfly_frames::Seed;
use cosfly_schema::Split;
use cosfly_schema::config::{AreaCut, CutAxis, SplitBy, SplitShares};
use std::collections::BTreeMap;

/// Smallest distance between two lines that are tried, metres.
const STEP_M: f64 = 8.0;
/// Most lines that are tried.
const MOST_LINES: usize = 128;
/// Loss of all flights against a difference of 1 between shares.
const LEFT_OUT_WEIGHT: f64 = 0.5;

/// Smallest and largest coordinate of a walk along an axis, metres.
type Span = [f64; 2];

/// The shares with areas for all towns without named ones; the shares themselves for other units.
///
/// Lines are multiples of 8 m, and the axis is that of the longer side of all walks, so that few more flights seldom move
/// a line; named areas never move.
pub fn resolved(facts: &[FlightFacts], shares: &SplitShares) -> SplitShares {
    let mut shares = shares.clone();
    if shares.by != SplitBy::Area {
        return shares;
    }
    let places = Places::of(facts, &shares);
    let mut walks: BTreeMap<(usize, &str), [Span; 2]> = BTreeMap::new();
    let mut towns: BTreeMap<&str, usize> = BTreeMap::new();
    for (it, place) in facts.iter().zip(&places.of_flight) {
        towns.entry(&it.town).or_insert(*place);
        if let Some(extent) = it.route.extent_m {
            let whole = walks.entry((*place, &it.pedestrian_id)).or_insert(extent);
            for (span, more) in whole.iter_mut().zip(extent) {
                *span = [span[0].min(more[0]), span[1].max(more[1])];
            }
        }
    }
    for (town, place) in towns {
        let is_named = places.all[place].split.is_some() || shares.areas.contains_key(town);
        if !is_named {
            let of_place = walks.range((place, "")..(place + 1, "")).map(|(_, extent)| *extent);
            let cut = cut(&of_place.collect::<Vec<_>>(), &shares, &places.all[place].name);
            shares.areas.insert(town.to_owned(), cut);
        }
    }
    shares
}

/// The split of the area that holds the whole walk; `None` for walks in a guard band, and without a position.
pub fn split_of(cut: &AreaCut, guard_m: f64, route: &Route) -> Option<Split> {
    let [low, high] = route.extent_m?[cut.axis as usize];
    let holds = |at: &usize| {
        let after = *at == 0 || low >= cut.at_m[at - 1] + 0.5 * guard_m;
        after && cut.at_m.get(*at).is_none_or(|line| high <= line - 0.5 * guard_m)
    };
    (0..cut.splits.len()).find(holds).map(|at| cut.splits[at])
}

/// Why each flight is left out of the dataset, if so. The shares are [`resolved`] ones.
pub fn left_out(facts: &[FlightFacts], shares: &SplitShares) -> Vec<Option<String>> {
    facts.iter().map(|it| problem(it, shares).filter(|_| !shares.towns.contains_key(&it.town))).collect()
}

/// Why no area holds the walk of a flight, if so.
fn problem(it: &FlightFacts, shares: &SplitShares) -> Option<String> {
    if shares.by != SplitBy::Area {
        return None;
    }
    let cut = shares.areas.get(&it.town)?;
    if it.route.extent_m.is_none() {
        return Some("its walk has no position in any area".into());
    }
    split_of(cut, shares.guard_m, &it.route).is_none().then(|| {
        // The same text for all flights of a town: reports count equal reasons.
        let (axis, lines) = (["x", "y"][cut.axis as usize], &cut.at_m);
        format!("its walk enters a guard band of {} m between areas of splits: {axis} = {lines:?} m", shares.guard_m)
    })
}

/// Flights in another split than their area's, with the problem in words. The shares are those of `splits.json`.
pub fn broken<'a>(
    facts: &'a [FlightFacts],
    shares: &'a SplitShares,
) -> impl Iterator<Item = (&'a FlightFacts, String)> {
    let judged = facts.iter().filter(|it| shares.by == SplitBy::Area && !shares.towns.contains_key(&it.town));
    judged.filter_map(|it| {
        let cut = shares.areas.get(&it.town)?;
        match split_of(cut, shares.guard_m, &it.route) {
            Some(split) if split.name() == it.split => None,
            Some(split) => {
                Some((it, format!("it is in `{}`; its walk is in the area of `{}`", it.split, split.name())))
            }
            None => Some((it, problem(it, shares)?)),
        }
    })
}

/// The cut with the smallest loss: differences of shares, and flights left out. The areas are in the order of the splits or
/// in the reverse order, drawn from the place.
fn cut(walks: &[[Span; 2]], shares: &SplitShares, place: &str) -> AreaCut {
    let asked: Vec<(Split, f64)> =
        Split::ALL.into_iter().zip(shares.asked()).filter(|(_, share)| *share > 0.0).collect();
    let side = |axis: usize| {
        let low = walks.iter().map(|walk| walk[axis][0]).fold(f64::INFINITY, f64::min);
        walks.iter().map(|walk| walk[axis][1]).fold(low, f64::max) - low
    };
    let axis = if side(1) > side(0) { CutAxis::Y } else { CutAxis::X };
    let spans: Vec<Span> = walks.iter().map(|walk| walk[axis as usize]).collect();
    let is_reversed = Seed::of_item(shares.seed, "area", place).stream("area").unit() < 0.5;
    let asked: Vec<(Split, f64)> = if is_reversed { asked.into_iter().rev().collect() } else { asked };
    let held = Held::of(&spans, shares.guard_m);
    let shares: Vec<f64> = asked.iter().map(|(_, share)| *share).collect();
    let at_m = held.best(&shares).into_iter().map(|line| held.lines_m[line]).collect();
    AreaCut { axis, splits: asked.into_iter().map(|(split, _)| split).collect(), at_m }
}

/// Numbers of walks between any two lines.
struct Held {
    lines_m: Vec<f64>,
    /// By the number of the first line plus 1, 0 without one, and of the last line, their number without one.
    between: Vec<Vec<u32>>,
    all: usize,
}

impl Held {
    fn of(spans: &[Span], guard_m: f64) -> Self {
        let low = spans.iter().map(|span| span[0]).fold(f64::INFINITY, f64::min);
        let high = spans.iter().map(|span| span[1]).fold(low, f64::max);
        let mut step_m = STEP_M;
        while (high - low) / step_m > MOST_LINES as f64 - 2.0 && step_m < 1e9 {
            step_m *= 2.0;
        }
        let first = if low.is_finite() { (low / step_m).floor() } else { 0.0 };
        let count = if low.is_finite() { ((high - low) / step_m).ceil() as usize + 2 } else { 2 };
        let lines_m: Vec<f64> = (0..count).map(|line| (first + line as f64) * step_m).collect();
        let half_m = 0.5 * guard_m;
        let mut between = vec![vec![0u32; count + 1]; count + 1];
        for [low, high] in spans {
            let after = lines_m.partition_point(|line| line + half_m <= *low);
            let before = lines_m.partition_point(|line| line - half_m < *high);
            between[after][before] += 1;
        }
        // From numbers of walks with these lines to numbers of walks between lines.
        for from in (0..=count).rev() {
            for to in 0..=count {
                let further = if from < count { between[from + 1][to] } else { 0 };
                let nearer = if to > 0 { between[from][to - 1] } else { 0 };
                let both = if from < count && to > 0 { between[from + 1][to - 1] } else { 0 };
                between[from][to] += further + nearer - both;
            }
        }
        Self { lines_m, between, all: spans.len() }
    }

    /// Numbers of the lines between areas with the given shares, in ascending order.
    fn best(&self, shares: &[f64]) -> Vec<usize> {
        let lines = self.lines_m.len();
        let candidates: Vec<Vec<usize>> = match shares.len() {
            0 | 1 => vec![vec![]],
            2 => (0..lines).map(|line| vec![line]).collect(),
            _ => (0..lines).flat_map(|a| (a + 1..lines).map(move |b| vec![a, b])).collect(),
        };
        let loss = |cut: &Vec<usize>| {
            let end = |at: usize| cut.get(at).copied().unwrap_or(lines);
            let start = |at: usize| if at == 0 { 0 } else { cut[at - 1] + 1 };
            let held: Vec<f64> = (0..shares.len()).map(|at| f64::from(self.between[start(at)][end(at)])).collect();
            let kept = held.iter().sum::<f64>().max(1.0);
            let differences: f64 = held.iter().zip(shares).map(|(held, share)| (held / kept - share).abs()).sum();
            let empty = held.iter().filter(|held| **held == 0.0).count() as f64;
            empty + differences + LEFT_OUT_WEIGHT * (1.0 - kept / self.all.max(1) as f64)
        };
        let mut best = (f64::INFINITY, vec![]);
        for cut in candidates {
            let loss = loss(&cut);
            if loss < best.0 {
                best = (loss, cut);
            }
        }
        best.1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assign::assign;
    use crate::facts::fixture::behind;
    use crate::leaks::{LintRules, lint};
    use cosfly_frames::DVec3;

    /// Walks in a dense town of 600 by 300 m: anywhere, 20 to 80 m long, along x or y.
    fn dense_town(count: usize) -> Vec<FlightFacts> {
        let walk = |id: usize| {
            let mut random = Seed::of_item(7, "walk", &id.to_string()).stream("walk");
            let from = DVec3::new((random.unit() * 520.0 / 6.0).floor() * 6.0, random.unit() * 220.0, 0.0);
            let along = if random.unit() < 0.5 { DVec3::X } else { DVec3::Y };
            let length = 20.0 + 60.0 * random.unit();
            let feet: Vec<DVec3> = (0..40).map(|k| from + along * (length * f64::from(k) / 39.0)).collect();
            behind(id, &feet)
        };
        (0..count).map(walk).collect()
    }

    fn by_area() -> SplitShares {
        SplitShares { by: SplitBy::Area, ..SplitShares::default() }
    }

    #[test]
    fn a_dense_town_has_all_shares_and_no_leak_by_area() {
        let facts = dense_town(3000);
        let shares = resolved(&facts, &by_area());
        let out = left_out(&facts, &shares);
        let kept: Vec<FlightFacts> =
            facts.iter().zip(&out).filter(|(_, why)| why.is_none()).map(|it| it.0.clone()).collect();
        assert!(kept.len() > 2200, "{} of 3000: {shares:?}", kept.len());
        let assignment = assign(&kept, &shares);
        for (split, share) in Split::ALL.into_iter().zip(shares.asked()) {
            let reached = assignment.splits.iter().filter(|it| **it == split).count() as f64 / kept.len() as f64;
            assert!((reached - share).abs() < 0.03, "{split:?}: {reached}");
        }
        let mut kept = kept;
        for ((it, split), group) in kept.iter_mut().zip(&assignment.splits).zip(&assignment.groups) {
            (it.split, it.group) = (split.name().to_owned(), group.clone());
        }
        let strict = LintRules { max_route_overlap: 0.0, ..LintRules::of_shares(&shares) };
        assert_eq!(lint(&kept, &strict).found, 0);
        assert_eq!(broken(&kept, &shares).count(), 0);
        kept[0].split = if kept[0].split == "train" { "test".into() } else { "train".into() };
        assert_eq!(broken(&kept, &shares).count(), 1);
        // Every two walks of different splits are a guard band apart.
        let cut = &shares.areas["town"];
        let span = |it: &FlightFacts| it.route.extent_m.unwrap()[cut.axis as usize];
        for a in &kept[1..200] {
            for b in kept[1..].iter().filter(|b| b.split != a.split) {
                let ([a_low, a_high], [b_low, b_high]) = (span(a), span(b));
                assert!(a_low - b_high >= shares.guard_m || b_low - a_high >= shares.guard_m);
            }
        }
    }

    #[test]
    fn named_areas_stay_and_few_more_walks_move_few_old_ones() {
        let all = dense_town(3000);
        let before = resolved(&all[..2900], &by_area());
        let named = SplitShares { areas: before.areas.clone(), ..by_area() };
        assert_eq!(resolved(&all, &named), named);
        let (old, new) = (assign(&all[..2900], &named), assign(&all, &named));
        assert_eq!(old.splits, new.splits[..2900]);
        let after = resolved(&all, &by_area());
        let moved = |it: &&FlightFacts| {
            let of = |shares: &SplitShares| split_of(&shares.areas["town"], shares.guard_m, &it.route);
            of(&before) != of(&after)
        };
        assert!(all[..2900].iter().filter(moved).count() < 300);
    }

    #[test]
    fn areas_need_no_walks_and_no_third_share() {
        assert!(resolved(&[], &by_area()).areas.is_empty());
        let mut standing = dense_town(3);
        standing.iter_mut().for_each(|it| it.route = Route::default());
        let shares = resolved(&standing, &by_area());
        assert!(left_out(&standing, &shares).iter().all(Option::is_some));
        let two = SplitShares { val: 0.0, ..by_area() };
        let shares = resolved(&dense_town(300), &two);
        assert_eq!((shares.areas["town"].at_m.len(), shares.areas["town"].splits.len()), (1, 2));
    }
}
