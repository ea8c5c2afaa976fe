//! Evaluation of flights, the same for all planners: in `f64`, against the unsimplified map.

use super::contender::Planned;
use cosfly_frames::{DVec3, TargetTrack, real};
use cosfly_geometry::SpatialQuery;
use cosfly_planner::certificate::Kinematics;
use cosfly_planner::{MucoConfig, Walk};
use cosfly_surroundings::visibility::visibility;
use serde::Serialize;

/// Clearance below which a swept path collides, metres: the radius of the drone.
pub const COLLISION_M: f64 = 0.5;
/// Largest clearance that is measured, metres.
const CLEARANCE_CAP_M: f64 = 50.0;

/// Result of one contender on one path.
pub struct Flight {
    /// Positions, one per frame, metres; empty when there is no flight.
    pub waypoints: Vec<DVec3>,
    /// CPU time of the planning thread, seconds, also when there is no flight.
    pub cpu_s: f64,
    /// Figures, or the reason for a missing flight.
    pub figures: Result<Figures, String>,
}

/// Figures of one flight.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Figures {
    /// Mean share of visible body points, 0..1.
    pub visibility: f64,
    /// Share of frames with at least half of them visible, 0..1.
    pub frames_half_visible: f64,
    /// Mean distance from drone to the target's feet, metres.
    pub distance_m: f64,
    /// Path length of the drone, metres.
    pub length_m: f64,
    /// Path length of the target, metres.
    pub target_length_m: f64,
    /// Smallest distance of the swept path to a box, metres.
    pub min_clearance_m: f64,
    /// Number of segments nearer than [`COLLISION_M`].
    pub collisions: u32,
    /// Number of segments nearer than the clearance limit.
    pub margin_violations: u32,
    /// Largest speed, m/s.
    pub max_speed_mps: f64,
    /// Largest acceleration, m/s^2.
    pub max_acceleration_mps2: f64,
    /// Largest jerk, m/s^3.
    pub max_jerk_mps3: f64,
    /// Mean angle from straight behind the walker, degrees; `None` when the target never walks.
    pub rear_angle_deg: Option<f64>,
    /// Visibility as a share of that of the lattice's best path; `None` without a lattice.
    pub share_of_lattice: Option<f64>,
    /// Number of expanded nodes.
    pub nodes: u64,
}

impl Flight {
    /// Evaluates a planned path.
    pub fn judge(
        planned: Result<Planned, String>,
        cpu_s: f64,
        track: &TargetTrack,
        exact: &dyn SpatialQuery,
        config: &MucoConfig,
    ) -> Self {
        let planned = match planned {
            Ok(planned) => planned,
            Err(reason) => {
                return Self { waypoints: Vec::new(), cpu_s, figures: Err(reason) };
            }
        };
        let seen: Vec<f64> = planned
            .waypoints
            .iter()
            .zip(&track.states)
            .map(|(&waypoint, state)| visibility(exact, waypoint, state, track.height_m))
            .collect();
        let figures = figures(&planned, &seen, track, exact, config.limits.clearance_m);
        Self { waypoints: planned.waypoints, cpu_s, figures: Ok(figures) }
    }
}

fn figures(
    planned: &Planned,
    seen: &[f64],
    track: &TargetTrack,
    exact: &dyn SpatialQuery,
    clearance_m: f64,
) -> Figures {
    let waypoints = &planned.waypoints;
    let frames = waypoints.len().max(1) as f64;
    let clearances: Vec<f64> = swept_clearances_m(exact, waypoints);
    let kinematics = Kinematics::of(track, waypoints, 0);
    let nearer = |limit_m: f64| clearances.iter().filter(|&&clearance| clearance < limit_m - 1e-9).count() as u32;
    let distances = waypoints.iter().zip(&track.states).map(|(w, state)| w.distance(state.feet_in_world));
    let visibility = seen.iter().sum::<f64>() / frames;
    Figures {
        visibility,
        frames_half_visible: seen.iter().filter(|&&share| share >= 0.5).count() as f64 / frames,
        distance_m: distances.sum::<f64>() / frames,
        length_m: waypoints.windows(2).map(|pair| pair[1].distance(pair[0])).sum(),
        target_length_m: track.length_m(),
        min_clearance_m: clearances.iter().copied().fold(CLEARANCE_CAP_M, f64::min),
        collisions: nearer(COLLISION_M),
        margin_violations: nearer(clearance_m),
        max_speed_mps: kinematics.speed_mps,
        max_acceleration_mps2: kinematics.acceleration_mps2,
        max_jerk_mps3: kinematics.jerk_mps3,
        rear_angle_deg: rear_angle_deg(track, waypoints),
        share_of_lattice: planned.lattice_visibility.map(|best| visibility / best.max(1e-9)),
        nodes: planned.nodes,
    }
}

/// Distances of each segment to the nearest box, metres; the last waypoint is a segment of its own.
pub fn swept_clearances_m(exact: &dyn SpatialQuery, waypoints: &[DVec3]) -> Vec<f64> {
    let ends = waypoints.iter().skip(1).chain(waypoints.last());
    waypoints.iter().zip(ends).map(|(&from, &to)| exact.segment_clearance(from, to, CLEARANCE_CAP_M)).collect()
}

/// Mean horizontal angle between "target to drone" and "against the walking direction" while the target walks, degrees.
fn rear_angle_deg(track: &TargetTrack, waypoints: &[DVec3]) -> Option<f64> {
    let walk = Walk::of(track);
    let (mut sum, mut count) = (0.0, 0.0);
    for ((waypoint, state), direction) in waypoints.iter().zip(&track.states).zip(&walk.direction) {
        let toward = (waypoint - state.feet_in_world).truncate().normalize_or_zero();
        if toward.length_squared() > 0.5 && direction.length_squared() > 0.5 {
            sum += real::acos((-toward.dot(*direction)).clamp(-1.0, 1.0)).to_degrees();
            count += 1.0;
        }
    }
    (count > 0.0).then(|| sum / count)
}
