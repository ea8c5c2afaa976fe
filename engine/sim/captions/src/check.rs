//! The slot check: claims of a text against facts of the trajectory.

use crate::facts::{Facts, Wear};
use crate::language::Language;
use crate::precision::{DISTANCE_STEP_M, PITCH_STEP_DEG, SPEED_STEP_MPS, STOP_STEP_S, duration_step_s, way_step_m};
use crate::reading::{Claim, chinese, english};
use crate::turns::TurnKind;
use std::fmt;

/// Subject of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Slot {
    Language,
    Direction,
    Distance,
    Altitude,
    Pitch,
    Way,
    Duration,
    Speed,
    Stops,
    Standing,
    Turns,
    Walking,
    Clothes,
    Place,
    People,
    Number,
    Things,
    Wording,
}

impl Slot {
    /// The name in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Language => "language",
            Self::Direction => "direction",
            Self::Distance => "distance",
            Self::Altitude => "altitude",
            Self::Pitch => "pitch",
            Self::Way => "way",
            Self::Duration => "duration",
            Self::Speed => "speed",
            Self::Stops => "stops",
            Self::Standing => "time of standing",
            Self::Turns => "turns",
            Self::Walking => "walking",
            Self::Clothes => "clothes",
            Self::Place => "place",
            Self::People => "people",
            Self::Number => "number",
            Self::Things => "things",
            Self::Wording => "wording",
        }
    }
}

/// One disagreement between a text and the facts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SlotMismatch {
    /// Subject of the claim.
    pub slot: Slot,
    /// Claim of the text.
    pub found: String,
    /// Fact of the trajectory.
    pub expected: String,
}

impl fmt::Display for SlotMismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: the text says `{}`, the trajectory `{}`", self.slot.name(), self.found, self.expected)
    }
}

/// Compares every number, direction, turn and stop that a text claims with the facts.
///
/// A text must name a distance and a pitch; whatever else it claims must be true to the step in [`crate::precision`]. Clothes
/// are judged where the facts know them. The first direction is where the walk sets out, a second one where it ends. Listed
/// turns must be all turns, in order. The text must be in the script of its language.
///
/// # Errors
/// All disagreements, in the order of the text; missing slots come last.
pub fn check(text: &str, language: Language, facts: &Facts) -> Result<(), Vec<SlotMismatch>> {
    let claims = listed_turns(claims_of(text, language));
    let mut checker = Checker { facts, mismatches: vec![] };
    checker.script(text, language);
    checker.directions(&claims);
    for claim in claims.iter().filter(|claim| is_of_weight(claim, &claims, facts)) {
        checker.claim(claim);
    }
    checker.turns(&claims);
    checker.pair_of_colours(&claims);
    checker.required(&claims);
    if checker.mismatches.is_empty() { Ok(()) } else { Err(checker.mismatches) }
}

/// Subjects that a text says something about, each once.
pub fn claimed(text: &str, language: Language) -> Vec<Slot> {
    let slot = |claim: Claim| match claim {
        Claim::Direction(_) => Slot::Direction,
        Claim::Distance(_) | Claim::Metres(_) => Slot::Distance,
        Claim::Altitude(_) => Slot::Altitude,
        Claim::Pitch(_) | Claim::Tilt(_) => Slot::Pitch,
        Claim::Way(_) => Slot::Way,
        Claim::Duration(_) | Claim::Seconds(_) => Slot::Duration,
        Claim::Speed(_) => Slot::Speed,
        Claim::Stops(_) | Claim::SomeStops | Claim::Times(_) => Slot::Stops,
        Claim::Standing(_) => Slot::Standing,
        Claim::Turn(_)
        | Claim::Turns(_)
        | Claim::TurnsOf(..)
        | Claim::NoTurns
        | Claim::Straight
        | Claim::StopFirst(_) => Slot::Turns,
        Claim::Top(_)
        | Claim::Trousers(_)
        | Claim::Backpack
        | Claim::NoBackpack
        | Claim::Wears(_)
        | Claim::Shade { .. } => Slot::Clothes,
        Claim::Stays | Claim::StandsFor(_) => Slot::Walking,
        Claim::Unknown(_) => Slot::Number,
    };
    claims_of(text, language).into_iter().map(slot).collect::<std::collections::BTreeSet<_>>().into_iter().collect()
}

/// Compares what a text claims of the target's clothes alone, with the clothes.
///
/// # Errors
/// The first disagreement.
pub fn check_clothes(text: &str, language: Language, wear: Wear) -> Result<(), SlotMismatch> {
    claims_of(text, language).iter().find_map(|claim| clothes_mismatch(claim, &wear)).map_or(Ok(()), Err)
}

