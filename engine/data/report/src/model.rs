//! Content of the page: sketches of towns and flights, a few numbers per frame. World frame, metres, degrees.

use crate::figures::Figures;
use cosfly_metrics::shortcuts::ShortcutFigures;
use serde::{Deserialize, Serialize};

/// A dataset as the page shows it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// Heading of the page.
    pub title: String,
    /// Description, one paragraph.
    pub description: String,
    /// Short name and version.
    pub name_and_version: String,
    /// Day of publication, `YYYY-MM-DD`.
    pub published: String,
    /// Name of the licence.
    pub license: String,
    /// Publisher.
    pub creator: String,
    /// Languages of the captions.
    pub languages: Vec<String>,
    /// Towns by name.
    pub towns: Vec<TownSketch>,
    /// Figures over all flights, and sketches of some.
    pub figures: Figures,
    /// Items without a flight.
    pub rejections: Vec<RejectionSketch>,
    /// Comparison of planners; without rows there is no section.
    pub planners: Vec<PlannerRow>,
    /// Signs that give targets away; without frames there is no section.
    pub shortcuts: Option<ShortcutFigures>,
}

/// A town seen from above.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TownSketch {
    /// Name.
    pub name: String,
    /// Obstacles.
    pub boxes: Vec<BoxSketch>,
}

/// An obstacle seen from above.
#[derive(Clone, Debug, PartialEq)]
pub struct BoxSketch {
    /// Boxes with the same id are one object.
    pub instance: u32,
    /// Kind as in table `objects`, such as `building`.
    pub kind: String,
    /// Middle: x east, y south.
    pub center_m: [f64; 2],
    /// Half lengths along the box's own axes.
    pub half_m: [f64; 2],
    /// Yaw from x towards y, radians.
    pub yaw_rad: f64,
}

/// An item without a flight.
#[derive(Clone, Debug, PartialEq)]
pub struct RejectionSketch {
    /// The id that the flight would have had.
    pub id: String,
    /// Stage that rejected the item.
    pub stage: String,
    /// Reason.
    pub reason: String,
}

/// Figures of a planner; all planners have the same walks.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlannerRow {
    /// Name.
    pub planner: String,
    /// Number of walks.
    pub asked: u64,
    /// Number of flights that were found; the other numbers are means or extremes over them.
    pub planned: u64,
    /// Number of flights that keep all limits.
    pub sound: u64,
    /// Mean visibility, 0..=1.
    pub visible: KnownNumber,
    /// Share of frames with at least half of the target visible, 0..=1.
    pub half_visible: KnownNumber,
    /// Mean distance to the target, metres.
    pub distance_m: KnownNumber,
    /// Mean length of the way, metres.
    pub length_m: KnownNumber,
    /// Smallest distance of a swept way to an obstacle, metres.
    pub nearest_m: KnownNumber,
    /// Largest acceleration, m/s^2.
    pub acceleration_mps2: KnownNumber,
    /// Largest jerk, m/s^3.
    pub jerk_mps3: KnownNumber,
    /// Weighted cost of each term per frame.
    pub costs: Vec<(String, f64)>,
    /// Reason of the first walk without a flight.
    pub refusal: Option<String>,
}

/// A number that may be unknown.
pub type KnownNumber = Option<f64>;
