//! Pauses, standing and negations in Chinese clauses.

use super::words::{NO_STOP, STOP_CHARS};
use crate::Claim;

/// A time in a clause that speaks of nothing else: `有6秒`, `加一块儿14秒`.
pub(super) fn is_time_alone(clause: &str) -> bool {
    let clause = clause.replace("再走", "").replace("继续走", "");
    clause.contains('秒') && !NO_STOP.iter().any(|word| clause.contains(word))
}

/// `停顿总时长16秒（5次）`: a count in a clause of its own.
pub(super) fn is_count_alone(clause: &str) -> bool {
    let count = clause.trim_end_matches(['次', '回']);
    count.len() < clause.len() && count.chars().all(|c| c.is_ascii_digit() || "共一两二三四五六七八九十".contains(c))
}

/// `一次弯都没转`, `一个弯也不拐`: the number there counts nothing.
pub(super) fn without_empty_counts(clause: &str) -> String {
    let is_denied = ["都没", "都不", "都未", "也没", "也不", "也未"].iter().any(|word| clause.contains(word));
    if !is_denied {
        return clause.to_owned();
    }
    ["一次", "一回", "一个", "一步", "一下", "一刻", "半个", "半步"]
        .iter()
        .fold(clause.to_owned(), |clause, count| clause.replace(count, ""))
}

/// `站了3秒` speaks of standing; `停在原地` of a target that stays, not of a stop.
pub(super) fn is_only_standing(clause: &str) -> bool {
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

/// `把飞机停在离人32米的地方`: the drone, not the target.
pub(super) fn is_of_the_drone(clause: &str) -> bool {
    ["飞机停", "无人机停", "机位停", "悬停", "机停", "镜头停", "飞行器停"].iter().any(|it| clause.contains(it))
}

/// `左转前停了一次`, `停留之后右转`.
pub(super) fn order_of_stop_and_turn(clause: &str, about_stops: bool) -> Option<Claim> {
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

/// Whether a negation comes before the word in the clause.
/// `未携带`: a negation within the last four characters.
pub(super) fn denied_near(before: &str) -> bool {
    let last: String = before.chars().rev().take(4).collect();
    last.contains(['没', '未', '无', '不'])
}

pub(super) fn denied_word(clause: &str, word: &str) -> bool {
    let negations = ["不", "没", "未", "无", "零", "从来没", "毫无"];
    clause.match_indices(word).any(|(at, _)| {
        // `停顿是没有的`, `停留：无`
        let behind: String = clause[at + word.len()..].chars().take(5).collect();
        if ["是没有", "为没有", "为无", "为零", "为未"].iter().any(|it| behind.contains(it)) {
            return true;
        }
        let negation = negations.iter().filter_map(|negation| clause[..at].rfind(negation)).max();
        let negation = negation.filter(|from| !NO_NEGATIONS.iter().any(|word| clause[*from..].starts_with(word)));
        negation.is_some_and(|from| {
            let between = &clause[from..at];
            between.chars().count() <= FAR_NEGATION && !between.contains("背包") && !between.contains("双肩包")
        })
    })
}

/// Words with a negation in them that deny nothing.
pub(super) const NO_NEGATIONS: [&str; 6] = ["不久", "不远", "不断", "不时", "不过", "不一会"];

/// Characters over which a negation reaches.
pub(super) const FAR_NEGATION: usize = 8;
