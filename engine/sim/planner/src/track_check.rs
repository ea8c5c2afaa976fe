//! Checks of a target track before it is followed.

use crate::error::PlanError;
use cosfly_frames::TargetTrack;

/// Coordinates beyond this are refused, metres.
const FURTHEST_M: f64 = 1e6;

/// The reason why a track cannot be followed at `speed_limit_mps`, naming the frame and the value.
pub fn check_track(track: &TargetTrack, speed_limit_mps: f64) -> Result<(), PlanError> {
    if track.is_empty() {
        return Err(PlanError::Request("the target track has no frame".to_owned()));
    }
    for (name, value, low, high) in [("time step", track.dt_s, 1e-3, 10.0), ("height", track.height_m, 0.2, 5.0)] {
        if !(value >= low && value <= high) {
            return Err(PlanError::Request(format!(
                "the target's {name} is {value}; it must be between {low} and {high}"
            )));
        }
    }
    for (frame, state) in track.states.iter().enumerate() {
        let p = state.feet_in_world;
        if !p.is_finite() || !state.heading_rad.is_finite() || !state.speed_mps.is_finite() {
            return Err(PlanError::Request(format!("frame {frame}: the target's state is not a finite number ({p})")));
        }
        if p.abs().max_element() > FURTHEST_M {
            return Err(PlanError::Request(format!(
                "frame {frame}: the target is at {p}, more than {FURTHEST_M} m from the origin"
            )));
        }
    }
    for (i, pair) in track.states.windows(2).enumerate() {
        let speed = pair[1].feet_in_world.distance(pair[0].feet_in_world) / track.dt_s;
        if speed > speed_limit_mps {
            let frame = i + 1;
            return Err(PlanError::Request(format!(
                "frame {frame}: the target moves at {} m/s; the drone's limit is {speed_limit_mps} m/s",
                above(speed, speed_limit_mps)
            )));
        }
    }
    Ok(())
}

/// A number above a limit, with as many decimals as show it, one at least.
fn above(value: f64, limit: f64) -> String {
    let shows = |text: &String| text.parse().is_ok_and(|shown: f64| shown > limit);
    (1..10).map(|decimals| format!("{value:.decimals$}")).find(shows).unwrap_or_else(|| value.to_string())
}

#[cfg(test)]
mod tests {
    use super::above;

    #[test]
    fn a_number_above_a_limit_shows_it() {
        for (value, text) in
            [(14.23, "14.2"), (12.04, "12.04"), (12.000_31, "12.0003"), (12.000_000_000_000_002, "12.000000000000002")]
        {
            assert_eq!(above(value, 12.0), text);
        }
    }
}
