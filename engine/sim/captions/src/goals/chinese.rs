//! Chinese wordings of goals.

use super::claim::{Claim, Hider, Passed, Said, Subject};
use super::compose::Wording;
use crate::chinese::{colour, numeral, who};
use crate::facts::Wear;
use crate::sight::{LandmarkKind, OnSide};
use crate::turns::TurnKind;
use crate::wording::one_of;
use cosfly_maps::ObstacleKind;
use cosfly_random::RandomStream;
use cosfly_world::BodyKind;

/// Goals of whole flights: `[w]` who, `[p]` what they do, `[k]` how to fly.
const FLIGHTS: [&str; 16] = [
    "跟住[w]：[p]。[k]。",
    "目标是[w]，[p]。[k]。",
    "盯住[w]，对方[p]。跟拍时[k]。",
    "这一路要跟的是[w]：[p]。[k]。",
    "[k]，跟住[w]。途中对方[p]。",
    "请跟拍[w]。路上目标[p]。全程[k]。",
    "[w][p]。你跟在后面，[k]。",
    "从头到尾跟着[w]：[p]。[k]。",
    "别跟丢了[w]，对方[p]。[k]。",
    "镜头跟着[w]走。对方[p]。[k]。",
    "去跟[w]，[k]。对方[p]。",
    "本次任务是跟拍[w]：[p]。飞行时[k]。",
    "找到[w]，一路跟下去。对方[p]。[k]。",
    "要拍的人是[w]，[p]。[k]。",
    "紧跟[w]，[k]；对方[p]。",
    "麻烦跟一下[w]：[p]。[k]就行。",
];
/// Goals of stretches.
const STEPS: [&str; 18] = [
    "目标[p]，[k]。",
    "跟上去：对方[p]。[k]。",
    "接下来对方[p]，[k]。",
    "继续跟，目标[p]。[k]。",
    "[k]，目标[p]。",
    "这一段目标[p]，[k]。",
    "从这里开始，目标[p]。[k]。",
    "注意，对方[p]。跟紧，[k]。",
    "跟住别放，对方[p]。[k]。",
    "下一步：对方[p]。[k]。",
    "[k]，继续跟拍：对方[p]。",
    "镜头别离开目标，对方[p]。[k]。",
    "看好目标：[p]。[k]。",
    "此时目标[p]，[k]。",
    "别跟丢：目标[p]。[k]。",
    "接着拍，目标[p]，[k]。",
    "目标[p]。你照样跟着，[k]。",
    "随后目标[p]。[k]。",
];
/// Ways to hold a distance.
const KEEPS: [&str; 12] = [
    "保持约{d}米的距离",
    "距离控制在约{d}米",
    "离对方约{d}米",
    "跟在约{d}米外",
    "隔开约{d}米",
    "和目标相距约{d}米",
    "拉开约{d}米的距离",
    "间距保持在约{d}米",
    "与目标相隔约{d}米",
    "跟拍距离约{d}米",
    "在约{d}米开外跟着",
    "距离大约{d}米",
];

/// The wordings of the language.
pub(super) const WORDING: Wording = Wording {
    flights: &FLIGHTS,
    steps: &STEPS,
    keeps: &KEEPS,
    predicate,
    anchored,
    both,
    joined,
    finished,
    target,
    dialogue,
};

fn predicate(said: &Said, words: &mut RandomStream) -> String {
    match &said.claim {
        Claim::Turns(kind) => one_of(words, turns(*kind)).to_owned(),
        Claim::TurnsInAll(count) => {
            one_of(words, &["一共拐了{}次弯", "前后转了{}次弯", "一路上拐了{}次弯", "总共转弯{}次"])
                .replace("{}", &numeral(*count))
        }
        Claim::NoTurn => one_of(
            words,
            &[
                "一路往前走，没有急转弯",
                "顺着路往前走，没拐急弯",
                "继续往前走，途中没有急转弯",
                "顺着这条路一直走，没有急转弯",
                "往前走了一段，没有急转弯",
            ],
        )
        .to_owned(),
        Claim::Stops(seconds) => one_of(
            words,
            &[
                "停下来站了约{s}秒",
                "停了约{s}秒",
                "在原地站了约{s}秒",
                "停下脚步，等了约{s}秒",
                "站住不动约{s}秒",
                "停下约{s}秒再走",
            ],
        )
        .replace("{s}", &seconds.to_string()),
        Claim::Stands => {
            one_of(words, &["一直站在原地", "始终站着没动", "从头到尾没有挪动", "一直站着不走"]).to_owned()
        }
        around => surroundings(around, words),
    }
}

