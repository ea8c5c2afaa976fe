//! Chinese wordings of the facts.

use crate::facts::{Facts, Wear};
use crate::precision::{DISTANCE_STEP_M, PITCH_STEP_DEG, SPEED_STEP_MPS, STOP_STEP_S, duration_step_s, way_step_m};
use crate::turns::{Turn, TurnKind};
use crate::wording::{one_of, rounded};
use cosfly_random::RandomStream;
use cosfly_render::Colour;

/// More turns than this are counted instead of listed.
const LISTED_TURNS: usize = 4;

/// One sentence for the pilot: whom to follow, how far away, at which angle.
pub(crate) fn instruction(facts: &Facts, template: usize, words: &mut RandomStream) -> String {
    let standing = match (facts.walks, &facts.wear) {
        (true, _) => "",
        (false, Some(_)) => "站立不动、",
        (false, None) => "站立不动的",
    };
    let who = format!("{standing}{}", who(facts.wear.as_ref(), words));
    let distance = rounded(facts.distance_m, DISTANCE_STEP_M);
    let view = view(facts, words);
    match template {
        0 => format!("跟随{who}，保持约{distance}米距离，{view}。"),
        1 => format!("请在约{distance}米的距离上跟踪{who}，{view}。"),
        2 => format!("请跟随{who}，与其相距约{distance}米，{view}。"),
        3 => format!("与{who}保持约{distance}米的距离并持续跟拍，{view}。"),
        4 => format!("目标是{who}，跟随距离约{distance}米，{view}。"),
        _ => format!("{view}，在约{distance}米外跟拍{who}。"),
    }
}

/// Several sentences: route, stops, length, and how the drone flies.
pub(crate) fn description(facts: &Facts, template: usize, words: &mut RandomStream) -> String {
    let drone = drone(facts, template % 3, words);
    let target = who(facts.wear.as_ref(), words);
    let walk = if facts.walks {
        format!("{target}{}{}{}", route(facts, words), stops(facts, words), length(facts, words))
    } else {
        let duration = rounded(facts.duration_s, duration_step_s(facts.duration_s));
        format!("{target}站立不动，历时约{duration}秒。")
    };
    if template < 3 { format!("{walk}{drone}") } else { format!("{drone}{walk}") }
}

/// The target with clothes: `身穿红色上衣和蓝色裤子的行人`.
pub(crate) fn who(wear: Option<&Wear>, words: &mut RandomStream) -> String {
    let Some(wear) = wear else { return "行人".to_owned() };
    let (top, trousers) = (colour(wear.top), colour(wear.trousers));
    let backpack = if wear.backpack { "、背着背包" } else { "" };
    let pattern = one_of(words, &["身穿{}上衣、#裤子%的行人", "穿{}上衣和#裤子%的行人"]);
    pattern.replace("{}", top).replace('#', trousers).replace('%', backpack)
}

pub(crate) fn colour(colour: Colour) -> &'static str {
    match colour {
        Colour::Black => "黑色",
        Colour::Grey => "灰色",
        Colour::White => "白色",
        Colour::Red => "红色",
        Colour::Orange => "橙色",
        Colour::Yellow => "黄色",
        Colour::Green => "绿色",
        Colour::Blue => "蓝色",
        Colour::Purple => "紫色",
        Colour::Pink => "粉色",
        Colour::Brown => "棕色",
        Colour::Beige => "米色",
    }
}

fn view(facts: &Facts, words: &mut RandomStream) -> String {
    let patterns: &[&str] = if facts.pitch_down_deg < 0.0 {
        &["镜头向上仰视约{}度", "仰角约{}度"]
    } else {
        &["镜头向下俯视约{}度", "镜头俯角约{}度"]
    };
    one_of(words, patterns).replace("{}", &rounded(facts.pitch_down_deg.abs(), PITCH_STEP_DEG))
}

