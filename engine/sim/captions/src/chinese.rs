//! Chinese wordings of the facts.

use crate::chinese_frames::{CALLS, INSTRUCTIONS, KEEPS, LOOKS_DOWN, LOOKS_UP};
use crate::facts::{Facts, FirstTurn, Wear};
use crate::precision::{
    DISTANCE_STEP_M, PITCH_STEP_DEG, Pace, SPEED_STEP_MPS, STOP_STEP_S, duration_step_s, pace, way_step_m,
};
use crate::turns::Turn;
use crate::wording::{one_of, rounded, without};
use cosfly_claims::TurnKind;
use cosfly_domain::Colour;
use cosfly_random::RandomStream;

/// More turns than this are counted instead of listed.
const LISTED_TURNS: usize = 4;

/// One or two sentences for the pilot: whom to follow, how far away, at which angle.
pub(crate) fn instruction(facts: &Facts, template: usize, words: &mut RandomStream) -> String {
    let standing = match (facts.walks, &facts.wear) {
        (true, _) => "",
        (false, Some(_)) => "站立不动、",
        (false, None) => "站立不动的",
    };
    let who = format!("{standing}{}", who(facts.wear.as_ref(), words));
    // Nobody says of who stands where they go.
    let walking: &[&str] = &["走", "路"];
    let frames = without(INSTRUCTIONS, Some(walking).filter(|_| !facts.walks));
    let mut text = frames[template % frames.len()].to_owned();
    for (key, list) in [("[c]", CALLS), ("[k]", KEEPS), ("[k0]", &KEEPS[..1]), ("[l]", looks(facts))] {
        text = text.replace(key, one_of(words, list));
    }
    fill(&text, facts).replace("{who}", &who)
}

fn looks(facts: &Facts) -> &'static [&'static str] {
    if facts.pitch_down_deg < 0.0 { LOOKS_UP } else { LOOKS_DOWN }
}

/// `text` with distance and angle.
fn fill(text: &str, facts: &Facts) -> String {
    text.replace("{d}", &rounded(facts.distance_m, DISTANCE_STEP_M))
        .replace("{p}", &rounded(facts.pitch_down_deg.abs(), PITCH_STEP_DEG))
}

/// Several sentences: route, stops, length, and how the drone flies.
pub(crate) fn description(facts: &Facts, template: usize, words: &mut RandomStream) -> String {
    let drone = drone(facts, words);
    let target = who(facts.wear.as_ref(), words);
    if !facts.walks {
        let duration = rounded(facts.duration_s, duration_step_s(facts.duration_s));
        let stands = one_of(words, &["站立不动，历时约{}秒。", "一直站着，历时约{}秒。", "原地不动，前后约{}秒。"]);
        let walk = format!("{target}{}", stands.replace("{}", &duration));
        return if template.is_multiple_of(2) { format!("{walk}{drone}") } else { format!("{drone}{walk}") };
    }
    let (route, stops, length) =
        (format!("{target}{}", route(facts, words)), stops(facts, words), length(facts, words));
    // What follows the drone without a subject would be read as the drone's.
    match template % 4 {
        0 => format!("{route}{stops}{length}{drone}"),
        1 => format!("{drone}{route}{stops}{length}"),
        2 => format!("{route}{length}{stops}{drone}"),
        _ => format!("{drone}{route}{length}{stops}"),
    }
}

