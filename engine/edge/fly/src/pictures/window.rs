//! The steps of a flight that say most: around its end or its longest loss.

use crate::log::LogLine;
use cosfly_env::End;
use std::ops::Range;

/// Stretches without tracking, as ranges of steps.
pub fn losses(steps: &[LogLine]) -> Vec<Range<usize>> {
    let mut losses: Vec<Range<usize>> = Vec::new();
    for (at, _) in steps.iter().enumerate().filter(|(_, step)| !step.tracked) {
        match losses.last_mut() {
            Some(last) if last.end == at => last.end = at + 1,
            _ => losses.push(at..at + 1),
        }
    }
    losses
}

/// The `count` steps that say most: the last ones where the flight ended early, else those around its longest loss.
pub fn telling(steps: &[LogLine], count: usize) -> Range<usize> {
    let ended_well = steps.last().is_some_and(|last| last.end == Some(End::Finished));
    let longest = losses(steps).into_iter().max_by(|a, b| a.len().cmp(&b.len()).then(b.start.cmp(&a.start)));
    let middle = match longest {
        Some(loss) if ended_well => (loss.start + loss.end) / 2,
        _ if ended_well => steps.len() / 2,
        _ => steps.len(),
    };
    let start = middle.saturating_sub(count / 2).min(steps.len().saturating_sub(count));
    start..(start + count).min(steps.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steps(tracked: &[bool], end: End) -> Vec<LogLine> {
        let line = |(at, tracked): (usize, &bool)| LogLine {
            step: at as u32 + 1,
            time_s: 0.1 * (at + 1) as f64,
            position_in_world: [0.0; 3],
            velocity_in_world: [0.0; 3],
            yaw_deg: 0.0,
            pitch_deg: 0.0,
            attitude_xyzw: None,
            flown: None,
            latency_s: None,
            readings: Default::default(),
            target_in_world: [0.0; 3],
            visible: 1.0,
            in_picture: true,
            tracked: *tracked,
            action: None,
            reward: [0.0; 6],
            end: None,
        };
        let mut all: Vec<LogLine> = tracked.iter().enumerate().map(line).collect();
        if let Some(last) = all.last_mut() {
            last.end = Some(end);
        }
        all
    }

    #[test]
    fn the_longest_loss_or_the_end_is_shown() {
        let mut tracked = [true; 20];
        (tracked[3], tracked[8], tracked[9], tracked[10]) = (false, false, false, false);
        let finished = steps(&tracked, End::Finished);
        assert_eq!(losses(&finished), [3..4, 8..11]);
        assert_eq!(telling(&finished, 6), 6..12);
        assert_eq!(telling(&steps(&tracked, End::Collision), 6), 14..20);
        assert_eq!(telling(&finished, 50), 0..20);
        assert_eq!(telling(&[], 6), 0..0);
    }
}