/// The way: what a picture can show of it, without directions of the compass.
fn route(facts: &Facts, words: &mut RandomStream) -> String {
    match facts.turns.len() {
        0 if facts.start_direction == facts.end_direction => one_of(words, &["一路直行。", "笔直前行。"]).to_owned(),
        0 => "一路前行，没有急转弯。".to_owned(),
        listed if listed <= LISTED_TURNS => format!("出发后{}，随后继续前行。", listed_turns(facts)),
        count => {
            let counts: Vec<String> = [TurnKind::Left, TurnKind::Right, TurnKind::Around]
                .iter()
                .map(|&kind| (facts.turns_of(kind), side(kind)))
                .filter(|(count, _)| *count > 0)
                .map(|(count, side)| format!("{side}{count}次"))
                .collect();
            format!("途中转弯{count}次（{}），随后继续前行。", counts.join("、"))
        }
    }
}

/// `连续两次右转，再左转`.
fn listed_turns(facts: &Facts) -> String {
    let runs = facts.turns.chunk_by(|a, b| a.kind == b.kind);
    let run = |turns: &[Turn]| match turns.len() {
        1 => side(turns[0].kind).to_owned(),
        count => format!("连续{}次{}", numeral(count), side(turns[0].kind)),
    };
    runs.map(run).collect::<Vec<_>>().join("，再")
}

/// Numerals up to ten, before a measure word.
pub(crate) fn numeral(count: usize) -> String {
    let numerals = ["零", "一", "两", "三", "四", "五", "六", "七", "八", "九", "十"];
    numerals.get(count).map_or_else(|| count.to_string(), |numeral| (*numeral).to_owned())
}

fn side(kind: TurnKind) -> &'static str {
    match kind {
        TurnKind::Left => "左转",
        TurnKind::Right => "右转",
        TurnKind::Around => "掉头",
    }
}

fn stops(facts: &Facts, words: &mut RandomStream) -> String {
    let standing = rounded(facts.standing_s(), STOP_STEP_S);
    match facts.stops.len() {
        0 => one_of(words, &["途中没有停留。", "途中未作停留。"]).into(),
        1 => one_of(words, &["途中停留一次，约{}秒。", "途中停下一次，停了约{}秒。"]).replace("{}", &standing),
        count => one_of(words, &["途中停留#次，共约{}秒。", "途中停下#次，共停了约{}秒。"])
            .replace('#', &numeral(count))
            .replace("{}", &standing),
    }
}

fn length(facts: &Facts, words: &mut RandomStream) -> String {
    let way = rounded(facts.way_m, way_step_m(facts.way_m));
    let duration = rounded(facts.duration_s, duration_step_s(facts.duration_s));
    let speed = rounded(facts.walking_speed_mps, SPEED_STEP_MPS);
    match words.index(2) {
        0 => format!("全程约{way}米，用时约{duration}秒，步速约{speed}米/秒。"),
        _ => format!("路程约{way}米，历时约{duration}秒，行走速度约{speed}米/秒。"),
    }
}

fn drone(facts: &Facts, template: usize, words: &mut RandomStream) -> String {
    let distance = rounded(facts.distance_m, DISTANCE_STEP_M);
    let view = view(facts, words);
    // A drone that is not above its target has no height worth a word.
    let height = (facts.altitude_m >= 0.5).then(|| rounded(facts.altitude_m, DISTANCE_STEP_M));
    let height = |pattern: &str| height.as_ref().map_or(String::new(), |height| pattern.replace("{}", height));
    match template {
        0 => {
            let height = height("，飞行高度高出目标约{}米");
            format!("无人机与目标保持约{distance}米的距离{height}，{view}。")
        }
        1 => {
            let height = height("，位于目标上方约{}米");
            format!("无人机在约{distance}米外跟拍{height}，{view}。")
        }
        _ => {
            let height = height("，相对高度约{}米");
            format!("无人机与目标相距约{distance}米{height}，{view}。")
        }
    }
}