/// The target with clothes: `身穿红色上衣和蓝色裤子的行人`.
pub(crate) fn who(wear: Option<&Wear>, words: &mut RandomStream) -> String {
    let noun = one_of(words, &["行人", "行人", "路人"]);
    let Some(wear) = wear else { return noun.to_owned() };
    let (top, trousers) = (colour(wear.top), colour(wear.trousers));
    let backpack = if wear.backpack { one_of(words, &["、背着背包", "、背着双肩背包"]) } else { "" };
    let pattern = one_of(
        words,
        &[
            "身穿{}上衣、#裤子%的",
            "穿{}上衣和#裤子%的",
            "穿着{}上衣、#裤子%的",
            "穿着#裤子、{}上衣%的",
            "穿{}上衣配#裤子%的",
            "穿#裤子、{}上衣%的",
            "身着{}上衣、#裤子%的",
        ],
    );
    format!("{}{noun}", pattern.replace("{}", top).replace('#', trousers).replace('%', backpack))
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

/// The way: what a picture can show of it, without directions of the compass.
fn route(facts: &Facts, words: &mut RandomStream) -> String {
    if !facts.doubtful_turns.is_empty() {
        return one_of(words, &["一路步行。", "步行前行。"]).to_owned();
    }
    let ending = one_of(words, &["随后继续前行", "接着往前走", "然后继续走", "又继续往前走", "再往前走"]);
    match facts.turns.len() {
        0 if !facts.bends => {
            one_of(words, &["一路直行。", "笔直前行。", "沿直线往前走。", "从头到尾直走。", "径直往前走。"]).to_owned()
        }
        0 => one_of(words, &["一路前行，没有急转弯。", "往前走，路上没有急转弯。", "往前走，始终没有急转弯。"])
            .to_owned(),
        listed if listed <= LISTED_TURNS => {
            let patterns: &[&str] = match facts.first_turn() {
                Some(FirstTurn::Soon) => &["动身后不久{t}，{e}。", "出发后不久{t}，{e}。", "起步后不久就{t}，{e}。"],
                Some(FirstTurn::Late) => {
                    &["走了好一阵才{t}，{e}。", "往前走了好一阵，再{t}，{e}。", "出发后过了好一阵才{t}，{e}。"]
                }
                None => &["出发后{t}，{e}。", "起步往前，途中{t}，{e}。", "先往前走，再{t}，{e}。"],
            };
            one_of(words, patterns).replace("{t}", &listed_turns(facts)).replace("{e}", ending)
        }
        count => {
            let counts: Vec<String> = [TurnKind::Left, TurnKind::Right, TurnKind::Around]
                .iter()
                .map(|&kind| (facts.turns_of(kind), side(kind)))
                .filter(|(count, _)| *count > 0)
                .map(|(count, side)| format!("{side}{count}次"))
                .collect();
            let opening = one_of(words, &["途中转弯", "先后转弯", "前后转弯", "总共转弯"]);
            format!("{opening}{count}次（{}），{ending}。", counts.join("、"))
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
    // Who stands at the start or at the end stops on no way.
    let on_the_way: Option<&[&str]> = (!facts.stops_on_the_way()).then_some(&["途中", "路"]);
    match facts.stops.len() {
        0 => one_of(
            words,
            &[
                "途中没有停留。",
                "途中未作停留。",
                "一路没停。",
                "路上不曾停下。",
                "脚步没有停过。",
                "全程没有驻足。",
                "一刻不停。",
                "路上一次都没停。",
                "从头走到尾，没有停过。",
                "走得很连贯，没有停下。",
                "中途没有歇脚。",
                "中途没有停下。",
            ],
        )
        .into(),
        1 => one_of(
            words,
            &without(
                &[
                    "途中停留一次，约{}秒。",
                    "途中停下一次，停了约{}秒。",
                    "路上停下一回，停了约{}秒。",
                    "途中停过一次，停了约{}秒。",
                    "停下过一次，约{}秒。",
                    "途中有一次停留，约{}秒。",
                    "只停了一次，约{}秒。",
                ],
                on_the_way,
            ),
        )
        .replace("{}", &standing),
        count => one_of(
            words,
            &without(
                &[
                    "途中停留#次，共约{}秒。",
                    "途中停下#次，共停了约{}秒。",
                    "一路停了#次，合计约{}秒。",
                    "路上停下#回，总共停了约{}秒。",
                    "前后停了#次，加起来约{}秒。",
                    "途中有#次停留，总共约{}秒。",
                    "停过#次，累计约{}秒。",
                    "先后停下#次，一共约{}秒。",
                ],
                on_the_way,
            ),
        )
        .replace('#', &numeral(count))
        .replace("{}", &standing),
    }
}

fn length(facts: &Facts, words: &mut RandomStream) -> String {
    let way = rounded(facts.way_m, way_step_m(facts.way_m));
    let duration = rounded(facts.duration_s, duration_step_s(facts.duration_s));
    let speed = rounded(facts.walking_speed_mps, SPEED_STEP_MPS);
    let patterns: &[&str] = match pace(facts) {
        Pace::Whole => &[
            "全程约{w}米，用时约{t}秒，步速约{s}米/秒。",
            "路程约{w}米，历时约{t}秒，行走速度约{s}米/秒。",
            "一共走了约{w}米，花了约{t}秒，平均每秒约{s}米。",
            "约{t}秒走完约{w}米的路程，速度约{s}米/秒。",
            "以约{s}米/秒的步速，约{t}秒走了约{w}米。",
            "总长约{w}米，耗时约{t}秒，每秒走约{s}米。",
            "走完这段路用了约{t}秒，路程约{w}米，步速约{s}米/秒。",
            "约{w}米的路走了约{t}秒，每秒约{s}米。",
            "这一趟走了约{w}米，用了约{t}秒，步速约{s}米/秒。",
            "走了约{t}秒，路程约{w}米，速度约{s}米/秒。",
            "步速约{s}米/秒，约{t}秒走了约{w}米。",
            "前后约{t}秒，走了约{w}米，平均步速约{s}米/秒。",
            "全长约{w}米，走了约{t}秒，每秒约{s}米。",
            "用约{t}秒走完约{w}米，步速约{s}米/秒。",
        ],
        Pace::WhileWalking => &[
            "全程约{w}米，用时约{t}秒，走动时步速约{s}米/秒。",
            "约{t}秒走完约{w}米的路程，走动时速度约{s}米/秒。",
            "总长约{w}米，耗时约{t}秒，走动时每秒约{s}米。",
            "路程约{w}米，历时约{t}秒，行走时速度约{s}米/秒。",
            "一共走了约{w}米，花了约{t}秒，行走时步速约{s}米/秒。",
        ],
        Pace::Unsaid => &[
            "全程约{w}米，用时约{t}秒。",
            "路程约{w}米，历时约{t}秒。",
            "一共走了约{w}米，花了约{t}秒。",
            "约{t}秒走完约{w}米的路程。",
            "总长约{w}米，耗时约{t}秒。",
            "走完这段路用了约{t}秒，路程约{w}米。",
        ],
    };
    let pattern = one_of(words, patterns);
    pattern.replace("{w}", &way).replace("{t}", &duration).replace("{s}", &speed)
}

/// How the drone flies. One that is not above its target has no height worth a word.
fn drone(facts: &Facts, words: &mut RandomStream) -> String {
    let look = one_of(words, looks(facts));
    let height = (facts.altitude_m >= 0.5).then(|| rounded(facts.altitude_m, DISTANCE_STEP_M));
    let Some(height) = height else {
        let pattern = one_of(words, &["无人机与目标保持约{d}米的距离，", "无人机在约{d}米外跟拍，"]);
        return fill(&format!("{pattern}{look}。"), facts);
    };
    let pattern = one_of(
        words,
        &[
            "无人机与目标保持约{d}米的距离，比目标高约{h}米，#。",
            "无人机在约{d}米外跟拍，位于目标上方约{h}米，#。",
            "无人机与目标相距约{d}米，相对高度约{h}米，#。",
            "航拍距离约{d}米，比目标高约{h}米，#。",
            "无人机飞得比目标高约{h}米，相隔约{d}米，#。",
            "#，无人机离目标约{d}米，高出目标约{h}米。",
            "在目标上空约{h}米处，无人机保持约{d}米距离，#。",
            "无人机跟在约{d}米外，比目标高约{h}米，#。",
            "#，距离约{d}米，无人机高出目标约{h}米。",
            "拍摄时无人机离目标约{d}米，高出目标约{h}米，#。",
            "无人机隔着约{d}米跟拍，比目标高约{h}米，#。",
            "距离保持在约{d}米，无人机在目标上方约{h}米，#。",
            "无人机高出目标约{h}米，与目标相距约{d}米，#。",
            "跟拍距离约{d}米，#，无人机在目标上方约{h}米。",
        ],
    );
    fill(&pattern.replace('#', look), facts).replace("{h}", &height)
}
