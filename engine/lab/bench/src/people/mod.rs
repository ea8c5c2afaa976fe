//! `cosfly-lab people`: simulated people beside recorded ones: speeds, stops, turns, groups, distances, and the fall of speed
//! with density.

mod crowds;
mod density;
mod figures;
mod table;

pub use crowds::{Crowded, crowded, crowded_along};
pub use density::{DensityRow, density};
pub use figures::{Figures, SAMPLE_S, Tracks};
pub use table::PeopleTable;
