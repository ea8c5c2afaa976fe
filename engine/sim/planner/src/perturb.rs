//! The perturbed twin of an expert flight: two independent events per frame, with safe displacements
//! (paper, section "Dual-Trajectory Augmentation").

use crate::certificate::certify;
use crate::config::{LimitsConfig, MucoConfig};
use crate::obstacles::exact::ExactMap;
use crate::trajectory::{FramePerturbation, Perturbation, PlanOutcome, Trajectory};
use crate::visibility::aim_point;
use cosfly_frames::{DVec3, Pose, RandomStream, Seed, real};
use cosfly_geometry::SpatialQuery;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Kept beyond the asked clearance, so that rounding cannot take it away again, metres.
const ROUNDING_M: f64 = 1e-6;

/// Steepest pitch of a turned view, radians (89.9 degrees): at 90 a pose has no unique yaw.
const STEEPEST_PITCH_RAD: f64 = 89.9 * (real::PI / 180.0);

/// Fresh draws of a displacement that is not free, before it is shortened.
const DRAWS: usize = 8;

/// Shares of the drawn lengths that are tried at last.
const SHARES: [f64; 4] = [0.75, 0.5, 0.25, 0.125];

/// How far a twin departs from its expert. The defaults are the paper's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PerturbConfig {
    /// Probability per frame that drone and aim are displaced. Default 0.6.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub position_probability: f64,
    /// Probability per frame that the view is turned, independent of the other. Default 0.6.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub rotation_probability: f64,
    /// Length of the drone's displacement, in any direction.
    pub drone_offset: OffsetRange,
    /// Length of the displacement of the point aimed at, in any horizontal direction.
    pub aim_offset: OffsetRange,
    /// Largest turn of the view, pitch and yaw together, degrees. Default 5.
    #[schemars(range(min = 0.0, max = 90.0))]
    pub max_rotation_deg: f64,
    /// Distance from obstacles that displaced drones keep along the whole swept path, metres. Default 1.
    #[schemars(range(min = 0.05, max = 10.0))]
    pub clearance_m: f64,
    /// Height above the target's feet that displaced drones keep, metres. Default 3.
    #[schemars(range(min = 0.5, max = 100.0))]
    pub min_height_m: f64,
}

/// Length of a displacement, drawn uniformly.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct OffsetRange {
    /// Smallest, metres. Default 2.
    #[schemars(range(min = 0.0, max = 50.0))]
    pub min_m: f64,
    /// Largest, metres. Default 3.
    #[schemars(range(min = 0.0, max = 50.0))]
    pub max_m: f64,
}

impl Default for PerturbConfig {
    fn default() -> Self {
        Self {
            position_probability: 0.6,
            rotation_probability: 0.6,
            drone_offset: OffsetRange::default(),
            aim_offset: OffsetRange::default(),
            max_rotation_deg: 5.0,
            clearance_m: 1.0,
            min_height_m: 3.0,
        }
    }
}

impl Default for OffsetRange {
    fn default() -> Self {
        Self { min_m: 2.0, max_m: 3.0 }
    }
}

impl PerturbConfig {
    /// Refuses values out of range and reversed ranges: (path of the parameter, what is wrong).
    pub fn validate(&self) -> Result<(), (String, String)> {
        for (path, value, low, high) in [
            ("position_probability", self.position_probability, 0.0, 1.0),
            ("rotation_probability", self.rotation_probability, 0.0, 1.0),
            ("drone_offset.min_m", self.drone_offset.min_m, 0.0, 50.0),
            ("drone_offset.max_m", self.drone_offset.max_m, 0.0, 50.0),
            ("aim_offset.min_m", self.aim_offset.min_m, 0.0, 50.0),
            ("aim_offset.max_m", self.aim_offset.max_m, 0.0, 50.0),
            ("max_rotation_deg", self.max_rotation_deg, 0.0, 90.0),
            ("clearance_m", self.clearance_m, 0.05, 10.0),
            ("min_height_m", self.min_height_m, 0.5, 100.0),
        ] {
            if !(low..=high).contains(&value) {
                return Err((path.to_owned(), format!("`{path}` is {value}; it must be between {low} and {high}")));
            }
        }
        for (name, range) in [("drone_offset", &self.drone_offset), ("aim_offset", &self.aim_offset)] {
            if range.min_m > range.max_m {
                let rule = format!(
                    "`{name}.min_m` is {}; it must not be above `{name}.max_m`, which is {}",
                    range.min_m, range.max_m
                );
                return Err((format!("{name}.min_m"), rule));
            }
        }
        Ok(())
    }
}

