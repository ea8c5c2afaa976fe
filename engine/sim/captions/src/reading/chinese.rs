//! Reads Chinese texts: characters and numbers, clause by clause.

use super::chinese_words::{
    ALTITUDE_WORDS, COLOURS, DISTANCE_WORDS, GOES_ON, NO_STOP, OTHER_COLOURS, STANDING_WORDS, STOP_CHARS,
    STRAIGHT_WORDS, TOPS, TROUSERS, WAY_WORDS,
};
use super::{Claim, count, sentences};
use crate::compass::Compass;
use crate::turns::TurnKind;

/// Everything that the text claims, in order.
pub fn read(text: &str) -> Vec<Claim> {
    let sentence = |sentence: &str| {
        let mut after_stop = false;
        let read = |clause: Vec<char>| {
            let words = without_empty_counts(&clause.iter().collect::<String>());
            // `途中停留一次，约3秒`: the time belongs to the stop.
            let speaks = STOP_CHARS.iter().any(|word| words.contains(word));
            let about_stops =
                speaks || after_stop && (GOES_ON.iter().any(|it| words.starts_with(it)) || is_time_alone(&words));
            after_stop = about_stops && !STOP_CHARS.iter().any(|word| denied_word(&words, word));
            read_clause(&words, about_stops)
        };
        clauses(sentence).into_iter().flat_map(read).collect::<Vec<_>>()
    };
    sentences(text).into_iter().flat_map(sentence).collect()
}

/// A time in a clause that speaks of nothing else: `有6秒`, `加一块儿14秒`.
fn is_time_alone(clause: &str) -> bool {
    let clause = clause.replace("再走", "").replace("继续走", "");
    clause.contains('秒') && !NO_STOP.iter().any(|word| clause.contains(word))
}

/// `一次弯都没转`, `一个弯也不拐`: the number there counts nothing.
fn without_empty_counts(clause: &str) -> String {
    let is_denied = ["都没", "都不", "都未", "也没", "也不", "也未"].iter().any(|word| clause.contains(word));
    if !is_denied {
        return clause.to_owned();
    }
    ["一次", "一回", "一个", "一步", "一下", "一刻", "半个", "半步"]
        .iter()
        .fold(clause.to_owned(), |clause, count| clause.replace(count, ""))
}

