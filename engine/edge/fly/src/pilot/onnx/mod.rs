//! Policies that are networks in ONNX files.
//!
//! * [`OnnxPolicy`]: the file, with the description in its metadata.
//! * `pilot`: the policy in an episode: pictures, history, memory.

mod description;
mod observation;
mod pilot;
mod policy;

pub use description::FARTHEST_M;
pub use observation::units_of;
pub use pilot::OnnxPilot;
pub use policy::OnnxPolicy;
