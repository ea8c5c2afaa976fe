//! Frozen poses, actions that do not lead to the next pose, broken limits.

use cosfly_diagnose::counted;
use cosfly_episodes::{ExaminedEpisode, Flag};
use cosfly_frames::{DVec3, Pose};

/// Largest difference between actions and poses, metres and degrees.
const ACTION_TOLERANCE: f64 = 1e-3;
/// Time in one pose behind a walking target from which a drone counts as frozen, seconds.
const FROZEN_S: f64 = 3.0;
/// Largest plausible speed of a drone, m/s.
const ABSURD_MPS: f64 = 45.0;
/// Distance between two displaced poses of a perturbed flight that states no displacement, metres: twice the paper's 3 m.
const DISPLACED_APART_M: f64 = 6.0;
/// Least such distance in upper quartiles of the flight's steps: displacements of most frames are no jumps of one.
const USUAL_STEPS: f64 = 3.0;
/// Way of a target, metres, from which a target and a drone in one place are a repeated frame; shorter ones may be rounding.
const NOTICEABLE_M: f64 = 0.05;
/// Tolerance of limits, for rounding.
const LIMIT_TOLERANCE: f64 = 1e-3;

/// Checks poses, actions and limits.
pub fn check(episode: &ExaminedEpisode) -> Vec<Flag> {
    let parts = [frozen(episode), actions(episode)];
    parts.into_iter().flatten().chain(limits(episode)).collect()
}

/// Finds a pose that stays the same for long while the target walks: repeated frames.
fn frozen(episode: &ExaminedEpisode) -> Option<Flag> {
    let moments = &episode.moments;
    let (mut start, mut longest) = (0, (0, 0));
    for frame in 1..moments.len() {
        if moments[frame].drone != moments[start].drone {
            start = frame;
        }
        if frame - start > longest.1 {
            longest = (start, frame - start);
        }
    }
    let (start, steps) = longest;
    let walked = moments[start].target_in_world.zip(moments.get(start + steps)?.target_in_world);
    let walked_m = walked.map_or(0.0, |(from, to)| from.distance(to));
    let seconds = steps as f64 * episode.dt_s;
    // A repeated frame repeats the target, too; a hovering drone does not.
    let target_stands_still = walked_m == 0.0
        && moments[start].heading_and_speed.is_some_and(|(_, mps)| mps > 0.3 && mps * seconds > NOTICEABLE_M);
    if seconds >= FROZEN_S && (target_stands_still || walked_m > 2.0) || (steps >= 2 && target_stands_still) {
        let message = format!(
            "frames {start} to {} have the same pose, {seconds:.1} s long, while the target walks",
            start + steps
        );
        return Some(Flag::damage("frozen-frames", &episode.id, message));
    }
    None
}

/// Compares actions with the next poses; recognises actions of other frames.
fn actions(episode: &ExaminedEpisode) -> Option<Flag> {
    let moments = &episode.moments;
    let error = |shift: i64| {
        let mut worst: f64 = 0.0;
        let mut count = 0;
        for (frame, moment) in moments.iter().enumerate() {
            let Some(stated) = moment.next_in_world else { continue };
            // The step that is stated, moved to the frame that it may belong to.
            let step = stated - moment.drone.position_in_world;
            let Some(from) = frame.checked_add_signed(shift as isize).filter(|at| at + 1 < moments.len()) else {
                continue;
            };
            let Some(next) = led(episode, from + 1) else { continue };
            let taken = next.position_in_world - moments[from].drone.position_in_world;
            worst = worst.max((step - taken).length());
            count += 1;
        }
        (count > 0).then_some(worst)
    };
    let own = error(0)?;
    if own <= ACTION_TOLERANCE {
        return turns(episode);
    }
    let message = match [-1, 1, -2, 2].into_iter().find(|shift| error(*shift).is_some_and(|it| it <= ACTION_TOLERANCE))
    {
        Some(shift) => format!("actions are those of {}; they miss the next pose by up to {own:.3} m", frames(shift)),
        None => format!("actions do not lead to the next pose: they miss it by up to {own:.3} m"),
    };
    Some(Flag::damage("action-mismatch", &episode.id, message))
}

