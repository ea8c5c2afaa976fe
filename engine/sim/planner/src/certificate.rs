//! The final word on a flight: everything measured again in f64 against the unsimplified map.

use crate::config::muco::MucoConfig;
use crate::terms::term::{TermContext, WeightedTerm};
use crate::walk::Walk;
use cosfly_domain::{Certificate, Limits, TermCost};
use cosfly_frames::{DVec3, Pose, TargetState, TargetTrack, real};
use cosfly_surroundings::exact::ExactMap;
use cosfly_surroundings::visibility::aim_point;

/// Distances from obstacles are reported up to here, metres.
pub const CLEARANCE_CAP_M: f64 = 50.0;
/// Slack of the kinematic checks for rounding.
const ROUNDING: f64 = 1e-9;

/// Largest finite-difference speed, acceleration, jerk and rates of view of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kinematics {
    /// m/s.
    pub speed_mps: f64,
    /// m/s^2.
    pub acceleration_mps2: f64,
    /// m/s^3.
    pub jerk_mps3: f64,
    /// Yaw of the camera, which looks at the target, degrees per second.
    pub yaw_rate_deg_s: f64,
    /// Pitch of the camera, degrees per second.
    pub pitch_rate_deg_s: f64,
}

impl Kinematics {
    /// Of waypoints behind `track`; 0 where there are too few. Rates of view count from the last of the `given` first
    /// waypoints on: before that the target is not where it was.
    pub fn of(track: &TargetTrack, waypoints: &[DVec3], given: usize) -> Self {
        let dt_s = track.dt_s;
        let largest = |order: usize, difference: &dyn Fn(&[DVec3]) -> DVec3| {
            waypoints.windows(order + 1).map(|w| difference(w).length()).fold(0.0, f64::max)
        };
        let look = |(w, state): (&DVec3, &TargetState)| Pose::looking_at(*w, aim_point(state, track.height_m));
        let views: Vec<Pose> = waypoints.iter().zip(&track.states).skip(given.saturating_sub(1)).map(look).collect();
        let [yaw_rate_deg_s, pitch_rate_deg_s] = view_rates_deg_s(&views, dt_s);
        Self {
            speed_mps: largest(1, &|w| w[1] - w[0]) / dt_s,
            acceleration_mps2: largest(2, &|w| w[2] - 2.0 * w[1] + w[0]) / (dt_s * dt_s),
            jerk_mps3: largest(3, &|w| w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0]) / (dt_s * dt_s * dt_s),
            yaw_rate_deg_s,
            pitch_rate_deg_s,
        }
    }

    /// As a certificate states them.
    fn stated(certificate: &Certificate) -> Self {
        Self {
            speed_mps: certificate.max_speed_mps,
            acceleration_mps2: certificate.max_acceleration_mps2,
            jerk_mps3: certificate.max_jerk_mps3,
            yaw_rate_deg_s: certificate.max_yaw_rate_deg_s,
            pitch_rate_deg_s: certificate.max_pitch_rate_deg_s,
        }
    }

    /// Violated limits, in words.
    pub fn violations(&self, limits: &Limits) -> Vec<String> {
        [
            ("speed", self.speed_mps, limits.speed_mps, "m/s"),
            ("acceleration", self.acceleration_mps2, limits.acceleration_mps2, "m/s^2"),
            ("jerk", self.jerk_mps3, limits.jerk_mps3, "m/s^3"),
            ("yaw rate", self.yaw_rate_deg_s, limits.yaw_rate_deg_s, "degrees/s"),
            ("pitch rate", self.pitch_rate_deg_s, limits.pitch_rate_deg_s, "degrees/s"),
        ]
        .into_iter()
        .filter(|(_, value, limit, _)| value.is_nan() || *value > limit + ROUNDING)
        .map(|(name, value, limit, unit)| format!("{name} reaches {value:.2} {unit}; the limit is {limit} {unit}"))
        .collect()
    }
}

/// Largest rates of yaw and pitch from pose to pose, degrees per second; 0 where there are too few.
pub fn view_rates_deg_s(views: &[Pose], dt_s: f64) -> [f64; 2] {
    let angles: [fn(&Pose) -> f64; 2] = [|view| view.yaw_rad, |view| view.pitch_rad];
    angles.map(|angle| {
        let turn = |pair: &[Pose]| real::wrap_angle_rad(angle(&pair[1]) - angle(&pair[0])).abs().to_degrees();
        views.windows(2).map(turn).fold(0.0, f64::max) / dt_s
    })
}

/// Smallest distance of the swept path to the exact obstacles, capped at [`CLEARANCE_CAP_M`].
pub fn swept_clearance_m(exact: ExactMap<'_>, waypoints: &[DVec3]) -> f64 {
    let mut smallest = CLEARANCE_CAP_M;
    for (i, &from) in waypoints.iter().enumerate() {
        let to = waypoints.get(i + 1).copied().unwrap_or(from);
        smallest = smallest.min(exact.segment_clearance(i, from, to, smallest));
    }
    smallest
}

/// Whether a flight may be published: clearance always holds, and the limits of motion when the recipe requires them.
pub fn publishable(config: &MucoConfig, certificate: &Certificate) -> bool {
    if certificate.holds {
        return true;
    }
    let kinematic = Kinematics::stated(certificate).violations(&certificate.limits);
    !config.limits.require_kinematics && certificate.violations.iter().all(|v| kinematic.contains(v))
}