/// What is around them, and hides them.
fn surroundings(claim: &Claim, words: &mut RandomStream) -> String {
    match claim {
        Claim::Passes(passed) => {
            let pattern = one_of(
                words,
                &["从{side}的{n}{t}旁边走过", "经过{side}的{n}{t}", "走过{side}的{n}{t}", "路过{side}的{n}{t}"],
            );
            let (measure, thing) = thing(passed.kind);
            let count = format!("{}{measure}", numeral(passed.count));
            pattern.replace("{side}", side(passed.side, words)).replace("{n}", &count).replace("{t}", thing)
        }
        Claim::Lost { behind, seconds, found } => lost(*behind, *seconds, *found, words),
        Claim::PartlyHidden(hider) => {
            one_of(words, &["被{}挡住大半个身子", "身影被{}遮去大半", "从{}后面走过，只露出一小半"])
                .replace("{}", hider_words(*hider))
        }
        Claim::WalksWith(count) => {
            let others =
                if *count == 1 { "另一个人".to_owned() } else { format!("另外{}个人", numeral(*count)) };
            one_of(words, &["和{}走在一起", "跟{}并肩走", "与{}结伴而行", "同{}一块儿走"]).replace("{}", &others)
        }
        Claim::Meets(top) => {
            let pattern = one_of(
                words,
                &[
                    "迎面遇上一个穿{}上衣的人",
                    "和迎面走来的一个穿{}上衣的人擦肩而过",
                    "与对面过来的一个穿{}上衣的人错身而过",
                ],
            );
            pattern.replace("{}", colour(*top))
        }
        _ => String::new(),
    }
}

fn turns(kind: TurnKind) -> &'static [&'static str] {
    match kind {
        TurnKind::Left => &["往左拐", "向左转", "左拐", "左转", "拐向左边", "往左边拐过去"],
        TurnKind::Right => &["往右拐", "向右转", "右拐", "右转", "拐向右边", "往右边拐过去"],
        TurnKind::Around => &["掉头往回走", "掉头", "转身往回走", "原路折返"],
    }
}

/// `过了左手边第二棵树再往右拐`.
fn anchored(passed: &Passed, action: &str, words: &mut RandomStream) -> String {
    let pattern = one_of(
        words,
        &[
            "过了{side}第{n}{t}再{a}",
            "走过{side}第{n}{t}后{a}",
            "经过{side}第{n}{t}之后{a}",
            "走到{side}第{n}{t}，过去以后{a}",
        ],
    );
    let (measure, thing) = thing(passed.kind);
    let ordinal = ["零", "一", "二", "三", "四", "五", "六"].get(passed.count).copied().unwrap_or("几");
    let filled = pattern.replace("{side}", side(passed.side, words)).replace("{n}", &format!("{ordinal}{measure}"));
    filled.replace("{t}", thing).replace("{a}", action)
}

fn lost(behind: Option<Hider>, seconds: u32, found: bool, words: &mut RandomStream) -> String {
    let patterns: &[&str] = match (behind, found) {
        (Some(_), true) => &[
            "被{h}完全挡住约{s}秒，之后又出现",
            "走到{h}后面，约{s}秒后重新露面",
            "消失在{h}后面，过了约{s}秒才出来",
            "被{h}遮住约{s}秒，随后重新出现",
            "让{h}整个挡住约{s}秒",
        ],
        (Some(_), false) => {
            &["走到{h}后面，再也没出现", "被{h}完全挡住，直到最后也没露面", "消失在{h}后面，没有再出来"]
        }
        (None, true) => &["离开画面约{s}秒，之后又回来", "走出画面，约{s}秒后重新入画", "出画约{s}秒"],
        (None, false) => &["走出画面，没有再回来", "离开画面，直到最后也没回来"],
    };
    one_of(words, patterns).replace("{h}", behind.map_or("", hider_words)).replace("{s}", &seconds.to_string())
}

/// Two things in no order of time.
fn both(one: &str, two: &str, words: &mut RandomStream) -> String {
    one_of(words, &["{1}，{2}", "{1}，途中{2}", "{1}，路上{2}"]).replace("{1}", one).replace("{2}", two)
}

fn joined(parts: &[String], words: &mut RandomStream) -> String {
    match parts {
        [] => String::new(),
        [one] => one.clone(),
        [one, two] => match words.index(4) {
            0 => format!("{one}，然后{two}"),
            1 => format!("先{one}，再{two}"),
            2 => format!("先{one}，接着{two}"),
            _ => format!("{one}，后来{two}"),
        },
        [one, two, rest @ ..] => match words.index(3) {
            0 => format!("先{one}，再{two}，最后{}", rest.join("，")),
            1 => format!("{one}，接着{two}，然后{}", rest.join("，")),
            _ => format!("先{one}，然后{two}，后来{}", rest.join("，")),
        },
    }
}

