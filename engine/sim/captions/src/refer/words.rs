//! Referring phrases in words.

use super::phrase::{Phrase, Property};
use crate::facts::runs;
use crate::messages::{Messages, messages_of};
use crate::part::PicturePart;
use cosfly_claims::Language;
use cosfly_domain::BodyKind;

/// A phrase in words, such as `the walking person in a red top`.
pub fn text(phrase: &Phrase, language: Language) -> String {
    let of = &phrase.of;
    let runs = of.kind.is_on_foot() && runs(of.kind == BodyKind::Runner, of.speed_mps);
    phrase_in(phrase, messages_of(language, runs))
}

/// The noun of a kind of body, by its name in tables, such as `cyclist`; none of an unknown kind.
pub fn noun(kind: &str, language: Language) -> Option<&'static str> {
    Some(messages_of(language, false).text(&format!("phrase-noun[{kind}]"))).filter(|noun| !noun.is_empty())
}

fn phrase_in(phrase: &Phrase, messages: &Messages) -> String {
    let of = &phrase.of;
    let is_dressed = of.kind.row().is_dressed;
    let ([top, a_top], [trousers, _]) = (messages.colours(of.top), messages.colours(of.trousers));
    let colours = [("top", top), ("a-top", a_top), ("trousers", trousers)];
    let said = |id: &str| messages.filled(id, &colours);
    let (mut front, mut back) = (vec![], vec![]);
    if phrase.names(Property::Motion) {
        front.push(said(motion(of.kind, of.moves() == Some(true))));
    }
    match (phrase.names(Property::Top), phrase.names(Property::Trousers)) {
        (true, _) if !is_dressed => front.push(said("phrase-paint")),
        (true, true) => back.push(said("phrase-clothes[both]")),
        (true, false) => back.push(said("phrase-clothes[top]")),
        (false, true) => back.push(said("phrase-clothes[trousers]")),
        (false, false) => {}
    }
    if phrase.names(Property::Backpack) {
        back.push(said("phrase-backpack"));
    }
    if phrase.names(Property::ShoulderBag) {
        back.push(said("phrase-shoulder-bag"));
    }
    let place = phrase.names(Property::Part).then(|| of.part().unwrap_or(PicturePart::Middle));
    let id = match (phrase.properties.is_empty(), is_dressed) {
        (true, true) => "phrase[plain-person]",
        (true, false) => "phrase[plain-vehicle]",
        (false, _) => "phrase",
    };
    let gap = messages.text("phrase-gap");
    let values = [
        ("noun", messages.text(&format!("phrase-noun[{}]", of.kind.name()))),
        ("place", place.map_or("", |it| messages.text(&format!("phrase-place[{}]", it.name())))),
        ("front", &front.join(gap)),
        ("back", &back.join(gap)),
        ("all", &[front.clone(), back.clone()].concat().join(gap)),
    ];
    messages.filled(id, &values)
}

fn motion(kind: BodyKind, moves: bool) -> &'static str {
    match (kind.is_on_foot(), moves) {
        (true, true) => "phrase-motion[walks]",
        (true, false) => "phrase-motion[stands]",
        (_, true) => "phrase-motion[drives]",
        (_, false) => "phrase-motion[halts]",
    }
}
