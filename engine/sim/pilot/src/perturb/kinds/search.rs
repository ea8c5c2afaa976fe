//! `search`: losses of the target. The camera stays behind, looks to both sides, and returns.

use super::kind::{Departing, Departure, Kind, no_offsets};
use crate::perturb::motion::waiting_s;
use crate::perturb::sizes::FlyableConfig;
use cosfly_frames::{Pose, TargetTrack, real};
use cosfly_random::RandomStream;

pub(super) const KIND: Kind = Kind {
    name: "search",
    doc: "The camera loses the target at times, looks for it to both sides, and finds it again.",
    departure: Departure::Flown { offsets: no_offsets, views },
};

/// Time of a sweep from one side to the other and back, seconds.
const SWEEP_S: f64 = 4.0;
/// The camera sinks or rises by this at most while it looks for the target, degrees.
const MOST_PITCH_DEG: f64 = 8.0;

/// A loss of the target.
struct Loss {
    from_s: f64,
    length_s: f64,
    /// The side that is looked at first.
    side: f64,
    pitch_rad: f64,
}

impl Loss {
    fn after(after_s: f64, config: &FlyableConfig, stream: &mut RandomStream) -> Self {
        Self {
            from_s: after_s + waiting_s(config.search_every_s, stream),
            length_s: stream.uniform(0.5 * config.search_s, config.search_s),
            side: if stream.chance(0.5) { 1.0 } else { -1.0 },
            pitch_rad: stream.uniform(-MOST_PITCH_DEG, MOST_PITCH_DEG).to_radians(),
        }
    }
}

/// The views of a camera that loses its target at times: from a loss on it sweeps around the view of that moment, and then
/// returns to `straight`, the views without losses.
fn views(departing: &Departing<'_>, _: &TargetTrack, straight: &[Pose]) -> Vec<Pose> {
    let Departing { dt_s, config, seed, .. } = *departing;
    let mut stream = seed.stream("search");
    let mut loss = Loss::after(0.0, config, &mut stream);
    let mut at_loss: Option<Pose> = None;
    let view = |(frame, pose): (usize, &Pose)| {
        let now_s = frame as f64 * dt_s;
        if now_s > loss.from_s + loss.length_s {
            (loss, at_loss) = (Loss::after(now_s, config, &mut stream), None);
        }
        if now_s < loss.from_s {
            return *pose;
        }
        let before = at_loss.get_or_insert(*pose);
        let swept = real::sin(real::TAU * (now_s - loss.from_s) / SWEEP_S);
        let yaw_rad = before.yaw_rad + loss.side * swept * config.search_deg.to_radians();
        let pitch_rad = before.pitch_rad + swept.abs() * loss.pitch_rad;
        Pose { pitch_rad: pitch_rad.clamp(-1.55, 1.55), yaw_rad: real::wrap_angle_rad(yaw_rad), ..*pose }
    };
    straight.iter().enumerate().map(view).collect()
}
