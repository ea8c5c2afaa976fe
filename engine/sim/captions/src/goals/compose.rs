//! Composition of goals: claims that were picked, put into words of both languages.

use super::claim::{Claim, Said, Subject};
use super::course::Course;
use super::plan::{Goal, Plan};
use super::predicate::{anchored, joined, predicate, together};
use super::{pick, steps};
use crate::facts::Wear;
use crate::messages::{Messages, Speaker, capital, fill, messages_of};
use crate::who::who;
use crate::wording::one_of;
use cosfly_claims::Language;
use cosfly_random::Seed;
use std::ops::Range;

/// A move within this time of the end of a crossing is `after the crossing`, seconds.
const RIGHT_AFTER_S: f64 = 5.0;

/// Goals of a flight, in all languages, in the order of [`Grain::ALL`](super::Grain::ALL).
pub fn goals(course: &Course<'_>, seed: &Seed) -> Vec<Goal> {
    let mut plans = pick::flights(course, &mut seed.stream("flights"));
    plans.extend(steps::steps(course, &mut seed.stream("steps")));
    plans.extend(pick::dialogues(course, &mut seed.stream("dialogues")));
    plans.extend(pick::negatives(course, &plans, &mut seed.stream("negatives")));
    let right_after = course.frames_in(RIGHT_AFTER_S);
    let (runs, mut goals) = (course.runs(), vec![]);
    for (number, plan) in plans.iter().enumerate() {
        for language in Language::ALL.iter().copied() {
            let words = &mut seed.child(language.code(), number as u64).stream("words");
            goals.push(Goal {
                grain: plan.grain,
                language,
                frames: plan.frames.clone(),
                lines: lines(plan, right_after, &mut Speaker { messages: messages_of(language, runs), words }),
                said: plan.said.clone(),
                wrong: plan.wrong,
            });
        }
    }
    goals
}

fn lines(plan: &Plan, right_after: usize, speaker: &mut Speaker<'_>) -> Vec<String> {
    match &plan.mistaken {
        Some(mistaken) => dialogue(plan, mistaken, right_after, speaker),
        None => vec![sentence(plan, right_after, speaker)],
    }
}

fn wear_of(said: &[Said]) -> Option<Wear> {
    said.iter().find_map(|it| if let Claim::Wears(wear) = it.claim { Some(wear) } else { None })
}

fn metres_of(said: &[Said]) -> Option<u32> {
    said.iter().find_map(|it| if let Claim::Distance(metres) = it.claim { Some(metres) } else { None })
}

/// One or several sentences with everything that is said.
fn sentence(plan: &Plan, right_after: usize, speaker: &mut Speaker<'_>) -> String {
    let wear = wear_of(&plan.said);
    let templates = if wear.is_some() { "goal-flight" } else { "goal-step" };
    let stands = plan.said.iter().any(|it| it.claim == Claim::Stands);
    let template = one_of(speaker.words, &speaker.without(templates, Some("goal-walking").filter(|_| stands)));
    let predicates = told_in_order(predicates(&plan.said, right_after, speaker), speaker);
    let metres = metres_of(&plan.said).unwrap_or(0).to_string();
    let keep = speaker.say("goal-keep", &[("d", &metres)]);
    let [finite, base] = forms(&predicates, speaker.messages);
    let text = fill(template, &[("p", &finite), ("b", &base), ("k", &keep), ("K", &capital(&keep))]);
    let text = capital(&text);
    wear.map_or_else(|| text.clone(), |wear| fill(&text, &[("w", &target(&wear, speaker))]))
}

/// The target, by its clothes.
fn target(wear: &Wear, speaker: &mut Speaker<'_>) -> String {
    let who = who(Some(wear), speaker);
    speaker.messages.filled("goal-target", &[("who", &who)])
}

/// A text with its verbs in the finite and the base form.
fn forms(text: &str, messages: &Messages) -> [String; 2] {
    ["finite", "base"].map(|form| {
        let [be, not] = ["be", "not"].map(|verb| messages.text(&format!("{verb}[{form}]")));
        fill(text, &[("be", be), ("not", not)])
    })
}