/// The pose that the action of the frame before leads to.
fn led(episode: &ExaminedEpisode, frame: usize) -> Option<Pose> {
    match &episode.followed {
        Some(followed) => followed.get(frame).copied(),
        None => episode.moments.get(frame).map(|moment| moment.drone),
    }
}

/// `1` as "the frame after", and so on.
pub fn frames(shift: i64) -> String {
    let side = if shift < 0 { "before" } else { "after" };
    if shift.abs() == 1 { format!("the frame {side}") } else { format!("{} {side}", counted(shift.abs(), "frame")) }
}

fn turns(episode: &ExaminedEpisode) -> Option<Flag> {
    for (frame, pair) in episode.moments.windows(2).enumerate() {
        let Some(stated) = pair[0].turn_deg else { continue };
        let Some(next) = led(episode, frame + 1) else { continue };
        let now = pair[0].drone;
        let taken = [next.pitch_rad - now.pitch_rad, next.yaw_rad - now.yaw_rad, next.roll_rad - now.roll_rad];
        for (name, (stated, taken)) in ["pitch", "yaw", "roll"].into_iter().zip(stated.into_iter().zip(taken)) {
            let gap = (stated - taken.to_degrees()).rem_euclid(360.0);
            if gap.min(360.0 - gap) > ACTION_TOLERANCE {
                let message = format!(
                    "the action of frame {frame} turns {name} by {stated:.3}°; the poses by {:.3}°",
                    taken.to_degrees()
                );
                return Some(Flag::damage("action-mismatch", &episode.id, message));
            }
        }
    }
    None
}

/// Largest speed, acceleration and jerk by finite differences.
pub fn extremes(places: &[DVec3], dt_s: f64) -> [f64; 3] {
    let difference = |values: &[DVec3]| -> Vec<DVec3> { values.windows(2).map(|it| (it[1] - it[0]) / dt_s).collect() };
    let speed = difference(places);
    let acceleration = difference(&speed);
    let jerk = difference(&acceleration);
    [speed, acceleration, jerk].map(|values| values.iter().map(|it| it.length()).fold(0.0, f64::max))
}

/// Finds a step that is neither flown nor a displacement: its limit is in metres, for any rate of frames.
fn jump(episode: &ExaminedEpisode, places: &[DVec3]) -> Option<Flag> {
    let mut steps_m: Vec<f64> = places.windows(2).map(|pair| pair[0].distance(pair[1])).collect();
    let (frame, longest_m) = steps_m.iter().copied().enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let displaced_m = match episode.displaced_m {
        Some(displaced_m) => 2.0 * displaced_m,
        None if episode.is_perturbed => {
            let place = 3 * steps_m.len() / 4;
            let (_, upper_quartile_m, _) = steps_m.select_nth_unstable_by(place, f64::total_cmp);
            DISPLACED_APART_M.max(USUAL_STEPS * *upper_quartile_m)
        }
        None => 0.0,
    };
    let flown_m = ABSURD_MPS * episode.dt_s;
    if longest_m <= flown_m + displaced_m {
        return None;
    }
    let of_twin = if displaced_m > 0.0 { format!(" and {displaced_m:.1} m of displacement") } else { String::new() };
    let message = format!(
        "the drone jumps: {longest_m:.1} m from frame {frame} to the next, {:.3} s later; more than {ABSURD_MPS} m/s{of_twin}",
        episode.dt_s
    );
    Some(Flag::damage("pose-jump", &episode.id, message))
}

fn limits(episode: &ExaminedEpisode) -> Vec<Flag> {
    let places: Vec<DVec3> = episode.moments.iter().map(|it| it.drone.position_in_world).collect();
    let found = extremes(&places, episode.dt_s);
    let mut flags = vec![];
    flags.extend(jump(episode, &places));
    let names = [("speed", "m/s"), ("acceleration", "m/s²"), ("jerk", "m/s³")];
    for ((value, limit), (name, unit)) in found.into_iter().zip(&episode.limits[1..]).zip(names) {
        if let Some(limit) = limit.filter(|limit| value > limit + LIMIT_TOLERANCE && !episode.is_perturbed) {
            let message = format!("{name} reaches {value:.2} {unit}; its limit is {limit} {unit}");
            flags.push(Flag::imperfect("kinematic-limit", &episode.id, message));
        }
    }
    flags
}
