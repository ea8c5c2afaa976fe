//! Turns and compass directions in Chinese clauses.

use super::numbers::number;
use crate::compass::Compass;
use crate::turn::TurnKind;

/// A turn at the start of `text`; `turns_here`: the clause speaks of turns, so that `先左后右` is two of them.
pub(super) fn turn(text: &str, turns_here: bool) -> Option<(TurnKind, usize)> {
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
        ("往左转弯", TurnKind::Left),
        ("转身往回走", TurnKind::Around),
        ("往回折", TurnKind::Around),
        ("原地转身", TurnKind::Around),
        ("回身", TurnKind::Around),
        ("反方向", TurnKind::Around),
        ("反向", TurnKind::Around),
        ("往回", TurnKind::Around),
        ("转个身", TurnKind::Around),
        ("原路折", TurnKind::Around),
    ];
    let short = [("左", TurnKind::Left), ("右", TurnKind::Right)];
    let short = short.iter().filter(|_| turns_here && !text.starts_with("左右"));
    long.iter().chain(short).find_map(|(word, kind)| text.starts_with(word).then_some((*kind, word.len())))
}

/// `两次右转` at the start of `text`: the turn, its repetitions, and what follows.
pub(super) fn repeated_turn(text: &str) -> Option<(TurnKind, usize, &str)> {
    let (value, after) = number(text)?;
    let after = after.strip_prefix(['次', '个', '回'])?;
    let (kind, length) = turn(after, false)?;
    (value.fract() == 0.0 && value < 100.0).then(|| (kind, value as usize, &after[length..]))
}

/// A run of compass characters: the direction, or `None` when there is no such direction; and its bytes.
pub(super) fn compass(text: &str) -> Option<(Option<Compass>, usize)> {
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