pub(crate) fn clauses(text: &str) -> Vec<Vec<char>> {
    let chars: Vec<char> = text.chars().collect();
    let mut clauses = vec![vec![]];
    for (i, &c) in chars.iter().enumerate() {
        let decimal = c == '.' && chars.get(i + 1).is_some_and(char::is_ascii_digit);
        // `80秒、130米` is one statement.
        let is_list = c == '、' && chars.get(i + 1).is_some_and(char::is_ascii_digit);
        let rest = || chars[i + 1..].iter().take(2).collect::<String>();
        // `上衣：红色`
        if c == '：' && COLOURS.iter().any(|(name, _)| rest().starts_with(name)) {
            clauses.last_mut().expect("there is always one clause").push('是');
        } else if ("，。；：！？、（）,;:!?()\n".contains(c) && !is_list) || (c == '.' && !decimal) {
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
    let turns_here = ['转', '拐', '弯'].iter().any(|word| clause.contains(*word));
    while let Some(first) = rest.chars().next() {
        let at = clause.len() - rest.len();
        if let Some(after) = rest.strip_prefix("左右") {
            rest = after;
        } else if let Some((kind, times, after)) = repeated_turn(rest) {
            claims.extend(core::iter::repeat_n(Claim::Turn(kind), times));
            rest = after;
        } else if let Some(other) = OTHER_COLOURS.iter().find(|it| rest.starts_with(**it)) {
            claims.push(Claim::Unknown((*other).to_owned()));
            rest = &rest[other.len()..];
        } else if let Some((claim, after)) = garment(rest).or_else(|| worn(clause, rest)) {
            let denied = ["没", "未", "不", "无"].iter().any(|word| clause[..at].ends_with(word))
                || ["没有", "未背", "不背", "没背", "没带", "未带"].iter().any(|word| clause[..at].ends_with(word));
            claims.push(if denied && claim == Claim::Backpack { Claim::NoBackpack } else { claim });
            rest = after;
        } else if let Some(after) =
            ["一秒走", "一秒钟走", "1秒走", "一秒能走"].iter().find_map(|it| rest.strip_prefix(it))
            && let Some((value, after)) = number(after.trim_start_matches(['约', '大', '概', '了']))
            && let Some(after) = after.strip_prefix('米')
        {
            claims.push(Claim::Speed(value));
            rest = after;
        } else if let Some((value, after)) = number(rest) {
            let (claim, used) = quantity(value, after, clause, at, about_stops);
            claims.push(claim);
            rest = &after[used..];
        } else if let Some((direction, length)) = compass(rest) {
            claims.push(direction.map_or_else(|| Claim::Unknown(rest[..length].to_owned()), Claim::Direction));
            rest = &rest[length..];
        } else if let Some((kind, length)) = turn(rest, turns_here) {
            rest = &rest[length..];
            // `左拐了一次`
            let times = rest.trim_start_matches(['了', '过']);
            match number(times).filter(|(_, after)| after.starts_with(['次', '回'])) {
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
    if STANDING_WORDS.iter().any(|word| clause.contains(word)) && !about_stops {
        claims.push(Claim::Stays);
    }
    if STRAIGHT_WORDS.iter().any(|word| clause.contains(word)) || denied(clause, '转') || denied(clause, '拐') {
        claims.retain(|claim| !matches!(claim, Claim::Turn(_) | Claim::Turns(_) | Claim::TurnsOf(..)));
        claims.push(Claim::NoTurns);
    }
    if STOP_CHARS.iter().any(|word| denied_word(clause, word))
        || ["一刻不停", "一口气"].iter().any(|it| clause.contains(it))
    {
        claims.retain(|claim| !matches!(claim, Claim::Stops(_)));
        claims.push(Claim::Stops(0));
    } else if STOP_CHARS.iter().any(|word| clause.contains(word))
        && !claims.iter().any(|claim| matches!(claim, Claim::Stops(_) | Claim::Standing(_)))
    {
        claims.push(Claim::SomeStops);
    }
    claims.extend(order_of_stop_and_turn(clause, about_stops));
    claims
}

/// `左转前停了一次`, `停留之后右转`.
fn order_of_stop_and_turn(clause: &str, about_stops: bool) -> Option<Claim> {
    let stop = STOP_CHARS.iter().find_map(|word| clause.find(word)).filter(|_| about_stops)?;
    let turn = ["左转", "右转", "左拐", "右拐", "掉头", "转弯", "拐弯"].iter().find_map(|word| clause.find(word))?;
    let between = &clause[stop.min(turn)..stop.max(turn)];
    match () {
        () if between.contains('前') && !between.contains("前行") && !between.contains("前进") => {
            Some(Claim::StopFirst(turn < stop))
        }
        () if between.contains('后') || between.contains('再') => Some(Claim::StopFirst(stop < turn)),
        () => None,
    }
}

/// `上衣是红色`, `上身穿红色`: a colour behind its garment; `红色` alone: something that is worn.
fn worn<'a>(clause: &str, text: &'a str) -> Option<(Claim, &'a str)> {
    let (colour, after) = COLOURS.iter().find_map(|(name, colour)| Some((*colour, text.strip_prefix(name)?)))?;
    let after = after.strip_prefix('色')?;
    let before = &clause[..clause.len() - text.len()];
    let last = |words: &[&str]| words.iter().filter_map(|word| before.rfind(word)).max();
    let links = before.ends_with(['是', '为', '穿', '着', '呈', '深', '浅'])
        || TOPS.iter().chain(&TROUSERS).any(|garment| before.ends_with(garment));
    let top = last(&TOPS).max(last(&["上身"])).filter(|_| links);
    let trousers = last(&TROUSERS).max(last(&["下身"])).filter(|_| links);
    let claim = match (top, trousers) {
        (None, None) => Claim::Wears(colour),
        (top, trousers) if top > trousers => Claim::Top(colour),
        _ => Claim::Trousers(colour),
    };
    Some((claim, after))
}

/// `两次右转` at the start of `text`: the turn, its repetitions, and what follows.
fn repeated_turn(text: &str) -> Option<(TurnKind, usize, &str)> {
    let (value, after) = number(text)?;
    let after = after.strip_prefix(['次', '个', '回'])?;
    let (kind, length) = turn(after, false)?;
    (value.fract() == 0.0 && value < 100.0).then(|| (kind, value as usize, &after[length..]))
}

/// A colour before a garment at the start of `text`, or luggage; and what follows.
pub(crate) fn garment(text: &str) -> Option<(Claim, &str)> {
    for luggage in ["双肩背包", "双肩包", "背包", "书包", "背着包", "背着个包", "背个包", "背了包", "背了个包"]
    {
        if let Some(after) = text.strip_prefix(luggage) {
            return Some((Claim::Backpack, after));
        }
    }
    let (colour, after) = COLOURS.iter().find_map(|(name, colour)| Some((*colour, text.strip_prefix(name)?)))?;
    let after = after.strip_prefix('色').unwrap_or(after).trim_start_matches(['的', 'T']);
    let starts = |garments: &[&str]| garments.iter().find_map(|garment| after.strip_prefix(garment));
    let top = starts(&TOPS).map(|after| (Claim::Top(colour), after));
    top.or_else(|| starts(&TROUSERS).map(|after| (Claim::Trousers(colour), after)))
}

/// Whether a negation comes before the word in the clause.
fn denied(clause: &str, word: char) -> bool {
    denied_word(clause, word.encode_utf8(&mut [0; 4]))
}

fn denied_word(clause: &str, word: &str) -> bool {
    let negations = ["不", "没", "未", "无"];
    clause.match_indices(word).any(|(at, _)| {
        let negation = negations.iter().filter_map(|negation| clause[..at].rfind(negation)).max();
        let negation = negation.filter(|from| !NO_NEGATIONS.iter().any(|word| clause[*from..].starts_with(word)));
        negation.is_some_and(|from| {
            let between = &clause[from..at];
            between.chars().count() <= FAR_NEGATION && !between.contains("背包") && !between.contains("双肩包")
        })
    })
}

/// Words with a negation in them that deny nothing.
const NO_NEGATIONS: [&str; 6] = ["不久", "不远", "不断", "不时", "不过", "不一会"];
/// Characters over which a negation reaches.
const FAR_NEGATION: usize = 8;

const UNITS: [&str; 14] =
    ["米/秒", "米每秒", "米", "公尺", "度", "°", "分钟", "分", "秒钟", "秒", "次", "回", "个弯", "个转弯"];

/// A number at the start of `text`, in digits or as Chinese numerals before a unit, and what follows it.
fn number(text: &str) -> Option<(f64, &str)> {
    let first = text.chars().next()?;
    if !first.is_ascii_digit() {
        let end = text.find(|c: char| !"零一二两三四五六七八九十百".contains(c)).unwrap_or(text.len());
        let after = &text[end..];
        let counts =
            UNITS.iter().any(|unit| after.starts_with(unit)) || after.starts_with("个左") || after.starts_with("个右");
        return numeral(&text[..end]).filter(|_| counts).map(|value| (value, after));
    }
    let end = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
    let value: f64 = text[..end].parse().ok()?;
    Some((value, text[end..].trim_start()))
}

/// The value of numerals below a thousand, such as `一百二十五`.
fn numeral(text: &str) -> Option<f64> {
    let digit = |c: char| match c {
        '两' => Some(2),
        c => "零一二三四五六七八九".chars().position(|it| it == c),
    };
    let (mut value, mut last) = (0, None);
    for c in text.chars() {
        match (c, digit(c)) {
            ('百', _) => value += 100 * last.take()?,
            ('十', _) => value += 10 * last.take().unwrap_or(1),
            (_, digit) => last = digit,
        }
    }
    (!text.is_empty()).then_some((value + last.unwrap_or(0)) as f64)
}

/// The list that has the word nearest to a number at a place of the clause.
fn nearest(clause: &str, at: usize, lists: &[&[&str]]) -> Option<usize> {
    let places = |word: &&str| {
        clause
            .match_indices(*word)
            .map(|(place, word)| if place < at { at - place - word.len() } else { place - at })
            .min()
    };
    let of = |(number, list): (usize, &&[&str])| Some((list.iter().filter_map(places).min()?, number));
    lists.iter().enumerate().filter_map(of).min().map(|(_, number)| number)
}

/// The claim of a number with the unit after it, and the bytes of that unit.
fn quantity(value: f64, after: &str, clause: &str, at: usize, about_stops: bool) -> (Claim, usize) {
    let unit = UNITS.into_iter().find(|unit| after.starts_with(unit));
    let before = &clause[..at];
    let is_up = ['仰', '扬', '抬'].iter().any(|word| clause.contains(*word))
        || clause.contains("向上")
        || ["朝上", "往上", "高于水平", "朝天"].iter().any(|word| clause.contains(word));
    let is_down = clause.contains('俯')
        || clause.contains("向下")
        || ["朝下", "下压", "往下", "低于水平", "下倾", "朝地"].iter().any(|word| clause.contains(word));
    let seconds = |value: f64| match about_stops
        && nearest(&clause.replace("再走", ""), at, &[&STOP_CHARS, &["用时", "历时", "耗时", "走"]]) != Some(1)
    {
        true => Claim::Standing(value),
        false => Claim::Duration(value),
    };
    let claim = match unit {
        Some("米/秒" | "米每秒") => Claim::Speed(value),
        Some("米" | "公尺") if before.trim_end_matches(['约', '大', '概', '走']).ends_with("每秒") => {
            Claim::Speed(value)
        }
        Some("米" | "公尺") => match nearest(clause, at, &[&ALTITUDE_WORDS, &WAY_WORDS, &DISTANCE_WORDS]) {
            Some(0) => Claim::Altitude(value),
            Some(1) => Claim::Way(value),
            _ => Claim::Distance(value),
        },
        Some("度" | "°") => Claim::Pitch(if is_up && !is_down { -value } else { value }),
        Some(unit @ ("分钟" | "分")) => {
            // `1分30秒` is one time.
            let rest = number(after[unit.len()..].trim_start_matches('零'));
            if let Some((more, tail)) = rest
                && let Some(last) = ["秒钟", "秒"].into_iter().find(|it| tail.starts_with(it))
            {
                return (seconds(60.0 * value + more), after.len() - tail.len() + last.len());
            }
            seconds(60.0 * value)
        }
        Some("秒" | "秒钟") => seconds(value),
        Some("次" | "回") if about_stops => count(value, "次", Claim::Stops),
        Some("次" | "回") if clause.contains(['转', '拐']) => count(value, "次", Claim::Turns),
        Some("个弯" | "个转弯") => count(value, "个弯", Claim::Turns),
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

/// A turn at the start of `text`; `turns_here`: the clause speaks of turns, so that `先左后右` is two of them.
fn turn(text: &str, turns_here: bool) -> Option<(TurnKind, usize)> {
    let long = [
        ("左转弯", TurnKind::Left),
        ("右转弯", TurnKind::Right),
        ("左转", TurnKind::Left),
        ("左拐", TurnKind::Left),
        ("右转", TurnKind::Right),
        ("右拐", TurnKind::Right),
        ("掉头", TurnKind::Around),
        ("调头", TurnKind::Around),
        ("折返", TurnKind::Around),
        ("回头", TurnKind::Around),
        ("原路返回", TurnKind::Around),
    ];
    let short = [("左", TurnKind::Left), ("右", TurnKind::Right)];
    let short = short.iter().filter(|_| turns_here && !text.starts_with("左右"));
    long.iter().chain(short).find_map(|(word, kind)| text.starts_with(word).then_some((*kind, word.len())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_render::Colour;

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
