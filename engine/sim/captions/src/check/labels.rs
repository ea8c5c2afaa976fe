//! Labels of values: which fact each number and each colour of a text speaks of.
//!
//! A text that states several facts of one family (lengths, times, counts, colours) states each of them once. So where one value of a
//! family seems to stand at a wrong place, and the fact that it equals is stated nowhere else, the place was misread.

use super::agreement::states_the_walk;
use crate::facts::Facts;
use crate::precision::{DISTANCE_STEP_M, STOP_STEP_S, duration_step_s, is_step, way_step_m};
use cosfly_claims::Claim;

/// A value of a family: the place that the text names, if any, and the places of all facts that the value equals.
struct Value {
    claim: usize,
    place: Option<usize>,
    fits: Vec<usize>,
}

impl Value {
    fn new(claim: usize, place: Option<usize>, fits: impl Iterator<Item = bool>) -> Self {
        Self { claim, place, fits: fits.enumerate().filter_map(|(place, fits)| fits.then_some(place)).collect() }
    }

    fn is_misplaced(&self) -> bool {
        self.place.is_some_and(|place| !self.fits.contains(&place))
    }
}

/// The claims, in which a single misplaced value of a family names no place any more.
pub(super) fn relabelled(mut claims: Vec<Claim>, facts: &Facts) -> Vec<Claim> {
    for family in [lengths, times, counts, colours] {
        let values = family(&claims, facts);
        if let Some(misread) = misread(&values) {
            misread.iter().for_each(|at| claims[*at] = without_place(&claims[*at]));
        }
    }
    claims
}

/// Claims of the only misplaced value, where no other value equals the fact that it does.
fn misread(values: &[Value]) -> Option<Vec<usize>> {
    let first = values.iter().find(|it| it.is_misplaced())?;
    let (same, others): (Vec<&Value>, Vec<&Value>) = values.iter().partition(|it| it.fits == first.fits);
    let is_free = |place: &usize| !others.iter().any(|other| other.fits.contains(place));
    let holds = first.fits.iter().any(is_free)
        && same.iter().all(|it| it.is_misplaced())
        && !others.iter().any(|it| it.is_misplaced());
    holds.then(|| same.iter().map(|it| it.claim).collect())
}

/// Distance, height and way.
fn lengths(claims: &[Claim], facts: &Facts) -> Vec<Value> {
    let known = [
        (facts.distance_m, DISTANCE_STEP_M),
        (facts.altitude_m, DISTANCE_STEP_M),
        (facts.way_m, way_step_m(facts.way_m)),
    ];
    let known = &known[..2 + usize::from(facts.walks)];
    let value = |(at, claim): (usize, &Claim)| {
        let (place, found) = match *claim {
            Claim::Distance(found) => (Some(0), found),
            Claim::Altitude(found) => (Some(1), found),
            Claim::Way(found) => (Some(2), found),
            Claim::Metres(found) => (None, found),
            _ => return None,
        };
        Some(Value::new(at, place, known.iter().map(|(fact, step)| is_step(found, *fact, *step))))
    };
    claims.iter().enumerate().filter_map(value).collect()
}

/// The whole time, and the time of all pauses. Without a word of a walk, a time of standing may be what the text is about.
fn times(claims: &[Claim], facts: &Facts) -> Vec<Value> {
    if !states_the_walk(claims, facts) {
        return vec![];
    }
    let known = [(facts.duration_s, duration_step_s(facts.duration_s)), (facts.standing_s(), STOP_STEP_S)];
    let value = |(at, claim): (usize, &Claim)| {
        let (place, found) = match *claim {
            Claim::Duration(found) => (Some(0), found),
            Claim::Standing(found) => (Some(1), found),
            Claim::StandsFor(found) | Claim::Seconds(found) => (None, found),
            _ => return None,
        };
        Some(Value::new(at, place, known.iter().map(|(fact, step)| is_step(found, *fact, *step))))
    };
    claims.iter().enumerate().filter_map(value).collect()
}

/// Stops and turns; a list of turns states their number.
fn counts(claims: &[Claim], facts: &Facts) -> Vec<Value> {
    let known = [facts.stops.len(), facts.turns.len()];
    let value = |(at, claim): (usize, &Claim)| {
        let (place, found) = match *claim {
            Claim::Stops(found) => (Some(0), found),
            Claim::Turns(found) => (Some(1), found),
            Claim::Times(found) => (None, found),
            Claim::Turn(_) | Claim::TurnsOf(..) | Claim::NoTurns => (None, known[1]),
            _ => return None,
        };
        let is_list = matches!(claim, Claim::Turn(_) | Claim::TurnsOf(..) | Claim::NoTurns);
        let fits =
            known.iter().enumerate().map(|(place, fact)| found > 0 && found == *fact && !(is_list && place == 0));
        Some(Value::new(at, place, fits))
    };
    claims.iter().enumerate().filter_map(value).collect()
}

/// Colours of top and trousers.
fn colours(claims: &[Claim], facts: &Facts) -> Vec<Value> {
    let Some(wear) = facts.wear else { return vec![] };
    let value = |(at, claim): (usize, &Claim)| {
        let (place, found) = match *claim {
            Claim::Top(found) => (Some(0), found),
            Claim::Trousers(found) => (Some(1), found),
            Claim::Wears(found) => (None, found),
            _ => return None,
        };
        Some(Value::new(at, place, [wear.top, wear.trousers].into_iter().map(|it| it == found)))
    };
    claims.iter().enumerate().filter_map(value).collect()
}

fn without_place(claim: &Claim) -> Claim {
    match *claim {
        Claim::Distance(value) | Claim::Altitude(value) | Claim::Way(value) => Claim::Metres(value),
        Claim::Duration(value) | Claim::Standing(value) => Claim::Seconds(value),
        Claim::Stops(count) | Claim::Turns(count) => Claim::Times(count),
        Claim::Top(colour) | Claim::Trousers(colour) => Claim::Wears(colour),
        ref other => other.clone(),
    }
}
