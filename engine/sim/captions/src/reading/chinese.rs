//! Reads Chinese texts: characters and numbers, clause by clause.

use super::{Claim, count};
use crate::compass::Compass;
use crate::turns::TurnKind;
use cosfly_render::Colour;

const ALTITUDE_WORDS: [&str; 3] = ["高", "上方", "头顶"];
const WAY_WORDS: [&str; 4] = ["全程", "路程", "行程", "走了"];
const DISTANCE_WORDS: [&str; 6] = ["距", "保持", "间隔", "外", "远", "后方"];
const STANDING_WORDS: [&str; 4] = ["站立", "站着", "静止", "原地"];
const STRAIGHT_WORDS: [&str; 4] = ["直行", "笔直", "径直", "直走"];

const COLOURS: [(&str, Colour); 12] = [
    ("黑", Colour::Black),
    ("灰", Colour::Grey),
    ("白", Colour::White),
    ("红", Colour::Red),
    ("橙", Colour::Orange),
    ("黄", Colour::Yellow),
    ("绿", Colour::Green),
    ("蓝", Colour::Blue),
    ("紫", Colour::Purple),
    ("粉", Colour::Pink),
    ("棕", Colour::Brown),
    ("米", Colour::Beige),
];

/// Everything that the text claims, in order.
pub fn read(text: &str) -> Vec<Claim> {
    let mut after_stop = false;
    let read = |clause: &Vec<char>| {
        let words: String = clause.iter().collect();
        // `途中停留一次，约3秒`: the time belongs to the stop.
        let about_stops = words.contains('停') || after_stop && ["约", "共约"].iter().any(|it| words.starts_with(it));
        after_stop = words.contains('停');
        read_clause(&words, about_stops)
    };
    clauses(text).iter().flat_map(read).collect()
}

pub(crate) fn clauses(text: &str) -> Vec<Vec<char>> {
    let chars: Vec<char> = text.chars().collect();
    let mut clauses = vec![vec![]];
    for (i, &c) in chars.iter().enumerate() {
        let decimal = c == '.' && chars.get(i + 1).is_some_and(char::is_ascii_digit);
        if "，。；：！？、（）,;:!?()\n".contains(c) || (c == '.' && !decimal) {
            clauses.push(vec![]);
        } else {
            clauses.last_mut().expect("there is always one clause").push(c);
        }
    }
    clauses
}

fn read_clause(clause: &str, about_stops: bool) -> Vec<Claim> {
    let mut claims = vec![];
    let mut rest = clause;
    while let Some(first) = rest.chars().next() {
        if let Some((kind, times, after)) = repeated_turn(rest) {
            claims.extend(core::iter::repeat_n(Claim::Turn(kind), times));
            rest = after;
        } else if let Some((claim, after)) = garment(rest) {
            claims.push(claim);
            rest = after;
        } else if let Some((value, after)) = number(rest) {
            let (claim, used) = quantity(value, after, clause, about_stops);
            claims.push(claim);
            rest = &after[used..];
        } else if let Some((direction, length)) = compass(rest) {
            claims.push(direction.map_or_else(|| Claim::Unknown(rest[..length].to_owned()), Claim::Direction));
            rest = &rest[length..];
        } else if let Some((kind, length)) = turn(rest) {
            rest = &rest[length..];
            match number(rest).filter(|(_, after)| after.starts_with('次')) {
                Some((value, after)) => {
                    claims.push(count(value, "次", |count| Claim::TurnsOf(kind, count)));
                    rest = &after['次'.len_utf8()..];
                }
                None => claims.push(Claim::Turn(kind)),
            }
        } else {
            rest = &rest[first.len_utf8()..];
        }
    }
    if STANDING_WORDS.iter().any(|word| clause.contains(word)) {
        claims.push(Claim::Stays);
    }
    if STRAIGHT_WORDS.iter().any(|word| clause.contains(word)) || denied(clause, '转') {
        claims.push(Claim::NoTurns);
    }
    if denied(clause, '停') {
        claims.push(Claim::Stops(0));
    } else if about_stops && !claims.iter().any(|claim| matches!(claim, Claim::Stops(_) | Claim::Standing(_))) {
        claims.push(Claim::SomeStops);
    }
    claims
}

/// `两次右转` at the start of `text`: the turn, its repetitions, and what follows.
fn repeated_turn(text: &str) -> Option<(TurnKind, usize, &str)> {
    let (value, after) = number(text)?;
    let after = after.strip_prefix('次')?;
    let (kind, length) = turn(after)?;
    (value.fract() == 0.0 && value < 100.0).then(|| (kind, value as usize, &after[length..]))
}

/// A colour before a garment at the start of `text`, or luggage; and what follows.
pub(crate) fn garment(text: &str) -> Option<(Claim, &str)> {
    if let Some(after) = text.strip_prefix("背包") {
        return Some((Claim::Backpack, after));
    }
    let (colour, after) = COLOURS.iter().find_map(|(name, colour)| Some((*colour, text.strip_prefix(name)?)))?;
    let after = after.strip_prefix('色').unwrap_or(after).trim_start_matches('的');
    let starts = |garments: &[&str]| garments.iter().find_map(|garment| after.strip_prefix(garment));
    let top = starts(&["上衣", "外套", "衬衫"]).map(|after| (Claim::Top(colour), after));
    top.or_else(|| starts(&["裤子", "长裤"]).map(|after| (Claim::Trousers(colour), after)))
}