/// The perturbed twin of `expert`, frame by frame.
///
/// With probability `position_probability` the drone is displaced and aims at a displaced point; independently, with
/// probability `rotation_probability`, its view is turned. A displacement that would come nearer to an obstacle than
/// `clearance_m`, there or on the way from the frame before or to the expert's next position, is drawn again, then
/// shortened, at last zero; the event stays recorded with the displacement that was flown. So the swept path of the
/// twin keeps `clearance_m` wherever the expert does.
///
/// Frames without events are the expert's, to the bit. `terms` is empty: costs belong to the expert's optimisation.
/// The certificate states infinite kinematic limits, since jumps from frame to frame are the point of a twin.
///
/// Rejected are only a config that breaks its rules, an expert whose frames do not match its track, and a twin that
/// touches an obstacle, which takes an expert that does.
pub fn perturb(
    expert: &Trajectory,
    expert_item: &str,
    exact: &dyn SpatialQuery,
    config: &PerturbConfig,
    seed: Seed,
) -> PlanOutcome {
    let rejected = |reason: String| PlanOutcome::Rejected { track: expert.track.clone(), reason };
    if let Err((_, rule)) = config.validate() {
        return rejected(rule);
    }
    let count = expert.track.len();
    if expert.poses_in_world.len() != count {
        return rejected(format!("the expert has {} poses for {count} frames", expert.poses_in_world.len()));
    }
    let mut frames = Vec::with_capacity(count);
    let mut poses: Vec<Pose> = Vec::with_capacity(count);
    let (mut position_events, mut rotation_events) = (seed.stream("position event"), seed.stream("rotation event"));
    for frame in 0..count {
        let mut applied = FramePerturbation {
            position: position_events.chance(config.position_probability),
            rotation: rotation_events.chance(config.rotation_probability),
            drone_offset_in_world: DVec3::ZERO,
            aim_offset_in_world: DVec3::ZERO,
            pitch_offset_rad: 0.0,
            yaw_offset_rad: 0.0,
            expert_frame: frame as u32,
        };
        let mut pose = expert.poses_in_world[frame];
        if applied.position {
            let corridor = Corridor {
                exact,
                clearance_m: config.clearance_m,
                lowest_z_m: expert.track.states[frame].feet_in_world.z + config.min_height_m,
                before: poses.last().map(|pose| pose.position_in_world),
                after: expert.poses_in_world.get(frame + 1).map(|pose| pose.position_in_world),
            };
            let own = seed.child("frame", frame as u64);
            applied.drone_offset_in_world =
                free_offset(&corridor, pose.position_in_world, &config.drone_offset, own.stream("drone"));
            applied.aim_offset_in_world = horizontal_offset(&config.aim_offset, own.stream("aim"));
            pose = displaced(pose, expert, frame, &applied);
        }
        if applied.rotation {
            turn(&mut pose, &mut applied, config, seed.child("frame", frame as u64).stream("rotation"));
        }
        poses.push(pose);
        frames.push(applied);
    }
    let perturbation = Perturbation {
        expert_item: expert_item.to_owned(),
        position_probability: config.position_probability,
        rotation_probability: config.rotation_probability,
        frames,
    };
    let twin = measured(expert, poses, perturbation, exact, config);
    match twin.certificate.min_clearance_m {
        free if free > 0.0 => PlanOutcome::Planned(Box::new(twin)),
        touching => rejected(format!("the twin comes to {touching:.2} m from an obstacle, as its expert does")),
    }
}

