//! Claims of a text against facts of the trajectory.

use super::agreement::{is_list_of, is_of_weight, listed, may_have, states_the_walk};
use super::clothes::clothes_mismatch;
use super::slot::{Slot, SlotMismatch};
use crate::facts::{Facts, LATE_S, LATE_SHARE, SOON_S, SOON_SHARE};
use crate::precision::{
    DISTANCE_STEP_M, PITCH_STEP_DEG, SPEED_STEP_MPS, STOP_STEP_S, duration_step_s, is_step, way_step_m,
};
use cosfly_claims::Claim;
use cosfly_claims::TurnKind;
use std::fmt;

/// All disagreements of claims with the facts, in the order of the text; missing slots come last.
pub(super) fn mismatches(claims: &[Claim], facts: &Facts) -> Vec<SlotMismatch> {
    let mut checker = Checker { facts, mismatches: vec![] };
    checker.directions(claims);
    for claim in claims.iter().filter(|claim| is_of_weight(claim, claims, facts)) {
        checker.claim(claim, claims);
    }
    checker.turns(claims);
    checker.pair_of_colours(claims);
    checker.required(claims);
    checker.mismatches
}

/// A turn this much beside the limits of soon and late may be either, seconds.
const BORDER_S: f64 = 2.0;

struct Checker<'a> {
    facts: &'a Facts,
    mismatches: Vec<SlotMismatch>,
}

