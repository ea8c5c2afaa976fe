//! Things in Chinese texts, by their words and by their place in a clause.

use super::chinese_words::{
    BEFORE_PLACES, BESIDE, CHARACTERS, COMPANIONS_BEGIN, HARMLESS, HOLDING, MEASURES, OF_THE_WALK, PASSING, SOME_OF,
    SOMEWHERE, THINGS, TOGETHER,
};
use crate::chinese::{clauses, plain};

/// Characters that the thing a place is beside may have.
const REACH: usize = 6;
/// Characters of the longest clause that only calls somebody.
const ADDRESS: usize = 6;
/// Characters of the longest clause in which somebody begins to speak.
const SPEECH: usize = 8;

/// Words that name a thing, and places, company and what is passed that are no part of a walk.
pub fn foreign_things(text: &str) -> Vec<String> {
    clauses(&plain(text)).iter().flat_map(|clause| in_clause(&clause.iter().collect::<String>())).collect()
}

fn in_clause(clause: &str) -> Vec<String> {
    // `孩子，`
    if clause.chars().count() <= 2 && clause.ends_with(['子', '学', '师', '友', '员', '长', '傅']) {
        return vec![];
    }
    // `妈妈跟你说，`
    let speaks = ["说", "告诉", "讲", "听"].iter().any(|word| clause.contains(word));
    if clause.chars().count() <= SPEECH && clause.contains(['你', '您']) && speaks {
        return vec![];
    }
    // `家人们，`: who is spoken to is no part of the flight.
    if clause.chars().count() <= ADDRESS && (clause.ends_with("们") || clause.starts_with("各位"))
        || clause.ends_with("请注意")
    {
        return vec![];
    }
    // What is harmless is taken out, so that the characters beside it are not joined.
    let mut plain = clause.to_owned();
    HARMLESS.split_whitespace().for_each(|word| plain = plain.replace(word, "·"));
    let mut found: Vec<String> =
        THINGS.split_whitespace().filter(|word| plain.contains(word)).map(str::to_owned).collect();
    if found.is_empty() {
        found.extend(plain.chars().filter(|c| CHARACTERS.contains(*c)).map(String::from).take(1));
    }
    if found.is_empty() {
        let places = [
            passed(&plain),
            beside(&plain),
            there(&plain),
            company(&plain),
            carried(&plain),
            holding(&plain),
            counted(&plain),
            from(&plain),
        ];
        let says = |it: &String| it.chars().any(|c| !"·的人了着".contains(c));
        found.extend(places.into_iter().flatten().filter(says).take(1));
    }
    found
}

fn is_of_the_walk(text: &str) -> bool {
    OF_THE_WALK.iter().any(|word| text.contains(word))
}

/// `穿红色上衣的人`
fn is_of_clothes(text: &str) -> bool {
    let start: String =
        text.trim_start_matches(['的', '是', '着', '那', '个', '位', '名', '一']).chars().take(2).collect();
    start.contains(['穿', '身', '上', '下', '背', '人', '衣', '裤', '着', '·']) || begins_with_colour(&start)
}

fn first(text: &str, count: usize) -> String {
    text.chars().take(count).collect()
}

/// What is passed or near, where it is no part of the walk.
fn passed(clause: &str) -> Option<String> {
    let is_ended = |text: &str| text.chars().all(|c| "了着的后之再便就，·".contains(c));
    let words = PASSING.iter().chain(&BEFORE_PLACES);
    let behind = words.filter_map(|word| clause.find(word).map(|at| &clause[at + word.len()..]));
    let mut foreign = behind.filter(|after| {
        let is_number = after.trim_start_matches(['了', '约', '大', '概']).starts_with(|c: char| c.is_ascii_digit());
        !is_number && !is_ended(after) && !is_of_clothes(after) && !is_of_the_walk(after)
    });
    foreign.next().map(|after| first(after, REACH))
}

/// Something beside a place, or a place beside something, where it is no part of the walk.
fn beside(clause: &str) -> Option<String> {
    let (at, word) = BESIDE.iter().find_map(|word| Some((clause.find(word)?, *word)))?;
    let before: String = clause[..at].chars().rev().take(REACH).collect();
    let before: String = before.chars().rev().collect();
    let after = &clause[at + word.len()..];
    let is_there =
        ["有", "是", "停", "立", "坐", "站", "为", "走着", "跟着"].iter().any(|verb| after.starts_with(verb));
    let is_own = is_of_the_walk(&before) || before.ends_with(['人', '其', '它', '他', '脚', '头', '身', '眼']);
    (is_there && !is_of_the_walk(after) || !is_own)
        .then(|| if is_there || before.is_empty() { first(after, REACH) } else { before })
}

