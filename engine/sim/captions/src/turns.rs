//! Turns of a walk, from its smoothed heading.

use cosfly_claims::TurnKind;
use cosfly_frames::{DVec2, real};
use serde::{Deserialize, Serialize};

/// Frames on either side over which the walking direction is taken.
const HALF_WINDOW: usize = 2;
/// Moving less than this over the window gives no direction, metres.
const LEAST_MOVE_M: f64 = 0.2;
/// A change of direction by `BEGIN_DEG` within `BEGIN_FRAMES` begins a turn; a street that bends more slowly has none.
const BEGIN_DEG: f64 = 50.0;
const BEGIN_FRAMES: usize = 20;
/// A smaller turn is none, degrees.
const LEAST_TURN_DEG: f64 = 60.0;
/// A turn beyond this is a turn around, degrees.
const AROUND_DEG: f64 = 135.0;
/// A turn is over when the direction changes by less than `SETTLED_DEG` over `SETTLED_FRAMES`.
const SETTLED_DEG: f64 = 10.0;
const SETTLED_FRAMES: usize = 4;

/// One turn of the walk.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Turn {
    /// Frame at which it begins.
    pub frame: u32,
    /// Change of direction, degrees; positive to the right.
    pub angle_deg: f64,
    /// Which way.
    pub kind: TurnKind,
}

/// Walking direction (unwrapped yaw, radians) at the frames that have one.
pub(crate) fn directions(feet: &[DVec2], moving: &[bool]) -> Vec<(usize, f64)> {
    let frames: Vec<usize> = (0..feet.len()).filter(|&i| moving[i]).collect();
    let mut found: Vec<(usize, f64)> = vec![];
    for (place, &frame) in frames.iter().enumerate() {
        let before = feet[frames[place.saturating_sub(HALF_WINDOW)]];
        let after = feet[frames[(place + HALF_WINDOW).min(frames.len() - 1)]];
        let step = after - before;
        if step.length() >= LEAST_MOVE_M {
            let yaw = real::atan2(step.y, step.x);
            let unwrapped = found.last().map_or(yaw, |(_, last)| last + real::wrap_angle_rad(yaw - last));
            found.push((frame, unwrapped));
        }
    }
    found
}

/// The turns in a series of directions.
pub(crate) fn turns(directions: &[(usize, f64)]) -> Vec<Turn> {
    let mean = |from: usize, count: usize| {
        let part = &directions[from..(from + count).min(directions.len())];
        part.iter().map(|(_, yaw)| yaw.to_degrees()).sum::<f64>() / part.len().max(1) as f64
    };
    let mut turns = vec![];
    let mut leg_start = 0;
    let mut i = 0;
    while i < directions.len() {
        let leg_deg = mean(leg_start.max(i.saturating_sub(BEGIN_FRAMES)), 3);
        if (directions[i].1.to_degrees() - leg_deg).abs() < BEGIN_DEG {
            i += 1;
            continue;
        }
        let end = settled_after(directions, i, leg_deg);
        let angle_deg = mean(end, 3) - leg_deg;
        if angle_deg.abs() >= LEAST_TURN_DEG {
            let kind = match angle_deg {
                around if around.abs() > AROUND_DEG => TurnKind::Around,
                right if right > 0.0 => TurnKind::Right,
                _ => TurnKind::Left,
            };
            turns.push(Turn { frame: directions[i].0 as u32, angle_deg, kind });
            leg_start = end;
        }
        i = end + 1;
    }
    turns
}

/// The first entry from `start` on after which the direction is steady, or that is a whole turn around away.
fn settled_after(directions: &[(usize, f64)], start: usize, leg_deg: f64) -> usize {
    let last = directions.len() - 1;
    (start..last)
        .find(|&i| {
            let ahead = directions[(i + SETTLED_FRAMES).min(last)].1;
            let settled = (ahead - directions[i].1).to_degrees().abs() < SETTLED_DEG;
            settled || (directions[i].1.to_degrees() - leg_deg).abs() >= 180.0
        })
        .unwrap_or(last)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Kinds of the turns of a walk of 1 m steps through the yaws (degrees), `count` steps each.
    fn kinds(legs: &[(f64, usize)]) -> Vec<TurnKind> {
        let mut feet = vec![DVec2::ZERO];
        for &(yaw_deg, count) in legs {
            let (sin, cos) = real::sin_cos(f64::to_radians(yaw_deg));
            for _ in 0..count {
                feet.push(feet[feet.len() - 1] + DVec2::new(cos, sin));
            }
        }
        let directions = directions(&feet, &vec![true; feet.len()]);
        turns(&directions).iter().map(|turn| turn.kind).collect()
    }

    #[test]
    fn turns_are_found_with_their_side_and_slow_bends_are_none() {
        use TurnKind::{Around, Left, Right};
        let bend = |step_deg: f64| -> Vec<(f64, usize)> {
            (0..=(90.0 / step_deg) as u32).map(|i| (step_deg * f64::from(i), 1)).chain([(90.0, 12)]).collect()
        };
        for (legs, expected) in [
            (vec![(0.0, 30)], vec![]),
            (vec![(0.0, 15), (90.0, 15)], vec![Right]),
            (vec![(0.0, 15), (-90.0, 15), (0.0, 15)], vec![Left, Right]),
            (vec![(170.0, 15), (-100.0, 15)], vec![Right]),
            (vec![(0.0, 15), (179.0, 15)], vec![Around]),
            (vec![(0.0, 15), (30.0, 15)], vec![]),
            (bend(4.0), vec![Right]),
            (bend(1.0), vec![]),
        ] {
            assert_eq!(kinds(&legs), expected, "{legs:?}");
        }
    }

    #[test]
    fn a_walk_without_steps_has_no_turns() {
        assert_eq!(turns(&directions(&[DVec2::ZERO; 20], &[true; 20])), vec![]);
        assert_eq!(turns(&directions(&[], &[])), vec![]);
    }
}
