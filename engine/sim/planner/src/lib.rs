//! MuCO, the multi-constraint trajectory optimiser, and its safety layers.
//!
//! [`plan`] turns a target track into a certified [`cosfly_domain::Trajectory`] or gives the reason why there is none.
//!
//! * [`planning`]: from a request to a published flight; hands the problem to the planner that the recipe names.
//! * [`muco`], [`paper`], [`baselines`]: the optimiser, the paper's own pipeline, planners to compare with.
//! * [`terms`]: the cost, one file per term.
//! * [`certificate`]: the promises of a published flight. The map around a path is the room `cosfly-surroundings`.

pub mod baselines;
pub mod certificate;
pub mod config;
pub mod equations;
pub mod found;
pub mod gradient;
pub mod muco;
pub mod paper;
pub mod planning;
pub mod problem;
pub mod request;
pub mod terms;
mod track_check;
pub mod walk;
pub mod weights;

pub use config::MucoConfig;
pub use planning::{plan, plan_request, plan_with_terms};
pub use request::{PlanRequest, StartState};
pub use terms::{CostTerm, TermContext, WeightedTerm};
pub use terms::{WeightOverrides, Weights};
pub use weights::Preset;
