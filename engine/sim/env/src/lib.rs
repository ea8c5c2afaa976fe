//! Closed-loop tracking: a drone, its target and its surroundings, stepped by actions.
//!
//! An [`Episode`] is a town, the track of a target, whoever else moves ([`Others`]), and a start. An [`Environment`] flies it: each step takes an [`Action`] and
//! gives an [`Observation`], a [`Reward`] by named terms, and the [`End`] where there is one; [`EpisodeScore`] is the outcome so far.
//! Steps depend on the episode, the [`EnvironmentSettings`] and the actions alone, and allocate nothing.
//!
//! A [`Policy`] answers observations; [`policies`] are the baselines. [`pictures`] draws what the cameras see, [`readings`] are those of
//! sensors that are no cameras.

mod action;
mod action_number;
mod craft;
mod environment;
mod episode;
mod observation;
mod others;
pub mod pictures;
mod place;
pub mod policies;
mod readings;
mod reward;
mod score;
mod settings;
mod suite;

#[cfg(test)]
mod tests;

pub use action::{Action, Drive, VelocityAxes};
pub use action_number::ActionNumber;
pub use environment::{Environment, Step};
pub use episode::{Episode, Start};
pub use observation::{FEATURES, Observation, TargetSighting};
pub use others::{BodyAtTime, EpisodeBody, Others};
pub use place::FlightSite;
pub use policies::Policy;
pub use readings::readings;
pub use reward::Reward;
pub use score::{End, EpisodeScore};
pub use settings::{Blackouts, DroneSettings, EnvironmentSettings, FieldOfView, RewardWeights};
pub use suite::{MOST_BLACKOUTS, MOST_LATENCY_MS, MOST_WIND_MPS, SuiteTable};
