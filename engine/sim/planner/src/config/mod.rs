//! Parameters of the `plan` stage: one file per table of the recipe, with defaults, ranges and contradictions.

pub mod descent;
pub mod drones;
pub mod foresight;
pub mod limits;
pub mod muco;
pub mod occlusion;
pub mod paper;
pub mod planner;
pub(crate) mod ranges;
pub mod search;
pub mod targets;
pub mod view;

pub use cosfly_surroundings::SeveralTargets;
pub use descent::DescentConfig;
pub use drones::DronesConfig;
pub use foresight::{CausalConfig, Foresight};
pub use limits::LimitsConfig;
pub use muco::MucoConfig;
pub use occlusion::OcclusionConfig;
pub use paper::PaperConfig;
pub use planner::Planner;
pub use ranges::{RangeRefusal, in_range};
pub use search::{SearchConfig, SearchEffort};
pub use targets::TargetsConfig;
pub use view::ViewConfig;
