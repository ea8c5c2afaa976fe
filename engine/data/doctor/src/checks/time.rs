//! Times that decrease, repeat or jump.

use cosfly_episodes::{ExaminedEpisode, Flag};

/// Largest difference of a step from the usual one, as a share.
const TOLERANCE: f64 = 0.02;
/// Largest difference by rounding, seconds: times are often written in whole milliseconds.
const ROUNDING_S: f64 = 1.001e-3;

/// Checks the steps between frames.
pub fn check(episode: &ExaminedEpisode) -> Vec<Flag> {
    let steps = || episode.moments.windows(2).map(|pair| pair[1].time_s - pair[0].time_s).enumerate();
    let flag = |message: String| vec![Flag::damage("timestamps", &episode.id, message)];
    if let Some((frame, step)) = steps().find(|(_, step)| step.is_nan() || *step <= 0.0) {
        return flag(format!("time does not increase after frame {frame}: the step is {step:.3} s"));
    }
    let tolerance_s = (TOLERANCE * episode.dt_s).max(ROUNDING_S.min(0.25 * episode.dt_s));
    let is_odd = |step: f64| (step - episode.dt_s).abs() > tolerance_s;
    match steps().find(|(_, step)| is_odd(*step)) {
        Some((frame, step)) => {
            let odd = steps().filter(|(_, step)| is_odd(*step)).count();
            flag(format!(
                "{odd} of {} steps are not {:.3} s; the first is {step:.3} s after frame {frame}",
                episode.moments.len() - 1,
                episode.dt_s
            ))
        }
        None => vec![],
    }
}
