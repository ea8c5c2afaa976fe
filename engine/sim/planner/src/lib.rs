//! MuCO, the multi-constraint trajectory optimiser, its safety layers, and the perturbed twins.

pub mod trajectory;

pub use trajectory::{Certificate, FramePerturbation, Limits, Perturbation, PlanOutcome, TermCost, Trajectory};
