//! Numbers with a unit in Chinese clauses.

use super::numbers::{UNITS, number};
use super::words::{STOP_CHARS, STRONG_ALTITUDE, STRONG_DISTANCE, STRONG_WAY};
use crate::turn::TurnKind;
use crate::{Claim, count};

/// The claim of a number with the unit after it, and the bytes of that unit.
pub(super) fn quantity(
    value: f64,
    after: &str,
    clause: &str,
    at: usize,
    context: &str,
    stops: (bool, bool),
) -> (Claim, usize) {
    let (about_stops, is_near_stop) = stops;
    let unit = UNITS.into_iter().find(|unit| after.starts_with(unit));
    let before = &clause[..at];
    // `镜头往上一挑，29度`: the words stand in the clause before.
    let is_alone = clause.chars().all(|c| c.is_ascii_digit() || "约大概差不多度°角左右的样子到在，".contains(c));
    let is_aimed = |text: &str| {
        text.contains(['上', '下', '俯', '仰', '高', '低', '抬', '垂', '昂', '翘', '扬', '压', '天', '地'])
    };
    let aim = if is_alone || !is_aimed(clause) { context } else { clause }.replace("俯仰", "");
    let has = |words: &[&str]| words.iter().any(|word| aim.contains(word));
    let aimed = |from: char| {
        let chars: Vec<char> = aim.replace("上一", "上").replace("下一", "下").chars().collect();
        chars.windows(2).any(|pair| pair[0] == from && AIMED.contains(pair[1]))
    };
    // `俯仰负45度`
    let signed = |sign: char| before.ends_with(sign) && clause.contains('俯');
    // `比水平线低4度`, `水平面以上17度`
    let level = ["水平", "地平"].iter().filter_map(|word| aim.find(word)).min().map_or("", |at| &aim[at..]);
    let from_level = |words: &[&str]| words.iter().any(|word| level.contains(word));
    let is_up = signed('正')
        || from_level(&["高", "以上", "上方", "之上"])
        || aimed('上')
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
            "天空",
            "昂",
            "翘",
            "冲上",
        ]);
    let is_down = signed('负')
        || from_level(&["低", "以下", "下方", "之下"])
        || aimed('下')
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
            "地面",
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
        (false, true) if !is_near_stop => Claim::Duration(value),
        _ => Claim::Seconds(value),
    };
    let claim = match unit {
        Some("米/秒" | "米每秒") => Claim::Speed(value),
        Some("米" | "公尺") if is_each_second(before) => Claim::Speed(value),
        Some("米" | "公尺") if value.fract() != 0.0 && clause.contains('秒') => Claim::Speed(value),
        Some("米" | "公尺") => length(value, clause, at),
        Some("度" | "°") if value == 180.0 && !is_up && !is_down => Claim::Turn(TurnKind::Around),
        Some("度") if value < 20.0 && is_times(&after["度".len()..]) => {
            count(value, "度", if about_stops { Claim::Stops } else { Claim::Turns })
        }
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
        Some("次" | "回" | "遍" | "处" | "个停" | "遭" | "番")
            if about_stops && (stops || !clause.contains(['转', '拐', '弯'])) =>
        {
            count(value, "次", Claim::Stops)
        }
        Some("次" | "回") if clause.contains(['转', '拐', '弯', '向', '折']) => count(value, "次", Claim::Turns),
        Some("个弯" | "个转弯" | "道弯") => count(value, "个弯", Claim::Turns),
        None if ["角度", "云台", "镜头", "相机", "俯", "仰"].iter().any(|it| clause.contains(it)) => {
            Claim::Tilt(value)
        }
        // `停留次数：2`
        None if clause.contains("停") || clause.contains("驻足") => count(value, "次", Claim::Stops),
        None if clause.contains(['转', '拐', '弯']) => count(value, "次", Claim::Turns),
        _ => Claim::Unknown(format!("{value}{}", unit.unwrap_or_default())),
    };
    (claim, unit.map_or(0, str::len))
}

/// The claim of a length: of one place where words beyond doubt of that place alone are in the clause.
pub(super) fn length(value: f64, clause: &str, at: usize) -> Claim {
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

/// `每秒钟走约1.4米`
fn is_each_second(before: &str) -> bool {
    let before = before.trim_end_matches(['约', '大', '概', '走', '合', '钟']);
    before.ends_with("每秒") || before.ends_with("一秒")
}

/// Whether `度` counts times: `两度停下`.
pub(super) fn is_times(after: &str) -> bool {
    !after.starts_with("左右")
        && after.starts_with(['停', '歇', '驻', '左', '右', '转', '拐', '掉', '等', '站', '逗', '止', '折', '休'])
}

/// Characters that, behind `上` or `下`, tell where a camera looks.
pub(super) const AIMED: &str = "调偏压倾斜探俯仰扬抬翘移摆拨打看望瞧视瞄指对垂沉弯勾挑摇";
