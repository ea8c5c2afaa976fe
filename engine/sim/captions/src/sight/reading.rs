//! Reads texts about one picture back: the claims of a text, whoever wrote it.

use super::facts::{Across, Place, Side};
use super::landmark_reading::{LandmarkClaim, of_chinese, of_english};
use crate::part::Part;
use cosfly_claims::english::clothes as english_clothes;
use cosfly_claims::english::numbers::number_word;
use cosfly_claims::english::tokens::{self, Token};
use cosfly_claims::{Claim, Language, chinese};
use cosfly_domain::Colour;

/// One claim of a text about a picture.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum SightClaim {
    /// Way across the picture.
    Across(Across),
    /// Part of the picture.
    Part(Part),
    /// So many people in the picture.
    People(usize),
    /// Outermost on a side.
    Outermost(Side),
    /// Nearest to the camera.
    Nearest,
    /// Ahead of, behind or beside so many people.
    Near(Place, usize),
    /// The one person whom the target is near wears a top of this colour.
    NearTop(Colour),
    /// Passes, approaches, is next to or in front of a landmark.
    Landmark(LandmarkClaim),
    /// Not in the picture.
    Hidden,
    /// Clothes of the target.
    Clothes(Claim),
    /// A number that says nothing this reader knows.
    Unknown(String),
}

/// Everything that the text claims, in order.
pub(super) fn read(text: &str, language: Language) -> Vec<SightClaim> {
    match language {
        Language::En => tokens::clauses(text).iter().flat_map(|clause| read_english(clause)).collect(),
        Language::Zh => {
            let words = |clause: &Vec<char>| clause.iter().collect::<String>();
            chinese::clauses(text).iter().flat_map(|clause| read_chinese(&words(clause))).collect()
        }
    }
}

fn read_english(tokens: &[Token]) -> Vec<SightClaim> {
    let words: Vec<String> = tokens
        .iter()
        .map(|token| match token {
            Token::Word(word) => word.clone(),
            Token::Number(value) => value.to_string(),
        })
        .collect();
    let (landmark, words) = match of_english(&words) {
        Some((claim, rest)) => (Some(SightClaim::Landmark(claim)), rest),
        None => (None, words),
    };
    let rest = |at: usize| words[at.min(words.len())..].join(" ");
    let before = |at: usize| words[..at].join(" ");
    let walks =
        ["walking", "walks", "moving", "moves", "heading", "going"].iter().any(|it| words.iter().any(|w| w == it));
    let mut claims = vec![];
    let mut is_near = false;
    for (at, word) in words.iter().enumerate() {
        let (rest, before) = (rest(at), before(at));
        let starts = |phrases: &[&str]| phrases.iter().any(|phrase| rest.starts_with(phrase));
        let next = words.get(at + 1).map_or("", String::as_str);
        let place = match () {
            () if starts(&["ahead of", "in front of"]) => Some(Place::Ahead),
            () if word == "behind" => Some(Place::Behind),
            () if starts(&["side by side", "beside", "next to", "alongside"]) => Some(Place::Beside),
            () => None,
        };
        let is_left = word == "left";
        let count = word.parse().ok().or_else(|| number_word(word));
        claims.extend(match (word.as_str(), count) {
            _ if place.is_some() => {
                is_near = true;
                let one = ["someone", "a person", "a pedestrian", "another"].iter().any(|it| rest.contains(it));
                place.filter(|_| one).map(|place| SightClaim::Near(place, 1))
            }
            (_, Some(count)) => Some(match (next, last_place(&words[..at])) {
                ("others" | "other", Some(place)) => SightClaim::Near(place, count as usize),
                ("people", None) => SightClaim::People(count as usize),
                _ => SightClaim::Unknown(format!("{count} {next}")),
            }),
            ("only", _) if next == "person" => Some(SightClaim::People(1)),
            ("leftmost", _) => Some(SightClaim::Outermost(Side::Leftmost)),
            ("rightmost", _) => Some(SightClaim::Outermost(Side::Rightmost)),
            ("nearest" | "closest", _) => Some(SightClaim::Nearest),
            ("away", _) if next == "from" => Some(SightClaim::Across(Across::Away)),
            ("towards" | "toward", _) => Some(SightClaim::Across(Across::Towards)),
            ("left" | "right", _) if walks && before.ends_with("to the") => {
                Some(SightClaim::Across(if is_left { Across::ToTheLeft } else { Across::ToTheRight }))
            }
            ("left" | "right", _) => Some(SightClaim::Part(if is_left { Part::Left } else { Part::Right })),
            ("middle" | "centre" | "center", _) => Some(SightClaim::Part(Part::Middle)),
            ("still", _) => Some(SightClaim::Across(Across::Stands)),
            ("hidden", _) => Some(SightClaim::Hidden),
            ("cannot", _) if starts(&["cannot be seen"]) => Some(SightClaim::Hidden),
            _ => english_clothes::garment_claim(word, next).map(|claim| of_garment(claim, is_near)),
        });
    }
    claims.extend(landmark);
    claims
}

