//! [`Kind`]: a kind of perturbation, and what a departure is made from.

use crate::perturb::sizes::{FlyableConfig, JumpSizes};
use cosfly_domain::{FramePerturbation, Trajectory};
use cosfly_frames::{DVec3, Pose, TargetTrack};
use cosfly_random::Seed;
use cosfly_surroundings::exact::ExactMap;

/// Kind of perturbation.
pub struct Kind {
    /// Name in recipes and tables; its key in `mixture`.
    pub name: &'static str,
    /// Description for the reference page, a sentence.
    pub doc: &'static str,
    /// The departure itself.
    pub departure: Departure,
}

/// Poses of a twin, and the recorded departure of each.
pub type Departed = (Vec<Pose>, Vec<FramePerturbation>);

/// Displacements of a twin, one per frame, world frame, metres.
pub type Offsets = fn(&Departing<'_>) -> Vec<DVec3>;

/// Views of a twin from those that keep the expert's aim.
pub type Views = fn(&Departing<'_>, &TargetTrack, &[Pose]) -> Vec<Pose>;

/// Departure of a twin from its expert.
pub enum Departure {
    /// Frame by frame, as no drone could fly it.
    FrameByFrame(fn(&Trajectory, ExactMap<'_>, &JumpSizes<'_>, &Seed) -> Departed),
    /// Displaced as a drone could fly. Displacements shrink until clearance, height, speed and acceleration hold; views
    /// turn no faster than `max_rate_deg_s`.
    Flown {
        /// Displacements beside the drift that every such twin has; `no_offsets` for none.
        offsets: Offsets,
        /// Views from the displaced places; `straight_on` for the expert's aim.
        views: Views,
    },
}

/// Values that displacements and views of a twin depend on.
#[derive(Clone, Copy)]
pub struct Departing<'a> {
    /// Positions of the expert, one per frame, world frame, metres.
    pub places: &'a [DVec3],
    /// Time between frames, seconds.
    pub dt_s: f64,
    /// Sizes and limits.
    pub config: &'a FlyableConfig,
    /// Seed of the twin: take streams of own names from it.
    pub seed: &'a Seed,
}

/// No displacements beside the drift.
pub(super) fn no_offsets(_: &Departing<'_>) -> Vec<DVec3> {
    vec![]
}

/// Views that keep the expert's aim.
pub(super) fn straight_on(_: &Departing<'_>, _: &TargetTrack, straight: &[Pose]) -> Vec<Pose> {
    straight.to_vec()
}
