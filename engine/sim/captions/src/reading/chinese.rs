//! Reads Chinese texts: characters and numbers, clause by clause.

use super::chinese_words::{
    COLOURS, GOES_ON, NO_STOP, NO_TURN_WORDS, SHADES, STANDING_WORDS, STOP_CHARS, STRAIGHT_WORDS, STRONG_ALTITUDE,
    STRONG_DISTANCE, STRONG_WAY, TOPS, TROUSERS,
};
use super::{Claim, count, sentences, stands_for};
use crate::compass::Compass;
use crate::turns::TurnKind;

/// Everything that the text claims, in order.
pub fn read(text: &str) -> Vec<Claim> {
    let sentence = |sentence: &str| {
        let mut after_stop = false;
        let mut before = String::new();
        let read = |clause: Vec<char>| {
            let words = without_empty_counts(&clause.iter().collect::<String>());
            // `途中停留一次，约3秒`: the time belongs to the stop.
            let speaks = STOP_CHARS.iter().any(|word| words.contains(word));
            let about_stops =
                speaks || after_stop && (GOES_ON.iter().any(|it| words.starts_with(it)) || is_time_alone(&words));
            after_stop = about_stops && !STOP_CHARS.iter().any(|word| denied_word(&words, word));
            let claims = read_clause(&words, &before, about_stops);
            before = words;
            claims
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

fn read_clause(clause: &str, before: &str, about_stops: bool) -> Vec<Claim> {
    let mut claims = vec![];
    let mut rest = clause;
    // A turn around in two words is one.
    let turns_here = ['转', '拐', '弯', '折'].iter().any(|word| clause.contains(*word));
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
            let (claim, used) = quantity(value, after, clause, at, before, about_stops);
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
                None if kind == TurnKind::Around && claims.last() == Some(&Claim::Turn(kind)) => {}
                None => claims.push(Claim::Turn(kind)),
            }
        } else {
            rest = &rest[first.len_utf8()..];
        }
    }
    // A time of standing tells a stop from a target that stands all the time.
    let stands =
        STANDING_WORDS.iter().any(|word| clause.contains(word)) || MOVES.iter().any(|word| denied_word(clause, word));
    if stands && (!about_stops || is_only_standing(clause)) {
        claims.push(Claim::Stays);
    }
    if NO_TURN_WORDS.iter().any(|word| clause.contains(word)) || TURNS.iter().any(|word| denied_word(clause, word)) {
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
    if STOP_CHARS.iter().any(|word| denied_word(clause, word)) || NEVER_STOPS.iter().any(|it| clause.contains(it)) {
        claims.retain(|claim| !matches!(claim, Claim::Stops(_)));
        claims.push(Claim::Stops(0));
    } else if STOP_CHARS.iter().any(|word| clause.contains(word))
        && !claims.iter().any(|claim| matches!(claim, Claim::Stops(_) | Claim::Standing(_) | Claim::Stays))
    {
        claims.push(Claim::SomeStops);
    }
    claims.extend(order_of_stop_and_turn(clause, about_stops));
    stands_for(claims)
}

/// Characters that, behind `上` or `下`, tell where a camera looks.
const AIMED: &str = "调偏压倾斜探俯仰扬抬翘移摆拨打看望瞧视瞄指对垂沉弯勾挑摇";
/// Words that, denied, say that the target stays.
const MOVES: [&str; 14] = [
    "移动",
    "位移",
    "走动",
    "挪动",
    "动弹",
    "动过",
    "挪窝",
    "迈步",
    "迈开",
    "离开原",
    "挪步",
    "移步",
    "挪位",
    "动地方",
];
/// Words that, denied, say that a walk has no turn.
const TURNS: [&str; 8] = ["转", "拐", "弯", "变向", "变方向", "换方向", "掉头", "调头"];
/// Words that say that a walk has no stop.
const NEVER_STOPS: [&str; 12] = [
    "一刻不停",
    "一口气",
    "马不停蹄",
    "一气呵成",
    "连续不断",
    "连贯",
    "没断过",
    "脚步不断",
    "一直在走",
    "始终在走",
    "一直走着",
    "脚不沾地",
];

/// `站了3秒` speaks of standing; `停在原地` of a target that stays, not of a stop.
fn is_only_standing(clause: &str) -> bool {
    [
        "停在原",
        "停留在原",
        "站了",
        "站着",
        "一动不动",
        "静止",
        "没有移动",
        "没有走动",
        "站在原",
        "没走",
        "不走",
        "未走",
        "没动",
        "未动",
        "没挪",
        "纹丝",
    ]
    .iter()
    .any(|it| clause.contains(it))
        && !clause.contains(['次', '回'])
}

/// Whether a text begins with a colour.
pub(crate) fn begins_with_colour(text: &str) -> bool {
    COLOURS.iter().any(|(name, _)| text.starts_with(name)) || SHADES.iter().any(|(name, _)| text.starts_with(name))
}

/// A shade of a garment, or said of one: `藏青色裤子`, `上衣是卡其色`.
fn shade<'a>(clause: &str, text: &'a str) -> Option<(Claim, &'a str)> {
    let (name, colours) = SHADES.iter().find(|(name, _)| text.starts_with(name))?;
    let after = &text[name.len()..];
    let is_coloured = after.starts_with('色');
    let after = after.strip_prefix('色').unwrap_or(after);
    let garment = after.trim_start_matches(['的', 'T']);
    let is_top = TOPS.iter().any(|it| garment.starts_with(it));
    let is_trousers = TROUSERS.iter().any(|it| garment.starts_with(it));
    let before = &clause[..clause.len() - text.len()];
    let last = |words: &[&str]| words.iter().filter_map(|word| before.rfind(word)).max();
    let is_top = match (is_top, is_trousers) {
        (false, false) if !is_coloured => return None,
        (false, false) => {
            let (top, trousers) = (last(&TOPS).max(last(&["上身"])), last(&TROUSERS).max(last(&["下身"])));
            (top.is_some() || trousers.is_some()).then_some(top > trousers)?
        }
        (is_top, _) => is_top,
    };
    Some((Claim::Shade { is_top, name: (*name).to_owned(), colours: colours.to_vec() }, after))
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

/// `头一回`, `下一次`: what follows the word that counts nothing.
fn ordinal<'a>(before: &str, text: &'a str) -> Option<&'a str> {
    let is_one = before.ends_with(['头', '下', '上', '第', '这', '那', '每', '又', '再']);
    ["一回", "一次", "一遭"].iter().find_map(|it| text.strip_prefix(it)).filter(|_| is_one)
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
    for luggage in [
        "背囊",
        "行囊",
        "挎包",
        "旅行包",
        "登山包",
        "双肩背包",
        "双肩包",
        "背包",
        "书包",
        "背着包",
        "背着个包",
        "背个包",
        "背了包",
        "背了个包",
    ] {
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
/// `未携带`: a negation within the last four characters.
fn denied_near(before: &str) -> bool {
    let last: String = before.chars().rev().take(4).collect();
    last.contains(['没', '未', '无', '不'])
}

fn denied_word(clause: &str, word: &str) -> bool {
    let negations = ["不", "没", "未", "无", "零", "从来没", "毫无"];
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

const UNITS: [&str; 20] = [
    "米/秒",
    "米每秒",
    "米",
    "公尺",
    "度",
    "°",
    "分钟",
    "分",
    "秒钟",
    "秒",
    "次",
    "回",
    "个弯",
    "个转弯",
    "道弯",
    "遭",
    "番",
    "遍",
    "处",
    "个停",
];

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

/// The claim of a length: of one place where words beyond doubt of that place alone are in the clause.
fn length(value: f64, clause: &str, at: usize) -> Claim {
    let has = |words: &[&str]| words.iter().any(|word| clause.contains(word));
    let before = clause[..at].trim_end_matches(['约', '大', '概', '近']);
    let behind = clause[at..].split_once('米').map_or("", |it| it.1);
    match (has(&STRONG_ALTITUDE), has(&STRONG_WAY), has(&STRONG_DISTANCE)) {
        _ if ["走了", "走过", "全程"].iter().any(|it| before.ends_with(it)) => Claim::Way(value),
        _ if ["外", "开外", "之外"].iter().any(|it| behind.starts_with(it)) => Claim::Distance(value),
        (true, false, false) => Claim::Altitude(value),
        (false, true, false) => Claim::Way(value),
        (false, false, true) => Claim::Distance(value),
        _ => Claim::Metres(value),
    }
}

/// Whether `度` counts times: `两度停下`.
fn is_times(after: &str) -> bool {
    !after.starts_with("左右")
        && after.starts_with(['停', '歇', '驻', '左', '右', '转', '拐', '掉', '等', '站', '逗', '止', '折', '休'])
}

/// The claim of a number with the unit after it, and the bytes of that unit.
fn quantity(value: f64, after: &str, clause: &str, at: usize, context: &str, about_stops: bool) -> (Claim, usize) {
    let unit = UNITS.into_iter().find(|unit| after.starts_with(unit));
    let before = &clause[..at];
    // `镜头往上一挑，29度`: the words stand in the clause before.
    let is_alone = clause.chars().all(|c| c.is_ascii_digit() || "约大概差不多度°角左右的样子到在，".contains(c));
    let aim = if is_alone { context } else { clause }.replace("俯仰", "");
    let has = |words: &[&str]| words.iter().any(|word| aim.contains(word));
    let aimed = |from: char| {
        let chars: Vec<char> = aim.replace("上一", "上").replace("下一", "下").chars().collect();
        chars.windows(2).any(|pair| pair[0] == from && AIMED.contains(pair[1]))
    };
    let is_up = aimed('上')
        || has(&[
            "仰",
            "扬",
            "抬",
            "向上",
            "朝上",
            "往上",
            "高于水平",
            "高于地平",
            "朝天",
            "上翘",
            "上倾",
            "上斜",
            "上挑",
            "向天",
            "昂",
            "翘",
            "冲上",
        ]);
    let is_down = aimed('下')
        || has(&[
            "俯",
            "向下",
            "朝下",
            "下压",
            "往下",
            "低于水平",
            "低于地平",
            "下倾",
            "朝地",
            "低头",
            "下垂",
            "下斜",
            "下探",
            "下沉",
            "压低",
            "斜下",
            "向地",
            "压下",
            "下看",
            "下拍",
            "冲下",
            "下打",
            "下偏",
            "下俯",
            "埋",
            "垂",
        ]);
    let stops = STOP_CHARS.iter().any(|word| clause.contains(word));
    let walks = ["用时", "历时", "耗时", "走", "全程", "飞", "时长", "花", "行"]
        .iter()
        .any(|it| clause.replace("再走", "").contains(it));
    let seconds = |value: f64| match (stops, walks) {
        (true, false) => Claim::Standing(value),
        (false, true) if !about_stops => Claim::Duration(value),
        _ => Claim::Seconds(value),
    };
    let claim = match unit {
        Some("米/秒" | "米每秒") => Claim::Speed(value),
        Some("米" | "公尺") if before.trim_end_matches(['约', '大', '概', '走']).ends_with("每秒") => {
            Claim::Speed(value)
        }
        Some("米" | "公尺") if value.fract() != 0.0 && clause.contains('秒') => Claim::Speed(value),
        Some("米" | "公尺") => length(value, clause, at),
        Some("度") if is_times(&after["度".len()..]) => {
            count(value, "度", if about_stops { Claim::Stops } else { Claim::Turns })
        }
        Some("度" | "°") if value == 180.0 && !is_up && !is_down => Claim::Turn(TurnKind::Around),
        Some("度" | "°") if is_up == is_down => Claim::Tilt(value),
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
        Some("次" | "回" | "遍" | "处" | "个停" | "遭" | "番") if about_stops => {
            count(value, "次", Claim::Stops)
        }
        Some("次" | "回") if clause.contains(['转', '拐', '弯', '向', '折']) => count(value, "次", Claim::Turns),
        Some("个弯" | "个转弯" | "道弯") => count(value, "个弯", Claim::Turns),
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
        ("往左一拐", TurnKind::Left),
        ("往右一拐", TurnKind::Right),
        ("往左一转", TurnKind::Left),
        ("往右一转", TurnKind::Right),
        ("左手边拐", TurnKind::Left),
        ("右手边拐", TurnKind::Right),
        ("左手拐", TurnKind::Left),
        ("右手拐", TurnKind::Right),
        ("左折", TurnKind::Left),
        ("右折", TurnKind::Right),
        ("折向左", TurnKind::Left),
        ("折向右", TurnKind::Right),
        ("拐向左", TurnKind::Left),
        ("拐向右", TurnKind::Right),
        ("转向左", TurnKind::Left),
        ("转向右", TurnKind::Right),
        ("左弯", TurnKind::Left),
        ("右弯", TurnKind::Right),
        ("打左", TurnKind::Left),
        ("打右", TurnKind::Right),
        ("向后转", TurnKind::Around),
        ("转身", TurnKind::Around),
        ("返身", TurnKind::Around),
        ("折回", TurnKind::Around),
        ("往回走", TurnKind::Around),
        ("调转", TurnKind::Around),
        ("掉转", TurnKind::Around),
        ("回转", TurnKind::Around),
        ("走回头路", TurnKind::Around),
        ("反身", TurnKind::Around),
        ("倒回", TurnKind::Around),
        ("原路折", TurnKind::Around),
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
                vec![Claim::Direction(Compass::North), Claim::Distance(25.0), Claim::Tilt(45.0)],
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
            ("途中停留一次，约3秒，历时约20秒", vec![Claim::Stops(1), Claim::Seconds(3.0), Claim::Duration(20.0)]),
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