/// The place that the last words speak of.
fn last_place(words: &[String]) -> Option<Place> {
    match words.last().map(String::as_str)? {
        "of" => Some(Place::Ahead),
        "behind" => Some(Place::Behind),
        "with" | "beside" | "to" | "alongside" => Some(Place::Beside),
        _ => None,
    }
    .filter(|place| *place != Place::Ahead || words.iter().any(|word| word == "ahead" || word == "front"))
}

/// A garment is the target's, or that of the person near it.
fn of_garment(claim: Claim, is_near: bool) -> SightClaim {
    match claim {
        Claim::Top(colour) if is_near => SightClaim::NearTop(colour),
        other => SightClaim::Clothes(other),
    }
}

fn read_chinese(clause: &str) -> Vec<SightClaim> {
    let landmark = of_chinese(clause);
    let clause = landmark.as_ref().map_or(clause, |(_, rest)| rest);
    let has = |phrases: &[&str]| phrases.iter().any(|phrase| clause.contains(phrase));
    let place = match () {
        () if has(&["前面", "前方"]) => Some(Place::Ahead),
        () if has(&["后面", "身后", "后方"]) => Some(Place::Behind),
        () if has(&["并排", "并肩", "身旁", "旁边"]) => Some(Place::Beside),
        () => None,
    };
    let walks = clause.contains('走');
    let mut claims = vec![];
    match place {
        Some(place) => claims.extend(people(clause).map(|count| SightClaim::Near(place, count))),
        None if has(&["唯一", "独自"]) => claims.push(SightClaim::People(1)),
        None => claims.extend(people(clause).map(SightClaim::People)),
    }
    let phrases: [(&[&str], SightClaim); 8] = [
        (&["最左"], SightClaim::Outermost(Side::Leftmost)),
        (&["最右"], SightClaim::Outermost(Side::Rightmost)),
        (&["最近"], SightClaim::Nearest),
        (&["背对镜头", "远离镜头"], SightClaim::Across(Across::Away)),
        (&["迎着镜头", "朝镜头", "向镜头"], SightClaim::Across(Across::Towards)),
        (&["站着", "不动", "静止"], SightClaim::Across(Across::Stands)),
        (&["中央", "中间"], SightClaim::Part(Part::Middle)),
        (&["不在视野", "看不见", "不可见"], SightClaim::Hidden),
    ];
    claims.extend(phrases.into_iter().filter(|(words, _)| has(words)).map(|(_, claim)| claim));
    for (word, across, part) in [("画面左", Across::ToTheLeft, Part::Left), ("画面右", Across::ToTheRight, Part::Right)]
    {
        if clause.contains(word) {
            claims.push(if walks { SightClaim::Across(across) } else { SightClaim::Part(part) });
        }
    }
    let garments = clause.char_indices().filter_map(|(at, _)| chinese::clothes::garment(&clause[at..]));
    claims.extend(garments.map(|(claim, _)| of_garment(claim, place.is_some())));
    claims.extend(landmark.map(|(claim, _)| SightClaim::Landmark(claim)));
    claims
}

