//! Chinese texts, clause by clause: characters and numbers become claims.

use super::clothes::{both_garments, garment, shade, worn};
use super::garments::COLOURS;
use super::numbers::number;
use super::pauses::{
    denied_near, denied_word, is_count_alone, is_of_the_drone, is_only_standing, is_time_alone, order_of_stop_and_turn,
    without_empty_counts,
};
use super::plain::plain;
use super::quantities::quantity;
use super::turns::{compass, repeated_turn, turn};
use super::words::{
    GOES_ON, LEVEL, MOVES, NEVER_STOPS, NO_TURN_WORDS, STANDING_WORDS, STOP_CHARS, STRAIGHT_WORDS, TURNS, WALKING,
};
use crate::turn::TurnKind;
use crate::{Claim, count, sentences, stands_for, with_level_view};

/// Everything that the text claims, in order.
pub fn read(text: &str) -> Vec<Claim> {
    let text = &plain(text);
    let sentence = |sentence: &str| {
        let mut after_stop = false;
        let mut before = String::new();
        let read = |clause: Vec<char>| {
            let words = without_empty_counts(&joined(&clause.iter().collect::<String>()));
            // `途中停留一次，约3秒`: the time belongs to the stop.
            let speaks = STOP_CHARS.iter().any(|word| words.contains(word)) && !is_of_the_drone(&words);
            let about_stops = speaks
                || after_stop
                    && (GOES_ON.iter().any(|it| words.starts_with(it))
                        || is_time_alone(&words)
                        || is_count_alone(&words));
            let is_near_stop = about_stops || after_stop;
            let was_stop = after_stop;
            after_stop = about_stops && !STOP_CHARS.iter().any(|word| denied_word(&words, word));
            let claims = read_clause(&words, &before, about_stops, is_near_stop, was_stop);
            before = words;
            claims
        };
        let mut claims: Vec<Claim> = clauses(sentence).into_iter().flat_map(read).collect();
        // A word of pausing in a sentence with a negation may be what is denied.
        let is_denied = sentence.contains(['没', '不', '未', '无', '别', '零']);
        let is_told = claims.iter().any(|claim| matches!(claim, Claim::Stops(_)));
        claims.retain(|claim| !((is_denied || is_told) && *claim == Claim::SomeStops));
        claims
    };
    let is_level = LEVEL.iter().any(|word| text.contains(word)) || clauses(text).iter().any(|it| denies_tilt(it));
    with_level_view(sentences(text).into_iter().flat_map(sentence).collect(), is_level)
}

/// `镜头不要俯也不要仰`, `镜头未作俯仰`: neither up nor down.
fn denies_tilt(clause: &[char]) -> bool {
    let has = |of: &str| clause.iter().any(|c| of.contains(*c));
    let is_aim = has("俯") && has("仰") || clause.windows(2).any(|pair| pair == ['角', '度']) && has("镜机云台");
    is_aim && has("不没未无别勿") && !has("0123456789")
}

/// Clauses of a text, without the marks between them.
pub fn clauses(text: &str) -> Vec<Vec<char>> {
    let chars: Vec<char> = text.chars().collect();
    let mut clauses = vec![vec![]];
    for (i, &c) in chars.iter().enumerate() {
        let is_statement = "：:".contains(c) && chars.get(i + 1).is_some_and(|next| starts_statement(*next));
        let decimal = c == '.' && chars.get(i + 1).is_some_and(char::is_ascii_digit);
        // `80秒、130米` is one statement.
        let is_list = c == '、' && chars.get(i + 1).is_some_and(char::is_ascii_digit);
        let rest = || chars[i + 1..].iter().take(2).collect::<String>();
        // `上衣：红色`
        if c == '：' && COLOURS.iter().any(|(name, _)| rest().starts_with(name)) {
            clauses.last_mut().expect("there is always one clause").push('是');
        } else if "：:？?".contains(c) && ["无", "零", "没有", "未"].iter().any(|it| rest().starts_with(it)) {
            // `停留：无`
            clauses.last_mut().expect("there is always one clause").push('为');
        } else if is_statement {
            // `停顿：2次` is one statement.
        } else if ("，。；：！？、（）,;:!?()\n".contains(c) && !is_list) || (c == '.' && !decimal) {
            clauses.push(vec![]);
        } else {
            clauses.last_mut().expect("there is always one clause").push(c);
        }
    }
    clauses
}

