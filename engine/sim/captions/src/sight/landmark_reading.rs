//! Reads what a text says of landmarks, and leaves the rest of its clause to the other readers.

use super::beside::{Beside, OnSide};
use super::landmarks::LandmarkKind;

/// What a text says of a landmark; `beside` is `None` for a relation that this reader does not know.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct LandmarkClaim {
    pub beside: Option<Beside>,
    pub kind: LandmarkKind,
    pub side: Option<OnSide>,
}

const ENGLISH: [(&str, Beside); 15] = [
    ("passing", Beside::Passes),
    ("passes", Beside::Passes),
    ("past", Beside::Passes),
    ("approaching", Beside::Approaches),
    ("approaches", Beside::Approaches),
    ("towards", Beside::Approaches),
    ("toward", Beside::Approaches),
    ("up to", Beside::Approaches),
    ("next to", Beside::NextTo),
    ("close to", Beside::NextTo),
    ("beside", Beside::NextTo),
    ("alongside", Beside::NextTo),
    ("by", Beside::NextTo),
    ("near", Beside::NextTo),
    ("in front of", Beside::InFront),
];

/// The landmark of an English clause, and the clause without it.
pub(super) fn of_english(words: &[String]) -> Option<(LandmarkClaim, Vec<String>)> {
    let kind = |at: usize| english_kind(&words[at], at.checked_sub(1).map_or("", |before| &words[before]));
    let (noun, kind) = (0..words.len()).find_map(|at| kind(at).map(|kind| (at, kind)))?;
    let starts_at = |at: usize, phrase: &str| words[at..noun].join(" ").starts_with(phrase);
    let relation = (0..noun).rev().find_map(|at| {
        ENGLISH.iter().find(|(phrase, _)| starts_at(at, &format!("{phrase} "))).map(|(_, beside)| (at, *beside))
    });
    let mut begin = relation.map_or(noun, |(at, _)| at);
    if begin > 0 && ["walking", "walks", "standing", "stands"].contains(&words[begin - 1].as_str()) {
        // "standing" says more than the relation.
        begin -= usize::from(words[begin - 1].starts_with("walk"));
    }
    let after = words[noun + 1..].join(" ");
    let side = [("left", OnSide::Left), ("right", OnSide::Right)].into_iter().find_map(|(word, side)| {
        ["on the ", "to the ", "on its ", "on their "]
            .iter()
            .any(|it| after.starts_with(&format!("{it}{word}")))
            .then_some(side)
    });
    let end = noun + 1 + if side.is_some() { 3 } else { 0 };
    let rest = words[..begin].iter().chain(&words[end..]).cloned().collect();
    Some((LandmarkClaim { beside: relation.map(|(_, beside)| beside), kind, side }, rest))
}

fn english_kind(word: &str, before: &str) -> Option<LandmarkKind> {
    match (word, before) {
        ("light" | "lights", "traffic") => Some(LandmarkKind::TrafficLight),
        ("lamp" | "lamppost" | "streetlight" | "streetlamp", _) | ("light", "street") => Some(LandmarkKind::Lamp),
        ("sign", _) => Some(LandmarkKind::TrafficSign),
        ("tree" | "trees", _) => Some(LandmarkKind::Tree),
        ("car" | "cars", _) => Some(LandmarkKind::Car),
        ("building" | "buildings" | "house", _) => Some(LandmarkKind::Building),
        _ => None,
    }
}

const CHINESE: [(&str, LandmarkKind); 14] = [
    ("红绿灯", LandmarkKind::TrafficLight),
    ("交通灯", LandmarkKind::TrafficLight),
    ("信号灯", LandmarkKind::TrafficLight),
    ("路灯", LandmarkKind::Lamp),
    ("交通标志牌", LandmarkKind::TrafficSign),
    ("标志牌", LandmarkKind::TrafficSign),
    ("交通标志", LandmarkKind::TrafficSign),
    ("大树", LandmarkKind::Tree),
    ("树", LandmarkKind::Tree),
    ("汽车", LandmarkKind::Car),
    ("轿车", LandmarkKind::Car),
    ("楼房", LandmarkKind::Building),
    ("大楼", LandmarkKind::Building),
    ("建筑", LandmarkKind::Building),
];

/// The landmark of a Chinese clause, and the clause without it.
pub(super) fn of_chinese(clause: &str) -> Option<(LandmarkClaim, String)> {
    let (noun, kind) = CHINESE.into_iter().find(|(noun, _)| clause.contains(noun))?;
    let (before, after) = clause.split_once(noun)?;
    let tail = |phrases: &[&'static str]| phrases.iter().find(|it| after.starts_with(**it)).map_or(0, |it| it.len());
    let head = |phrases: &[&str]| phrases.iter().any(|it| before.contains(it));
    let (passed, beside, ahead) = (
        tail(&["旁走过", "旁经过", "旁边走过", "旁边经过", "边走过"]),
        tail(&["旁边", "旁", "附近", "边"]),
        tail(&["前面", "前方", "前"]),
    );
    let (relation, end) = match () {
        () if passed > 0 => (Some(Beside::Passes), passed),
        () if head(&["经过", "路过"]) => (Some(Beside::Passes), 0),
        () if head(&["走近", "走向", "靠近"]) => (Some(Beside::Approaches), 0),
        () if beside > 0 => (Some(Beside::NextTo), beside),
        () if ahead > 0 => (Some(Beside::InFront), ahead),
        () => (None, 0),
    };
    let begins = ["从", "经过", "路过", "走近", "走向", "靠近", "位于", "在"];
    let begin = begins.iter().filter_map(|it| before.rfind(it)).max().unwrap_or(before.len());
    let side = match () {
        () if before[begin..].contains('左') => Some(OnSide::Left),
        () if before[begin..].contains('右') => Some(OnSide::Right),
        () => None,
    };
    Some((LandmarkClaim { beside: relation, kind, side }, format!("{}{}", &before[..begin], &after[end..])))
}