/// What a displaced position must keep to.
struct Corridor<'a> {
    exact: &'a dyn SpatialQuery,
    clearance_m: f64,
    lowest_z_m: f64,
    /// Where the twin was one frame before.
    before: Option<DVec3>,
    /// Where the expert will be: the twin must always be able to return there.
    after: Option<DVec3>,
}

impl Corridor<'_> {
    fn holds(&self, position: DVec3) -> bool {
        let kept_m = self.clearance_m + ROUNDING_M;
        let swept = |other: DVec3| self.exact.segment_clearance(position, other, kept_m) >= kept_m;
        position.z >= self.lowest_z_m && swept(self.before.unwrap_or(position)) && self.after.is_none_or(swept)
    }
}

/// A displacement of the drone that is free: fresh draws first, then shorter ones, then none.
fn free_offset(corridor: &Corridor<'_>, from: DVec3, range: &OffsetRange, mut stream: RandomStream) -> DVec3 {
    let mut drawn = [DVec3::ZERO; DRAWS];
    for offset in &mut drawn {
        *offset = stream.uniform(range.min_m, range.max_m) * direction_on_sphere(&mut stream);
        if corridor.holds(from + *offset) {
            return *offset;
        }
    }
    for share in SHARES {
        if let Some(offset) = drawn.iter().map(|offset| share * *offset).find(|offset| corridor.holds(from + *offset)) {
            return offset;
        }
    }
    DVec3::ZERO
}

/// Uniform on the unit sphere (Archimedes: z is uniform).
fn direction_on_sphere(stream: &mut RandomStream) -> DVec3 {
    let z = stream.uniform(-1.0, 1.0);
    let (sin, cos) = real::sin_cos(stream.uniform(-real::PI, real::PI));
    let radius = (1.0 - z * z).max(0.0).sqrt();
    DVec3::new(radius * cos, radius * sin, z)
}

fn horizontal_offset(range: &OffsetRange, mut stream: RandomStream) -> DVec3 {
    let length = stream.uniform(range.min_m, range.max_m);
    let (sin, cos) = real::sin_cos(stream.uniform(-real::PI, real::PI));
    DVec3::new(length * cos, length * sin, 0.0)
}

/// The pose from the displaced position towards the displaced aim. The undisplaced aim is the point of the expert's
/// own line of sight abreast of the target, so that zero displacements give the expert's view.
fn displaced(expert_pose: Pose, expert: &Trajectory, frame: usize, applied: &FramePerturbation) -> Pose {
    let position = expert_pose.position_in_world;
    let forward = expert_pose.world_from_body() * DVec3::X;
    let ahead_m = (aim_point(&expert.track.states[frame], expert.track.height_m) - position).dot(forward).max(1.0);
    let aim = position + ahead_m * forward + applied.aim_offset_in_world;
    Pose { roll_rad: expert_pose.roll_rad, ..Pose::looking_at(position + applied.drone_offset_in_world, aim) }
}

/// Turns the view by an angle uniform in 0..=max, split into pitch and yaw by a uniform direction. The pitch stops at
/// [`STEEPEST_PITCH_RAD`]; what was turned is recorded, not what was drawn.
fn turn(pose: &mut Pose, applied: &mut FramePerturbation, config: &PerturbConfig, mut stream: RandomStream) {
    let angle = stream.uniform(0.0, config.max_rotation_deg.to_radians());
    let (sin, cos) = real::sin_cos(stream.uniform(-real::PI, real::PI));
    let pitch_rad = (pose.pitch_rad + sin * angle).clamp(-STEEPEST_PITCH_RAD, STEEPEST_PITCH_RAD);
    applied.pitch_offset_rad = pitch_rad - pose.pitch_rad;
    applied.yaw_offset_rad = cos * angle;
    pose.pitch_rad = pitch_rad;
    pose.yaw_rad = real::wrap_angle_rad(pose.yaw_rad + applied.yaw_offset_rad);
}