/// Whether a negation comes before the word in the clause.
fn denied(clause: &str, word: char) -> bool {
    let Some(at) = clause.find(word) else { return false };
    ["不", "没", "未", "无需", "从未"].iter().any(|negation| clause[..at].contains(negation))
}

/// A number at the start of `text`, in digits or as one Chinese numeral before a unit, and what follows it.
fn number(text: &str) -> Option<(f64, &str)> {
    let first = text.chars().next()?;
    if let Some(value) =
        "零一二三四五六七八九十".chars().position(|numeral| numeral == first).or((first == '两').then_some(2))
    {
        let after = &text[first.len_utf8()..];
        let counts = ["次", "米", "度", "秒", "个弯"].iter().any(|unit| after.starts_with(unit));
        return counts.then_some((value as f64, after));
    }
    let end = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
    let value: f64 = text[..end].parse().ok()?;
    Some((value, text[end..].trim_start()))
}

/// The claim of a number with the unit after it, and the bytes of that unit.
fn quantity(value: f64, after: &str, clause: &str, about_stops: bool) -> (Claim, usize) {
    let has = |known: &[&str]| known.iter().any(|word| clause.contains(word));
    let unit = ["米/秒", "米每秒", "米", "公尺", "度", "°", "秒", "次", "个弯"]
        .into_iter()
        .find(|unit| after.starts_with(unit));
    let claim = match unit {
        Some("米/秒" | "米每秒") => Claim::Speed(value),
        Some("米" | "公尺") if has(&ALTITUDE_WORDS) => Claim::Altitude(value),
        Some("米" | "公尺") if has(&WAY_WORDS) => Claim::Way(value),
        Some("米" | "公尺") if has(&DISTANCE_WORDS) => Claim::Distance(value),
        Some("度" | "°") => {
            Claim::Pitch(if clause.contains('仰') && !clause.contains('俯') { -value } else { value })
        }
        Some("秒") if about_stops => Claim::Standing(value),
        Some("秒") => Claim::Duration(value),
        Some("次") if about_stops => count(value, "次", Claim::Stops),
        Some("次") if clause.contains('转') => count(value, "次", Claim::Turns),
        Some("个弯") => count(value, "个弯", Claim::Turns),
        _ => Claim::Unknown(format!("{value}{}", unit.unwrap_or_default())),
    };
    (claim, unit.map_or(0, str::len))
}

/// A run of compass characters: the direction, or `None` when there is no such direction; and its bytes.
fn compass(text: &str) -> Option<(Option<Compass>, usize)> {
    let run: String = text.chars().take_while(|c| "东南西北".contains(*c)).collect();
    let direction = match run.as_str() {
        "" => return None,
        "东" => Some(Compass::East),
        "东南" => Some(Compass::Southeast),
        "南" => Some(Compass::South),
        "西南" => Some(Compass::Southwest),
        "西" => Some(Compass::West),
        "西北" => Some(Compass::Northwest),
        "北" => Some(Compass::North),
        "东北" => Some(Compass::Northeast),
        _ => None,
    };
    Some((direction, run.len()))
}

fn turn(text: &str) -> Option<(TurnKind, usize)> {
    [
        ("左转", TurnKind::Left),
        ("左拐", TurnKind::Left),
        ("右转", TurnKind::Right),
        ("右拐", TurnKind::Right),
        ("掉头", TurnKind::Around),
        ("折返", TurnKind::Around),
    ]
    .into_iter()
    .find_map(|(word, kind)| text.starts_with(word).then_some((kind, word.len())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sentences_in_other_words_are_read() {
        for (text, expected) in [
            (
                "跟随向北行走的行人，保持约25米距离，俯仰角约45度。",
                vec![Claim::Direction(Compass::North), Claim::Distance(25.0), Claim::Pitch(45.0)],
            ),
            ("仰角约5度", vec![Claim::Pitch(-5.0)]),
            ("途中停了两次，没有转弯。", vec![Claim::Stops(2), Claim::NoTurns]),
            ("一路不停", vec![Claim::Stops(0)]),
            ("停了一会儿", vec![Claim::SomeStops]),
            ("以1.4米/秒向东南走", vec![Claim::Speed(1.4), Claim::Direction(Compass::Southeast)]),
            (
                "左转2次、右转、掉头",
                vec![Claim::TurnsOf(TurnKind::Left, 2), Claim::Turn(TurnKind::Right), Claim::Turn(TurnKind::Around)],
            ),
            ("向北东走，3只猫", vec![Claim::Unknown("北东".into()), Claim::Unknown("3".into())]),
            (
                "出发后连续两次右转，再左转",
                vec![Claim::Turn(TurnKind::Right), Claim::Turn(TurnKind::Right), Claim::Turn(TurnKind::Left)],
            ),
            ("途中停留一次，约3秒，历时约20秒", vec![Claim::Stops(1), Claim::Standing(3.0), Claim::Duration(20.0)]),
            (
                "身穿红色上衣、蓝色裤子、背着背包的行人",
                vec![Claim::Top(Colour::Red), Claim::Trousers(Colour::Blue), Claim::Backpack],
            ),
            ("在目标上方20米", vec![Claim::Altitude(20.0)]),
        ] {
            assert_eq!(read(text), expected, "{text}");
        }
    }
}
