//! Seeded streets, alleys and canyons with walkers in them: for tests, examples and benchmarks.
//!
//! The kinds follow the planner's reference figures: `light` and `leafy` are 16 m streets between houses of 8 to 26 m
//! with trees over the pavement (a third of the places or nearly all; in
//! `tunnel` with crowns that nearly touch), `alley` and `canyon` are gaps of 4.5 to 7 m and
//! 4.2 to 5.2 m between houses of 20 to 45 m and 40 to 60 m. `fine` is `leafy` cut into some 65,000 boxes.

mod movers;
mod scene;

pub use movers::movers_around;
pub use scene::{SceneKind, SeededScene};
