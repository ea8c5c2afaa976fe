//! Visibility against learnability: how much of the target the flights of a planner show, and how well the next 2.5 s of a
//! flight follow from its last 2.5 s.
//!
//! Learnability is the error of a ridge regression that is given the clean past of drone and target, never the target's
//! future, on flights that it was not fitted to. It is a lower bound of what a policy can reach that sees no map.

use super::outcomes::{PathOutcome, PlannerOptions};
use cosfly_frames::{DVec3, Pose, TargetTrack, real};
use cosfly_metrics::baselines::features::Examples;
use cosfly_metrics::baselines::{InputFrames, Ridge};
use cosfly_metrics::errors;
use cosfly_planner::Walk;
use cosfly_surroundings::visibility::aim_point;
use cosfly_windows::WindowShape;
use serde::Serialize;
use std::fmt;

/// Parts into which flights are divided: each is predicted by a ridge that was fitted to the others.
const PARTS: usize = 5;
/// Speed above which a drone behind a walker dashes, m/s.
const DASH_MPS: f64 = 5.0;
/// Angle from straight behind the walker within which the paper starts, degrees.
const REAR_DEG: f64 = 60.0;

/// Rows by scene, then planner.
#[derive(Clone, Debug, Serialize)]
pub struct Front {
    /// The rows.
    pub rows: Vec<FrontRow>,
}

/// Figures of one planner in one scene, over all of its flights.
#[derive(Clone, Debug, Serialize)]
pub struct FrontRow {
    /// Name of the scene or recipe.
    pub scene: String,
    /// Name of the planner.
    pub planner: String,
    /// Number of flights.
    pub flights: usize,
    /// Mean visibility, 0..1.
    pub visibility: f64,
    /// Mean error of the ridge 2.5 s ahead, given poses and the target's places, metres; `None` for fewer than two flights.
    pub ridge_m: Option<f64>,
    /// Mean error of the ridge given poses alone, metres.
    pub ridge_of_poses_m: Option<f64>,
    /// Largest yaw rate, degrees per second.
    pub yaw_rate_deg_s: f64,
    /// Largest pitch rate, degrees per second.
    pub pitch_rate_deg_s: f64,
    /// Speed that 99 % of the steps stay below, m/s.
    pub speed_p99_mps: f64,
    /// Times that the speed rises above 5 m/s, per 100 s.
    pub dashes: f64,
    /// Share of flights that start within 60 degrees of the walker's back, among those whose walker walks then.
    pub rear_starts: f64,
    /// Length of all flights divided by that of their targets.
    pub length_ratio: f64,
    /// Mean CPU time per path, milliseconds.
    pub mean_ms: f64,
}

/// A flight and the walk behind which it is.
struct Flown<'a> {
    track: &'a TargetTrack,
    poses: Vec<Pose>,
}

/// The rows of all scenes and planners.
pub fn front(options: &PlannerOptions<'_>, outcomes: &[PathOutcome]) -> Front {
    let mut rows = Vec::new();
    for (index, ground) in options.grounds.iter().enumerate() {
        let of_ground: Vec<&PathOutcome> = outcomes.iter().filter(|outcome| outcome.ground == index).collect();
        for (position, contender) in options.contenders.iter().enumerate() {
            let flights = of_ground.iter().map(|outcome| (&ground.tracks[outcome.path], &outcome.flights[position]));
            let good = || flights.clone().filter(|(_, flight)| flight.figures.is_ok());
            let flown: Vec<Flown<'_>> = good().map(|(track, flight)| Flown::new(track, &flight.waypoints)).collect();
            let seen: f64 = good().filter_map(|(_, flight)| Some(flight.figures.as_ref().ok()?.visibility)).sum();
            let cpu_s: f64 = flights.clone().map(|(_, flight)| flight.cpu_s).sum();
            rows.push(FrontRow {
                scene: ground.name.clone(),
                planner: contender.name().to_owned(),
                visibility: seen / flown.len().max(1) as f64,
                mean_ms: 1e3 * cpu_s / of_ground.len().max(1) as f64,
                ..row(&flown)
            });
        }
    }
    Front { rows }
}

