//! Composition of goals: claims that were picked, put into words of both languages.

use super::claim::{Claim, Said, Subject};
use super::course::Course;
use super::plan::{Goal, Plan, Wording};
use super::{chinese, english, pick, steps};
use crate::facts::Wear;
use crate::wording::{one_of, without};
use cosfly_claims::Language;
use cosfly_domain::Colour;
use cosfly_random::{RandomStream, Seed};
use std::ops::Range;

/// A move within this time of the end of a crossing is `after the crossing`, seconds.
const RIGHT_AFTER_S: f64 = 5.0;

/// Words of templates that say that somebody walks, in both languages.
const OF_A_WALK: &[&str] =
    &["walk", "way", "trip", "pace", "set out", "may go", "will go", "Go with", "走", "路", "途中", "陪"];

/// Goals of a flight, in both languages, in the order of [`Grain::ALL`](super::Grain::ALL).
pub fn goals(course: &Course<'_>, seed: &Seed) -> Vec<Goal> {
    let mut plans = pick::flights(course, &mut seed.stream("flights"));
    plans.extend(steps::steps(course, &mut seed.stream("steps")));
    plans.extend(pick::dialogues(course, &mut seed.stream("dialogues")));
    plans.extend(pick::negatives(course, &plans, &mut seed.stream("negatives")));
    let right_after = course.frames_in(RIGHT_AFTER_S);
    let mut goals = vec![];
    for (number, plan) in plans.iter().enumerate() {
        for language in Language::ALL {
            let words = &mut seed.child(language.code(), number as u64).stream("words");
            goals.push(Goal {
                grain: plan.grain,
                language,
                frames: plan.frames.clone(),
                lines: lines(plan, right_after, language, words),
                said: plan.said.clone(),
                wrong: plan.wrong,
            });
        }
    }
    goals
}

fn lines(plan: &Plan, right_after: usize, language: Language, words: &mut RandomStream) -> Vec<String> {
    let wording = wording(language);
    match &plan.mistaken {
        Some(mistaken) => dialogue(plan, mistaken, right_after, language, words),
        None => vec![sentence(plan, right_after, wording, words)],
    }
}

fn wording(language: Language) -> &'static Wording {
    match language {
        Language::Zh => &chinese::WORDING,
        Language::En => &english::WORDING,
    }
}

fn wear_of(said: &[Said]) -> Option<Wear> {
    said.iter().find_map(|it| if let Claim::Wears(wear) = it.claim { Some(wear) } else { None })
}

fn metres_of(said: &[Said]) -> Option<u32> {
    said.iter().find_map(|it| if let Claim::Distance(metres) = it.claim { Some(metres) } else { None })
}

/// One or several sentences with everything that is said.
fn sentence(plan: &Plan, right_after: usize, wording: &Wording, words: &mut RandomStream) -> String {
    let wear = wear_of(&plan.said);
    let templates = if wear.is_some() { wording.flights } else { wording.steps };
    let stands = plan.said.iter().any(|it| it.claim == Claim::Stands);
    let template = one_of(words, &without(templates, Some(OF_A_WALK).filter(|_| stands)));
    let predicates = told_in_order(predicates(&plan.said, right_after, wording, words), wording, words);
    let keep = one_of(words, wording.keeps).replace("{d}", &metres_of(&plan.said).unwrap_or(0).to_string());
    let text = (wording.finished)(template, &predicates, &keep);
    wear.map_or(text.clone(), |wear| text.replace("[w]", &(wording.target)(&wear, words)))
}

/// Things in order of time; those that overlap are told as one.
fn told_in_order(parts: Vec<(String, Range<usize>)>, wording: &Wording, words: &mut RandomStream) -> String {
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
    let told: Vec<String> = groups.iter().map(|(texts, _)| (wording.together)(texts, words)).collect();
    (wording.joined)(&told, words)
}

/// What the target does, in order; a move after landmarks may be told by the last of them.
fn predicates(
    said: &[Said],
    right_after: usize,
    wording: &Wording,
    words: &mut RandomStream,
) -> Vec<(String, Range<usize>)> {
    let told: Vec<&Said> = said.iter().filter(|it| !matches!(it.claim, Claim::Wears(_) | Claim::Distance(_))).collect();
    let mut parts: Vec<(String, Range<usize>)> = vec![];
    let mut at = 0;
    while at < told.len() {
        let is_move = |it: &&Said| matches!(it.claim, Claim::Turns(_));
        match (&told[at].claim, told.get(at + 1)) {
            (claim, Some(next)) if is_anchor(told[at], next, right_after) && is_move(next) => {
                let action = (wording.predicate)(next, words);
                parts.push(((wording.anchored)(claim, &action, words), told[at].frames.start..next.frames.end));
                at += 2;
            }
            _ => {
                parts.push(((wording.predicate)(told[at], words), told[at].frames.clone()));
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

fn dialogue(
    plan: &Plan,
    mistaken: &Claim,
    right_after: usize,
    language: Language,
    words: &mut RandomStream,
) -> Vec<String> {
    let wording = wording(language);
    let patterns = (wording.dialogue)(plan.wrong.unwrap_or(Subject::Clothes));
    // Of more than two people nobody is `the other one`.
    let is_of_two = |lines: &[&str; 3]| lines.iter().any(|line| line.contains("other one") || line.contains("另一个"));
    let fitting: Vec<&[&str; 3]> = patterns.iter().filter(|it| plan.is_other_of_two || !is_of_two(it)).collect();
    let lines = fitting[words.index(fitting.len())];
    let wear = wear_of(&plan.said);
    let metres = metres_of(&plan.said);
    let top = |colour: Colour| match language {
        Language::En => format!("{} {}", crate::english::article(colour.name()), colour.name()),
        Language::Zh => crate::chinese::colour(colour).to_owned(),
    };
    let trousers = |colour: Colour| match language {
        Language::En => colour.name().to_owned(),
        Language::Zh => crate::chinese::colour(colour).to_owned(),
    };
    let mut filled: Vec<String> = lines.iter().map(|line| (*line).to_owned()).collect();
    let mut put = |key: &str, value: &str| filled.iter_mut().for_each(|line| *line = line.replace(key, value));
    if let Some(wear) = &wear {
        let target = (wording.target)(wear, words);
        put("{w}", &target);
        put("{W}", &english::capital(&target));
        put("{c}", wear.top.name());
        put("{t}", &top(wear.top));
        put("{r}", &trousers(wear.trousers));
    }
    if let Some(metres) = metres {
        put("{d}", &metres.to_string());
    }
    match mistaken {
        Claim::Wears(other) => {
            put("{o}", &top(other.top));
            put("{O}", &english::capital(&top(other.top)));
        }
        Claim::Distance(wrong) => {
            let is_closer = metres.is_some_and(|metres| metres < *wrong);
            put("{x}", &wrong.to_string());
            put(
                "{F}",
                match (language, is_closer) {
                    (Language::En, true) => "Closer",
                    (Language::En, false) => "Farther back",
                    (Language::Zh, true) => "太远了",
                    (Language::Zh, false) => "太近了",
                },
            );
        }
        wrong => {
            let own = told_in_order(predicates(&plan.said, right_after, wording, words), wording, words);
            put("{m}", &own);
            put("{n}", &(wording.predicate)(&Said { claim: wrong.clone(), frames: plan.frames.clone() }, words));
        }
    }
    filled.iter().map(|line| (wording.finished)(line, "", "")).collect()
}
