//! MuCO, the multi-constraint trajectory optimiser, its safety layers, and the perturbed twins.
//!
//! [`plan`] turns a target track into a certified [`Trajectory`] or says why there is none. What is worth seeing
//! is in [`terms`] (one file per cost term), how it is found in [`muco`], what is promised in [`certificate`].

pub mod baselines;
pub mod certificate;
pub mod config;
pub mod equations;
pub mod found;
pub mod gradient;
pub mod muco;
pub mod objectives;
pub mod obstacles;
pub mod paper;
pub mod perturb;
pub mod planning;
pub mod problem;
pub mod request;
pub mod scenes;
pub mod terms;
mod track_check;
pub mod trajectory;
pub mod visibility;
pub mod walk;
pub mod weights;

pub use config::MucoConfig;
pub use planning::{plan, plan_request, plan_with_terms};
pub use request::{PlanRequest, StartState};
pub use terms::{CostTerm, TermContext, WeightedTerm};
pub use terms::{WeightOverrides, Weights};
pub use trajectory::{Certificate, FramePerturbation, Limits, Perturbation, PlanOutcome, TermCost, Trajectory};
pub use visibility::{aim_point, body_points, visibility};
pub use weights::Preset;
