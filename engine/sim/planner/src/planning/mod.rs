//! From a request to a certified flight, whoever plans it: the optimiser, the paper's pipeline or a baseline.
//!
//! ```text
//! check the request                                                (plan)
//! put frames before a given start                                  (start)
//! join a known flight from there, or                               (join)
//! hand the problem to the planner that the recipe names            (planners)
//!   long tracks in stretches                                       (stretches)
//!   from moment to moment where the future is not known            (causal)
//!     and blindly while the target is lost on purpose              (causal_losses)
//! publish what holds, with poses and the costs of all terms        (publish)
//! ```

mod causal;
mod causal_losses;
mod join;
mod plan;
mod planners;
mod publish;
mod start;
mod stretches;

pub use plan::{plan, plan_request, plan_with_terms};