/// `有个木偶`: something that is there and is no part of the walk.
fn there(clause: &str) -> Option<String> {
    let behind = |words: &[&str]| words.iter().find_map(|word| clause.find(word).map(|at| &clause[at + word.len()..]));
    let is_there = |after: &&str| {
        ["有", "是", "停着", "站着", "坐着", "立着", "飞过", "开过"].iter().any(|it| after.starts_with(it))
    };
    let under = || {
        let place = clause.strip_prefix('在')?;
        let is_inside = ["下", "里", "外面", "前面", "后头"].iter().any(|end| place.ends_with(end));
        (is_inside && !place.contains(['空', '这', '那', '人']) && !place.contains(|c: char| c.is_ascii_digit()))
            .then_some(place)
    };
    let after = behind(&SOME_OF).or_else(|| behind(&SOMEWHERE).filter(is_there)).or_else(under)?;
    let is_own = is_of_the_walk(after) || is_of_clothes(after) || after.contains('停');
    (!is_own).then(|| first(after, REACH))
}

/// `和爱人一起`: who goes with the target.
fn company(clause: &str) -> Option<String> {
    let end = TOGETHER.iter().find_map(|word| clause.find(word))?;
    let start = COMPANIONS_BEGIN.iter().filter_map(|word| clause[..end].rfind(word)).max()?;
    let who = &clause[start..end];
    (!is_of_the_walk(who)).then(|| who.to_owned())
}

/// `捏着票`: what somebody holds or does with the hands, which is no part of a walk.
fn holding(clause: &str) -> Option<String> {
    let of_hands = |(at, _): &(usize, &str)| clause[..*at].ends_with(|c: char| HOLDING.contains(c));
    let (at, _) = clause.match_indices(['着', '了']).find(of_hands)?;
    (!is_of_the_walk(&clause[at..])).then(|| first(&clause[at..], REACH))
}

/// `一名水手`: a count of things, by the measure word.
fn counted(clause: &str) -> Option<String> {
    let numbers = "一两二三四五六七八九十几数某另";
    let chars: Vec<char> = clause.chars().collect();
    let is_measured = |at: &usize| numbers.contains(chars[*at]) && MEASURES.contains(chars[at + 1]);
    let at = (0..chars.len().saturating_sub(2)).find(is_measured)?;
    let after: String = chars[at + 2..].iter().collect();
    // `一架无人机`
    if after.starts_with('·') {
        return None;
    }
    let after = after.trim_matches('·').to_owned();
    let is_dressed = after.chars().take(2).any(|c| "穿着身上下背裤衣".contains(c));
    let is_own = is_dressed
        || ["的", "裤", "衣", "线", "路", "直", "弯", "·", "人", "距", "行", "步", "度", "目", "对", "机"]
            .iter()
            .any(|it| after.starts_with(it));
    (!after.is_empty() && !is_own && !is_of_the_walk(&after) && !begins_with_colour(&after))
        .then(|| first(&after, REACH))
}

/// `从脚手架下面过`
fn from(clause: &str) -> Option<String> {
    let after = &clause[clause.find('从')? + '从'.len_utf8()..];
    let place = &after[..["下面", "底下", "下方", "旁边", "面前", "中间", "边上", "跟前"]
        .iter()
        .filter_map(|it| after.find(it))
        .min()?];
    (!place.is_empty() && after.contains('过') && !is_of_the_walk(place)).then(|| place.to_owned())
}

fn begins_with_colour(text: &str) -> bool {
    crate::chinese::clothes::begins_with_colour(text)
}

/// `带着小孩`: what the target has with it.
fn carried(clause: &str) -> Option<String> {
    let after =
        ["带着", "带了", "领了"].iter().find_map(|word| clause.find(word).map(|at| &clause[at + word.len()..]))?;
    (!after.starts_with('·') && !is_of_the_walk(after)).then(|| first(after, REACH))
}