/// Per-frame measurements and the certificate they add up to.
pub struct Measured {
    /// Share of the target's body points seen, 0..=1, per frame.
    pub visibility: Vec<f64>,
    /// Distance to the nearest exact obstacle per frame, metres, capped at [`CLEARANCE_CAP_M`].
    pub clearance_m: Vec<f64>,
    /// All figures.
    pub certificate: Certificate,
}

/// Measures a path whose first `given` waypoints were given; figures that only the solver knows stay 0. `ground` gives the
/// height of the ground, metres, above which the clearance is kept, too.
pub fn certify(
    track: &TargetTrack,
    waypoints: &[DVec3],
    given: usize,
    exact: ExactMap<'_>,
    ground: &dyn Fn(f64, f64) -> f64,
    config: &MucoConfig,
) -> Measured {
    let limits = config.stated_limits();
    let frames = || waypoints.iter().zip(&track.states).enumerate();
    let seen: Vec<f64> = frames().map(|(i, (&w, state))| exact.visibility(i, w, state, track.height_m)).collect();
    let near = |i: usize, w: DVec3| exact.nearest(i, w, CLEARANCE_CAP_M).map_or(CLEARANCE_CAP_M, |near| near.0);
    let clearance_m: Vec<f64> = waypoints.iter().enumerate().map(|(i, &w)| near(i, w)).collect();
    let swept = clearance_m.iter().copied().fold(swept_clearance_m(exact, waypoints), f64::min);
    let kinematics = Kinematics::of(track, waypoints, given);
    let mut violations = Vec::new();
    if swept.is_nan() || swept < limits.clearance_m {
        violations.push(format!("clearance falls to {swept:.2} m; the limit is {} m", limits.clearance_m));
    }
    if let Some((at, above)) = lowest_above_ground(waypoints, ground).filter(|low| low.1 < limits.clearance_m) {
        let limit = limits.clearance_m;
        violations.push(format!("at {at:.1} the flight is {above:.2} m above ground; the limit is {limit} m"));
    }
    violations.extend(kinematics.violations(&limits));
    let frames = waypoints.len().max(1) as f64;
    let length_m = waypoints.windows(2).map(|w| w[1].distance(w[0])).sum::<f64>();
    let walked = track.length_m();
    let certificate = Certificate {
        limits,
        holds: violations.is_empty(),
        violations,
        mean_visibility: seen.iter().sum::<f64>() / frames,
        frames_half_visible: seen.iter().filter(|&&v| v >= 0.5).count() as f64 / frames,
        min_clearance_m: swept,
        max_speed_mps: kinematics.speed_mps,
        max_acceleration_mps2: kinematics.acceleration_mps2,
        max_jerk_mps3: kinematics.jerk_mps3,
        max_yaw_rate_deg_s: kinematics.yaw_rate_deg_s,
        max_pitch_rate_deg_s: kinematics.pitch_rate_deg_s,
        mean_distance_m: distances(track, waypoints).sum::<f64>() / frames,
        mean_rear_angle_deg: mean_rear_angle_deg(track, waypoints),
        length_m,
        length_ratio: if walked > 0.0 { length_m / walked } else { 0.0 },
        ..Certificate::default()
    };
    Measured { visibility: seen, clearance_m, certificate }
}

fn distances<'a>(track: &'a TargetTrack, waypoints: &'a [DVec3]) -> impl Iterator<Item = f64> + 'a {
    waypoints.iter().zip(&track.states).map(|(w, state)| w.distance(state.feet_in_world))
}

fn lowest_above_ground(waypoints: &[DVec3], ground: &dyn Fn(f64, f64) -> f64) -> Option<(DVec3, f64)> {
    let above = |w: &DVec3| (*w, w.z - ground(w.x, w.y));
    waypoints.iter().map(above).filter(|low| low.1.is_finite()).min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Mean angle between "target to drone" and "against the walking direction", seen from above, over the frames
/// in which the target walks; 0 when it never does.
fn mean_rear_angle_deg(track: &TargetTrack, waypoints: &[DVec3]) -> f64 {
    let walk = Walk::of(track);
    let angles: Vec<f64> = waypoints
        .iter()
        .zip(&track.states)
        .zip(&walk.direction)
        .filter_map(|((w, state), direction)| {
            let toward = (w - state.feet_in_world).truncate().normalize_or_zero();
            let defined = toward.length_squared() > 0.5 && direction.length_squared() > 0.5;
            defined.then(|| real::acos((-toward.dot(*direction)).clamp(-1.0, 1.0)).to_degrees())
        })
        .collect();
    if angles.is_empty() { 0.0 } else { angles.iter().sum::<f64>() / angles.len() as f64 }
}

/// Every term's cost, frame by frame.
pub fn term_costs(terms: &[WeightedTerm], waypoints: &[DVec3], context: &TermContext<'_>) -> Vec<TermCost> {
    terms
        .iter()
        .map(|weighted| {
            let mut per_frame = vec![0.0; waypoints.len()];
            weighted.term.cost(waypoints, context, &mut per_frame);
            TermCost {
                name: weighted.term.name().to_owned(),
                weight: weighted.weight,
                sum: per_frame.iter().sum(),
                per_frame,
            }
        })
        .collect()
}