/// Whether a character behind a colon begins a number.
fn starts_statement(c: char) -> bool {
    c.is_ascii_digit() || "零一二两三四五六七八九十".contains(c)
}

/// Verb and object without what stands between them: `掉过头来` as `掉头来`.
fn joined(clause: &str) -> String {
    let parted = [
        ("掉过头", "掉头"),
        ("掉了头", "掉头"),
        ("转过身", "转身"),
        ("转了身", "转身"),
        ("调过头", "调头"),
        ("掉了个头", "掉头"),
        ("调了个头", "调头"),
        ("调了头", "调头"),
    ];
    counted_around(&parted.iter().fold(clause.to_owned(), |clause, (from, to)| clause.replace(from, to)))
}

/// `掉了1次头` as `掉头1次`.
fn counted_around(clause: &str) -> String {
    for verb in ["掉了", "调了", "掉", "调"] {
        let Some((before, after)) = clause.split_once(verb) else { continue };
        let Some((_, counted)) = number(after) else { continue };
        if let Some(rest) = counted.strip_prefix(['次', '个', '回']).and_then(|rest| rest.strip_prefix('头')) {
            let times = &after[..after.len() - counted.len()];
            return format!("{before}掉头{times}次{rest}");
        }
    }
    clause.to_owned()
}

