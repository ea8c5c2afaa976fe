//! Policies of an evaluation: baselines, servers, functions in Python, networks in ONNX files.

mod answer;
mod baseline;
mod first_answer;
mod manners;
mod onnx;
mod open;
mod place;
mod process;
mod python;
mod question;
mod runnable;
mod seam;
mod socket;
mod source;

pub use answer::{ActionKind, PolicyAnswer, wrong_number};
pub use first_answer::{Asked, FirstAnswer};
pub use manners::Manners;
pub use onnx::{FARTHEST_M, OnnxPolicy, units_of};
pub use open::open;
pub use place::Place;
pub use runnable::Runnable;
pub use seam::{Pilot, PilotFailure};
pub use source::source_of;
