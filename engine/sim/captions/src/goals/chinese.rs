//! Chinese wordings of goals.

use super::chinese_frames::{FLIGHTS, KEEPS, OF_CLOTHES, OF_DISTANCE, OF_MOVES, STEPS};
use super::claim::{Claim, Hider, Said, Subject};
use super::plan::Wording;
use crate::chinese::{colour, numeral, who};
use crate::facts::Wear;
use crate::sight::{LandmarkKind, OnSide};
use crate::wording::one_of;
use cosfly_claims::TurnKind;
use cosfly_domain::ObstacleKind;
use cosfly_random::RandomStream;

/// The wordings of the language.
pub(super) const WORDING: Wording = Wording {
    flights: FLIGHTS,
    steps: STEPS,
    keeps: KEEPS,
    predicate,
    anchored,
    together,
    joined,
    finished,
    target,
    dialogue,
};

fn predicate(said: &Said, words: &mut RandomStream) -> String {
    match &said.claim {
        Claim::Turns(kind) => one_of(words, turns(*kind)).to_owned(),
        Claim::TurnsInAll(count) => {
            one_of(words, &["一共拐了{}次弯", "前后转了{}次弯", "拐了{}次弯", "总共转了{}次弯"])
                .replace("{}", &numeral(*count))
        }
        Claim::NoTurn => one_of(
            words,
            &[
                "一路走着，没有急转弯",
                "顺着路往前走，没拐急弯",
                "继续往前走，途中没有急转弯",
                "顺着这条路走，没有急转弯",
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
                "停下约{s}秒",
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
            let patterns: &[&str] = if passed.after_crossing {
                &["过了斑马线后经过{side}的{n}{t}", "过斑马线后走过{side}的{n}{t}", "过完斑马线又路过{side}的{n}{t}"]
            } else {
                &["从{side}的{n}{t}旁边走过", "经过{side}的{n}{t}", "走过{side}的{n}{t}", "路过{side}的{n}{t}"]
            };
            let pattern = one_of(words, patterns);
            let (measure, thing) = thing(passed.kind);
            let count = format!("{}{measure}", numeral(passed.count));
            pattern.replace("{side}", side(passed.side, words)).replace("{n}", &count).replace("{t}", thing)
        }
        Claim::Crosses => {
            one_of(words, &["走斑马线过马路", "从人行横道过马路", "沿斑马线走到马路对面", "走过一道斑马线"]).to_owned()
        }
        Claim::Lost { behind, seconds, found } => lost(*behind, *seconds, *found, words),
        Claim::PartlyHidden(hider) => {
            one_of(words, &["被{}挡住大半个身子", "身影被{}遮去大半"]).replace("{}", hider_words(*hider))
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
        Claim::Overtakes(top) => {
            let pattern = one_of(
                words,
                &["超过前面一个穿{}上衣的人", "赶上前面一个穿{}上衣的人并超了过去", "从一个穿{}上衣的人身旁超过去"],
            );
            pattern.replace("{}", colour(*top))
        }
        Claim::MeetsVehicle(kind) => {
            let pattern = one_of(words, &["迎面遇上{}", "与迎面过来的{}交错而过", "与对面过来的{}错身而过"]);
            pattern.replace("{}", hider_words(Hider::Body(*kind)))
        }
        Claim::OvertakenBy(kind) => {
            let pattern = one_of(words, &["被{}从后面超过", "被后面来的{}超过", "让后面来的{}超了过去"]);
            pattern.replace("{}", hider_words(Hider::Body(*kind)))
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
fn anchored(claim: &Claim, action: &str, words: &mut RandomStream) -> String {
    let Claim::Passes(passed) = claim else {
        return one_of(words, &["走斑马线过马路后{a}", "过了斑马线再{a}", "过完斑马线{a}"]).replace("{a}", action);
    };
    let patterns: &[&str] = if passed.after_crossing {
        &[
            "过斑马线后，走过{side}第{n}{t}再{a}",
            "过了斑马线，再过{side}第{n}{t}，然后{a}",
            "走过斑马线后面{side}第{n}{t}，再{a}",
        ]
    } else {
        &["过了{side}第{n}{t}再{a}", "走过{side}第{n}{t}后{a}", "经过{side}第{n}{t}之后{a}"]
    };
    let pattern = one_of(words, patterns);
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
            "被{h}整个挡住约{s}秒",
        ],
        (Some(_), false) => {
            &["走到{h}后面，再也没出现", "被{h}完全挡住，直到最后也没露面", "消失在{h}后面，没有再出来"]
        }
        (None, true) => &["离开画面约{s}秒，之后又回来", "走出画面，约{s}秒后重新入画", "出画约{s}秒"],
        (None, false) => &["走出画面，没有再回来", "离开画面，直到最后也没回来"],
    };
    one_of(words, patterns).replace("{h}", behind.map_or("", hider_words)).replace("{s}", &seconds.to_string())
}

/// Things that overlap in time, with one word for that at most.
fn together(parts: &[String], words: &mut RandomStream) -> String {
    match parts {
        [] => String::new(),
        [one] => one.clone(),
        [first, middle @ .., last] => {
            let link = one_of(words, &["，", "，途中", "，其间"]);
            let again = if middle.is_empty() || last.contains('又') { "" } else { "又" };
            let middle: String = middle.iter().map(|part| format!("{part}，")).collect();
            format!("{first}{link}{middle}{again}{last}")
        }
    }
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
        Hider::Body(kind) => kind.row().words.one_in_chinese,
    }
}

/// Lines of dialogues about a subject.
fn dialogue(subject: Subject) -> &'static [[&'static str; 3]] {
    match subject {
        Subject::Clothes => OF_CLOTHES,
        Subject::Distance => OF_DISTANCE,
        _ => OF_MOVES,
    }
}
