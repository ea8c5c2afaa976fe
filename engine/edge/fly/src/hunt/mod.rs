//! Hunting: episodes in which a policy fails and the expert does not, within a budget of flights.
//!
//! * [`range`]: what may vary.
//! * [`pool`]: the candidates: episodes of recipes drawn from the ranges.
//! * [`scouts`]: baselines that fly every candidate first; the expert says which can be flown at all.
//! * `hidden_views`: how much of the air around a target has no sight of it.
//! * [`guess`]: how likely the policy fails, by what the scouts did and by the failures so far.
//! * [`search`]: rounds of flights, the likeliest failures first.
//! * [`found`]: the suite of the failures, and the recipe of training data around them.

pub mod found;
pub mod guess;
mod hidden_views;
pub mod pool;
pub mod range;
pub mod scouts;
pub mod search;
mod toml_text;
