//! A finished flight: camera poses frame by frame, what it cost, and what was verified about it.

use cosfly_frames::{DVec3, Pose, TargetTrack};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// The planner's answer to a target track: a certified trajectory, or the reason why there is none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum PlanOutcome {
    /// Safe and complete.
    Planned(Box<Trajectory>),
    /// No valid trajectory; the reason is published with the dataset, never a bad flight.
    Rejected {
        /// The track that could not be followed.
        track: TargetTrack,
        /// Reason, in words.
        reason: String,
    },
}

/// One flight behind one target. All per-frame vectors have the track's length.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trajectory {
    /// The target that is followed.
    pub track: TargetTrack,
    /// Drone (= camera) pose per frame.
    pub poses_in_world: Vec<Pose>,
    /// Share of the target's body points that an unoccluded ray reaches, 0..=1, per frame, exact boxes.
    pub visibility: Vec<f64>,
    /// Distance from drone to the nearest exact obstacle per frame, metres, capped at 50.
    pub clearance_m: Vec<f64>,
    /// Cost per term of the recipe's weights.
    pub terms: Vec<TermCost>,
    /// Share of the inspected faces that each frame is the first to see; empty but for inspections.
    pub coverage: Vec<f64>,
    /// Labels that plugins gave, in the order in which they were given; names differ.
    pub labels: Vec<FlightLabel>,
    /// Total cost against the planning boxes: before and after refinement, and of the flight itself; with
    /// `preset = "paper"` after each iteration of its descent in between. Stretch by stretch on tracks that are planned so;
    /// empty for baselines.
    pub convergence: Vec<f64>,
    /// Figures and limits, checked at the end against the unsimplified map.
    pub certificate: Certificate,
    /// Departure from the expert; `None` for an expert.
    pub perturbation: Option<Perturbation>,
}

/// One named cost term, summed over the frames, before and after weighting.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TermCost {
    /// Name in recipes, such as `visibility`.
    pub name: String,
    /// Weight of the term.
    pub weight: f64,
    /// Sum over the frames, unweighted.
    pub sum: f64,
    /// Unweighted cost of each frame.
    pub per_frame: Vec<f64>,
}

/// A label of a plugin: one value per frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FlightLabel {
    /// Name of the label.
    pub name: String,
    /// Name of the plugin that gave it.
    pub plugin: String,
    /// Version of the plugin.
    pub version: String,
    /// Values, one per frame.
    pub per_frame: Vec<f64>,
}

/// Stated limits of a flight; violations are explicit failures of planning.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    /// Smallest distance from obstacles along the whole swept path, metres.
    pub clearance_m: f64,
    /// Speed, m/s.
    pub speed_mps: f64,
    /// Acceleration, m/s^2.
    pub acceleration_mps2: f64,
    /// Jerk, m/s^3.
    pub jerk_mps3: f64,
    /// Yaw rate, degrees per second.
    pub yaw_rate_deg_s: f64,
    /// Pitch rate, degrees per second.
    pub pitch_rate_deg_s: f64,
}

/// Facts about the finished path, computed in f64 against the unsimplified boxes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Certificate {
    /// Limits that the flight was checked against.
    pub limits: Limits,
    /// Whether all limits hold; a published expert always has clearance.
    pub holds: bool,
    /// Violated limits, in words; empty when all hold.
    pub violations: Vec<String>,
    /// Mean visibility over the frames.
    pub mean_visibility: f64,
    /// Share of frames with visibility of at least one half.
    pub frames_half_visible: f64,
    /// Smallest distance of the swept path to an obstacle, metres, capped at 50.
    pub min_clearance_m: f64,
    /// Largest finite-difference speed, m/s.
    pub max_speed_mps: f64,
    /// Largest finite-difference acceleration, m/s^2.
    pub max_acceleration_mps2: f64,
    /// Largest finite-difference jerk, m/s^3.
    pub max_jerk_mps3: f64,
    /// Largest yaw rate of the camera from frame to frame, degrees per second.
    pub max_yaw_rate_deg_s: f64,
    /// Largest pitch rate of the camera from frame to frame, degrees per second.
    pub max_pitch_rate_deg_s: f64,
    /// Mean 3-D distance from drone to target's feet, metres.
    pub mean_distance_m: f64,
    /// Mean angle between "target to drone" and "against the walking direction", degrees, horizontal.
    pub mean_rear_angle_deg: f64,
    /// Path length of the drone, metres.
    pub length_m: f64,
    /// Path length divided by the target's; 0 when the target stands.
    pub length_ratio: f64,
    /// Visibility along the way through the lattice that the flight was refined from, mean over the lattice's layers; the
    /// flight may see more. Of a causal flight, the visibility that its plans promised, mean over its frames. 0 where no lattice
    /// was searched.
    pub lattice_visibility: f64,
    /// `lattice_visibility` minus the flight's visibility; 0 when the flight sees as much or more.
    pub visibility_regret: f64,
    /// Lattices tried, from the fast one to finer and calmer ones.
    pub attempts: u32,
    /// Searches through the last lattice, one more for every connection that was not free.
    pub searches: u32,
    /// Steps of refinement, descent and smoothing.
    pub iterations: u32,
    /// Obstacle boxes left by the per-path filter.
    pub filtered_boxes: u32,
    /// Time for which the target was to be lost on purpose, seconds.
    pub occlusion_ordered_s: f64,
    /// Time for which the target was lost where that was ordered, seconds.
    pub occlusion_reached_s: f64,
}

/// Kind of departure of a twin from its expert: its name in recipes and tables. The list of kinds is `KINDS` of `sim/pilot`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PerturbationKind(Cow<'static, str>);

impl PerturbationKind {
    /// Independent displacements and turns, frame by frame (the paper's): the only kind that no drone could fly.
    pub const JUMPS: Self = Self::named("jumps");

    /// The kind of a name.
    pub const fn named(name: &'static str) -> Self {
        Self(Cow::Borrowed(name))
    }

    /// Name in recipes and tables.
    pub fn name(&self) -> &str {
        &self.0
    }

    /// Whether a drone could fly it: speed, acceleration and rates of turning are bounded.
    pub fn is_flyable(&self) -> bool {
        *self != Self::JUMPS
    }
}

/// Departure of a perturbed trajectory from its expert (paper, dual-trajectory augmentation).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Perturbation {
    /// Item id of the expert in its stage.
    pub expert_item: String,
    /// Kind of the departure.
    pub kind: PerturbationKind,
    /// Probability of the position event per frame; 0 for all kinds but `jumps`.
    pub position_probability: f64,
    /// Probability of the rotation event per frame; 0 for all kinds but `jumps`.
    pub rotation_probability: f64,
    /// One entry per frame.
    pub frames: Vec<FramePerturbation>,
}

/// Events and displacements of one frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FramePerturbation {
    /// The position event occurred: the drone is displaced.
    pub position: bool,
    /// The rotation event occurred: the view is turned.
    pub rotation: bool,
    /// Displacement of the drone, metres; zero without the event.
    pub drone_offset_in_world: DVec3,
    /// Displacement of the point that the camera was aimed at, metres; zero without the event.
    pub aim_offset_in_world: DVec3,
    /// Turn added to the pitch, radians.
    pub pitch_offset_rad: f64,
    /// Turn added to the yaw, radians.
    pub yaw_offset_rad: f64,
    /// Frame of the expert that this frame belongs to.
    pub expert_frame: u32,
}
