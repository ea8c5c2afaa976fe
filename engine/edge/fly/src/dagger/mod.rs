//! Labels where a policy came (DAgger): flights under a mixture of policy and expert, and the expert's action in every state.
//!
//! * [`rollout`]: one episode, flown and labelled.
//! * [`kept`]: pictures and readings of the states, where they are asked for.
//! * [`folder`]: a version of the labels: rounds, arrays, card; [`difference`]: two versions side by side.
//! * [`run`]: a round, on several threads.

pub mod difference;
pub mod folder;
pub mod kept;
mod npy;
pub mod rollout;
pub mod run;
