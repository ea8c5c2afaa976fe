//! The facts of a flight in words, for a language model.

use crate::config::Style;
use crate::facts::Facts;
use crate::precision::{DISTANCE_STEP_M, PITCH_STEP_DEG, SPEED_STEP_MPS, STOP_STEP_S, duration_step_s, way_step_m};
use crate::turns::Turn;
use crate::wording::rounded;
use crate::{chinese, english};
use cosfly_claims::{Language, TurnKind};

/// Numbers of the facts, rounded as texts state them.
struct Numbers {
    distance: String,
    pitch: String,
    altitude: String,
    way: String,
    duration: String,
    speed: String,
    standing: String,
}

impl Numbers {
    fn of(facts: &Facts) -> Self {
        Self {
            distance: rounded(facts.distance_m, DISTANCE_STEP_M),
            pitch: rounded(facts.pitch_down_deg.abs(), PITCH_STEP_DEG),
            altitude: rounded(facts.altitude_m, DISTANCE_STEP_M),
            way: rounded(facts.way_m, way_step_m(facts.way_m)),
            duration: rounded(facts.duration_s, duration_step_s(facts.duration_s)),
            speed: rounded(facts.walking_speed_mps, SPEED_STEP_MPS),
            standing: rounded(facts.standing_s(), STOP_STEP_S),
        }
    }
}

/// The facts in words, one a line.
pub fn facts_in_words(facts: &Facts, language: Language, style: Style) -> String {
    let is_long = style == Style::Description;
    let lines = match language {
        Language::En => facts_in_english(facts, is_long),
        Language::Zh => facts_in_chinese(facts, is_long),
    };
    lines.iter().map(|line| format!("- {line}")).collect::<Vec<_>>().join("\n")
}

fn facts_in_english(facts: &Facts, is_long: bool) -> Vec<String> {
    let Numbers { distance, pitch, altitude, way, duration, speed, standing } = Numbers::of(facts);
    let side = |turn: &Turn| match turn.kind {
        TurnKind::Left => "left",
        TurnKind::Right => "right",
        TurnKind::Around => "around",
    };
    let turns: Vec<&str> = facts.turns.iter().map(side).collect();
    let up_or_down = if facts.pitch_down_deg < 0.0 { "up" } else { "down" };
    let mut lines = vec![
        match &facts.wear {
            Some(wear) => format!(
                "the person wears {} {} top and {} trousers{}",
                english::article(wear.top.name()),
                wear.top.name(),
                wear.trousers.name(),
                if wear.backpack { ", with a backpack" } else { "" }
            ),
            None => "the clothes are unknown: do not name any".to_owned(),
        },
        if facts.walks { "the person walks" } else { "the person stands still all the time" }.to_owned(),
        format!("the drone keeps about {distance} m away"),
        format!("the camera looks {up_or_down} at about {pitch} degrees"),
    ];
    if is_long && facts.walks {
        lines.push(match turns.len() {
            _ if !facts.doubtful_turns.is_empty() => {
                "whether the person turns is not clear: do not write of turns".to_owned()
            }
            0 if facts.bends => "no sharp turn, and not straight".to_owned(),
            0 => "no turns".to_owned(),
            count => format!("{count} turns, in order: {}", turns.join(", ")),
        });
        lines.push(match facts.stops.len() {
            0 => "no stops".to_owned(),
            count => format!("{count} stops, about {standing} seconds in all"),
        });
        lines.push(format!("the way is about {way} m; while walking, the speed is about {speed} m/s"));
    }
    if is_long {
        lines.push(format!("the flight takes about {duration} seconds"));
        let height =
            (facts.altitude_m >= 0.5).then(|| format!("the drone is about {altitude} m above the person's feet"));
        lines.extend(height);
    }
    lines
}

fn facts_in_chinese(facts: &Facts, is_long: bool) -> Vec<String> {
    let Numbers { distance, pitch, altitude, way, duration, speed, standing } = Numbers::of(facts);
    let side = |turn: &Turn| match turn.kind {
        TurnKind::Left => "左转",
        TurnKind::Right => "右转",
        TurnKind::Around => "掉头",
    };
    let turns: Vec<&str> = facts.turns.iter().map(side).collect();
    let up_or_down = if facts.pitch_down_deg < 0.0 { "上仰视" } else { "下俯视" };
    let mut lines = vec![
        match &facts.wear {
            Some(wear) => format!(
                "此人穿{}上衣、{}裤子{}",
                chinese::colour(wear.top),
                chinese::colour(wear.trousers),
                if wear.backpack { "，背着背包" } else { "" }
            ),
            None => "衣着未知：不要写衣着".to_owned(),
        },
        if facts.walks { "此人在行走" } else { "此人始终站立不动" }.to_owned(),
        format!("无人机保持约{distance}米距离"),
        format!("镜头向{up_or_down}约{pitch}度"),
    ];
    if is_long && facts.walks {
        lines.push(match turns.len() {
            _ if !facts.doubtful_turns.is_empty() => "是否转弯看不清：不要写转弯".to_owned(),
            0 if facts.bends => "没有急转弯，也不是直线".to_owned(),
            0 => "没有转弯".to_owned(),
            count => format!("转弯{count}次，依次为：{}", turns.join("、")),
        });
        lines.push(match facts.stops.len() {
            0 => "途中没有停留".to_owned(),
            count => format!("停留{count}次，共约{standing}秒"),
        });
        lines.push(format!("全程约{way}米，走动时步速约{speed}米/秒"));
    }
    if is_long {
        lines.push(format!("历时约{duration}秒"));
        lines.extend((facts.altitude_m >= 0.5).then(|| format!("无人机高出目标约{altitude}米")));
    }
    lines
}
