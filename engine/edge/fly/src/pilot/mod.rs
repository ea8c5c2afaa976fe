//! Policies of an evaluation: baselines, servers, functions in Python.

mod answer;
mod baseline;
mod first_answer;
mod manners;
mod open;
mod place;
mod process;
mod python;
mod question;
mod seam;
mod socket;
mod source;

pub use answer::{ActionKind, Answer, wrong_number};
pub use first_answer::{Asked, FirstAnswer};
pub use manners::Manners;
pub use open::open;
pub use place::Place;
pub use seam::{Failure, Pilot};
pub use source::source_of;