impl Checker<'_> {
    fn expect(&mut self, holds: bool, slot: Slot, found: impl fmt::Display, expected: impl fmt::Display) {
        if !holds {
            self.mismatches.push(SlotMismatch { slot, found: found.to_string(), expected: expected.to_string() });
        }
    }

    /// A stated number is the fact, to its step.
    fn number(&mut self, slot: Slot, found: f64, fact: f64, step: f64) {
        self.expect(is_step(found, fact, step), slot, found, format_args!("{fact:.2}"));
    }

    /// A stated number that may be one of several facts is one of them.
    fn one_of(&mut self, slot: Slot, found: f64, facts: &[(f64, f64)]) {
        let fits = facts.iter().any(|(fact, step)| is_step(found, *fact, *step));
        let expected: Vec<String> = facts.iter().map(|(fact, _)| format!("{fact:.2}")).collect();
        self.expect(fits, slot, found, expected.join("` or `"));
    }

    /// Two colours without garments are those of the top and the trousers, in any order.
    fn pair_of_colours(&mut self, claims: &[Claim]) {
        let Some(wear) = &self.facts.wear else { return };
        let is_garment = |claim: &Claim| matches!(claim, Claim::Top(_) | Claim::Trousers(_) | Claim::Shade { .. });
        let worn = claims.iter().filter_map(|claim| match claim {
            Claim::Wears(colour) => Some(colour.name()),
            _ => None,
        });
        if let ([one, other], false) = (&worn.collect::<Vec<_>>()[..], claims.iter().any(is_garment)) {
            let expected = [wear.top.name(), wear.trousers.name()];
            let holds = [*one, *other] == expected || [*other, *one] == expected;
            self.expect(holds, Slot::Clothes, format_args!("{one}, {other}"), expected.join(", "));
        }
    }

    fn directions(&mut self, claims: &[Claim]) {
        let stated = claims.iter().filter_map(|claim| match claim {
            Claim::Direction(direction) => Some(*direction),
            _ => None,
        });
        for (place, direction) in stated.enumerate() {
            let expected = match place {
                0 => self.facts.start_direction,
                _ => self.facts.end_direction,
            };
            self.expect(direction == expected && place < 2, Slot::Direction, direction.english(), expected.english());
        }
    }

    fn claim(&mut self, claim: &Claim, claims: &[Claim]) {
        let facts = self.facts;
        match *claim {
            Claim::Top(_)
            | Claim::Trousers(_)
            | Claim::Backpack
            | Claim::NoBackpack
            | Claim::Wears(_)
            | Claim::Shade { .. } => {
                self.mismatches.extend(facts.wear.as_ref().and_then(|wear| clothes_mismatch(claim, wear)));
            }
            Claim::Stops(count) => self.expect(count == facts.stops.len(), Slot::Stops, count, facts.stops.len()),
            Claim::Times(count) => {
                let holds = [facts.stops.len(), facts.turns.len()].contains(&count);
                self.expect(holds, Slot::Stops, count, facts.stops.len());
            }
            Claim::SomeStops => self.expect(!facts.stops.is_empty(), Slot::Stops, "some", 0),
            Claim::Turns(count) => {
                self.expect(may_have(count, None, facts), Slot::Turns, count, facts.turns.len());
            }
            Claim::NoTurns => self.expect(facts.turns.is_empty(), Slot::Turns, 0, facts.turns.len()),
            Claim::Straight => {
                let expected = if facts.bends { "bends" } else { "turns" };
                self.expect(facts.turns.is_empty() && !facts.bends, Slot::Turns, "straight", expected);
            }
            Claim::TurnsOf(kind, count) => {
                let holds = may_have(count, Some(kind), facts);
                self.expect(holds, Slot::Turns, format_args!("{count} {kind:?}"), facts.turns_of(kind));
            }
            Claim::TurnsSoon | Claim::TurnsLate => self.time_of_turn(*claim == Claim::TurnsSoon),
            Claim::StopFirst(first) => self.order_of_stop_and_turn(first),
            Claim::Stays => self.expect(!facts.walks, Slot::Walking, "stands", "walks"),
            Claim::Unknown(ref words) => {
                // `take 4`: a number without a unit may be any number of the flight.
                let end = words.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(words.len());
                let holds = words[..end].parse().is_ok_and(|value| is_any_number(value, facts));
                self.expect(holds, Slot::Number, words, "nothing of the kind");
            }
            Claim::Direction(_) | Claim::Turn(_) | Claim::PerhapsTurn(_) => {}
            _ => self.measure(claim, claims),
        }
    }

    /// A number with a unit.
    fn measure(&mut self, claim: &Claim, claims: &[Claim]) {
        let facts = self.facts;
        let whole = (facts.duration_s, duration_step_s(facts.duration_s));
        let standing = (facts.standing_s(), STOP_STEP_S);
        let way = (facts.way_m, way_step_m(facts.way_m));
        match *claim {
            Claim::Distance(found) => self.number(Slot::Distance, found, facts.distance_m, DISTANCE_STEP_M),
            Claim::Altitude(found) => self.number(Slot::Altitude, found, facts.altitude_m, DISTANCE_STEP_M),
            Claim::Pitch(found) => self.number(Slot::Pitch, found, facts.pitch_down_deg, PITCH_STEP_DEG),
            Claim::Tilt(found) => self.number(Slot::Pitch, found, facts.pitch_down_deg.abs(), PITCH_STEP_DEG),
            Claim::Way(found) => self.number(Slot::Way, found, way.0, way.1),
            Claim::Metres(found) => {
                let places = [(facts.distance_m, DISTANCE_STEP_M), (facts.altitude_m, DISTANCE_STEP_M), way];
                self.one_of(Slot::Distance, found, &places[..2 + usize::from(facts.walks)]);
            }
            Claim::Speed(found) => self.number(Slot::Speed, found, facts.walking_speed_mps, SPEED_STEP_MPS),
            Claim::Duration(found) => self.number(Slot::Duration, found, whole.0, whole.1),
            Claim::Standing(found) if !facts.walks => self.number(Slot::Duration, found, whole.0, whole.1),
            Claim::Standing(found) => self.number(Slot::Standing, found, standing.0, standing.1),
            Claim::Seconds(found) => self.one_of(Slot::Duration, found, &[whole, standing]),
            Claim::StandsFor(found) if !facts.walks => self.number(Slot::Duration, found, whole.0, whole.1),
            Claim::StandsFor(found) if states_the_walk(claims, facts) => {
                self.one_of(Slot::Standing, found, &[whole, standing]);
            }
            Claim::StandsFor(found) => self.number(Slot::Standing, found, standing.0, standing.1),
            _ => {}
        }
    }

    /// The first turn comes soon, or late; judged a little wider than it is said.
    fn time_of_turn(&mut self, is_soon: bool) {
        let facts = self.facts;
        let first = facts.turns.first().map_or(u32::MAX, |turn| turn.frame);
        let may_be_first = facts.doubtful_turns.iter().chain(&facts.turns).filter(|turn| turn.frame <= first);
        let times_s = || may_be_first.clone().map(|turn| f64::from(turn.frame) * facts.dt_s);
        let holds = match is_soon {
            _ if facts.dt_s == 0.0 => true,
            true => times_s().any(|it| it <= SOON_S.min(SOON_SHARE * facts.duration_s) + BORDER_S),
            false => times_s().any(|it| it >= LATE_S.max(LATE_SHARE * facts.duration_s) - BORDER_S),
        };
        let times: Vec<String> = times_s().map(|it| format!("{it:.0} s")).collect();
        let said = if is_soon { "turns soon" } else { "turns late" };
        self.expect(holds, Slot::Turns, said, format_args!("{} of {:.0} s", times.join(", "), facts.duration_s));
    }

    fn order_of_stop_and_turn(&mut self, first: bool) {
        let known = match (&self.facts.stops[..], &self.facts.turns[..]) {
            ([stop], [turn]) => Some(stop.frame < turn.frame),
            _ => None,
        };
        let words = |first| if first { "a stop before the turn" } else { "a stop after the turn" };
        let expected = known.map_or("another order", words);
        self.expect(known == Some(first), Slot::Turns, words(first), expected);
    }

    /// A list of turns is the whole list; counts by side leave no side out.
    fn turns(&mut self, claims: &[Claim]) {
        let listed = listed(claims);
        let expected: Vec<TurnKind> = self.facts.turns.iter().map(|turn| turn.kind).collect();
        let holds = listed.is_empty() || is_list_of(claims, self.facts);
        self.expect(holds, Slot::Turns, format_args!("{listed:?}"), format_args!("{expected:?}"));
        let counts = claims.iter().filter_map(|claim| match claim {
            Claim::TurnsOf(_, count) => Some(*count),
            _ => None,
        });
        let (sides, sum) = counts.fold((0, 0), |(sides, sum), count| (sides + 1, sum + count));
        self.expect(sides == 0 || may_have(sum, None, self.facts), Slot::Turns, sum, expected.len());
    }

    fn required(&mut self, claims: &[Claim]) {
        let facts = self.facts;
        let is_distance = |claim: &Claim| match claim {
            Claim::Distance(_) => true,
            Claim::Metres(found) => is_step(*found, facts.distance_m, DISTANCE_STEP_M),
            _ => false,
        };
        self.expect(claims.iter().any(is_distance), Slot::Distance, "", facts.distance_m);
        let is_pitch = |claim: &Claim| matches!(claim, Claim::Pitch(_) | Claim::Tilt(_));
        self.expect(claims.iter().any(is_pitch), Slot::Pitch, "", facts.pitch_down_deg);
        // `Follow the walking person, who stands still` is none of both.
        let stays = claims.iter().any(|claim| matches!(claim, Claim::Stays | Claim::StandsFor(_)));
        let walks = claims.contains(&Claim::Walks) && !stays;
        self.expect(facts.walks || !walks, Slot::Walking, "walks", "stands");
    }
}

/// Whether a number is one of the flight's, whatever its unit.
fn is_any_number(value: f64, facts: &Facts) -> bool {
    let measures = [
        (facts.distance_m, DISTANCE_STEP_M),
        (facts.altitude_m, DISTANCE_STEP_M),
        (facts.pitch_down_deg.abs(), PITCH_STEP_DEG),
        (facts.way_m, way_step_m(facts.way_m)),
        (facts.walking_speed_mps, SPEED_STEP_MPS),
        (facts.duration_s, duration_step_s(facts.duration_s)),
        (facts.standing_s(), STOP_STEP_S),
    ];
    let counts = [facts.stops.len(), facts.turns.len()];
    measures.iter().any(|(fact, step)| is_step(value, *fact, *step)) || counts.iter().any(|it| *it as f64 == value)
}