/// The number of people that a clause names: `另外两人`, `三个人`, `一名`.
fn people(clause: &str) -> Option<usize> {
    let chars: Vec<char> = clause.chars().collect();
    let value = |c: char| match c {
        '两' => Some(2),
        digit if digit.is_ascii_digit() => digit.to_digit(10).map(|digit| digit as usize),
        other => "零一二三四五六七八九十".chars().position(|numeral| numeral == other),
    };
    let is_unit = |at: usize| match chars.get(at) {
        Some('人' | '名' | '位') => true,
        Some('个') => chars.get(at + 1) == Some(&'人'),
        _ => false,
    };
    (0..chars.len()).find_map(|at| value(chars[at]).filter(|_| is_unit(at + 1)))
}

#[cfg(test)]
mod tests {
    use super::super::beside::{Beside, OnSide};
    use super::super::landmarks::LandmarkKind;
    use super::*;

    #[test]
    fn sentences_in_other_words_are_read() {
        let landmark = |beside, kind| SightClaim::Landmark(LandmarkClaim { beside, kind, side: None });
        let tree =
            |side| SightClaim::Landmark(LandmarkClaim { beside: Some(Beside::Passes), kind: LandmarkKind::Tree, side });
        use SightClaim::{Clothes, Hidden, Near, NearTop, Nearest, Outermost, People};
        for (text, language, expected) in [
            (
                "Pursue the walker in a red shirt in front of a person in a black jacket!",
                Language::En,
                vec![Clothes(Claim::Top(Colour::Red)), Near(Place::Ahead, 1), NearTop(Colour::Black)],
            ),
            ("They walk behind 3 others", Language::En, vec![Near(Place::Behind, 3)]),
            ("next to two others", Language::En, vec![Near(Place::Beside, 2)]),
            ("moving to the right", Language::En, vec![SightClaim::Across(Across::ToTheRight)]),
            ("in the right half of the picture", Language::En, vec![SightClaim::Part(Part::Right)]),
            ("the closest of 4 people", Language::En, vec![Nearest, People(4)]),
            ("the person is hidden", Language::En, vec![Hidden]),
            ("7 dogs", Language::En, vec![SightClaim::Unknown("7 dogs".into())]),
            ("walks to the left past a tree", Language::En, vec![SightClaim::Across(Across::ToTheLeft), tree(None)]),
            ("She passes the big tree on the right", Language::En, vec![tree(Some(OnSide::Right))]),
            (
                "standing still beside a street light",
                Language::En,
                vec![SightClaim::Across(Across::Stands), landmark(Some(Beside::NextTo), LandmarkKind::Lamp)],
            ),
            ("above the house", Language::En, vec![landmark(None, LandmarkKind::Building)]),
            ("in a light grey top", Language::En, vec![Clothes(Claim::Top(Colour::Grey))]),
            ("此人经过右边的大树", Language::Zh, vec![tree(Some(OnSide::Right))]),
            (
                "独自一人走近红绿灯",
                Language::Zh,
                vec![People(1), landmark(Some(Beside::Approaches), LandmarkKind::TrafficLight)],
            ),
            ("走在三个人身后", Language::Zh, vec![Near(Place::Behind, 3)]),
            ("与一位穿灰色外套的人并肩而行", Language::Zh, vec![Near(Place::Beside, 1), NearTop(Colour::Grey)]),
            ("画面里有4个人，他在最右边", Language::Zh, vec![People(4), Outermost(Side::Rightmost)]),
            ("在画面右侧站着", Language::Zh, vec![SightClaim::Across(Across::Stands), SightClaim::Part(Part::Right)]),
        ] {
            assert_eq!(read(text, language), expected, "{text}");
        }
    }
}
