//! Windows for training and evaluation: where they start in a flight, and how hard they are.

mod difficulty;
mod shape;

pub use difficulty::{Difficulty, EASY_BELOW, HARD_FROM, WindowFeatures, WindowFrames};
pub use shape::WindowShape;