/// Disagreement of a claim about clothes with the clothes; `None` for other claims.
pub(crate) fn clothes_mismatch(claim: &Claim, wear: &Wear) -> Option<SlotMismatch> {
    let (garment, found, expected) = match claim {
        Claim::Top(colour) => ("top", colour.name(), wear.top.name()),
        Claim::Trousers(colour) => ("trousers", colour.name(), wear.trousers.name()),
        Claim::Backpack => ("backpack", "one", if wear.backpack { "one" } else { "none" }),
        Claim::NoBackpack => ("backpack", "none", if wear.backpack { "one" } else { "none" }),
        Claim::Shade { is_top, name, colours } => {
            let (garment, worn) = if *is_top { ("top", wear.top) } else { ("trousers", wear.trousers) };
            let told = |words: &str| format!("{garment}: {words}");
            let mismatch = SlotMismatch { slot: Slot::Clothes, found: told(name), expected: told(worn.name()) };
            return (!colours.contains(&worn)).then_some(mismatch);
        }
        Claim::Wears(colour) if *colour == wear.top || *colour == wear.trousers => return None,
        Claim::Wears(colour) => ("colour", colour.name(), wear.top.name()),
        _ => return None,
    };
    let told = |words: &str| format!("{garment}: {words}");
    (found != expected).then(|| SlotMismatch { slot: Slot::Clothes, found: told(found), expected: told(expected) })
}

/// The disagreement of a text that is not in the script of its language.
pub(crate) fn script_mismatch(text: &str, language: Language) -> Option<SlotMismatch> {
    // A letter in a Chinese word.
    let text = &text.replace("T恤", "恤");
    let han = text.chars().filter(|c| ('\u{4e00}'..='\u{9fff}').contains(c)).count();
    let latin = text.chars().filter(char::is_ascii_alphabetic).count();
    let foreign = text.chars().filter(|c| c.is_alphabetic() && !c.is_ascii()).count();
    let (holds, expected) = match language {
        Language::Zh => (han > 0 && latin == 0 && foreign == han, "Chinese characters alone"),
        Language::En => (latin > 0 && foreign == 0, "Latin letters alone"),
    };
    let found = || format!("{han} Chinese and {latin} Latin letters");
    (!holds).then(|| SlotMismatch { slot: Slot::Language, found: found(), expected: expected.to_owned() })
}

fn claims_of(text: &str, language: Language) -> Vec<Claim> {
    match language {
        Language::Zh => chinese::read(text),
        Language::En => english::read(text),
    }
}

/// Counts of turns to a side as a list, where the text lists others: `two left turns, then a right one`.
fn listed_turns(claims: Vec<Claim>) -> Vec<Claim> {
    if !claims.iter().any(|claim| matches!(claim, Claim::Turn(_))) {
        return claims;
    }
    let listed = |claim: Claim| match claim {
        Claim::TurnsOf(kind, count) if count <= 100 => vec![Claim::Turn(kind); count],
        other => vec![other],
    };
    claims.into_iter().flat_map(listed).collect()
}

/// Whether a stated number is a multiple of the step, and no nearer multiple to the fact exists.
fn is_step(found: f64, fact: f64, step: f64) -> bool {
    let steps = found / step;
    (steps - steps.round()).abs() < 1e-6 && (found - fact).abs() <= 0.5 * step + 1e-6
}