/// Things in order of time; those that overlap are told as one.
fn told_in_order(parts: Vec<(String, Range<usize>)>, speaker: &mut Speaker<'_>) -> String {
    let mut groups: Vec<(Vec<String>, usize)> = vec![];
    for (text, frames) in parts {
        match groups.last_mut() {
            Some((texts, end)) if frames.start < *end => {
                texts.push(text);
                *end = (*end).max(frames.end);
            }
            _ => groups.push((vec![text], frames.end)),
        }
    }
    let told: Vec<String> = groups.iter().map(|(texts, _)| together(texts, speaker)).collect();
    joined(&told, speaker)
}

/// Actions of the target, in order; a move after landmarks may be told by the last of them.
fn predicates(said: &[Said], right_after: usize, speaker: &mut Speaker<'_>) -> Vec<(String, Range<usize>)> {
    let told: Vec<&Said> = said.iter().filter(|it| !matches!(it.claim, Claim::Wears(_) | Claim::Distance(_))).collect();
    let mut parts: Vec<(String, Range<usize>)> = vec![];
    let mut at = 0;
    while at < told.len() {
        let is_move = |it: &&Said| matches!(it.claim, Claim::Turns(_));
        match (&told[at].claim, told.get(at + 1)) {
            (claim, Some(next)) if is_anchor(told[at], next, right_after) && is_move(next) => {
                let action = predicate(next, speaker);
                parts.push((anchored(claim, &action, speaker), told[at].frames.start..next.frames.end));
                at += 2;
            }
            _ => {
                parts.push((predicate(told[at], speaker), told[at].frames.clone()));
                at += 1;
            }
        }
    }
    parts
}

/// Whether what is next is told by something before it: the last of some landmarks, or a crossing at most so many frames before.
fn is_anchor(said: &Said, next: &Said, right_after: usize) -> bool {
    let after = next.frames.start.checked_sub(said.frames.end);
    match said.claim {
        Claim::Passes(_) => after.is_some(),
        Claim::Crosses => after.is_some_and(|frames| frames <= right_after),
        _ => false,
    }
}

/// Three lines, the last of which corrects the second.
fn dialogue(plan: &Plan, mistaken: &Claim, right_after: usize, speaker: &mut Speaker<'_>) -> Vec<String> {
    let messages = speaker.messages;
    let subject = match plan.wrong.unwrap_or(Subject::Clothes) {
        Subject::Clothes => "clothes",
        Subject::Distance => "distance",
        _ => "moves",
    };
    // Of more than two people nobody is `the other one`.
    let of_two = Some("dialogue-of-two").filter(|_| !plan.is_other_of_two);
    let pattern = one_of(speaker.words, &speaker.without(&format!("dialogue[{subject}]"), of_two));
    let wear = wear_of(&plan.said);
    let metres = metres_of(&plan.said);
    let mut values: Vec<(&str, String)> = vec![];
    if let Some(wear) = &wear {
        let target = target(wear, speaker);
        let [top, a_top] = messages.colours(wear.top).map(str::to_owned);
        let [trousers, _] = messages.colours(wear.trousers).map(str::to_owned);
        values.extend([("W", capital(&target)), ("w", target), ("c", top), ("t", a_top), ("r", trousers)]);
    }
    values.extend(metres.map(|metres| ("d", metres.to_string())));
    match mistaken {
        Claim::Wears(other) => {
            let [_, top] = messages.colours(other.top);
            values.extend([("o", top.to_owned()), ("O", capital(top))]);
        }
        Claim::Distance(wrong) => {
            let is_closer = metres.is_some_and(|metres| metres < *wrong);
            let correction = if is_closer { "dialogue-closer" } else { "dialogue-farther" };
            values.extend([("x", wrong.to_string()), ("F", messages.text(correction).to_owned())]);
        }
        wrong => {
            values.push(("m", told_in_order(predicates(&plan.said, right_after, speaker), speaker)));
            values.push(("n", predicate(&Said { claim: wrong.clone(), frames: plan.frames.clone() }, speaker)));
        }
    }
    let values: Vec<(&str, &str)> = values.iter().map(|(slot, value)| (*slot, value.as_str())).collect();
    let finished = |line: &str| {
        let [finite, _] = forms(&fill(line, &values), messages);
        capital(&finite)
    };
    pattern.split(" | ").map(finished).collect()
}
