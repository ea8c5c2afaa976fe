//! MuCO, the multi-constraint trajectory optimiser, and its safety layers.
//!
//! [`plan`] turns a target track into a certified [`cosfly_domain::Trajectory`] or gives the reason why there is none; [`plan_request`] also
//! takes start states, companions, moving boxes and further cost terms. Where a call can fail, its error is [`PlanError`].
//!
//! ```
//! use cosfly_domain::{OrientedBox, PlanOutcome};
//! use cosfly_frames::{DVec3, TargetState, TargetTrack};
//! use cosfly_geometry::BoxBvh;
//! use cosfly_planner::{MucoConfig, PlanRequest, plan_request};
//!
//! let state = |frame: u32| TargetState {
//!     feet_in_world: DVec3::new(0.6 * f64::from(frame), 0.0, 0.0),
//!     heading_rad: 0.0,
//!     speed_mps: 1.2,
//! };
//! let track = TargetTrack { dt_s: 0.5, height_m: 1.75, radius_m: 0.3, states: (0..40).map(state).collect() };
//! let boxes = [OrientedBox::from_corners(DVec3::new(4.0, 4.0, 0.0), DVec3::new(14.0, 10.0, 8.0))];
//! let (map, config) = (BoxBvh::build(boxes.to_vec()), MucoConfig::default());
//! match plan_request(PlanRequest::new(&track, &map, &boxes, &|_, _| 0.0, &config)) {
//!     PlanOutcome::Planned(flight) => assert!(flight.certificate.holds && flight.poses_in_world.len() == 40),
//!     PlanOutcome::Rejected { reason, .. } => panic!("{reason}"),
//! }
//! ```
//!
//! * [`config`]: the parameters, with their ranges.
//! * [`terms`]: the cost, one file per term; a term of your own implements [`CostTerm`].
//! * [`certificate`]: the promises of a published flight. The map around a path is the room `cosfly-surroundings`.
//! * [`baselines`]: planners to compare with.
//!
//! Modules that the documentation leaves out are parts of the planners, open for the project's own benches; they may change at any time.

pub mod baselines;
pub mod certificate;
pub mod config;
#[doc(hidden)]
pub mod equations;
mod error;
mod found;
#[doc(hidden)]
pub mod gradient;
#[doc(hidden)]
pub mod muco;
#[doc(hidden)]
pub mod paper;
mod planning;
#[doc(hidden)]
pub mod problem;
mod request;
pub mod terms;
mod track_check;
mod walk;
mod weights;

pub use config::MucoConfig;
pub use error::PlanError;
pub use planning::{plan, plan_request, plan_with_terms};
pub use request::{PlanRequest, StartState};
pub use terms::{CostTerm, TermContext, WeightedTerm};
pub use terms::{WeightOverrides, Weights};
pub use walk::Walk;
pub use weights::Preset;