/// Whether a claim says anything beside the others of its text: `straight on` before a turn does not, nor does the pause of a
/// target that stands all the time.
fn is_of_weight(claim: &Claim, claims: &[Claim], facts: &Facts) -> bool {
    let is_turn = |claim: &Claim| matches!(claim, Claim::Turn(_) | Claim::Turns(_) | Claim::TurnsOf(..));
    let stays = |claim: &Claim| matches!(claim, Claim::Stays | Claim::StandsFor(_));
    match claim {
        Claim::Straight => !claims.iter().any(is_turn),
        Claim::SomeStops => facts.walks || !claims.iter().any(stays),
        _ => true,
    }
}

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

    fn script(&mut self, text: &str, language: Language) {
        self.mismatches.extend(script_mismatch(text, language));
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
            Claim::Distance(found) => self.number(Slot::Distance, found, facts.distance_m, DISTANCE_STEP_M),
            Claim::Altitude(found) => self.number(Slot::Altitude, found, facts.altitude_m, DISTANCE_STEP_M),
            Claim::Pitch(found) => self.number(Slot::Pitch, found, facts.pitch_down_deg, PITCH_STEP_DEG),
            Claim::Way(found) => self.number(Slot::Way, found, facts.way_m, way_step_m(facts.way_m)),
            Claim::Duration(found) => {
                self.number(Slot::Duration, found, facts.duration_s, duration_step_s(facts.duration_s));
            }
            Claim::Metres(found) => {
                let way = (facts.way_m, way_step_m(facts.way_m));
                let places = [(facts.distance_m, DISTANCE_STEP_M), (facts.altitude_m, DISTANCE_STEP_M), way];
                self.one_of(Slot::Distance, found, &places[..2 + usize::from(facts.walks)]);
            }
            Claim::Tilt(found) => self.number(Slot::Pitch, found, facts.pitch_down_deg.abs(), PITCH_STEP_DEG),
            Claim::Seconds(found) => {
                let whole = (facts.duration_s, duration_step_s(facts.duration_s));
                self.one_of(Slot::Duration, found, &[whole, (facts.standing_s(), STOP_STEP_S)]);
            }
            Claim::StandsFor(found) if facts.walks => {
                self.number(Slot::Standing, found, facts.standing_s(), STOP_STEP_S);
            }
            Claim::StandsFor(found) => {
                self.number(Slot::Duration, found, facts.duration_s, duration_step_s(facts.duration_s));
            }
            Claim::Speed(found) => self.number(Slot::Speed, found, facts.walking_speed_mps, SPEED_STEP_MPS),
            Claim::Standing(found) => self.number(Slot::Standing, found, facts.standing_s(), STOP_STEP_S),
            Claim::Stops(count) => self.expect(count == facts.stops.len(), Slot::Stops, count, facts.stops.len()),
            Claim::Times(count) => {
                let holds = [facts.stops.len(), facts.turns.len()].contains(&count);
                self.expect(holds, Slot::Stops, count, facts.stops.len());
            }
            Claim::SomeStops => self.expect(!facts.stops.is_empty(), Slot::Stops, "some", 0),
            Claim::Turns(count) => self.expect(count == facts.turns.len(), Slot::Turns, count, facts.turns.len()),
            Claim::NoTurns | Claim::Straight => self.expect(facts.turns.is_empty(), Slot::Turns, 0, facts.turns.len()),
            Claim::TurnsOf(kind, count) => {
                let expected = facts.turns_of(kind);
                self.expect(count == expected, Slot::Turns, format_args!("{count} {kind:?}"), expected);
            }
            Claim::Top(_)
            | Claim::Trousers(_)
            | Claim::Backpack
            | Claim::NoBackpack
            | Claim::Wears(_)
            | Claim::Shade { .. } => {
                self.mismatches.extend(facts.wear.as_ref().and_then(|wear| clothes_mismatch(claim, wear)));
            }
            Claim::StopFirst(first) => {
                let known = match (&facts.stops[..], &facts.turns[..]) {
                    ([stop], [turn]) => Some(stop.frame < turn.frame),
                    _ => None,
                };
                let words = |first| if first { "a stop before the turn" } else { "a stop after the turn" };
                let expected = known.map_or("another order", words);
                self.expect(known == Some(first), Slot::Turns, words(first), expected);
            }
            Claim::Stays => self.expect(!facts.walks, Slot::Walking, "stands", "walks"),
            Claim::Unknown(ref words) => self.expect(false, Slot::Number, words, "nothing of the kind"),
            Claim::Direction(_) | Claim::Turn(_) => {}
        }
    }

    /// A list of turns is the whole list; counts by side leave no side out.
    fn turns(&mut self, claims: &[Claim]) {
        let listed: Vec<TurnKind> = claims
            .iter()
            .filter_map(|claim| match claim {
                Claim::Turn(kind) => Some(*kind),
                _ => None,
            })
            .collect();
        let expected: Vec<TurnKind> = self.facts.turns.iter().map(|turn| turn.kind).collect();
        let holds = listed.is_empty() || listed == expected;
        self.expect(holds, Slot::Turns, format_args!("{listed:?}"), format_args!("{expected:?}"));
        let counts = claims.iter().filter_map(|claim| match claim {
            Claim::TurnsOf(_, count) => Some(*count),
            _ => None,
        });
        let (sides, sum) = counts.fold((0, 0), |(sides, sum), count| (sides + 1, sum + count));
        self.expect(sides == 0 || sum == expected.len(), Slot::Turns, sum, expected.len());
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
        let stays = claims.iter().any(|claim| matches!(claim, Claim::Stays | Claim::StandsFor(_)));
        self.expect(facts.walks || stays, Slot::Walking, "walks", "stands");
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::caption::tests::flights;
    use crate::{CaptionConfig, Compass, captions};
    use cosfly_random::Seed;

    /// Places of the numbers in a text.
    fn numbers(text: &str) -> Vec<std::ops::Range<usize>> {
        let inside = |i: usize, b: u8| {
            b.is_ascii_digit() || (b == b'.' && text.as_bytes().get(i + 1).is_some_and(u8::is_ascii_digit))
        };
        let mut found: Vec<std::ops::Range<usize>> = vec![];
        for (i, b) in text.bytes().enumerate().filter(|(i, b)| inside(*i, *b)) {
            debug_assert!(b.is_ascii());
            match found.last_mut() {
                Some(last) if last.end == i => last.end += 1,
                _ => found.push(i..i + 1),
            }
        }
        found
    }

    /// The text with each occurrence of `word` replaced, one at a time. Longer words that contain it stay.
    fn replaced(text: &str, word: &str, other: &str, part_of_word: impl Fn(char) -> bool) -> Vec<String> {
        text.match_indices(word)
            .filter(|(at, _)| {
                !text[..*at].chars().next_back().is_some_and(&part_of_word)
                    && !text[at + word.len()..].chars().next().is_some_and(&part_of_word)
            })
            .map(|(at, _)| format!("{}{other}{}", &text[..at], &text[at + word.len()..]))
            .collect()
    }

    fn mutations(text: &str, language: Language) -> Vec<String> {
        let mut mutated = vec![];
        for place in numbers(text) {
            let digits = &text[place.clone()];
            let value: f64 = digits.parse().unwrap();
            let fraction = usize::from(digits.contains('.'));
            for change in [1.0, 10.0, -10.0, if fraction == 1 { 0.1 } else { 2.0 }] {
                let other = (value + change).abs();
                mutated.push(format!("{}{other:.fraction$}{}", &text[..place.start], &text[place.end..]));
            }
        }
        let sides = match language {
            Language::En => vec![
                ("left", "right"),
                ("right", "left"),
                ("turns around", "turns left"),
                ("then around", "then left"),
                ("no stops", "2 stops"),
                ("red", "blue"),
                ("black", "white"),
                ("without a", "with 1"),
                ("turns", "turns left, then"),
            ],
            Language::Zh => vec![
                ("左转", "右转"),
                ("右转", "左转"),
                ("掉头", "左转"),
                ("没有停留", "停留2次"),
                ("红色", "蓝色"),
                ("黑色", "白色"),
                ("连续两次", "连续三次"),
                ("连续三次", "连续两次"),
            ],
        };
        let letter = |c: char| c.is_ascii_alphabetic() || "东南西北".contains(c);
        for direction in Compass::ALL {
            let place = Compass::ALL.iter().position(|one| *one == direction).unwrap();
            for turn in [1, 2, 4] {
                let other = Compass::ALL[(place + turn) % 8];
                let (from, to) = match language {
                    Language::En => (direction.english(), other.english()),
                    Language::Zh => (direction.chinese(), other.chinese()),
                };
                mutated.extend(replaced(text, from, to, letter));
            }
        }
        mutated.extend(sides.iter().flat_map(|(from, to)| replaced(text, from, to, letter)));
        mutated
    }

    #[test]
    fn every_mutated_number_direction_side_and_count_fails() {
        let config = CaptionConfig { variants_per_style: 6, ..CaptionConfig::default() };
        let mut tried = 0;
        for (walk, facts) in flights().iter().enumerate() {
            for item in 0..4 {
                for caption in captions(facts, &config, Seed::of_item(2, "captions", &format!("{walk}-{item}"))) {
                    for text in mutations(&caption.text, caption.language) {
                        assert!(check(&text, caption.language, facts).is_err(), "{}\n{text}\n{facts:?}", caption.text);
                        tried += 1;
                    }
                }
            }
        }
        assert!(tried > 10_000, "{tried}");
    }

    #[test]
    fn a_text_in_the_wrong_script_or_without_its_slots_fails() {
        let facts = &flights()[0];
        let slots = |text: &str, language| -> Vec<Slot> {
            check(text, language, facts).unwrap_err().iter().map(|mismatch| mismatch.slot).collect()
        };
        let english = "Follow the pedestrian walking east; keep about 28 m away and look down about 45 degrees.";
        assert_eq!(check(english, Language::En, facts), Ok(()));
        assert!(slots(english, Language::Zh).contains(&Slot::Language));
        let chinese = "跟随向东行走的行人，保持约28米距离，俯仰角约45度。";
        assert_eq!(check(chinese, Language::Zh, facts), Ok(()));
        assert!(slots(chinese, Language::En).contains(&Slot::Language));
        assert_eq!(slots("跟随向东行走的行人，保持约28m距离，俯仰角约45度。", Language::Zh)[0], Slot::Language);
        assert_eq!(slots("Follow the pedestrian.", Language::En), [Slot::Distance, Slot::Pitch]);
        assert_eq!(slots("", Language::En), [Slot::Language, Slot::Distance, Slot::Pitch]);
    }

    #[test]
    fn a_mismatch_says_both_sides() {
        let facts = &flights()[0];
        let text = "Follow the pedestrian walking north; keep about 28 m away and look down about 45 degrees.";
        let mismatches = check(text, Language::En, facts).unwrap_err();
        assert_eq!(mismatches[0].to_string(), "direction: the text says `north`, the trajectory `east`");
    }
}