fn finished(template: &str, predicates: &str, keep: &str) -> String {
    template.replace("[p]", predicates).replace("[k]", keep)
}

fn target(wear: &Wear, words: &mut RandomStream) -> String {
    who(Some(wear), words)
}

/// Measure word and name.
fn thing(kind: LandmarkKind) -> (&'static str, &'static str) {
    match kind {
        LandmarkKind::TrafficLight => ("个", "红绿灯"),
        LandmarkKind::Lamp => ("盏", "路灯"),
        LandmarkKind::TrafficSign => ("块", "交通标志牌"),
        LandmarkKind::Tree => ("棵", "树"),
        LandmarkKind::Car => ("辆", "停着的汽车"),
        LandmarkKind::Building => ("栋", "楼"),
    }
}

fn side(side: OnSide, words: &mut RandomStream) -> &'static str {
    match side {
        OnSide::Left => one_of(words, &["左边", "左手边", "左侧"]),
        OnSide::Right => one_of(words, &["右边", "右手边", "右侧"]),
    }
}

fn hider_words(hider: Hider) -> &'static str {
    match hider {
        Hider::Object(ObstacleKind::Building) => "一栋楼",
        Hider::Object(ObstacleKind::Wall) => "一堵墙",
        Hider::Object(ObstacleKind::Fence) => "一道围栏",
        Hider::Object(ObstacleKind::TreeTrunk | ObstacleKind::TreeCrown) => "一棵树",
        Hider::Object(ObstacleKind::Bush) => "一丛灌木",
        Hider::Object(ObstacleKind::Bridge) => "一座桥",
        Hider::Object(ObstacleKind::Car) => "一辆停着的汽车",
        Hider::Object(_) => "别的东西",
        Hider::Body(BodyKind::Pedestrian) => "另一个人",
        Hider::Body(BodyKind::Bicycle) => "一个骑自行车的人",
        Hider::Body(BodyKind::Motorcycle) => "一个骑摩托车的人",
        Hider::Body(BodyKind::Car) => "一辆汽车",
        Hider::Body(BodyKind::Van) => "一辆面包车",
        Hider::Body(BodyKind::Truck) => "一辆卡车",
        Hider::Body(BodyKind::Bus) => "一辆公交车",
    }
}

/// Lines of dialogues, as the English ones.
fn dialogue(subject: Subject) -> &'static [[&'static str; 3]] {
    match subject {
        Subject::Clothes => &[
            ["跟上那个人。", "是穿{o}上衣的那个吗？", "不是，是另一个，穿{t}上衣、{r}裤子的。"],
            ["去跟前面那位行人。", "你说的是穿{o}上衣的那位？", "不对，要跟的是{w}。"],
            ["盯住目标。", "好的，已锁定穿{o}上衣的人。", "跟错了，应该是{w}。"],
            ["开始跟拍吧。", "正在跟穿{o}上衣的那位。", "不是那位，换成{w}。"],
            ["看到目标了吗？", "看到了，穿{o}上衣，对吧？", "不对，再找找，是{w}。"],
            ["跟着走路的那个人。", "穿{o}上衣的，收到。", "错了，是另一个：{w}。"],
            ["目标就在那儿，跟上。", "是{o}上衣那位吧？", "不是，上衣是{t}，裤子是{r}的那位。"],
        ],
        Subject::Distance => &[
            ["跟住{w}。", "收到，距离约{x}米。", "{F}，保持约{d}米。"],
            ["请跟拍{w}。", "好的，我在约{x}米外跟着。", "不行，改成约{d}米。"],
            ["目标是{w}。", "明白。约{x}米可以吗？", "不行，约{d}米才对。"],
            ["一路跟着{w}。", "现在相距约{x}米。", "距离不对，应该是约{d}米。"],
        ],
        _ => &[
            ["对方往哪儿走了？", "{n}了。", "不对，是{m}。继续跟住{w}。"],
            ["跟着{w}，随时报一下动向。", "目标{n}。", "看错了，目标{m}。"],
            ["继续跟{w}。", "对方是{n}吗？", "不是，方向反了，是{m}。"],
            ["现在往哪边？", "应该是{n}。", "不对，对方{m}，跟紧{w}。"],
        ],
    }
}