fn read_clause(clause: &str, before: &str, about_stops: bool, is_near_stop: bool, was_stop: bool) -> Vec<Claim> {
    let mut claims = vec![];
    let mut rest = clause;
    while let Some(first) = rest.chars().next() {
        let at = clause.len() - rest.len();
        if let Some(after) = rest.strip_prefix("左右") {
            rest = after;
        } else if let Some((kind, times, after)) = repeated_turn(rest) {
            claims.extend(core::iter::repeat_n(Claim::Turn(kind), times));
            rest = after;
        } else if let Some((claim, after)) = shade(clause, rest) {
            claims.push(claim);
            rest = after;
        } else if let Some((claim, after)) = garment(rest).or_else(|| worn(clause, rest)) {
            let denied = denied_near(&clause[..at]);
            claims.push(if denied && claim == Claim::Backpack { Claim::NoBackpack } else { claim });
            rest = after;
        } else if let Some(after) =
            ["一秒走", "一秒钟走", "1秒走", "一秒能走", "一秒钟合", "一秒合", "一秒钟", "一秒", "1秒"]
                .iter()
                .find_map(|it| rest.strip_prefix(it))
            && let Some((value, after)) = number(after.trim_start_matches(['约', '大', '概', '了']))
            && let Some(after) = after.strip_prefix('米')
        {
            claims.push(Claim::Speed(value));
            rest = after;
        } else if let Some(after) = ordinal(&clause[..at], rest) {
            rest = after;
        } else if let Some((value, after)) = number(rest) {
            let (claim, used) = quantity(value, after, clause, at, before, (about_stops, is_near_stop));
            claims.push(claim);
            rest = &after[used..];
        } else if let Some((direction, length)) = compass(rest) {
            claims.push(direction.map_or_else(|| Claim::Unknown(rest[..length].to_owned()), Claim::Direction));
            rest = &rest[length..];
        } else if let Some((kind, length)) = turn(rest, true) {
            rest = &rest[length..];
            // `左拐了一次`
            let times = rest.trim_start_matches(['了', '过']);
            match number(times).filter(|(_, after)| after.starts_with(['次', '回'])) {
                Some((value, after)) => {
                    if kind == TurnKind::Around && claims.last() == Some(&Claim::Turn(kind)) {
                        claims.pop();
                    }
                    claims.push(count(value, "次", |count| Claim::TurnsOf(kind, count)));
                    rest = &after['次'.len_utf8()..];
                }
                // A turn around in two words is one.
                None if kind == TurnKind::Around && claims.last() == Some(&Claim::Turn(kind)) => {
                    claims.push(Claim::PerhapsTurn(kind));
                }
                None => claims.push(Claim::Turn(kind)),
            }
        } else {
            rest = &rest[first.len_utf8()..];
        }
    }
    later_first(&mut claims, clause);
    both_garments(clause, &mut claims);
    // A time of standing tells a stop from a target that stands all the time.
    let is_timed_stop = was_stop && clause.contains('秒') && !clause.contains("原地") && !clause.contains("一直");
    let stands = !is_timed_stop
        && (STANDING_WORDS.iter().any(|word| clause.contains(word))
            || MOVES.iter().any(|word| denied_word(clause, word)));
    if stands && (!about_stops || is_only_standing(clause)) {
        claims.push(Claim::Stays);
    }
    let is_walking = WALKING.iter().any(|word| clause.contains(word) && !denied_word(clause, word));
    if is_walking && !stands {
        claims.push(Claim::Walks);
    }
    // `左转右转掉头一个都没有`
    let none_of_these = clause.contains("都没有") && claims.iter().any(|claim| matches!(claim, Claim::Turn(_)));
    if none_of_these
        || NO_TURN_WORDS.iter().any(|word| clause.contains(word))
        || TURNS.iter().any(|word| denied_word(clause, word))
    {
        claims.retain(|claim| !matches!(claim, Claim::Turn(_) | Claim::Turns(_) | Claim::TurnsOf(..)));
        claims.push(Claim::NoTurns);
    } else if STRAIGHT_WORDS.iter().any(|word| clause.contains(word))
        || ["方向", "朝向", "航向"].iter().any(|it| clause.contains(it))
            && ["不变", "没变", "未变", "一致", "恒定", "如一", "不改", "没改", "未改", "固定"]
                .iter()
                .any(|it| clause.contains(it))
    {
        claims.push(Claim::Straight);
    }
    if about_stops && STOP_CHARS.iter().any(|word| denied_word(clause, word))
        || NEVER_STOPS.iter().any(|it| clause.contains(it))
    {
        claims.retain(|claim| !matches!(claim, Claim::Stops(_)));
        claims.push(Claim::Stops(0));
    } else if about_stops
        && STOP_CHARS.iter().any(|word| clause.contains(word))
        && !claims.iter().any(|claim| matches!(claim, Claim::Stops(_) | Claim::Standing(_) | Claim::Stays))
    {
        claims.push(Claim::SomeStops);
    }
    claims.extend(order_of_stop_and_turn(clause, about_stops));
    stands_for(claims)
}

/// `左转之前先右转` says the later turn first.
fn later_first(claims: &mut [Claim], clause: &str) {
    let places: Vec<usize> = (0..claims.len()).filter(|at| matches!(claims[*at], Claim::Turn(_))).collect();
    if let ([one, other], true) = (&places[..], clause.contains("之前先") || clause.contains("前先")) {
        claims.swap(*one, *other);
    }
}

/// `头一回`, `下一次`: what follows the word that counts nothing.
fn ordinal<'a>(before: &str, text: &'a str) -> Option<&'a str> {
    let is_one = before.ends_with(['头', '下', '上', '第', '这', '那', '每', '又', '再']);
    ["一回", "一次", "一遭"].iter().find_map(|it| text.strip_prefix(it)).filter(|_| is_one)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compass::Compass;
    use cosfly_domain::Colour;

    #[test]
    fn sentences_in_other_words_are_read() {
        for (text, expected) in [
            (
                "跟随向北行走的行人，保持约25米距离，俯仰角约45度。",
                vec![Claim::Direction(Compass::North), Claim::Walks, Claim::Distance(25.0), Claim::Tilt(45.0)],
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
            ("途中停留一次，约3秒，历时约20秒", vec![Claim::Stops(1), Claim::Seconds(3.0), Claim::Seconds(20.0)]),
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