fn row(flown: &[Flown<'_>]) -> FrontRow {
    let mut speeds: Vec<f64> = flown.iter().flat_map(Flown::speeds_mps).collect();
    speeds.sort_by(f64::total_cmp);
    let dashes: usize = flown.iter().map(Flown::dashes).sum();
    let seconds: f64 = flown.iter().map(|one| one.track.duration_s()).sum();
    let starts: Vec<f64> = flown.iter().filter_map(Flown::start_off_rear_deg).collect();
    let behind = starts.iter().filter(|angle| **angle <= REAR_DEG).count();
    let flown_m: f64 = flown.iter().map(Flown::length_m).sum();
    let walked_m: f64 = flown.iter().map(|one| one.track.length_m()).sum();
    let turns = || flown.iter().flat_map(Flown::turns_deg_s);
    FrontRow {
        scene: String::new(),
        planner: String::new(),
        flights: flown.len(),
        visibility: 0.0,
        ridge_m: ridge_error_m(flown, true),
        ridge_of_poses_m: ridge_error_m(flown, false),
        yaw_rate_deg_s: turns().map(|turn| turn.0).fold(0.0, f64::max),
        pitch_rate_deg_s: turns().map(|turn| turn.1).fold(0.0, f64::max),
        speed_p99_mps: speeds.get(speeds.len() * 99 / 100).copied().unwrap_or(0.0),
        dashes: 100.0 * dashes as f64 / seconds.max(1e-9),
        rear_starts: behind as f64 / starts.len().max(1) as f64,
        length_ratio: flown_m / walked_m.max(1e-9),
        mean_ms: 0.0,
    }
}

impl<'a> Flown<'a> {
    fn new(track: &'a TargetTrack, waypoints: &[DVec3]) -> Self {
        let look = |(&at, state): (&DVec3, &_)| Pose::looking_at(at, aim_point(state, track.height_m));
        Self { track, poses: waypoints.iter().zip(&track.states).map(look).collect() }
    }

    fn steps(&self) -> impl Iterator<Item = (&Pose, &Pose)> {
        self.poses.iter().zip(self.poses.iter().skip(1))
    }

    fn length_m(&self) -> f64 {
        self.steps().map(|(from, to)| from.position_in_world.distance(to.position_in_world)).sum()
    }

    fn speeds_mps(&self) -> impl Iterator<Item = f64> {
        self.steps().map(|(from, to)| from.position_in_world.distance(to.position_in_world) / self.track.dt_s)
    }

    fn dashes(&self) -> usize {
        let fast: Vec<bool> = self.speeds_mps().map(|speed| speed > DASH_MPS).collect();
        let before = core::iter::once(&false).chain(&fast);
        before.zip(&fast).filter(|(before, now)| **now && !**before).count()
    }

    /// Rates of yaw and pitch from frame to frame, degrees per second, without sign.
    fn turns_deg_s(&self) -> impl Iterator<Item = (f64, f64)> {
        let rate = |from: f64, to: f64| real::wrap_angle_rad(to - from).abs().to_degrees() / self.track.dt_s;
        self.steps().map(move |(from, to)| (rate(from.yaw_rad, to.yaw_rad), rate(from.pitch_rad, to.pitch_rad)))
    }

    /// Angle at the first frame between "target to drone" and "against the walking direction", degrees; `None` where the
    /// target stands.
    fn start_off_rear_deg(&self) -> Option<f64> {
        let direction = *Walk::of(self.track).direction.first()?;
        let (pose, state) = (self.poses.first()?, self.track.states.first()?);
        let toward = (pose.position_in_world - state.feet_in_world).truncate().normalize_or_zero();
        let walks = direction.length_squared() > 0.5;
        walks.then(|| real::acos((-toward.dot(direction)).clamp(-1.0, 1.0)).to_degrees())
    }
}

/// Mean error at the last waypoint of all windows, each predicted by a ridge fitted to the flights of the other parts;
/// with the places of the target, or with poses alone.
fn ridge_error_m(flown: &[Flown<'_>], with_target: bool) -> Option<f64> {
    let shape = WindowShape::default();
    let (mut sum, mut count) = (0.0, 0.0);
    for part in 0..PARTS {
        let mut examples = Examples::default();
        let of_part = |(index, one)| (index % PARTS == part).then_some(one);
        let others = flown.iter().enumerate().filter(|(index, _)| index % PARTS != part);
        for (_, one) in others {
            for_each_window(one, shape, with_target, |view, truth| examples.push(view, &view.current(), truth));
        }
        let Some(ridge) = Ridge::fit(&examples) else { continue };
        for one in flown.iter().enumerate().filter_map(of_part) {
            for_each_window(one, shape, with_target, |view, truth| {
                if let Some(found) = ridge.predict(view) {
                    sum += errors(&found.waypoints, truth).fde_m;
                    count += 1.0;
                }
            });
        }
    }
    (count > 0.0).then(|| sum / count)
}

/// Calls `each` with the input and the true waypoints of every window of a flight.
fn for_each_window(
    one: &Flown<'_>,
    shape: WindowShape,
    with_target: bool,
    mut each: impl FnMut(&InputFrames<'_>, &[Pose]),
) {
    let feet: Vec<DVec3> = one.track.states.iter().map(|state| state.feet_in_world).collect();
    for start in shape.starts(one.poses.len()) {
        let (now, end) = (start + shape.history, start + shape.size());
        let feet = if with_target { &feet[start..now] } else { &[] };
        let view =
            InputFrames { poses: &one.poses[start..now], feet, horizon: shape.horizon, ..InputFrames::default() };
        each(&view, &one.poses[now..end]);
    }
}

impl fmt::Display for Front {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "scene | planner | flights | vis | ridge | poses | yaw | pitch | v99 | dashes | rear | ratio | ms"
        )?;
        writeln!(f, "--- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | ---")?;
        for row in &self.rows {
            let metres = |error: Option<f64>| error.map_or("-".to_owned(), |error| format!("{error:.2}"));
            writeln!(
                f,
                "{} | {} | {} | {:.3} | {} | {} | {:.0} | {:.0} | {:.1} | {:.1} | {:.0} % | {:.2} | {:.1}",
                row.scene,
                row.planner,
                row.flights,
                row.visibility,
                metres(row.ridge_m),
                metres(row.ridge_of_poses_m),
                row.yaw_rate_deg_s,
                row.pitch_rate_deg_s,
                row.speed_p99_mps,
                row.dashes,
                100.0 * row.rear_starts,
                row.length_ratio,
                row.mean_ms,
            )?;
        }
        Ok(())
    }
}

/// Legend of [`Front`], for the end of a printed table.
pub const FRONT_LEGEND: &str = "\
vis: mean share of visible body points; ridge: error 2.5 s ahead of a ridge regression that knows the last 2.5 s of drone
and target, on flights that it was not fitted to, m; poses: the same without the target; yaw, pitch: largest rates,
degrees/s; v99: speed that 99 % of the steps stay below, m/s; dashes: times that the speed rises above 5 m/s, per 100 s;
rear: flights that start within 60 degrees of the walker's back; ratio: length to the walk's; ms: CPU time per path.
";

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::TargetState;

    fn walk(frames: usize) -> TargetTrack {
        let state = |i: usize| TargetState {
            feet_in_world: DVec3::new(0.5 * i as f64, 0.0, 0.0),
            heading_rad: 0.0,
            speed_mps: 1.0,
        };
        TargetTrack { dt_s: 0.5, height_m: 1.75, radius_m: 0.3, states: (0..frames).map(state).collect() }
    }

    #[test]
    fn a_steady_flight_is_learnt_and_a_restless_one_is_told_by_its_dashes_and_turns() {
        let track = walk(60);
        let behind: Vec<DVec3> =
            track.states.iter().map(|it| it.feet_in_world + DVec3::new(-20.0, 0.0, 20.0)).collect();
        let sides = |frame: usize| if frame % 20 < 10 { -20.0 } else { 20.0 };
        let jumps = |(frame, state): (usize, &TargetState)| state.feet_in_world + DVec3::new(1.0, sides(frame), 20.0);
        let restless: Vec<DVec3> = track.states.iter().enumerate().map(jumps).collect();
        let many = |waypoints: &[DVec3]| row(&(0..6).map(|_| Flown::new(&track, waypoints)).collect::<Vec<_>>());
        let (calm, wild) = (many(&behind), many(&restless));
        assert!(calm.ridge_m.is_some_and(|error| error < 0.05), "{calm:?}");
        assert!(wild.ridge_m > calm.ridge_m, "{wild:?}");
        assert_eq!((calm.dashes, calm.rear_starts, wild.rear_starts), (0.0, 1.0, 0.0));
        assert!(wild.dashes > 10.0 && wild.yaw_rate_deg_s > 300.0 && calm.yaw_rate_deg_s < 1e-6, "{wild:?}");
    }
}