/// The twin with visibility, clearance and certificate measured anew.
fn measured(
    expert: &Trajectory,
    poses: Vec<Pose>,
    perturbation: Perturbation,
    exact: &dyn SpatialQuery,
    config: &PerturbConfig,
) -> Trajectory {
    let positions: Vec<DVec3> = poses.iter().map(|pose| pose.position_in_world).collect();
    let limits = LimitsConfig {
        clearance_m: config.clearance_m,
        speed_mps: f64::INFINITY,
        acceleration_mps2: f64::INFINITY,
        jerk_mps3: f64::INFINITY,
        require_kinematics: false,
    };
    // Height is kept above the target's feet while displacing; no ground below is known here.
    let no_ground = |_: f64, _: f64| f64::NEG_INFINITY;
    let muco = MucoConfig { limits, ..MucoConfig::default() };
    let mut measured = certify(&expert.track, &positions, ExactMap::still(exact), &no_ground, &muco);
    measured.certificate.filtered_boxes = expert.certificate.filtered_boxes;
    Trajectory {
        track: expert.track.clone(),
        poses_in_world: poses,
        visibility: measured.visibility,
        clearance_m: measured.clearance_m,
        terms: vec![],
        convergence: vec![],
        certificate: measured.certificate,
        perturbation: Some(perturbation),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trajectory::{Certificate, Limits};
    use cosfly_frames::{TargetState, TargetTrack};
    use cosfly_geometry::{BoxBvh, OrientedBox};

    /// An expert 20 m behind and 20 m above a target that walks along x at 1 m/s.
    fn expert(count: usize) -> Trajectory {
        let states: Vec<TargetState> = (0..count)
            .map(|i| TargetState {
                feet_in_world: DVec3::new(0.5 * i as f64, 0.0, 0.0),
                heading_rad: 0.0,
                speed_mps: 1.0,
            })
            .collect();
        let track = TargetTrack { dt_s: 0.5, height_m: 1.7, radius_m: 0.25, states };
        let poses_in_world: Vec<Pose> = track
            .states
            .iter()
            .map(|s| Pose::looking_at(s.feet_in_world + DVec3::new(-20.0, 0.0, 20.0), aim_point(s, 1.7)))
            .collect();
        let no_twin = Perturbation {
            expert_item: String::new(),
            position_probability: 0.0,
            rotation_probability: 0.0,
            frames: vec![],
        };
        let mut blank = Trajectory {
            track,
            poses_in_world: vec![],
            visibility: vec![],
            clearance_m: vec![],
            terms: vec![],
            convergence: vec![],
            certificate: Certificate {
                limits: Limits { clearance_m: 1.5, speed_mps: 12.0, acceleration_mps2: 6.0, jerk_mps3: 12.0 },
                holds: true,
                violations: vec![],
                mean_visibility: 0.0,
                frames_half_visible: 0.0,
                min_clearance_m: 0.0,
                max_speed_mps: 0.0,
                max_acceleration_mps2: 0.0,
                max_jerk_mps3: 0.0,
                mean_distance_m: 0.0,
                mean_rear_angle_deg: 0.0,
                length_m: 0.0,
                length_ratio: 0.0,
                iterations: 7,
                filtered_boxes: 3,
                ..Certificate::default()
            },
            perturbation: None,
        };
        blank = measured(&blank, poses_in_world, no_twin, &BoxBvh::build(vec![]), &PerturbConfig::default());
        blank.perturbation = None;
        blank
    }

    fn seed() -> Seed {
        Seed::of_item(9, "perturbed", "p3")
    }

    fn twin_of(expert: &Trajectory, exact: &BoxBvh, config: &PerturbConfig, seed: Seed) -> Trajectory {
        match perturb(expert, "p3", exact, config, seed) {
            PlanOutcome::Planned(twin) => *twin,
            PlanOutcome::Rejected { reason, .. } => panic!("{reason}"),
        }
    }

    fn frames(twin: &Trajectory) -> &[FramePerturbation] {
        &twin.perturbation.as_ref().unwrap().frames
    }

    /// A tunnel around the flight, 3.8 m wide and 3.2 m high: no room for 2 m but along it.
    fn tunnel() -> BoxBvh {
        let slab = |y: f64, z: f64, half_y: f64, half_z: f64| OrientedBox {
            center_in_world: DVec3::new(200.0, y, z),
            half_extents_m: DVec3::new(400.0, half_y, half_z),
            yaw_rad: 0.0,
        };
        BoxBvh::build(vec![
            slab(2.9, 20.0, 1.0, 10.0),
            slab(-2.9, 20.0, 1.0, 10.0),
            slab(0.0, 22.1, 3.0, 0.5),
            slab(0.0, 17.9, 3.0, 0.5),
        ])
    }

    #[test]
    fn the_four_states_have_the_papers_shares() {
        let twin = twin_of(&expert(8000), &BoxBvh::build(vec![]), &PerturbConfig::default(), seed());
        for (position, rotation, share) in
            [(false, false, 0.16), (true, false, 0.24), (false, true, 0.24), (true, true, 0.36)]
        {
            let found = frames(&twin).iter().filter(|f| (f.position, f.rotation) == (position, rotation)).count();
            let sigma = (8000.0_f64 * share * (1.0 - share)).sqrt();
            assert!((found as f64 - 8000.0 * share).abs() < 3.0 * sigma, "{position} {rotation}: {found}");
        }
    }

    #[test]
    fn offsets_keep_their_bounds_and_frames_their_expert() {
        let (expert, config) = (expert(500), PerturbConfig::default());
        let twin = twin_of(&expert, &BoxBvh::build(vec![]), &config, seed());
        assert_eq!(twin.poses_in_world.len(), 500);
        for (i, frame) in frames(&twin).iter().enumerate() {
            let (pose, original) = (twin.poses_in_world[i], expert.poses_in_world[i]);
            assert_eq!(frame.expert_frame as usize, i);
            let moved = pose.position_in_world - original.position_in_world;
            assert!((moved - frame.drone_offset_in_world).length() < 1e-9);
            let (drone_m, aim_m) = (frame.drone_offset_in_world.length(), frame.aim_offset_in_world.length());
            if frame.position {
                assert!((2.0..=3.0 + 1e-9).contains(&drone_m) && (2.0 - 1e-9..=3.0 + 1e-9).contains(&aim_m));
                // Before the turn the camera looked at the displaced middle of the body.
                let aim = aim_point(&expert.track.states[i], 1.7) + frame.aim_offset_in_world;
                let mut unturned = pose;
                unturned.pitch_rad -= frame.pitch_offset_rad;
                unturned.yaw_rad -= frame.yaw_offset_rad;
                let seen = unturned.body_from_world_point(aim);
                assert!(seen.y.abs() < 1e-6 && seen.z.abs() < 1e-6, "{seen}");
            } else {
                assert_eq!((drone_m, aim_m), (0.0, 0.0));
            }
            let turned = real::hypot(frame.pitch_offset_rad, frame.yaw_offset_rad).to_degrees();
            assert!(turned <= 5.0 + 1e-9 && (frame.rotation || turned == 0.0));
            if !frame.position && !frame.rotation {
                assert_eq!(pose, original);
            }
        }
        assert!(twin.certificate.holds && twin.certificate.mean_visibility == 1.0);
        assert_eq!(twin.perturbation.as_ref().unwrap().expert_item, "p3");
    }

    #[test]
    fn views_never_turn_past_the_vertical_and_record_what_was_turned() {
        let expert = expert(400);
        let config = PerturbConfig { position_probability: 0.0, max_rotation_deg: 90.0, ..PerturbConfig::default() };
        let twin = twin_of(&expert, &BoxBvh::build(vec![]), &config, seed());
        let steepest = 89.9 + 1e-9;
        let mut stopped = 0;
        for (i, frame) in frames(&twin).iter().enumerate() {
            let (pose, original) = (twin.poses_in_world[i], expert.poses_in_world[i]);
            assert!(pose.pitch_rad.to_degrees().abs() <= steepest, "{}", pose.pitch_rad.to_degrees());
            assert!((original.pitch_rad + frame.pitch_offset_rad - pose.pitch_rad).abs() < 1e-12);
            stopped += usize::from(pose.pitch_rad.to_degrees() < -89.8);
        }
        assert!(stopped > 10, "{stopped}");
    }

    #[test]
    fn a_twin_in_a_tunnel_keeps_its_clearance_along_the_whole_way() {
        let (expert, exact) = (expert(700), tunnel());
        let config = PerturbConfig::default();
        let twin = twin_of(&expert, &exact, &config, seed());
        let positions: Vec<DVec3> = twin.poses_in_world.iter().map(|pose| pose.position_in_world).collect();
        for pair in positions.windows(2) {
            assert!(exact.segment_clearance(pair[0], pair[1], 5.0) >= 1.0 - 1e-9);
        }
        assert!(twin.certificate.holds, "{:?}", twin.certificate.violations);
        let shortened = frames(&twin).iter().filter(|f| f.position && f.drone_offset_in_world.length() < 2.0).count();
        let full = frames(&twin).iter().filter(|f| f.drone_offset_in_world.length() >= 2.0).count();
        assert!(shortened > 5 && full > 100, "{shortened} shortened, {full} full");
        assert!(twin.clearance_m.iter().all(|clearance| *clearance >= 1.0 - 1e-9));
    }

    #[test]
    fn an_expert_closer_than_the_clearance_is_reported_and_not_left() {
        let exact =
            BoxBvh::build(vec![OrientedBox::from_corners(DVec3::new(-30.0, 0.5, 0.0), DVec3::new(90.0, 40.0, 60.0))]);
        let (expert, config) = (expert(100), PerturbConfig::default());
        let twin = twin_of(&expert, &exact, &config, seed());
        assert!(!twin.certificate.holds);
        assert!(twin.certificate.violations[0].starts_with("clearance falls to 0.50 m; the limit is 1 m"));
        assert!(twin.clearance_m.iter().all(|clearance| *clearance >= 0.5 - 1e-9));
    }

    #[test]
    fn a_low_flight_is_not_pushed_into_the_ground() {
        let mut expert = expert(300);
        for pose in &mut expert.poses_in_world {
            pose.position_in_world.z = 3.5;
        }
        let twin = twin_of(&expert, &BoxBvh::build(vec![]), &PerturbConfig::default(), seed());
        assert!(twin.poses_in_world.iter().all(|pose| pose.position_in_world.z >= 3.0));
    }

    #[test]
    fn a_twin_depends_on_its_seed_alone() {
        let (expert, exact, config) = (expert(200), tunnel(), PerturbConfig::default());
        let twin = |seed| twin_of(&expert, &exact, &config, seed);
        assert_eq!(twin(seed()), twin(seed()));
        assert_ne!(twin(seed()), twin(Seed::of_item(9, "perturbed", "p4")));
    }

    #[test]
    fn uneven_and_touching_experts_are_rejected_and_empty_ones_have_empty_twins() {
        let config = PerturbConfig::default();
        let reason = |expert: &Trajectory| match perturb(expert, "p3", &tunnel(), &config, seed()) {
            PlanOutcome::Rejected { reason, .. } => reason,
            PlanOutcome::Planned(_) => String::new(),
        };
        let (mut uneven, mut touching) = (expert(10), expert(10));
        uneven.poses_in_world.truncate(4);
        assert_eq!(reason(&uneven), "the expert has 4 poses for 10 frames");
        touching.poses_in_world[5].position_in_world.y = 2.5;
        assert!(reason(&touching).starts_with("the twin comes to"), "{}", reason(&touching));
        assert!(twin_of(&expert(0), &tunnel(), &config, seed()).poses_in_world.is_empty());
    }

    #[test]
    fn a_reversed_range_names_its_parameter() {
        let mut config = PerturbConfig::default();
        assert_eq!(config.validate(), Ok(()));
        config.aim_offset.min_m = 4.0;
        let (path, rule) = config.validate().unwrap_err();
        assert_eq!(path, "aim_offset.min_m");
        assert_eq!(rule, "`aim_offset.min_m` is 4; it must not be above `aim_offset.max_m`, which is 3");
        config.clearance_m = f64::NAN;
        assert_eq!(config.validate().unwrap_err().0, "clearance_m");
    }
}
