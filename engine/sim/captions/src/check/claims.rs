//! Claims of a text against facts of the trajectory.

use super::clothes::clothes_mismatch;
use super::slot::{Slot, SlotMismatch};
use super::turns::{is_list_of, may_have};
use crate::facts::{Facts, LATE_S, LATE_SHARE, LEAST_STOP_S, LeftOut, SOON_S, SOON_SHARE, running_mps};
use crate::precision::{
    DISTANCE_STEP_M, PITCH_STEP_DEG, SPEED_STEP_MPS, STOP_STEP_S, duration_step_s, is_step, way_step_m,
};
use cosfly_claims::{Claim, TurnKind};
use std::fmt;

/// All disagreements of claims with the facts, in the order of the text; missing slots come last.
pub(super) fn mismatches(claims: &[Claim], facts: &Facts) -> Vec<SlotMismatch> {
    let mut checker = Checker { facts, mismatches: vec![] };
    checker.directions(claims);
    // `straight on, then turns left`: a list of turns says more.
    let turns = claims.iter().any(|it| matches!(it, Claim::Turn(_) | Claim::Turns(_)));
    claims.iter().filter(|it| !turns || **it != Claim::Straight).for_each(|it| checker.claim(it));
    checker.turns(claims);
    checker.required(claims);
    checker.mismatches
}

/// A turn this much beside the limits of soon and late may be either, seconds.
const BORDER_S: f64 = 2.0;
/// A target goes at most this much faster than on average where frames miss it.
const FAST: f64 = 1.5;

/// Slower people than runners by less than this may be said to run, faster ones to walk, m/s.
const GAIT_MPS: f64 = 0.4;

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

    /// A stated number is the fact, or at most `slack` away, to its step.
    fn number(&mut self, slot: Slot, found: f64, (fact, slack): (f64, f64), step: f64) {
        let holds = is_step(found, found.max(fact - slack).min(fact + slack), step);
        self.expect(holds && !fact.is_nan(), slot, found, format_args!("{fact:.2}"));
    }

    /// A stated time or way is the fact, or at most `more`, to its step.
    fn extent(&mut self, slot: Slot, found: f64, (fact, more): (f64, f64), step: fn(f64) -> f64) {
        let nearest = found.max(fact).min(fact + more);
        let holds = [fact, fact + more].iter().any(|it| is_step(found, nearest, step(*it)));
        self.expect(holds && !fact.is_nan(), slot, found, format_args!("{fact:.2}"));
    }

    /// A stated number of stops. Frames that are far apart may miss short ones and draw out others.
    fn stops(&mut self, found: usize) {
        let stops = &self.facts.stops;
        let holds = self.facts.left_out.map_or(found == stops.len(), |left_out| {
            let sure_s = LEAST_STOP_S + 2.0 * left_out.time_s;
            found >= stops.iter().filter(|stop| stop.duration_s >= sure_s).count()
        });
        self.expect(holds, Slot::Stops, found, stops.len());
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

    fn claim(&mut self, claim: &Claim) {
        let facts = self.facts;
        match *claim {
            Claim::Top(_) | Claim::Trousers(_) | Claim::Backpack(_) => {
                self.mismatches.extend(facts.wear.as_ref().and_then(|wear| clothes_mismatch(claim, wear)));
            }
            Claim::Stops(count) => self.stops(count),
            Claim::SomeStops if facts.left_out.is_some() => {}
            Claim::SomeStops => self.expect(!facts.stops.is_empty(), Slot::Stops, "some", 0),
            Claim::Turns(count) => self.expect(may_have(count, None, facts), Slot::Turns, count, facts.turns.len()),
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
            Claim::Stays => self.expect(!facts.walks, Slot::Walking, "stands", "walks"),
            Claim::Walks => {
                let is_slow = facts.walking_speed_mps < running_mps(facts.is_runner) + GAIT_MPS;
                self.gait("walks", facts.walks && is_slow);
            }
            Claim::Runs => {
                self.gait("runs", facts.walking_speed_mps > running_mps(facts.is_runner) - GAIT_MPS);
            }
            Claim::Unknown(ref words) => self.expect(false, Slot::Number, words, "nothing of the kind"),
            Claim::Direction(_) | Claim::Turn(_) => {}
            _ => self.measure(claim),
        }
    }

    /// Whether the target goes so; between walking and running, both may be said.
    fn gait(&mut self, said: &str, holds: bool) {
        let does = if self.facts.runs() { "runs" } else { "walks" };
        self.expect(holds, Slot::Walking, said, if self.facts.walks { does } else { "stands" });
    }

    /// A number with a unit.
    fn measure(&mut self, claim: &Claim) {
        let facts = self.facts;
        let left_out =
            facts.left_out.unwrap_or(LeftOut { time_s: 0.0, distance_m: 0.0, pitch_deg: 0.0, altitude_m: 0.0 });
        let missed_s = 2.0 * left_out.time_s;
        let missed_m = FAST * facts.walking_speed_mps * missed_s;
        let slack_mps = if facts.left_out.is_some() { SPEED_STEP_MPS } else { 0.0 };
        let [distance, altitude] = [(facts.distance_m, left_out.distance_m), (facts.altitude_m, left_out.altitude_m)];
        match *claim {
            Claim::Distance(found) => self.number(Slot::Distance, found, distance, DISTANCE_STEP_M),
            Claim::Altitude(found) => self.number(Slot::Altitude, found, altitude, DISTANCE_STEP_M),
            Claim::Pitch(found) => {
                self.number(Slot::Pitch, found, (facts.pitch_down_deg, left_out.pitch_deg), PITCH_STEP_DEG);
            }
            Claim::Way(found) => self.extent(Slot::Way, found, (facts.way_m, missed_m), way_step_m),
            Claim::Speed(found) => {
                self.number(Slot::Speed, found, (facts.walking_speed_mps, slack_mps), SPEED_STEP_MPS);
            }
            Claim::Duration(found) => self.extent(Slot::Duration, found, (facts.duration_s, missed_s), duration_step_s),
            Claim::Standing(_) if facts.left_out.is_some() => {}
            Claim::Standing(found) => self.number(Slot::Standing, found, (facts.standing_s(), 0.0), STOP_STEP_S),
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

    /// A list of turns is the whole list; counts by side leave no side out.
    fn turns(&mut self, claims: &[Claim]) {
        let turn = |claim: &Claim| match claim {
            Claim::Turn(kind) => Some(*kind),
            _ => None,
        };
        let listed: Vec<TurnKind> = claims.iter().filter_map(turn).collect();
        let expected: Vec<TurnKind> = self.facts.turns.iter().map(|turn| turn.kind).collect();
        let holds = listed.is_empty() || is_list_of(&listed, self.facts);
        self.expect(holds, Slot::Turns, format_args!("{listed:?}"), format_args!("{expected:?}"));
        let counts = claims.iter().filter_map(|claim| match claim {
            Claim::TurnsOf(_, count) => Some(*count),
            _ => None,
        });
        let (sides, sum) = counts.fold((0, 0), |(sides, sum), count| (sides + 1, sum + count));
        self.expect(sides == 0 || may_have(sum, None, self.facts), Slot::Turns, sum, expected.len());
    }

    fn required(&mut self, claims: &[Claim]) {
        let has_distance = claims.iter().any(|it| matches!(it, Claim::Distance(_)));
        self.expect(has_distance, Slot::Distance, "", self.facts.distance_m);
        let has_pitch = claims.iter().any(|it| matches!(it, Claim::Pitch(_)));
        self.expect(has_pitch, Slot::Pitch, "", self.facts.pitch_down_deg);
    }
}
