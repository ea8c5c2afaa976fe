//! Chinese wordings of the facts.

use crate::facts::Facts;
use crate::precision::{DISTANCE_STEP_M, PITCH_STEP_DEG, SPEED_STEP_MPS, STOP_STEP_S, duration_step_s, way_step_m};
use crate::turns::TurnKind;
use crate::wording::{one_of, rounded};
use cosfly_random::RandomStream;

/// More turns than this are counted instead of listed.
const LISTED_TURNS: usize = 4;

/// One sentence for the pilot: whom to follow, how far away, at which angle.
pub(crate) fn instruction(facts: &Facts, template: usize, words: &mut RandomStream) -> String {
    let who = who(facts, words);
    let distance = rounded(facts.distance_m, DISTANCE_STEP_M);
    let view = view(facts, words);
    match template {
        0 => format!("跟随{who}，保持约{distance}米距离，{view}。"),
        1 => format!("请在约{distance}米的距离上跟踪{who}，{view}。"),
        2 => format!("跟住{who}，与其相距约{distance}米，{view}。"),
        3 => format!("与{who}保持约{distance}米的距离并持续跟拍，{view}。"),
        4 => format!("目标是{who}，跟随距离约{distance}米，{view}。"),
        _ => format!("{view}，在约{distance}米外跟拍{who}。"),
    }
}

/// Several sentences: route, stops, length, and how the drone flies.
pub(crate) fn description(facts: &Facts, template: usize, words: &mut RandomStream) -> String {
    let drone = drone(facts, template % 3, words);
    let walk = if facts.walks {
        format!("{}{}{}", route(facts, words), stops(facts, words), length(facts, words))
    } else {
        let duration = rounded(facts.duration_s, duration_step_s(facts.duration_s));
        format!("行人面朝{}站立不动，历时约{duration}秒。", facts.start_direction.chinese())
    };
    if template < 3 { format!("{walk}{drone}") } else { format!("{drone}{walk}") }
}

/// The attribute that says which way the target goes, and the target.
fn who(facts: &Facts, words: &mut RandomStream) -> String {
    let (start, end) = (facts.start_direction.chinese(), facts.end_direction.chinese());
    if !facts.walks {
        return one_of(words, &["面朝{}站立的行人", "原地站着、面向{}的行人"]).replace("{}", start);
    }
    if start != end {
        return one_of(words, &["先向{}走、最后转向#行进的行人", "先朝{}出发、最终朝#走去的行人"])
            .replace("{}", start)
            .replace('#', end);
    }
    let patterns: &[&str] = if facts.turns.is_empty() {
        &["向{}行走的行人", "朝{}走的行人", "正往{}走的行人"]
    } else {
        &["向{}出发的行人", "起初朝{}走的行人"]
    };
    one_of(words, patterns).replace("{}", start)
}

fn view(facts: &Facts, words: &mut RandomStream) -> String {
    let patterns: &[&str] = if facts.pitch_down_deg < 0.0 {
        &["镜头上仰约{}度", "仰角约{}度"]
    } else {
        &["镜头俯角约{}度", "俯角约{}度", "镜头下俯约{}度"]
    };
    one_of(words, patterns).replace("{}", &rounded(facts.pitch_down_deg.abs(), PITCH_STEP_DEG))
}

fn route(facts: &Facts, words: &mut RandomStream) -> String {
    let (start, end) = (facts.start_direction.chinese(), facts.end_direction.chinese());
    match facts.turns.len() {
        0 if start == end => one_of(words, &["行人一路向{}直行。", "行人朝{}笔直走去。"]).replace("{}", start),
        0 => format!("行人起初向{start}走，最后朝{end}走。"),
        listed if listed <= LISTED_TURNS => {
            let sides: Vec<&str> = facts.turns.iter().map(|turn| side(turn.kind)).collect();
            let first = if listed > 1 { "依次" } else { "途中" };
            format!("行人向{start}出发，{first}{}，最后朝{end}走去。", sides.join("、"))
        }
        count => {
            let counts: Vec<String> = [TurnKind::Left, TurnKind::Right, TurnKind::Around]
                .iter()
                .map(|&kind| (facts.turns_of(kind), side(kind)))
                .filter(|(count, _)| *count > 0)
                .map(|(count, side)| format!("{side}{count}次"))
                .collect();
            format!("行人向{start}出发，途中转弯{count}次（{}），最后朝{end}走去。", counts.join("、"))
        }
    }
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
        1 => one_of(words, &["途中停留1次，停留约{}秒。", "途中停下1次，停了约{}秒。"]).replace("{}", &standing),
        count => one_of(words, &["途中停留#次，停留共约{}秒。", "途中停下#次，共停了约{}秒。"])
            .replace('#', &count.to_string())
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
